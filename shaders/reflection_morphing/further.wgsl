enable primitive_index;
// What is seen by a trace of several reflectors, drawn through the first one's stencil where the trace's
// reflectors are shown.
#import bindings::record::{RecordTargets, record_targets}
#import bindings::scene::objects
#import bindings::surface::{Surface, surface_colour}
#import common::record::found_chain
#import reflection_morphing::chain::{along_at, whole}
#import reflection_morphing::morphed::{Morphed, is_drawn, morphed_vertex, order}

// The scene's triangle each triangle lies in, and where each object's begin.
@group(0) @binding(2) var<storage, read> source_triangles: array<u32>;
@group(0) @binding(3) var<storage, read> first_triangles: array<u32>;

@vertex
fn vertex(
    @builtin(vertex_index) index: u32,
    @builtin(instance_index) object: u32,
) -> Morphed {
    return morphed_vertex(index, object);
}

@fragment
fn fragment(in: Morphed, @builtin(primitive_index) primitive: u32) -> RecordTargets {
    let pixel = vec2<u32>(in.clip.xy);
    let along = along_at(pixel);
    if !is_drawn(in) || along.reflector != order.last + 1u {
        discard;
    }
    let source = Surface(in.clip, in.position, in.normal, in.uv, in.object);
    let colour = surface_colour(source, in.position - along.position);
    let triangle = source_triangles[first_triangles[in.object] + primitive];
    let rank = objects[order.last].rank;
    let once = found_chain(colour, in.position, along.position, in.object, triangle, rank);
    return record_targets(whole(once, along, order.trace, order.order));
}
