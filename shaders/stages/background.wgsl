// The environment behind everything, over the whole image.
#import bindings::scene::environment
#import common::camera::{Camera, eye_direction}
#import common::cover::cover

@group(0) @binding(30) var<uniform> camera: Camera;

struct Varying {
    @builtin(position) position: vec4<f32>,
    @location(0) ndc: vec2<f32>,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Varying {
    let corner = cover(index);
    return Varying(vec4(corner, 0.0, 1.0), corner);
}

@fragment
fn fragment(in: Varying) -> @location(0) vec4<f32> {
    return vec4(environment(eye_direction(camera, in.ndc)), 1.0);
}
