// The entry points of a shader that answers reflector pixels one by one: included at the end of a file
// with a function `answer(at: MirrorPoint) -> Chain`. See stages/pixel_pass.rs.
#import bindings::record::{RecordTargets, record_targets, write_record}
#import bindings::view::{is_asked, mirror_point, mirror_point_at, pixel_count}
#import common::cover::cover

#ifdef STAGE_FRAGMENT
@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    return vec4(cover(index), 0.0, 1.0);
}

@fragment @early_depth_test(force)
fn fragment(@builtin(position) position: vec4<f32>) -> RecordTargets {
    let pixel = vec2<u32>(position.xy);
    if !is_asked(pixel) {
        discard;
    }
    let at = mirror_point_at(pixel);
    if !at.departs {
        discard;
    }
    return record_targets(answer(at));
}
#else
@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= pixel_count() {
        return;
    }
    let at = mirror_point(id.x);
    if at.departs {
        write_record(at.pixel, answer(at));
    }
}
#endif
