// Rays traced from every reflector pixel, to any order (Whitted 1980).
#import bindings::record::{count, write_record}
#import bindings::rays::ray_work
#import bindings::view::{mirror_point, pixel_count}
#import bindings::whitted::traced_chain

// Longest chain of reflectors followed.
@group(0) @binding(0) var<uniform> bounces: u32;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= pixel_count() {
        return;
    }
    let at = mirror_point(id.x);
    if !at.departs {
        return;
    }
    write_record(at.pixel, traced_chain(at, bounces));
#ifdef RECORD_FULL
    count(0u, ray_work.rays);
    count(1u, ray_work.nodes);
    count(2u, ray_work.triangles);
#endif
}
