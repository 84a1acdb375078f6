// One reflector as searches see it: its points and normals in textures, T_P and T_N of Estalella et al.
// 2006, section 4, and how well a texel answers for a vertex.
#define_import_path virtual_objects::reflector

#import common::camera::{Camera, arriving}

struct Search {
    // Vertices to reflect.
    total: u32,
    // Where this reflector's texels of the frame before begin.
    history: u32,
    // 1 where those are void.
    cut: u32,
    // Most neighbourhoods looked at in a walk.
    cap: u32,
    // Of the textures, texels.
    size: vec2<u32>,
    // N.B from which on a texel is good enough; 1 for none.
    threshold: f32,
    // The reflector itself, which it does not reflect.
    reflector: u32,
    // The coarsest level of the pyramid, where there is one.
    top: i32,
    // Refractive index behind the surface over that before it, where what is refracted is sought.
    index: f32,
    // The coarsest level of the pyramid of bounds, where there is one.
    bounds_top: i32,
    pad: u32,
}
@group(0) @binding(0) var<storage, read> search: Search;
@group(0) @binding(1) var mirror_position: texture_2d<f32>;
@group(0) @binding(2) var mirror_normal: texture_2d<f32>;
// That of the textures.
@group(0) @binding(30) var<uniform> camera: Camera;
#ifdef SECOND
// P1 and N1: the textures show this reflector in another, and these that one, texel by texel.
@group(0) @binding(36) var first_position: texture_2d<f32>;
@group(0) @binding(37) var first_normal: texture_2d<f32>;
// Pixels of the view that show it so, by object.
@group(0) @binding(38) var<storage, read> shown_pixels: array<u32>;
#endif

// x | y << 16 of no texel.
const NOWHERE: u32 = 0xffffffffu;
// Below every quality: no texel of the reflector.
const OUTSIDE: f32 = -3.0;

// Texels whose quality was computed.
var<private> evaluations: u32;

fn packed_texel(texel: vec2<i32>) -> u32 {
    return u32(texel.x) | (u32(texel.y) << 16u);
}

fn unpacked_texel(texel: u32) -> vec2<i32> {
    return vec2<i32>(vec2(texel & 0xffffu, texel >> 16u));
}

// P at a texel; the fourth is 1 where the reflector is.
fn point_at(texel: vec2<i32>) -> vec4<f32> {
    if any(texel < vec2(0)) || any(texel >= vec2<i32>(search.size)) {
        return vec4(0.0);
    }
    return textureLoad(mirror_position, texel, 0);
}

fn normal_at(texel: vec2<i32>) -> vec3<f32> {
    return textureLoad(mirror_normal, texel, 0).xyz;
}

#ifdef SECOND
fn first_at(texel: vec2<i32>) -> vec4<f32> {
    if any(texel < vec2(0)) || any(texel >= vec2<i32>(search.size)) {
        return vec4(0.0);
    }
    return textureLoad(first_position, texel, 0);
}

// P1 between texels; at the rim that of the texel.
fn first_near(place: vec2<f32>) -> vec3<f32> {
    let corner = vec2<i32>(floor(place - 0.5));
    let f = place - 0.5 - vec2<f32>(corner);
    let p_00 = first_at(corner);
    let p_10 = first_at(corner + vec2(1, 0));
    let p_01 = first_at(corner + vec2(0, 1));
    let p_11 = first_at(corner + vec2(1, 1));
    if p_00.w * p_10.w * p_01.w * p_11.w == 0.0 {
        return first_at(vec2<i32>(place)).xyz;
    }
    return mix(mix(p_00, p_10, f.x), mix(p_01, p_11, f.x), f.y).xyz;
}
#endif

// Unit direction in which sight arrives at the point of a texel: from the eye, or from the first
// reflector.
fn arriving_at(texel: vec2<i32>, p: vec3<f32>) -> vec3<f32> {
#ifdef SECOND
    return normalize(p - first_at(texel).xyz);
#else
    return arriving(camera, p);
#endif
}

// The same at a place between texels.
fn arriving_near(place: vec2<f32>, p: vec3<f32>) -> vec3<f32> {
#ifdef SECOND
    return normalize(p - first_near(place));
#else
    return arriving(camera, p);
#endif
}

// Where a world point is on the textures, in texels; off them behind the eye.
fn texel_of(v: vec3<f32>) -> vec2<f32> {
    let clip = camera.clip_from_world * vec4(v, 1.0);
    let texel = (0.5 * clip.xy / clip.w + 0.5) * vec2<f32>(search.size);
    return select(vec2(-1.0), texel, clip.w > 0.0);
}

// V in the tangent plane at P: equation 1 with the sign its text means.
fn mirrored(v: vec3<f32>, p: vec3<f32>, n: vec3<f32>) -> vec3<f32> {
    return v - 2.0 * dot(v - p, n) * n;
}

// V' of a vertex that is not hidden, from its reflection point; the place matters in a second bounce alone.
fn image_of(v: vec3<f32>, place: vec2<f32>, p: vec3<f32>, n: vec3<f32>) -> vec3<f32> {
#ifdef SECOND
    // As far behind P1, as the eye sees it, as the path from there is long.
    let first = first_near(place);
    return first + (distance(first, p) + distance(p, v)) * arriving(camera, first);
#else ifdef REFRACTED
    return p + distance(v, p) * arriving(camera, p);
#else ifdef IMAGE_PUSH
    // At an exact point the same; at one found roughly the plane's error grows with the distance.
    return p + distance(v, p) * arriving(camera, p);
#else
    return mirrored(v, p, n);
#endif
}

// Whether a point is on the side of a plane where it is not seen by the plane's reflection, or not
// through its refraction.
fn is_out_of_sight(v: vec3<f32>, p: vec3<f32>, n: vec3<f32>) -> bool {
#ifdef REFRACTED
    return dot(v - p, n) > 0.0;
#else
    return dot(v - p, n) < 0.0;
#endif
}

// How well the normal at a texel bisects eye and vertex, the higher the better. Inverse: for the vertex
// that is reflected into `v` there (section 5.1).
fn quality(texel: vec2<i32>, v: vec3<f32>, inverse: bool) -> f32 {
    let p = point_at(texel);
    if p.w == 0.0 {
        return OUTSIDE;
    }
    evaluations += 1u;
    let n = normal_at(texel);
    let seen = select(v, mirrored(v, p.xyz, n), inverse);
#ifdef REFRACTED
    // Of Snell's law what is left along the surface, see newton.wgsl.
    let law = cross(n, search.index * normalize(v - p.xyz) - arriving_at(texel, p.xyz));
    let scale = 1.0 + search.index;
    return select(-dot(law, law) / (scale * scale), OUTSIDE + 1.0, is_out_of_sight(v, p.xyz, n));
#else
    let half = normalize(seen - p.xyz) - arriving_at(texel, p.xyz);
#ifdef OBJECTIVE_CROSS
    // -|N x B|^2, carried on past 90 degrees: N.B is flat at its top and hides small angles there.
    let c = cross(n, half);
    let sine = dot(c, c) / max(dot(half, half), 1e-12);
    return select(-sine, sine - 2.0, dot(n, half) < 0.0);
#else
    return dot(n, normalize(half));
#endif
#endif
}
