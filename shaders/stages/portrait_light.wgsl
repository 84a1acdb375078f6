// Light on portraits, as their objects stand this frame.
#import bindings::portrait::{Portrait, portrait_rotated}
#import bindings::scene::illumination

@group(0) @binding(0) var albedo: texture_2d_array<f32>;
@group(0) @binding(1) var normal: texture_2d_array<f32>;
@group(0) @binding(2) var radiance: texture_storage_2d_array<rgba16float, write>;
@group(0) @binding(3) var<storage, read> portraits: array<Portrait>;

// Layers stand below one another in the second dimension.
@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = textureDimensions(radiance);
    let layer = id.y / size.y;
    if id.x >= size.x || layer >= arrayLength(&portraits) {
        return;
    }
    let texel = vec2(id.x, id.y % size.y);
    let own = textureLoad(albedo, texel, layer, 0);
    let n = portrait_rotated(portraits[layer], textureLoad(normal, texel, layer, 0).xyz);
    // Where nothing is, all is 0: colours are weighted by their cover, as mip maps want it.
    textureStore(radiance, texel, layer, vec4(own.a * own.rgb * illumination(n), own.a));
}
