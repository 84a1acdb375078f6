// One reflector's points and normals as the eye sees them: T_P and T_N of Estalella et al. 2006,
// section 4.
#import bindings::surface::{Surface, surface_vertex}
#import common::camera::{Camera, arriving, seen_normal}

@group(0) @binding(30) var<uniform> camera: Camera;

@vertex
fn vertex(
    @builtin(vertex_index) index: u32,
    @builtin(instance_index) object: u32,
) -> Surface {
    var out = surface_vertex(index, object);
    out.clip = camera.clip_from_world * vec4(out.position, 1.0);
    return out;
}

struct Texel {
    // The fourth is 1 where the reflector is.
    @location(0) position: vec4<f32>,
    @location(1) normal: vec4<f32>,
}

@fragment
fn fragment(in: Surface) -> Texel {
    let normal = seen_normal(in.normal, arriving(camera, in.position));
    return Texel(vec4(in.position, 1.0), vec4(normal, 0.0));
}
