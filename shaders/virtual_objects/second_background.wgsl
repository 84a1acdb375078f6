// The environment as mirrors show it that are seen in a mirror: what is behind all that they reflect.
// Counts their pixels.
#import bindings::record::write_record
#import bindings::scene::environment
#import bindings::view::{mirror_point, pixel_count}
#import common::record::environment_chain
#import virtual_objects::twice::{Twice, second_of, twice_at}

// Pixels that show a reflector in this one, by object.
@group(0) @binding(0) var<storage, read_write> shown_pixels: array<atomic<u32>>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= pixel_count() {
        return;
    }
    let at = mirror_point(id.x);
    let twice = twice_at(at.pixel, at.reflector, at.position);
    if !twice.is_shown {
        return;
    }
    atomicAdd(&shown_pixels[twice.second], 1u);
    let once = environment_chain(environment(twice.outgoing), twice.outgoing, twice.position, 0u);
    write_record(at.pixel, second_of(once, twice));
}
