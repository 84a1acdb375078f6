// Environment mapping: the mirrored direction alone picks the texel, as if the scene were
// infinitely far away (Blinn & Newell 1976; six cube faces after Greene 1986). Glass is looked
// through the same way, in the direction refracted at its first surface.
//
// The lecture's "Solution 1" looks colours up at the corners of the reflector's triangles and blends
// them (`SHADE_AT_VERTEX`), "Solution 2" blends the corners' rays and looks up at each pixel
// (`SHADE_AT_VERTEX_RAY`); otherwise the ray, too, is each pixel's own.
#import bindings::record::count
#import bindings::scene::objects
#import bindings::view::{MirrorPoint, mirror_point_at as point_at_pixel, reflector_id}
#import common::proxy::unit_or
#import common::record::{Chain, environment_chain, found_chain}
#import environment_map::map::{ids_at, point_at, radiance_at, texels_between}
#import environment_map::sight::sight
#ifdef SHADE_AT_CORNERS
#import bindings::corners::{Corner, corners_of}
#endif

// What the map shows in a direction. The evidence is the nearest texel's own point, never a blend
// across an edge.
fn shown(at: MirrorPoint, direction: vec3<f32>, level: f32) -> Chain {
    let radiance = radiance_at(direction, level);
    let rank = objects[at.reflector].rank;
    var chain = environment_chain(radiance, direction, at.position, rank);
#ifdef RECORD_FULL
    let point = point_at(direction);
    chain.point = point;
    if point.w == 1.0 {
        let ids = ids_at(direction);
        chain = found_chain(radiance, point.xyz, at.position, ids.x, ids.y, rank);
    }
    count(0u, 1u);
#endif
    chain.lobe = at.lobe;
    return chain;
}

// Texels from a pixel's place in the map to that of the pixel beside it, on one side or the other;
// 0 where neither shows the same reflector.
fn texels_to(at: MirrorPoint, aside: vec2<i32>) -> f32 {
    let size = vec2<i32>(textureDimensions(reflector_id));
    for (var side = 1; side >= -1; side -= 2) {
        let pixel = vec2<i32>(at.pixel) + side * aside;
        if any(pixel < vec2(0)) || any(pixel >= size) {
            continue;
        }
        if textureLoad(reflector_id, pixel, 0).x == at.reflector {
            let beside = point_at_pixel(vec2<u32>(pixel));
            let direction = sight(beside.position, beside.outgoing);
            return texels_between(sight(at.position, at.outgoing), direction);
        }
    }
    return 0.0;
}

// The mip level whose texels are as far apart as the rays of neighbouring pixels, the larger of both
// axes: what a sampler's own derivatives would give.
fn level_of(at: MirrorPoint) -> f32 {
#ifdef FILTER_MIP
    return log2(max(1.0, max(texels_to(at, vec2(1, 0)), texels_to(at, vec2(0, 1)))));
#else
    return 0.0;
#endif
}

fn answer(at: MirrorPoint) -> Chain {
    let level = level_of(at);
#ifdef SHADE_AT_CORNERS
    var corners = corners_of(at);
#endif
#ifdef SHADE_AT_VERTEX
    // A blend of three colours shows no point; the corner that weighs most stands for it.
    var light = vec3(0.0);
    var most = -1.0;
    var chain: Chain;
    for (var i = 0u; i < 3u; i += 1u) {
        let corner = corners[i];
        let seen = shown(at, sight(corner.position, corner.outgoing), level);
        light += corner.weight * seen.radiance;
        if corner.weight > most {
            most = corner.weight;
            chain = seen;
        }
    }
    chain.radiance = light;
    return chain;
#else
    var outgoing = at.outgoing;
#ifdef SHADE_AT_VERTEX_RAY
    outgoing = vec3(0.0);
    for (var i = 0u; i < 3u; i += 1u) {
        outgoing += corners[i].weight * corners[i].outgoing;
    }
    outgoing = unit_or(outgoing, at.outgoing);
#endif
    return shown(at, sight(at.position, outgoing), level);
#endif
}

#include includes/answered_pixels.wgsl
