// The environment as mirrors show it, or glass, over their pixels: what is behind all else.
#import bindings::record::write_record
#import bindings::scene::{environment, objects}
#import bindings::view::{mirror_point, pixel_count}
#import common::record::environment_chain

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= pixel_count() {
        return;
    }
    let at = mirror_point(id.x);
    if !at.departs {
        return;
    }
    let radiance = environment(at.outgoing);
    let rank = objects[at.reflector].rank;
    var chain = environment_chain(radiance, at.outgoing, at.position, rank);
    chain.lobe = at.lobe;
    write_record(at.pixel, chain);
}
