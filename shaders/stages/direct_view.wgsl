enable primitive_index;
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
#ifdef RECORD_FULL
    @location(3) triangle: u32,
#endif
}

@fragment
#ifdef RECORD_FULL
fn fragment(in: Surface, @builtin(primitive_index) triangle: u32) -> Seen {
#else
fn fragment(in: Surface) -> Seen {
#endif
    var seen: Seen;
    seen.colour = vec4(surface_colour(in, arriving(camera, in.position)), 1.0);
    seen.depth = dot(in.position - camera.eye, camera.forward);
    seen.object = in.object;
#ifdef RECORD_FULL
    seen.triangle = triangle;
#endif
    return seen;
}
