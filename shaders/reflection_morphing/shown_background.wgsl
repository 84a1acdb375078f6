// The environment in the reflectors that others show: what is behind all that they mirror.
#import bindings::record::write_record
#import bindings::scene::{environment, objects}
#import bindings::view::{mirror_point, pixel_count}
#import common::record::{environment_chain, extended_trace}
#import reflection_morphing::chain::{along_at, whole}
#import reflection_morphing::morphed::Order

// The reflectors met before those shown.
@group(0) @binding(0) var<uniform> order: Order;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= pixel_count() {
        return;
    }
    let at = mirror_point(id.x);
    let along = along_at(at.pixel);
    if at.reflector != order.first || along.reflector == 0u {
        return;
    }
    let rank = objects[along.reflector - 1u].rank;
    let trace = extended_trace(order.trace, order.order, rank);
    let once = environment_chain(environment(along.outgoing), along.outgoing, along.position, rank);
    write_record(at.pixel, whole(once, along, trace, order.order + 1u));
}
