// One level of the depth pyramid from the one below it: a cell has the nearest and the farthest surface
// of two by two cells. The last cell of a row or column has what is left, three where the number below is
// odd, so that the pixel p lies in cell min(p >> level, last) whatever the image's size.
@group(0) @binding(0) var below: texture_2d<u32>;
@group(0) @binding(1) var<uniform> level_below: u32;
@group(0) @binding(2) var bounds: texture_storage_2d<rg32uint, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) cell: vec3<u32>) {
    let size = textureDimensions(bounds);
    if any(cell.xy >= size) {
        return;
    }
    let all_below = textureDimensions(below, level_below);
    let last = select(2u * cell.xy + 1u, all_below - 1u, cell.xy == size - 1u);
    var range = vec2(3.0e38, 0.0);
    for (var y = 2u * cell.y; y <= last.y; y += 1u) {
        for (var x = 2u * cell.x; x <= last.x; x += 1u) {
            let one = bitcast<vec2<f32>>(textureLoad(below, vec2(x, y), level_below).xy);
            range = vec2(min(range.x, one.x), max(range.y, one.y));
        }
    }
    textureStore(bounds, cell.xy, vec4(bitcast<vec2<u32>>(range), 0u, 0u));
}
