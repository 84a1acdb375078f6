// One reflector's points and normals about its centroid, in its own space: what directions outwards meet
// last.
#import bindings::faces::cube
#import bindings::scene::vertices
#import common::camera::facing

// The layer drawn into.
var<immediate> face: u32;

struct OwnSurface {
    @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> OwnSurface {
    let vertex = vertices[index];
    let clip = cube.clip_from_world[face] * vec4(vertex.position, 1.0);
    return OwnSurface(clip, vertex.position, vertex.normal);
}

struct Texel {
    // The fourth is 1 where the reflector is.
    @location(0) position: vec4<f32>,
    @location(1) normal: vec4<f32>,
}

@fragment
fn fragment(in: OwnSurface) -> Texel {
    // On the outside, whichever way an open reflector was modelled.
    let normal = -facing(in.normal, in.position - cube.centre);
    return Texel(vec4(in.position, 1.0), vec4(normal, 0.0));
}
