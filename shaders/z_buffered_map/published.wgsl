// Patow 1995: the environment map keeps the depths it was drawn with, and every mirror pixel
// searches them, along the plane of its mirrored ray and the map's centre, for the texel whose
// surface point lies best on that ray. Names are the paper's; lines of its figures 4 and 7 stand
// where they are carried out.
#import bindings::layers::{MapTexel, layer_colour, layer_identity, layer_inverse_depth, layered_map, texel_direction}
#import bindings::record::count
#import bindings::scene::{environment, objects}
#import bindings::view::MirrorPoint
#import common::cube::cube_texel
#import common::record::{Chain, environment_chain, found_chain}
#import common::reflection_plane::is_parallel
#import z_buffered_map::arc::{arc_texels, search_hybrid, search_image, search_vectors}
#import z_buffered_map::search::{LAYERS, Search, start_search, texel_at}

struct Params {
    // Steps of t.
    steps: u32,
    // Metres in the unit that t is counted in.
    unit: f32,
    // The tolerable limit: squared sine of the angle.
    threshold: f32,
    pad: u32,
}
@group(0) @binding(0) var<uniform> params: Params;

// Counters.
const EXAMINED: u32 = 0u;
const REPEATED: u32 = 1u;
const SKIPPED: u32 = 2u;
const FETCHES: u32 = 3u;
const BACKGROUND: u32 = 4u;

fn answer(at: MirrorPoint) -> Chain {
    var chain = reflection(at);
    chain.lobe = at.lobe;
    return chain;
}

fn reflection(at: MirrorPoint) -> Chain {
    // Fig. 4, line 1: With normal N and incident vector I, find reflected vector, B.
    let b = at.outgoing;
    let w = at.position - layered_map.centre;
    // Fig. 4, line 2: if (B . [W]) = +-1
    if is_parallel(b, w) {
        // Fig. 4, line 4: Compute reflection in the direction of B.
        let texel = texel_at(cube_texel(b));
        count(EXAMINED, 1u);
        count(FETCHES, 1u);
        if layer_inverse_depth(texel, 0u) == 0.0 {
            return background(at);
        }
        return shown(at, texel, 0u);
    }
    var search = start_search(b, w);
#ifdef SEARCH_VECTOR
    search_vectors(&search, w / params.unit, params.steps);
#else ifdef SEARCH_IMAGE
    search_image(&search);
#else
    // Fig. 4, line 6: For each pixel in (Reflection Plane ∩ Reflection Map) do
    search_hybrid(&search, w / params.unit, params.steps);
#endif
#ifdef RECORD_FULL
    count(EXAMINED, search.examined);
    count(REPEATED, search.repeated);
    let distinct = search.examined - search.repeated;
    count(SKIPPED, max(arc_texels(b, w), distinct) - distinct);
    count(FETCHES, search.fetches);
#endif
    // Section 4: "leaving the verification of which predictor is the best until the end"; the
    // second layer is asked when the first has no predictor, and so on.
    for (var layer = 0u; layer < LAYERS; layer += 1u) {
        // Fig. 4, line 12: if angle of best approximator > tolerable_limit
        if search.best[layer] <= params.threshold {
            return shown(at, search.texel[layer], layer);
        }
    }
    return background(at);
}

// The surface a texel stored.
fn shown(at: MirrorPoint, texel: MapTexel, layer: u32) -> Chain {
    let radiance = layer_colour(texel, layer);
    let rank = objects[at.reflector].rank;
#ifdef RECORD_FULL
    let s = texel_direction(texel) / layer_inverse_depth(texel, layer);
    let ids = layer_identity(texel, layer);
    return found_chain(radiance, layered_map.centre + s, at.position, ids.x, ids.y, rank);
#else
    return found_chain(radiance, vec3(0.0), at.position, 0u, 0u, rank);
#endif
}

fn background(at: MirrorPoint) -> Chain {
    count(BACKGROUND, 1u);
    // Fig. 4, line 14: Reflect infinity (background, B).
    let radiance = environment(at.outgoing);
    return environment_chain(radiance, at.outgoing, at.position, objects[at.reflector].rank);
}

#include includes/answered_pixels.wgsl
