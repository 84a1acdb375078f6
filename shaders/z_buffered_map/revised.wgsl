// The revised z-buffered environment map: the first crossing of the mirrored ray with intervals behind the map's
// texels, found over a pyramid of bounds, refined inside the texel, with a flag where the map cannot know.
#import bindings::interval_map::height
#import bindings::interval_search::{map_work, search_map}
#import bindings::layers::{MapTexel, layer_colour, layer_identity, layered_map}
#import bindings::record::count
#import bindings::scene::{environment, objects}
#import bindings::view::MirrorPoint
#import common::cube::cube_direction
#import common::record::{Chain, environment_chain, found_chain}

// Counters; those before are the published method's.
const TEXELS: u32 = 0u;
const VISITS: u32 = 5u;
const INTERVALS: u32 = 6u;
const FLAGGED: u32 = 7u;

fn answer(at: MirrorPoint) -> Chain {
#ifdef SCAN
    let hit = search_map(at.position - layered_map.centre, at.outgoing, true);
#else
    let hit = search_map(at.position - layered_map.centre, at.outgoing, false);
#endif
    let rank = objects[at.reflector].rank;
    var chain = environment_chain(vec3(0.0), at.outgoing, at.position, rank);
    if hit.found {
        let texel = MapTexel(hit.face, hit.texel);
        let centre = vec2<f32>(hit.texel) + 0.5;
#ifdef REFINE
        let uv = hit.uv;
#else
        let uv = centre;
#endif
        // The surface's own point in that direction, never the ray's.
        let w = height(hit.surface, uv - centre);
        let direction = cube_direction(hit.face, uv / f32(layered_map.size));
        let point = layered_map.centre + direction / w;
        let radiance = layer_colour(texel, hit.layer);
        var ids = vec2(0u);
#ifdef RECORD_FULL
        ids = layer_identity(texel, hit.layer);
#endif
        chain = found_chain(radiance, point, at.position, ids.x, ids.y, rank);
    } else {
        chain.radiance = environment(at.outgoing);
    }
    chain.lobe = at.lobe;
    chain.flag = hit.flag;
    count(TEXELS, map_work.texels);
    count(VISITS, map_work.visits);
    count(INTERVALS, map_work.intervals);
    count(FLAGGED, select(0u, 1u, hit.flag));
    return chain;
}

#include includes/answered_pixels.wgsl
