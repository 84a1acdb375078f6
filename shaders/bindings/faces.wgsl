// The six faces of a cube about a point, to draw surfaces into. Rust twin: stages/capture.rs.
#define_import_path bindings::faces

#import bindings::surface::{Surface, surface_vertex}

struct Cube {
    clip_from_world: array<mat4x4<f32>, 6>,
    centre: vec3<f32>,
    // Nearest depth captured; a depth of z is rasterised as near / z.
    near: f32,
}
@group(0) @binding(0) var<uniform> cube: Cube;

// A vertex of an object on one face.
fn face_vertex(index: u32, object: u32, face: u32) -> Surface {
    var out = surface_vertex(index, object);
    out.clip = cube.clip_from_world[face] * vec4(out.position, 1.0);
    return out;
}
