// The reflectors' footprint: which mirror each pixel shows, where, and its normal there.
#import bindings::scene::{vertices, objects, world_position, world_direction}
#import common::camera::{Camera, arriving, facing}

@group(0) @binding(30) var<uniform> camera: Camera;

struct Varying {
    @builtin(position) @invariant clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) @interpolate(flat) object: u32,
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
    return Varying(clip, position, world_direction(o, v.normal), object);
}

struct Mirror {
    @location(0) object: u32,
    @location(1) position: vec4<f32>,
    @location(2) normal: vec4<f32>,
}

@fragment
fn fragment(in: Varying) -> Mirror {
    let normal = facing(in.normal, arriving(camera, in.position));
    return Mirror(in.object, vec4(in.position, 1.0), vec4(normal, 0.0));
}
