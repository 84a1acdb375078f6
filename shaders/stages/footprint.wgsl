enable primitive_index;
// The reflectors' footprint: which mirror each pixel shows, where, and its normal there.
#import bindings::surface::{Surface, surface_vertex}
#import common::camera::{Camera, arriving, facing}

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

struct Mirror {
    @location(0) object: u32,
    // The fourth is the triangle, exact below 2^24.
    @location(1) position: vec4<f32>,
    // The fourth is 1 where the outside is seen.
    @location(2) normal: vec4<f32>,
}

@fragment
fn fragment(
    in: Surface,
    @builtin(primitive_index) triangle: u32,
    @builtin(front_facing) front: bool,
) -> Mirror {
    let normal = facing(in.normal, arriving(camera, in.position));
    let side = select(0.0, 1.0, front);
    return Mirror(in.object, vec4(in.position, f32(triangle)), vec4(normal, side));
}
