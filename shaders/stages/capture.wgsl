enable primitive_index;
// Surfaces into the six faces of a cube at once: colour, and where each texel's point is.
#import bindings::faces::{cube, face_vertex}
#import bindings::surface::{Surface, surface_colour}

// The layer drawn into.
var<immediate> face: u32;

@vertex
fn vertex(
    @builtin(vertex_index) index: u32,
    @builtin(instance_index) object: u32,
) -> Surface {
    return face_vertex(index, object, face);
}

struct Texel {
    @location(0) radiance: vec4<f32>,
    // w = 1: a surface point.
    @location(1) point: vec4<f32>,
    // Object, triangle.
    @location(2) ids: vec4<u32>,
}

@fragment
fn fragment(in: Surface, @builtin(primitive_index) triangle: u32) -> Texel {
    let colour = surface_colour(in, in.position - cube.centre);
    let ids = vec4(in.object, triangle, 0u, 0u);
    return Texel(vec4(colour, 1.0), vec4(in.position, 1.0), ids);
}
