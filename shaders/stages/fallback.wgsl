// Pixels a method left missing or flagged get the environment in the mirrored direction.
#import bindings::record::write_record
#import bindings::scene::{environment, objects}
#import bindings::view::{mirror_point, pixel_count}
#import common::record::{ANSWER_GIVEN, SOURCE_FALLBACK_ENVIRONMENT, environment_chain}

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
    let radiance = environment(at.mirrored);
    let rank = objects[at.reflector].rank;
    var chain = environment_chain(radiance, at.mirrored, at.position, rank);
    chain.source = SOURCE_FALLBACK_ENVIRONMENT;
    write_record(at.pixel, chain);
}
