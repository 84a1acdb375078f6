// Environment mapping: the mirrored direction alone picks the texel, as if the scene were
// infinitely far away (Blinn & Newell 1976; six cube faces after Greene 1986). Glass is looked
// through the same way, in the direction refracted at its first surface.
// Patow 1995, section 1, figure 2, picks it by the reflector point W instead: `INDEX_SURFACE`.
#import bindings::record::{RecordTargets, count, record_targets, write_record}
#import bindings::scene::objects
#import bindings::view::{MirrorPoint, is_asked, mirror_point, mirror_point_at, pixel_count}
#import common::cover::cover
#import common::cube::cube_texel
#import common::record::{Chain, environment_chain, found_chain}

struct Params {
    // Centre of the map, world.
    centre: vec3<f32>,
    // Texels along a face's side.
    size: u32,
}
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var capture_radiance: texture_cube<f32>;
@group(0) @binding(2) var capture_point: texture_2d_array<f32>;
@group(0) @binding(3) var capture_ids: texture_2d_array<u32>;
@group(0) @binding(4) var linear_filter: sampler;

fn answer(at: MirrorPoint) -> Chain {
#ifdef INDEX_SURFACE
    let direction = at.position - params.centre;
#else
    let direction = at.outgoing;
#endif
    let radiance = textureSampleLevel(capture_radiance, linear_filter, direction, 0.0).rgb;
    let rank = objects[at.reflector].rank;
    var chain = environment_chain(radiance, direction, at.position, rank);
#ifdef RECORD_FULL
    // The evidence is the nearest texel's own point, never a blend across an edge.
    let texel = cube_texel(direction);
    let place = min(vec2<u32>(texel.uv * f32(params.size)), vec2(params.size - 1u));
    let point = textureLoad(capture_point, place, texel.face, 0);
    chain.point = point;
    if point.w == 1.0 {
        let ids = textureLoad(capture_ids, place, texel.face, 0);
        chain = found_chain(radiance, point.xyz, at.position, ids.x, ids.y, rank);
    }
    count(0u, 1u);
#endif
    chain.lobe = at.lobe;
    return chain;
}

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
