// Records into a picture: the surface's own shade, plus what arrives by each of its lobes.
#import bindings::scene::{materials, objects}
#import common::record::NO_OBJECT
#ifdef GLASS
@group(0) @binding(4) var refracted: texture_2d<f32>;
#endif
#ifdef FADES
// The fourth channel is the length of the path from the mirror to what it shows.
@group(0) @binding(5) var last: texture_2d<f32>;
#endif
#ifdef BY_ANGLE
#import bindings::departure::{LOBE_REFLECTED, LOBE_REFRACTED, depart}
#import common::camera::{Camera, arriving}

@group(0) @binding(30) var<uniform> camera: Camera;
@group(0) @binding(32) var reflector_position: texture_2d<f32>;
@group(0) @binding(33) var reflector_normal: texture_2d<f32>;
#endif

@group(0) @binding(0) var direct: texture_2d<f32>;
@group(0) @binding(1) var radiance: texture_2d<f32>;
@group(0) @binding(31) var reflector_id: texture_2d<u32>;
@group(0) @binding(3) var picture: texture_storage_2d<rgba16float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) pixel: vec3<u32>) {
    if any(pixel.xy >= textureDimensions(direct)) {
        return;
    }
    var colour = textureLoad(direct, pixel.xy, 0).rgb;
    let object = textureLoad(reflector_id, pixel.xy, 0).x;
    if object != NO_OBJECT {
        let material = materials[objects[object].material];
        var mirrored = textureLoad(radiance, pixel.xy, 0).rgb;
#ifdef FADES
        if material.fade_distance > 0.0 {
            // Rust twin: Fade of scene/material.rs.
            let left = exp(-textureLoad(last, pixel.xy, 0).w / material.fade_distance);
            mirrored *= mix(left, 1.0, material.fade_floor);
        }
#endif
#ifdef BY_ANGLE
        let position = textureLoad(reflector_position, pixel.xy, 0).xyz;
        let normal = textureLoad(reflector_normal, pixel.xy, 0);
        let incident = arriving(camera, position);
        let front = normal.w == 1.0;
        let back = depart(material, LOBE_REFLECTED, incident, normal.xyz, front);
        colour += back.weight * mirrored;
#ifdef GLASS
        let on = depart(material, LOBE_REFRACTED, incident, normal.xyz, front);
        if on.exists {
            colour += on.weight * textureLoad(refracted, pixel.xy, 0).rgb;
        }
#endif
#else
        colour += material.reflectance * material.tint * mirrored;
#endif
    }
    textureStore(picture, pixel.xy, vec4(colour, 1.0));
}
