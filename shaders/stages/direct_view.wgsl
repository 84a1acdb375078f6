// What the eye sees directly: the diffuse shade of every surface, mirrors' included.
#import bindings::scene::{vertices, objects, materials, world_position, world_direction, shade}
#import common::camera::{Camera, arriving, facing}

@group(0) @binding(30) var<uniform> camera: Camera;

struct Varying {
    @builtin(position) @invariant clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
    @location(3) @interpolate(flat) object: u32,
}

@vertex
fn vertex(
    @builtin(vertex_index) index: u32,
    @builtin(instance_index) object: u32,
) -> Varying {
    let v = vertices[index];
    let o = objects[object];
    let position = world_position(o, v.position);
    let clip = camera.clip_from_world * vec4(position, 1.0);
    return Varying(clip, position, world_direction(o, v.normal), vec2(v.u, v.v), object);
}

struct Seen {
    @location(0) colour: vec4<f32>,
    // Distance along the camera's axis.
    @location(1) depth: f32,
    @location(2) object: u32,
}

@fragment
fn fragment(in: Varying) -> Seen {
    let normal = facing(in.normal, arriving(camera, in.position));
    let colour = shade(materials[objects[in.object].material], normal, in.uv);
    let depth = dot(in.position - camera.eye, camera.forward);
    return Seen(vec4(colour, 1.0), depth, in.object);
}
