// Mirror pixels answered from depth images: of all that a mirrored ray meets, the nearest; the environment
// where it meets none (Popescu et al. 2006, slides 36 to 38). With `OWN` a mirror is among what its rays meet
// ("self-reflections", slide 50), and they go on from there.
#import bindings::departure::{Departure, LOBE_REFLECTED, NO_DEPARTURE, depart, is_heaviest}
#import bindings::portrait::Portrait
#import bindings::record::count
#import bindings::scene::{environment, materials, objects}
#import bindings::view::MirrorPoint
#import common::camera::seen_normal
#import common::record::{Chain, STATUS_FOUND, environment_chain, extended_trace}
#import depth_impostors::projection::projected
#import depth_impostors::rows::{
    Found, ImageLine, degenerate, impostors, march, search_rows, segment_reads, texel_reads,
    texel_test,
}
#import depth_impostors::shown::{Shown, layer_limits, light_of, shown_at}
#ifdef FILTER_MIP
#import depth_impostors::shown::{beside_of, level_of}
#endif
#ifdef BACKDROP
#import environment_map::map::{ids_at, point_at, radiance_at}
#endif

@group(0) @binding(25) var<storage, read> portraits: array<Portrait>;
@group(0) @binding(8) var portrait_ids: texture_2d_array<u32>;

// Texels the point shown may lie off the ray before it is doubted.
const OFF_THE_RAY: f32 = 3.0;

// It is not known what is where a ray went behind something.
var<private> doubt: bool;
// Rays in an image, those that are a point there, those whose row has something in it.
var<private> rays: u32;
var<private> points: u32;
var<private> rows_found: u32;

fn met(line: ImageLine, layer: u32) -> Found {
    rays += 1u;
    if degenerate(line) {
        points += 1u;
        return texel_test(line, layer);
    }
#ifdef MARCH
    return march(line, layer, layer_limits[layer].x);
#else
    let found = search_rows(line, layer, layer_limits[layer].x);
    rows_found += select(0u, 1u, found.row_exists);
    return found;
#endif
}

// A ray, and the normal of the mirror it leaves.
struct Ray {
    origin: vec3<f32>,
    direction: vec3<f32>,
    normal: vec3<f32>,
}

// The nearest of what a ray meets.
struct Met {
    exists: bool,
    layer: u32,
    // Along the ray, and beside it; metres.
    along: f32,
    off: f32,
    shown: Shown,
}

// A ray is looked for in its mirror's own image from so many of its texels above the mirror on, as nearer than
// that an image cannot tell whether it left; or from where it would be so high if it rose so steeply.
const LIFT: f32 = 1.0;
const FLATTEST: f32 = 0.2;

// How far along a ray that is.
fn leaving(ray: Ray, layer: u32) -> f32 {
    let rise = max(dot(ray.normal, ray.direction), FLATTEST);
    return LIFT * layer_limits[layer].y / rise;
}

// Whether what was met is an end of the ray.
fn stops(ray: Ray, met: Met) -> bool {
#ifdef OWN
    if met.layer >= impostors.own {
        // The outside, and not the place that it left.
        let texel = layer_limits[met.layer].y;
        return dot(met.shown.normal, ray.direction) < 0.0 && met.off < OFF_THE_RAY * texel
            && met.along > 0.0;
    }
#endif
    return true;
}

// Of so many layers.
fn nearest(ray: Ray, layers: u32) -> Met {
    var best: Met;
    best.along = 1.0e30;
    for (var layer = 0u; layer < layers; layer += 1u) {
        let portrait = portraits[layer];
        let own = layer >= impostors.own;
        let start = ray.origin + select(0.0, leaving(ray, layer), own) * ray.direction;
        let seen = projected(portrait, start, ray.direction);
        if !seen.exists {
            continue;
        }
        let found = met(seen.line, layer);
        // In one of the images all round a mirror, every ray is behind something.
        doubt = doubt || found.behind && !own;
        if !found.hit {
            continue;
        }
        var here: Met;
        here.layer = layer;
        here.shown = shown_at(found.place, layer, portrait);
        let away = here.shown.point - ray.origin;
        here.along = dot(away, ray.direction);
        here.off = length(away - here.along * ray.direction);
        here.exists = here.shown.exists && here.along < best.along && stops(ray, here);
        if here.exists {
            best = here;
        }
    }
    return best;
}

// How a ray goes on from what it met: from its own mirror alone.
fn way_on(ray: Ray, met: Met, object: u32) -> Departure {
#ifdef OWN
    if met.layer >= impostors.own {
        let normal = seen_normal(met.shown.normal, ray.direction);
        let material = materials[objects[object].material];
        return depart(material, LOBE_REFLECTED, ray.direction, normal, true);
    }
#endif
    return NO_DEPARTURE;
}

// What is beyond all impostors in the ray's direction: the environment, or the scene's backdrop before it.
fn beyond(chain: Chain, ray: Ray, path: f32) -> Chain {
    var out = chain;
    out.point = vec4(ray.direction, 0.0);
#ifdef BACKDROP
#ifdef RECORD_FULL
    let point = point_at(ray.direction);
    out.point = point;
    if point.w == 1.0 {
        let ids = ids_at(ray.direction);
        out.last.w = path + distance(ray.origin, point.xyz);
        out.object = ids.x;
        out.triangle = ids.y;
        out.status = STATUS_FOUND;
    }
#endif
#endif
    return out;
}

fn light_beyond(direction: vec3<f32>) -> vec3<f32> {
#ifdef BACKDROP
    return radiance_at(direction, 0.0);
#else
    return environment(direction);
#endif
}

fn answer(at: MirrorPoint) -> Chain {
    let rank = objects[at.reflector].rank;
    var chain = environment_chain(vec3(0.0), at.outgoing, at.position, rank);
    chain.lobe = at.lobe;
    var ray = Ray(at.position, at.outgoing, at.normal);
#ifdef FILTER_MIP
    let beside = beside_of(at);
#endif
    var throughput = vec3(1.0);
    var on_chain = true;
    var path = 0.0;
    for (var order = 1u; order <= impostors.bounces; order += 1u) {
        // At the last order rays pass through their mirror, as all do without images of it.
        let sees_own = order < impostors.bounces && at.lobe == LOBE_REFLECTED;
        let met = nearest(ray, select(impostors.own, impostors.layers, sees_own));
        if !met.exists {
            chain.radiance += throughput * light_beyond(ray.direction);
            if on_chain {
                chain = beyond(chain, ray, path);
            }
            break;
        }
        var level = 0.0;
#ifdef FILTER_MIP
        // Of a ray that its own mirror sent on the neighbours are not followed.
        if order == 1u {
            level = level_of(met.shown, portraits[met.layer], beside);
        }
#endif
        chain.radiance += throughput * light_of(met.shown, met.layer, level);
        let ids = textureLoad(portrait_ids, met.shown.texel, met.layer, 0);
        let way = way_on(ray, met, ids.x);
        if on_chain && !is_heaviest(LOBE_REFLECTED, way.share) {
            chain.point = vec4(met.shown.point, 1.0);
            chain.last.w = path + distance(ray.origin, met.shown.point);
            chain.object = ids.x;
            chain.triangle = ids.y;
            chain.status = STATUS_FOUND;
            chain.flag = met.off > OFF_THE_RAY * layer_limits[met.layer].y;
            on_chain = false;
        }
        if !way.exists {
            break;
        }
        if on_chain {
            chain.trace = extended_trace(chain.trace, chain.order, objects[ids.x].rank);
            chain.order += 1u;
            chain.last = vec4(met.shown.point, chain.last.w);
        }
        path += distance(ray.origin, met.shown.point);
        throughput *= way.weight;
        ray = Ray(met.shown.point, way.direction, met.shown.normal);
    }
#ifdef RECORD_FULL
    count(0u, rays);
    count(1u, points);
    count(2u, rows_found);
    count(3u, segment_reads);
    count(4u, texel_reads);
    count(5u, select(0u, 1u, path > 0.0));
#endif
#ifdef SKINS
    chain.flag = false;
#else
    chain.flag = chain.flag || doubt;
#endif
    return chain;
}

#include includes/answered_pixels.wgsl
