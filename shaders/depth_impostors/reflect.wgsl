// Mirror pixels answered from depth images: of all that a mirrored ray meets, the nearest; the environment
// where it meets none (Popescu et al. 2006, slides 36 to 38).
#import bindings::portrait::{
    Portrait, portrait_axes, portrait_clip, portrait_own_direction, portrait_own_position,
    portrait_to_world,
}
#import bindings::record::count
#import bindings::scene::{environment, objects}
#import bindings::view::MirrorPoint
#import common::record::{Chain, environment_chain, found_chain}
#import depth_impostors::rows::{
    Found, ImageLine, degenerate, impostors, march, quads, search_rows, segment_reads, texel_reads,
    texel_test,
}

@group(0) @binding(4) var<storage, read> portraits: array<Portrait>;
// Of each layer: the jump of heights that is a silhouette, and the length of a texel's
// longer side, metres.
@group(0) @binding(5) var<storage, read> layer_limits: array<vec2<f32>>;
@group(0) @binding(6) var portrait_radiance: texture_2d_array<f32>;
@group(0) @binding(7) var portrait_point: texture_2d_array<f32>;
@group(0) @binding(8) var portrait_ids: texture_2d_array<u32>;
@group(0) @binding(9) var linear_filter: sampler;

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

// What a depth image shows where a ray meets it.
struct Shown {
    exists: bool,
    radiance: vec3<f32>,
    // World.
    point: vec3<f32>,
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
    let uv = place / f32(impostors.size);
    let blend = textureSampleLevel(portrait_radiance, linear_filter, uv, layer, 0.0);
    let single = textureLoad(portrait_radiance, shown.texel, layer, 0);
    shown.radiance = select(single.rgb / single.a, blend.rgb / blend.a, blend.a > 0.01);
    return shown;
}

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

fn answer(at: MirrorPoint) -> Chain {
    let rank = objects[at.reflector].rank;
    var chain = environment_chain(environment(at.outgoing), at.outgoing, at.position, rank);
    var nearest = 1.0e30;
    var doubt = false;
    for (var layer = 0u; layer < impostors.layers; layer += 1u) {
        let portrait = portraits[layer];
        let seen = projected(portrait, at.position, at.outgoing);
        if !seen.exists {
            continue;
        }
        let found = met(seen.line, layer);
        doubt = doubt || found.behind;
        if !found.hit {
            continue;
        }
        let shown = shown_at(found.place, layer, portrait);
        let away = shown.point - at.position;
        let along = dot(away, at.outgoing);
        if !shown.exists || along >= nearest {
            continue;
        }
        nearest = along;
        let off = length(away - along * at.outgoing);
        let ids = textureLoad(portrait_ids, shown.texel, layer, 0);
        chain = found_chain(shown.radiance, shown.point, at.position, ids.x, ids.y, rank);
        chain.flag = off > OFF_THE_RAY * layer_limits[layer].y;
    }
#ifdef RECORD_FULL
    count(0u, rays);
    count(1u, points);
    count(2u, rows_found);
    count(3u, segment_reads);
    count(4u, texel_reads);
#endif
    chain.lobe = at.lobe;
#ifdef SKINS
    chain.flag = false;
#else
    chain.flag = chain.flag || doubt;
#endif
    return chain;
}

#include includes/answered_pixels.wgsl
