// Records into a picture: the surface's own shade, plus the reflection through the mirror's tint.
#import bindings::scene::{materials, objects}
#import common::record::NO_OBJECT

@group(0) @binding(0) var direct: texture_2d<f32>;
@group(0) @binding(1) var radiance: texture_2d<f32>;
@group(0) @binding(2) var reflector_id: texture_2d<u32>;
@group(0) @binding(3) var picture: texture_storage_2d<rgba16float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) pixel: vec3<u32>) {
    if any(pixel.xy >= textureDimensions(direct)) {
        return;
    }
    var colour = textureLoad(direct, pixel.xy, 0).rgb;
    let object = textureLoad(reflector_id, pixel.xy, 0).x;
    if object != NO_OBJECT {
        let mirror = materials[objects[object].material];
        colour += mirror.reflectance * mirror.tint * textureLoad(radiance, pixel.xy, 0).rgb;
    }
    textureStore(picture, pixel.xy, vec4(colour, 1.0));
}
