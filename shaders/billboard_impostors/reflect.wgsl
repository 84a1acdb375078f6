// The pixel algorithm of Popescu et al. 2006, slide 15: a mirrored ray meets billboards, diffuse ones that
// end it and reflective ones that send it on by their normals, until none is in its way.
#import billboard_impostors::boards::{
    NOWHERE, Ray, board_light, board_surface, board_texel, leaving_point, params,
}
#import billboard_impostors::far::{far_chain, far_direction, far_light, far_reach}
#import billboard_impostors::nearest::{boards_tested, nearest_board}
#ifdef FILTER_MIP
#import billboard_impostors::footprint::{far_level, level_of, mirrored_neighbours, neighbours_of}
#endif
#import bindings::departure::{LOBE_REFLECTED, depart, is_heaviest}
#import bindings::record::{count, count_most}
#import bindings::scene::{materials, objects}
#import bindings::view::MirrorPoint
#import common::camera::seen_normal
#import common::record::{Chain, STATUS_FOUND, extended_trace, trace_of}

fn answer(at: MirrorPoint) -> Chain {
    var chain: Chain;
    chain.lobe = at.lobe;
    chain.order = 1u;
    chain.trace = trace_of(objects[at.reflector].rank);
    var ray = Ray(at.position, at.outgoing);
#ifdef FILTER_MIP
    var beside = neighbours_of(at);
#endif
    var reflector = at.reflector;
    var throughput = vec3(1.0);
    var on_chain = true;
    var path = 0.0;
    var tested = 0u;
    for (var order = 1u; order <= params.bounces; order += 1u) {
        let last = order == params.bounces;
#ifdef LAST_DIFFUSE
        // Slides 17 to 22: D + (R - 1) + D intersections for K = 2.
        let diffuse_only = last;
#else
        let diffuse_only = false;
#endif
        tested += boards_tested(reflector, diffuse_only);
        let met = nearest_board(ray, reflector, diffuse_only);
        if met.distance == NOWHERE || met.outside > 0.0 {
            let reach = far_reach(ray);
            let d = far_direction(ray, met, reach);
            var level = 0.0;
#ifdef FILTER_MIP
#ifdef BACKDROP
            level = far_level(d, met, beside, reach);
#endif
#endif
            chain.radiance += throughput * far_light(d, level);
            if on_chain {
                chain = far_chain(chain, d, ray.origin, path);
            }
            break;
        }
        var level = 0.0;
#ifdef FILTER_MIP
        level = level_of(met, beside);
#endif
        let texel = board_texel(met);
        let object = objects[texel.object];
        let material = materials[object.material];
        chain.radiance += throughput * board_light(met, level);
        let surface = board_surface(met);
        let normal = seen_normal(surface.normal, ray.direction);
        let way = depart(material, LOBE_REFLECTED, ray.direction, normal, texel.front);
        // What glass lets through no picture shows.
        let goes_on = !last && way.exists && material.index == 0.0;
        if on_chain && !(goes_on && is_heaviest(LOBE_REFLECTED, way.share)) {
            chain.point = vec4(texel.point, 1.0);
            chain.last = vec4(ray.origin, path + distance(ray.origin, texel.point));
            chain.object = texel.object;
            chain.triangle = texel.triangle;
            chain.status = STATUS_FOUND;
            on_chain = false;
        }
        if !goes_on {
            break;
        }
        if on_chain {
            chain.trace = extended_trace(chain.trace, chain.order, object.rank);
            chain.order += 1u;
        }
        let next = Ray(leaving_point(ray, met.distance, surface), way.direction);
#ifdef FILTER_MIP
        beside = mirrored_neighbours(met, beside, next);
#endif
        path += distance(ray.origin, next.origin);
        throughput *= way.weight;
        ray = next;
        reflector = texel.object;
    }
#ifdef RECORD_FULL
    count(0u, tested);
    count_most(1u, tested);
    count(2u, select(0u, 1u, chain.order > 1u));
#endif
    return chain;
}

#include includes/answered_pixels.wgsl
