// The pyramid over one reflector's texels: of each cell the texel of the reflector nearest to its
// middle. A level has half the cells of the one below, rounded down; its last row and column take what
// is left over.
#import virtual_objects::reflector::{NOWHERE, mirror_position, packed_texel, unpacked_texel}

// The level of `cells`; 0 is the textures' own.
@group(0) @binding(2) var<uniform> level: u32;
@group(0) @binding(3) var cells_below: texture_2d<u32>;
@group(0) @binding(4) var cells: texture_storage_2d<r32uint, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = textureDimensions(cells);
    if any(id.xy >= size) {
        return;
    }
    if level == 0u {
        let texel = vec2<i32>(id.xy);
        let shows = textureLoad(mirror_position, texel, 0).w == 1.0;
        textureStore(cells, id.xy, vec4(select(NOWHERE, packed_texel(texel), shows)));
        return;
    }
    let below = textureDimensions(cells_below, level - 1u);
    let first = 2u * id.xy;
    let last = select(first + 1u, below - 1u, id.xy == size - 1u);
    let middle = vec2<f32>(first + last + 1u) * 0.5 * f32(1u << (level - 1u));
    var nearest = NOWHERE;
    var least = 1e30;
    for (var y = first.y; y <= last.y; y += 1u) {
        for (var x = first.x; x <= last.x; x += 1u) {
            let texel = textureLoad(cells_below, vec2(x, y), level - 1u).x;
            let away = vec2<f32>(unpacked_texel(texel)) + 0.5 - middle;
            if texel != NOWHERE && dot(away, away) < least {
                least = dot(away, away);
                nearest = texel;
            }
        }
    }
    textureStore(cells, id.xy, vec4(nearest));
}
