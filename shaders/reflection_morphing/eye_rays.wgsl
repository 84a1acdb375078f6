// The ray of each texel of a reflector's textures: how light goes on from there that the eye sees (ray maps of
// Martin & Popescu 2004, section 4.1, of the eye's own place, the first hit drawn instead of traced). With `FURTHER`
// the reflector is met by the rays that leave another one, the texel's own ray being to it what the eye's is to
// the first; `THRICE`: which is not the first one either.
#import bindings::departure::{LOBE_REFLECTED, depart, is_heaviest}
#import bindings::scene::{materials, objects}
#import common::camera::{Camera, arriving, eye_direction}
#import reflection_morphing::eye_bins::{EyeRay, KIND, RAY_LEAVES, RAY_NONE, RAY_PASSES, TORN, bins}

@group(0) @binding(0) var mirror_position: texture_2d<f32>;
@group(0) @binding(1) var mirror_normal: texture_2d<f32>;
// That of the textures.
@group(0) @binding(30) var<uniform> camera: Camera;
@group(0) @binding(41) var<storage, read_write> rays: array<EyeRay>;
#ifdef FURTHER
// Those that leave the reflector before.
@group(0) @binding(48) var<storage, read> arriving_rays: array<EyeRay>;
// As eye_project.wgsl reads them.
@group(0) @binding(47) var<storage, read_write> firsts: array<vec4<f32>>;
#endif
#ifdef THRICE
// Of the rays that arrive.
@group(0) @binding(49) var<storage, read> firsts_before: array<vec4<f32>>;
#endif

// Cosine between normal and eye up to which the reflector goes out of sight by bending away.
const GRAZING: f32 = 0.4;
// Sine of the angle between a smooth surface and the way to its next texel, at most.
const STEEP: f32 = 0.7;

fn point_at(texel: vec2<i32>) -> vec4<f32> {
    if any(texel < vec2(0)) || any(texel >= vec2(i32(bins.size))) {
        return vec4(0.0);
    }
    let point = textureLoad(mirror_position, texel, 0);
#ifdef FURTHER
    return vec4(point.xyz, select(0.0, 1.0, point.w == 1.0 + f32(bins.reflector)));
#else
    return point;
#endif
}

fn normal_at(texel: vec2<i32>) -> vec3<f32> {
    return textureLoad(mirror_normal, texel, 0).xyz;
}

// How far a ray goes in the scene's box.
fn length_in_box(origin: vec3<f32>, direction: vec3<f32>) -> f32 {
    let ahead = select(bins.low, bins.high, direction > vec3(0.0)) - origin;
    let slow = abs(direction) < vec3(1e-9);
    let away = select(ahead / select(direction, vec3(1.0), slow), vec3(1e30), slow);
    return max(min(away.x, min(away.y, away.z)), 0.0);
}

// What meets the reflector at a texel, or passes it by there.
#ifdef FURTHER
fn arriving_ray(texel: vec2<i32>) -> EyeRay {
    return arriving_rays[u32(texel.y) * bins.size + u32(texel.x)];
}

fn incident(texel: vec2<i32>, p: vec3<f32>) -> vec3<f32> {
    return arriving_ray(texel).direction;
}
#else
fn arriving_ray(texel: vec2<i32>) -> EyeRay {
    let ndc = 2.0 * (vec2<f32>(texel) + 0.5) / f32(bins.size) - 1.0;
    let direction = eye_direction(camera, ndc);
    var eye = camera.eye;
    if camera.orthographic == 1u {
        eye += ndc.x * camera.half_width * camera.right - ndc.y * camera.half_height * camera.up;
    }
    return EyeRay(eye, RAY_LEAVES, direction, 0.0);
}

fn incident(texel: vec2<i32>, p: vec3<f32>) -> vec3<f32> {
    return arriving(camera, p);
}
#endif

// The ray through a texel that the reflector is next to, from the distance on at which that bends away.
fn passing(texel: vec2<i32>) -> EyeRay {
    var points = vec4(0.0);
    for (var i = 0; i < 9; i += 1) {
        let other = texel + vec2(i % 3 - 1, i / 3 - 1);
        let p = point_at(other);
        if p.w == 1.0 && abs(dot(normal_at(other), incident(other, p.xyz))) < GRAZING {
            points += p;
        }
    }
    let ray = arriving_ray(texel);
    if points.w == 0.0 || (ray.kind & KIND) == RAY_NONE {
        return EyeRay(vec3(0.0), RAY_NONE, vec3(0.0), 0.0);
    }
    let origin = ray.origin + dot(points.xyz / points.w - ray.origin, ray.direction) * ray.direction;
    return EyeRay(origin, RAY_PASSES, ray.direction, length_in_box(origin, ray.direction));
}

fn leaving(texel: vec2<i32>, p: vec3<f32>, n: vec3<f32>) -> EyeRay {
    let material = materials[objects[bins.reflector].material];
    let way = depart(material, bins.lobe, incident(texel, p), n, true);
    var kind = select(RAY_NONE, RAY_LEAVES, way.exists);
#ifdef FURTHER
    // A record follows the heavier layer.
    if material.index > 0.0 || !is_heaviest(bins.lobe, way.share) {
        kind = RAY_NONE;
    }
    kind = select(RAY_NONE, arriving_ray(texel).kind & KIND, kind == RAY_LEAVES);
#endif
    return EyeRay(p, kind, way.direction, length_in_box(p, way.direction));
}

// Whether two neighbouring texels show different parts of the reflector, one before the other.
fn parts(a: vec2<i32>, b: vec2<i32>) -> bool {
    let p = point_at(a);
    let q = point_at(b);
    let along = normalize(q.xyz - p.xyz);
    let steep = max(abs(dot(along, normal_at(a))), abs(dot(along, normal_at(b))));
    return p.w * q.w == 1.0 && steep > STEEP;
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= vec2(bins.size)) {
        return;
    }
    let texel = vec2<i32>(id.xy);
    let point = point_at(texel);
    var ray: EyeRay;
    if point.w == 1.0 {
        ray = leaving(texel, point.xyz, normal_at(texel));
    } else if bins.lobe == LOBE_REFLECTED {
        ray = passing(texel);
    }
    let right = texel + vec2(1, 0);
    let below = texel + vec2(0, 1);
    let across = texel + vec2(1, 1);
    if parts(texel, right) || parts(texel, below) || parts(right, across) || parts(below, across) {
        ray.kind |= TORN;
    }
    let index = id.y * bins.size + id.x;
#ifdef FURTHER
    let before = arriving_rays[index];
    ray.kind |= before.kind & TORN;
#ifdef THRICE
    let first = firsts_before[index];
#else
    let first = vec4(before.origin, 0.0);
#endif
    firsts[index] = vec4(first.xyz, first.w + distance(before.origin, ray.origin));
#endif
    rays[index] = ray;
}
