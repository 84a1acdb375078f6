// Mirror pixels answered from depth images: of all that a mirrored ray meets, the nearest; the environment
// where it meets none (Popescu et al. 2006, slides 36 to 38). With `OWN` a mirror is among what its rays meet
// ("self-reflections", slide 50), and they go on from there.
#import bindings::departure::{Departure, LOBE_REFLECTED, NO_DEPARTURE, depart, is_heaviest}
#import bindings::portrait::{
    Portrait, portrait_axes, portrait_clip, portrait_own_direction, portrait_own_position,
    portrait_rotated, portrait_to_world,
}
#import bindings::record::count
#import bindings::scene::{environment, materials, objects}
#import bindings::view::MirrorPoint
#import common::camera::seen_normal
#import common::record::{Chain, STATUS_FOUND, environment_chain, extended_trace}
#import depth_impostors::rows::{
    Found, ImageLine, degenerate, impostors, march, quads, search_rows, segment_reads, texel_reads,
    texel_test,
}
#ifdef BACKDROP
#import environment_map::map::{ids_at, linear_filter, point_at, radiance_at}
#endif

@group(0) @binding(25) var<storage, read> portraits: array<Portrait>;
// Of each layer: the jump of heights that is a silhouette, and the length of a texel's
// longer side, metres.
@group(0) @binding(5) var<storage, read> layer_limits: array<vec2<f32>>;
@group(0) @binding(6) var portrait_radiance: texture_2d_array<f32>;
@group(0) @binding(7) var portrait_point: texture_2d_array<f32>;
@group(0) @binding(8) var portrait_ids: texture_2d_array<u32>;
#ifndef BACKDROP
@group(0) @binding(9) var linear_filter: sampler;
#endif
#ifdef OWN
@group(0) @binding(26) var portrait_normal: texture_2d_array<f32>;
#endif

// Texels the point shown may lie off the ray before it is doubted.
const OFF_THE_RAY: f32 = 3.0;

// The share of a line, first and last, that satisfies a condition linear in it: a + t b >= 0.
fn kept(range: vec2<f32>, a: f32, b: f32) -> vec2<f32> {
    if b > 0.0 {
        return vec2(max(range.x, -a / b), range.y);
    }
    if b < 0.0 {
        return vec2(range.x, min(range.y, -a / b));
    }
    return select(range, vec2(1.0, 0.0), a < 0.0);
}

struct Projected {
    // Some of the ray is in the image.
    exists: bool,
    line: ImageLine,
}

fn in_image(clip: vec4<f32>) -> vec3<f32> {
    return vec3((0.5 + 0.5 * clip.xy / clip.w) * f32(impostors.size), clip.z / clip.w);
}

// The ray from `origin` along `direction`, world, in a layer's depth image.
fn projected(portrait: Portrait, origin: vec3<f32>, direction: vec3<f32>) -> Projected {
    let q = portrait_axes(portrait, portrait_own_position(portrait, origin));
    let own = portrait_own_direction(portrait, direction);
    let d = vec3(dot(own, portrait.right), dot(own, portrait.up), dot(own, portrait.towards));
    // Linear in the distance along the ray.
    let clip = portrait_clip(portrait, q);
    let change = portrait_clip(portrait, q + d) - clip;
    var range = vec2(0.0, 1.0e30);
    range = kept(range, clip.w - clip.x, change.w - change.x);
    range = kept(range, clip.w + clip.x, change.w + change.x);
    range = kept(range, clip.w - clip.y, change.w - change.y);
    range = kept(range, clip.w + clip.y, change.w + change.y);
    range = kept(range, clip.w - clip.z, change.w - change.z);
    range = kept(range, clip.z, change.z);
    var out: Projected;
    if range.x > range.y {
        return out;
    }
    let start = in_image(clip + range.x * change);
    let end = in_image(clip + range.y * change);
    // The part in the disc that rows cover.
    let middle = 0.5 * f32(impostors.size);
    let from_middle = start.xy - middle;
    let across = end.xy - start.xy;
    let square = dot(across, across);
    let half = dot(from_middle, across);
    let outside = dot(from_middle, from_middle) - middle * middle;
    if square < 1.0e-6 {
        out.exists = outside <= 0.0;
        out.line = ImageLine(start, end);
        return out;
    }
    let under = half * half - square * outside;
    if under <= 0.0 {
        return out;
    }
    let root = sqrt(under);
    let low = max((-half - root) / square, 0.0);
    let high = min((-half + root) / square, 1.0);
    out.exists = low < high;
    out.line = ImageLine(mix(start, end, low), mix(start, end, high));
    return out;
}

#ifdef OWN
// Between four texels, the outside's; what shows nothing has none.
fn normal_at(part: vec2<f32>, corner: vec2<i32>, layer: u32) -> vec3<f32> {
    let a = textureLoad(portrait_normal, corner, layer, 0).xyz;
    let b = textureLoad(portrait_normal, corner + vec2(1, 0), layer, 0).xyz;
    let c = textureLoad(portrait_normal, corner + vec2(0, 1), layer, 0).xyz;
    let d = textureLoad(portrait_normal, corner + vec2(1, 1), layer, 0).xyz;
    return mix(mix(a, b, part.x), mix(c, d, part.x), part.y);
}
#endif

// What a depth image shows where a ray meets it.
struct Shown {
    exists: bool,
    radiance: vec3<f32>,
    // World.
    point: vec3<f32>,
    normal: vec3<f32>,
    texel: vec2<u32>,
}

// "Colour from the unrotated image": the four texels about the place, as far as they show the object.
fn shown_at(place: vec2<f32>, layer: u32, portrait: Portrait) -> Shown {
    let low = clamp(floor(place - 0.5), vec2(0.0), vec2(f32(impostors.size) - 2.0));
    let part = clamp(place - 0.5 - low, vec2(0.0), vec2(1.0));
    let corner = vec2<u32>(low);
    let quad = textureLoad(quads, corner, layer, 0);
    let heights = vec4(unpack2x16unorm(quad.x), unpack2x16unorm(quad.y));
    let weights = vec4(
        (1.0 - part.x) * (1.0 - part.y),
        part.x * (1.0 - part.y),
        (1.0 - part.x) * part.y,
        part.x * part.y,
    );
    // The evidence is the nearest texel's own point; that between four texels of one surface, never a blend
    // across an edge.
    var best = -1.0;
    var nearest = 0u;
    for (var i = 0u; i < 4u; i += 1u) {
        if heights[i] > 0.0 && weights[i] > best {
            best = weights[i];
            nearest = i;
        }
    }
    var shown: Shown;
    if best < 0.0 {
        return shown;
    }
    shown.exists = true;
    shown.texel = corner + vec2(nearest & 1u, nearest >> 1u);
    var own = textureLoad(portrait_point, shown.texel, layer, 0).xyz;
    let least = min(min(heights.x, heights.y), min(heights.z, heights.w));
    let most = max(max(heights.x, heights.y), max(heights.z, heights.w));
    if least > 0.0 && most - least <= layer_limits[layer].x {
        own = vec3(0.0);
        for (var i = 0u; i < 4u; i += 1u) {
            let texel = corner + vec2(i & 1u, i >> 1u);
            own += weights[i] * textureLoad(portrait_point, texel, layer, 0).xyz;
        }
    }
    shown.point = portrait_to_world(portrait, own);
#ifdef OWN
    let normal = normal_at(place - 0.5 - low, vec2<i32>(corner), layer);
    shown.normal = normalize(portrait_rotated(portrait, normal));
#endif
    let uv = place / f32(impostors.size);
    let blend = textureSampleLevel(portrait_radiance, linear_filter, uv, layer, 0.0);
    let single = textureLoad(portrait_radiance, shown.texel, layer, 0);
    shown.radiance = select(single.rgb / single.a, blend.rgb / blend.a, blend.a > 0.01);
    return shown;
}

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
        chain.radiance += throughput * met.shown.radiance;
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
