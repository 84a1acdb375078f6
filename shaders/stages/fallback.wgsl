// Pixels a method left missing or flagged get the environment in the mirrored direction.
#import bindings::record::write_record
#import bindings::scene::{environment, objects}
#import bindings::view::{mirror_point, pixel_count}
#import common::record::{
    ANSWER_GIVEN, Chain, NO_OBJECT, SOURCE_FALLBACK_ENVIRONMENT, STATUS_ENVIRONMENT, trace_of,
}

// The record's radiance as the method left it.
@group(0) @binding(0) var answer: texture_2d<f32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= pixel_count() {
        return;
    }
    let at = mirror_point(id.x);
    if textureLoad(answer, at.pixel, 0).w == ANSWER_GIVEN {
        return;
    }
    let infinity = bitcast<f32>(0x7f800000u);
    var chain: Chain;
    chain.radiance = environment(at.mirrored);
    chain.point = vec4(at.mirrored, 0.0);
    chain.last = vec4(at.position, infinity);
    chain.object = NO_OBJECT;
    chain.trace = trace_of(objects[at.reflector].rank);
    chain.order = 1u;
    chain.status = STATUS_ENVIRONMENT;
    chain.source = SOURCE_FALLBACK_ENVIRONMENT;
    write_record(at.pixel, chain);
}
