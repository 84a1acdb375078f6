// A portrait as a depth image: heights above the farthest it can show, in which straight lines stay
// straight, four neighbours a texel.
#import bindings::portrait::{Portrait, portrait_clip}
#import depth_impostors::build::build

@group(0) @binding(1) var<storage, read> portraits: array<Portrait>;
@group(0) @binding(2) var portrait_albedo: texture_2d_array<f32>;
@group(0) @binding(3) var portrait_point: texture_2d_array<f32>;
// Of each texel: its own height and that of its right neighbour, then of the two below these; 16 bits each,
// 0 where nothing is.
@group(0) @binding(4) var quads: texture_storage_2d_array<rg32uint, write>;

fn height(texel: vec2<u32>) -> f32 {
    if any(texel >= vec2(build.size)) {
        return 0.0;
    }
    if textureLoad(portrait_albedo, texel, build.layer, 0).a == 0.0 {
        return 0.0;
    }
    let before = textureLoad(portrait_point, texel, build.layer, 0).w;
    let clip = portrait_clip(portraits[build.layer], vec3(0.0, 0.0, before));
    // What is farthest is still something.
    return clamp(clip.z / clip.w, 1.0 / 65535.0, 1.0);
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= vec2(build.size)) {
        return;
    }
    let top = vec2(height(id.xy), height(id.xy + vec2(1u, 0u)));
    let bottom = vec2(height(id.xy + vec2(0u, 1u)), height(id.xy + vec2(1u, 1u)));
    let quad = vec4(pack2x16unorm(top), pack2x16unorm(bottom), 0u, 0u);
    textureStore(quads, id.xy, build.layer, quad);
}
