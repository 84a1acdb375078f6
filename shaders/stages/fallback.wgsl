// Pixels a method left missing or flagged get the environment in the direction in which light
// leaves the reflector, or are traced.
#import bindings::record::{count, write_record}
#import bindings::scene::{environment, objects}
#import bindings::view::{mirror_point, pixel_count}
#import common::record::{ANSWER_GIVEN, SOURCE_FALLBACK_ENVIRONMENT, SOURCE_FALLBACK_RAY, environment_chain}
#ifdef FALLBACK_RAY
#import bindings::rays::ray_work
#import bindings::whitted::traced_chain

// Longest chain of reflectors followed.
@group(0) @binding(1) var<uniform> bounces: u32;
#endif

// The record's radiance as the method left it.
@group(0) @binding(0) var answer: texture_2d<f32>;

// Places of this stage's counters, after the methods'.
const FILLED: u32 = 12u;
const RAYS: u32 = 13u;
const NODES: u32 = 14u;
const TRIANGLES: u32 = 15u;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= pixel_count() {
        return;
    }
    let at = mirror_point(id.x);
    if !at.departs || textureLoad(answer, at.pixel, 0).w == ANSWER_GIVEN {
        return;
    }
#ifdef FALLBACK_RAY
    var chain = traced_chain(at, bounces);
    chain.source = SOURCE_FALLBACK_RAY;
#else
    let rank = objects[at.reflector].rank;
    var chain = environment_chain(environment(at.outgoing), at.outgoing, at.position, rank);
    chain.lobe = at.lobe;
    chain.source = SOURCE_FALLBACK_ENVIRONMENT;
#endif
    write_record(at.pixel, chain);
#ifdef RECORD_FULL
    count(FILLED, 1u);
#ifdef FALLBACK_RAY
    count(RAYS, ray_work.rays);
    count(NODES, ray_work.nodes);
    count(TRIANGLES, ray_work.triangles);
#endif
#endif
}
