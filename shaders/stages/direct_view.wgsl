// What the eye sees directly: the diffuse shade of every surface, mirrors' included.
#import bindings::surface::{Surface, surface_colour, surface_vertex}
#import common::camera::{Camera, arriving}

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

struct Seen {
    @location(0) colour: vec4<f32>,
    // Distance along the camera's axis.
    @location(1) depth: f32,
    @location(2) object: u32,
}

@fragment
fn fragment(in: Surface) -> Seen {
    let colour = surface_colour(in, arriving(camera, in.position));
    let depth = dot(in.position - camera.eye, camera.forward);
    return Seen(vec4(colour, 1.0), depth, in.object);
}
