// Morphed triangles as later orders draw them, through the stencil of a trace's first reflector.
#define_import_path reflection_morphing::morphed

#import bindings::surface::surface_vertex
#import common::camera::Camera
#import virtual_objects::corner::{Corner, HIDDEN, LOST, status_of}

struct Order {
    // The reflector whose pixels these are, and the trace's last one.
    first: u32,
    last: u32,
    trace: u32,
    // Reflectors in the trace.
    order: u32,
}
@group(0) @binding(0) var<uniform> order: Order;
@group(0) @binding(1) var<storage, read> corners: array<Corner>;
@group(0) @binding(30) var<uniform> camera: Camera;
@group(0) @binding(31) var reflector_id: texture_2d<u32>;

struct Morphed {
    @builtin(position) clip: vec4<f32>,
    // Of the source.
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
    @location(3) @interpolate(flat) object: u32,
    // 1 where the vertex lies in no bundle of rays; far below 0 where it is lost.
    @location(4) hidden: f32,
}

fn morphed_vertex(index: u32, object: u32) -> Morphed {
    let source = surface_vertex(index, object);
    let clip = camera.clip_from_world * vec4(corners[index].image, 1.0);
    let status = status_of(corners[index]);
    let hidden = select(select(0.0, 1.0, status == HIDDEN), -1e6, status == LOST);
    return Morphed(clip, source.position, source.normal, source.uv, object, hidden);
}

// All three corners are hidden where the share of hidden corners is 1, but for rounding.
const ALL_HIDDEN: f32 = 0.9999;

// Whether a fragment is of a triangle that is drawn, in a pixel of the first reflector.
fn is_drawn(in: Morphed) -> bool {
    let shows = textureLoad(reflector_id, vec2<u32>(in.clip.xy), 0).x;
    return shows == order.first && in.hidden >= 0.0 && in.hidden <= ALL_HIDDEN;
}
