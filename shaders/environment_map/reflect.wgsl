// Environment mapping: the mirrored direction alone picks the texel, as if the scene were
// infinitely far away (Blinn & Newell 1976; six cube faces after Greene 1986).
// Patow 1995, section 1, figure 2, picks it by the reflector point W instead: `INDEX_SURFACE`.
#import bindings::record::{write_record, count}
#import bindings::scene::objects
#import bindings::view::{mirror_point, pixel_count}
#import common::cube::cube_texel
#import common::record::{Chain, STATUS_ENVIRONMENT, STATUS_FOUND, trace_of}

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

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= pixel_count() {
        return;
    }
    let at = mirror_point(id.x);
#ifdef INDEX_SURFACE
    let direction = at.position - params.centre;
#else
    let direction = at.mirrored;
#endif
    var chain: Chain;
    chain.radiance = textureSampleLevel(capture_radiance, linear_filter, direction, 0.0).rgb;
    chain.status = STATUS_FOUND;
#ifdef RECORD_FULL
    // The evidence is the nearest texel's own point, never a blend across an edge.
    let texel = cube_texel(direction);
    let place = min(vec2<u32>(texel.uv * f32(params.size)), vec2(params.size - 1u));
    chain.point = textureLoad(capture_point, place, texel.face, 0);
    let ids = textureLoad(capture_ids, place, texel.face, 0);
    chain.object = ids.x;
    chain.triangle = ids.y;
    chain.trace = trace_of(objects[at.reflector].rank);
    chain.order = 1u;
    let infinity = bitcast<f32>(0x7f800000u);
    if chain.point.w == 0.0 {
        chain.status = STATUS_ENVIRONMENT;
        chain.last = vec4(at.position, infinity);
    } else {
        chain.last = vec4(at.position, distance(at.position, chain.point.xyz));
    }
    count(0u, 1u);
#endif
    write_record(at.pixel, chain);
}
