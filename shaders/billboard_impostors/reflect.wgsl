// The pixel algorithm of Popescu et al. 2006, slide 15: a mirrored ray meets billboards, diffuse ones that
// end it and reflective ones that send it on by their normals, until none is in its way.
#import billboard_impostors::boards::{
    Meeting, NOWHERE, Ray, board_light, board_surface, board_texel, boards_tested, leaving_point,
    linear_filter, morphed, nearest_board, params,
}
#ifdef FILTER_MIP
#import billboard_impostors::footprint::{far_level, level_of, mirrored_neighbours, neighbours_of}
#endif
#import bindings::departure::{LOBE_REFLECTED, depart, is_heaviest}
#import bindings::record::{count, count_most}
#import bindings::scene::{environment, materials, objects}
#import bindings::view::MirrorPoint
#import common::camera::seen_normal
#import common::cube::cube_texel
#import common::record::{
    Chain, NO_OBJECT, STATUS_ENVIRONMENT, STATUS_FOUND, extended_trace, trace_of,
}

#ifdef BACKDROP
@group(0) @binding(50) var backdrop_radiance: texture_cube<f32>;
#ifdef RECORD_FULL
@group(0) @binding(51) var backdrop_point: texture_2d_array<f32>;
@group(0) @binding(52) var backdrop_ids: texture_2d_array<u32>;
#endif
#endif

// EM(d): what is behind all billboards, in a direction as the environment map has it.
fn far_light(d: vec3<f32>, level: f32) -> vec3<f32> {
#ifdef BACKDROP
    return textureSampleLevel(backdrop_radiance, linear_filter, d, level).rgb;
#else
    return environment(d);
#endif
}

// The evidence for it, of a ray that left `origin` after `path` metres.
fn far_chain(start: Chain, d: vec3<f32>, origin: vec3<f32>, path: f32) -> Chain {
    var chain = start;
    chain.point = vec4(d, 0.0);
    // Infinitely far.
    chain.last = vec4(origin, bitcast<f32>(0x7f800000u));
    chain.object = NO_OBJECT;
    chain.status = STATUS_ENVIRONMENT;
#ifdef BACKDROP
#ifdef RECORD_FULL
    let texel = cube_texel(d);
    let size = textureDimensions(backdrop_point);
    let place = min(vec2<u32>(texel.uv * vec2<f32>(size)), size - 1u);
    let point = textureLoad(backdrop_point, place, texel.face, 0);
    chain.point = point;
    if point.w == 1.0 {
        let ids = textureLoad(backdrop_ids, place, texel.face, 0);
        chain.last.w = path + distance(origin, point.xyz);
        chain.object = ids.x;
        chain.triangle = ids.y;
        chain.status = STATUS_FOUND;
    }
#endif
#endif
    return chain;
}

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
            var d = ray.direction;
            if met.outside > 0.0 {
                d = morphed(ray, met.distance, met.outside);
            }
            var level = 0.0;
#ifdef FILTER_MIP
#ifdef BACKDROP
            level = far_level(d, met, beside, f32(textureDimensions(backdrop_radiance).x));
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
        let surface = board_surface(met.layer, met.place);
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
