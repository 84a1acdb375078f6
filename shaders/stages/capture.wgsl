enable primitive_index;
// Surfaces into the six faces of a cube at once: colour, and where each texel's point is.
#import bindings::scene::{vertices, objects, materials, world_position, world_direction, shade}
#import common::camera::facing

struct Cube {
    clip_from_world: array<mat4x4<f32>, 6>,
    centre: vec3<f32>,
    pad: u32,
}
@group(0) @binding(0) var<uniform> cube: Cube;

struct Varying {
    @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
    @location(3) @interpolate(flat) object: u32,
}

@vertex
fn vertex(
    @builtin(vertex_index) index: u32,
    @builtin(instance_index) object: u32,
    @builtin(view_index) face: u32,
) -> Varying {
    let v = vertices[index];
    let o = objects[object];
    let position = world_position(o, v.position);
    let clip = cube.clip_from_world[face] * vec4(position, 1.0);
    return Varying(clip, position, world_direction(o, v.normal), vec2(v.u, v.v), object);
}

struct Texel {
    @location(0) radiance: vec4<f32>,
    // w = 1: a surface point.
    @location(1) point: vec4<f32>,
    // Object, triangle.
    @location(2) ids: vec4<u32>,
}

@fragment
fn fragment(in: Varying, @builtin(primitive_index) triangle: u32) -> Texel {
    let normal = facing(in.normal, in.position - cube.centre);
    let colour = shade(materials[objects[in.object].material], normal, in.uv);
    let ids = vec4(in.object, triangle, 0u, 0u);
    return Texel(vec4(colour, 1.0), vec4(in.position, 1.0), ids);
}
