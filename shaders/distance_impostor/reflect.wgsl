// Distance impostors: the texel of the captured map that the mirrored ray meets, by the distances
// stored with it (Szirmay-Kalos et al. 2005).
#import bindings::record::count
#import bindings::scene::{environment, objects}
#import bindings::view::MirrorPoint
#import common::cube::cube_texel
#import common::record::{Chain, environment_chain, found_chain}
#import distance_impostor::search::{params, search, search_work, texel_of}

@group(0) @binding(2) var capture_radiance: texture_cube<f32>;
@group(0) @binding(3) var capture_point: texture_2d_array<f32>;
@group(0) @binding(4) var capture_ids: texture_2d_array<u32>;
@group(0) @binding(5) var linear_filter: sampler;

// What the map shows in a direction.
fn texel_chain(radiance: vec3<f32>, direction: vec3<f32>, bounce: vec3<f32>, rank: u32) -> Chain {
    var chain = environment_chain(radiance, direction, bounce, rank);
#ifdef RECORD_FULL
    // The evidence is the nearest texel's own point, never a blend across an edge.
    let texel = cube_texel(direction);
    let place = texel_of(texel.uv);
    let point = textureLoad(capture_point, place, texel.face, 0);
    chain.point = point;
    if point.w == 1.0 {
        let ids = textureLoad(capture_ids, place, texel.face, 0);
        chain = found_chain(radiance, point.xyz, bounce, ids.x, ids.y, rank);
    }
#endif
    return chain;
}

fn answer(at: MirrorPoint) -> Chain {
    let met = search(at.position - params.centre, at.outgoing);
    let rank = objects[at.reflector].rank;
    var chain: Chain;
    if met.sky {
        let radiance = environment(at.outgoing);
        chain = environment_chain(radiance, at.outgoing, at.position, rank);
    } else {
        let radiance = textureSampleLevel(capture_radiance, linear_filter, met.direction, 0.0).rgb;
        chain = texel_chain(radiance, met.direction, at.position, rank);
    }
#ifdef RECORD_FULL
    count(0u, search_work.fetches);
    count(1u, search_work.steps);
#endif
    chain.lobe = at.lobe;
    chain.flag = met.doubtful;
    return chain;
}

#include includes/answered_pixels.wgsl
