// What a depth image shows at a place of it, and the colour there: "from the unrotated image" (Popescu et al. 2006,
// slides 35 and 38), over the footprint of a pixel's ray with `FILTER_MIP` ("antialiasing", slide 35).
#define_import_path depth_impostors::shown

#import bindings::portrait::{
    Portrait, portrait_axes, portrait_clip, portrait_own_position, portrait_rotated,
    portrait_to_world,
}
#import depth_impostors::projection::in_image
#import depth_impostors::rows::{impostors, quads}
#ifdef BACKDROP
#import environment_map::map::linear_filter
#endif
#ifdef FILTER_MIP
#import bindings::beside::pixel_beside
#import bindings::view::MirrorPoint
#endif

// Of each layer: the jump of heights that is a silhouette, and the length of a texel's
// longer side, metres.
@group(0) @binding(5) var<storage, read> layer_limits: array<vec2<f32>>;
@group(0) @binding(6) var portrait_radiance: texture_2d_array<f32>;
@group(0) @binding(7) var portrait_point: texture_2d_array<f32>;
#ifndef BACKDROP
@group(0) @binding(9) var linear_filter: sampler;
#endif
#ifdef NORMALS
@group(0) @binding(26) var portrait_normal: texture_2d_array<f32>;
#endif

#ifdef NORMALS
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
    // In the image, texels.
    place: vec2<f32>,
    // World.
    point: vec3<f32>,
    normal: vec3<f32>,
    texel: vec2<u32>,
}

// The four texels about the place, as far as they show the object.
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
#ifdef NORMALS
    let normal = normal_at(place - 0.5 - low, vec2<i32>(corner), layer);
    shown.normal = normalize(portrait_rotated(portrait, normal));
#endif
    shown.place = place;
    return shown;
}

#ifdef FILTER_MIP
// The rays beside a pixel's own, to the right and below.
struct Beside {
    right_origin: vec3<f32>,
    right: vec3<f32>,
    below_origin: vec3<f32>,
    below: vec3<f32>,
}

fn beside_of(at: MirrorPoint) -> Beside {
    let right = pixel_beside(at, vec2(1, 0));
    let below = pixel_beside(at, vec2(0, 1));
    return Beside(right.position, right.outgoing, below.position, below.outgoing);
}

// From the place shown to where a ray beside meets the surface there, taken for a plane; texels.
fn apart(shown: Shown, portrait: Portrait, origin: vec3<f32>, direction: vec3<f32>) -> vec2<f32> {
    let facing = dot(shown.normal, direction);
    let along = dot(shown.normal, shown.point - origin) / facing;
    if abs(facing) < 1.0e-3 || along <= 0.0 {
        return vec2(0.0);
    }
    let own = portrait_own_position(portrait, origin + along * direction);
    return in_image(portrait_clip(portrait, portrait_axes(portrait, own))).xy - shown.place;
}

// The mip level whose texels are as large as the footprint, by its area.
fn level_of(shown: Shown, portrait: Portrait, beside: Beside) -> f32 {
    let right = apart(shown, portrait, beside.right_origin, beside.right);
    let below = apart(shown, portrait, beside.below_origin, beside.below);
    return 0.5 * log2(max(abs(right.x * below.y - right.y * below.x), 1.0));
}
#endif

// Light from there, from a mip level on.
fn light_of(shown: Shown, layer: u32, level: f32) -> vec3<f32> {
    let uv = shown.place / f32(impostors.size);
    let blend = textureSampleLevel(portrait_radiance, linear_filter, uv, layer, level);
    let single = textureLoad(portrait_radiance, shown.texel, layer, 0);
    return select(single.rgb / single.a, blend.rgb / blend.a, blend.a > 0.01);
}
