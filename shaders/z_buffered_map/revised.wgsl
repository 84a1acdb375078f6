// The revised z-buffered environment map: the first crossing of the mirrored ray with intervals behind the map's
// texels, found over a pyramid of bounds, refined inside the texel, with a flag where the map cannot know.
#import bindings::interval_map::{height, patch_at}
#import bindings::interval_search::{map_work, search_map}
#import bindings::layers::{MapTexel, layer_colour, layer_identity, layered_map}
#import bindings::record::{count, write_record}
#import bindings::scene::{environment, objects}
#import bindings::view::{mirror_point, pixel_count}
#import common::cube::cube_direction
#import common::record::{environment_chain, found_chain}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= pixel_count() {
        return;
    }
    let at = mirror_point(id.x);
    if !at.departs {
        return;
    }
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
        let w = height(patch_at(hit.face, hit.texel, hit.layer), uv - centre);
        let direction = cube_direction(hit.face, uv / f32(layered_map.size));
        let point = layered_map.centre + direction / w;
        let radiance = layer_colour(texel, hit.layer);
#ifdef RECORD_FULL
        let ids = layer_identity(texel, hit.layer);
        chain = found_chain(radiance, point, at.position, ids.x, ids.y, rank);
#else
        chain = found_chain(radiance, point, at.position, 0u, 0u, rank);
#endif
    } else {
        chain.radiance = environment(at.outgoing);
    }
    chain.lobe = at.lobe;
    chain.flag = hit.flag;
    write_record(at.pixel, chain);
#ifdef RECORD_FULL
    count(0u, map_work.visits);
    count(1u, map_work.texels);
    count(2u, map_work.intervals);
    count(3u, select(0u, 1u, hit.flag));
#endif
}
