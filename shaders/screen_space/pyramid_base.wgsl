// Level 0 of the depth pyramid: nearest and farthest surface of each pixel, which are the same.
@group(0) @binding(0) var depth: texture_2d<f32>;
@group(0) @binding(1) var bounds: texture_storage_2d<rg32uint, write>;

// Beyond any surface's depth; the direct view is infinite where there is no surface.
const EMPTY: f32 = 3.0e38;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) pixel: vec3<u32>) {
    if any(pixel.xy >= textureDimensions(bounds)) {
        return;
    }
    let z = textureLoad(depth, pixel.xy, 0).x;
    // Nothing to be met: nearest beyond all, farthest before all.
    let range = select(vec2(z), vec2(EMPTY, 0.0), z >= EMPTY);
    textureStore(bounds, pixel.xy, vec4(bitcast<vec2<u32>>(range), 0u, 0u));
}
