// From near a reflection point to the point itself, between texels: Gauss-Newton steps on N x H, H half
// way between eye and vertex, over points and normals interpolated from four texels.
//
// Refraction has the same form. With unit directions e from P to the eye and v to the vertex behind the surface,
// of index i over that before it, Snell's law says that along the surface the light's directions, each as long as
// its side's index, do not change: N x (e + i v) = 0. (Fermat: |EP| + i |PV| is stationary.)
#define_import_path virtual_objects::newton

#import common::camera::arriving
#import virtual_objects::reflector::{camera, evaluations, is_out_of_sight, normal_at, point_at, search}
#ifdef SECOND
#import virtual_objects::reflector::first_at
#endif
#ifdef ROOTS_ALL
#import virtual_objects::reject::is_patch
#endif

// Steps that bring any start within a few texels home; most take three.
const MOST_STEPS: u32 = 8u;
// Longest step, texels.
const REACH: f32 = 8.0;
// A last step shorter than this, texels, is made on the patch it starts from.
const ARRIVED: f32 = 0.1;
// Sine of the largest angle between N and H that counts as a reflection point.
const LAW: f32 = 2e-3;

struct ReflectionPoint {
    // In texels, centres at +0.5.
    place: vec2<f32>,
    // P and N there.
    position: vec3<f32>,
    normal: vec3<f32>,
    steps: u32,
    // Whether the law of reflection holds there.
    found: bool,
}

// The reflector between four texel centres: P and N at one place, and their slopes a texel.
struct Patch {
    whole: bool,
    p: vec3<f32>,
    n: vec3<f32>,
    p_x: vec3<f32>,
    p_y: vec3<f32>,
    n_x: vec3<f32>,
    n_y: vec3<f32>,
#ifdef SECOND
    // P1 and its slopes.
    first: vec3<f32>,
    first_x: vec3<f32>,
    first_y: vec3<f32>,
#endif
}

fn is_whole(corner: vec2<i32>) -> bool {
#ifdef ROOTS_ALL
    // Where there is a pyramid of bounds, it knows, and of leaps between texels as well.
    return is_patch(corner);
#else
    return point_at(corner).w * point_at(corner + vec2(1, 0)).w
        * point_at(corner + vec2(0, 1)).w * point_at(corner + vec2(1, 1)).w == 1.0;
#endif
}

// The patch at a place; at the reflector's rim the nearest whole one, carried on.
fn patch_at(place: vec2<f32>) -> Patch {
    let g = place - 0.5;
    let nearest = vec2<i32>(floor(g));
    var corner = nearest;
    var out: Patch;
    out.whole = is_whole(nearest);
    if !out.whole {
        var least = 1e9;
        for (var i = 0; i < 9; i += 1) {
            let other = nearest + vec2(i % 3 - 1, i / 3 - 1);
            let away = g - vec2<f32>(other) - 0.5;
            if dot(away, away) < least && is_whole(other) {
                least = dot(away, away);
                corner = other;
                out.whole = true;
            }
        }
        if !out.whole {
            return out;
        }
    }
    return patch_in(corner, g - vec2<f32>(corner));
}

// The patch from a texel's centre on, at a place in it, from 0 to 1.
fn patch_in(corner: vec2<i32>, f: vec2<f32>) -> Patch {
    let right = corner + vec2(1, 0);
    let below = corner + vec2(0, 1);
    let across = corner + vec2(1, 1);
    var out = patch_between(
        array(point_at(corner).xyz, point_at(right).xyz, point_at(below).xyz, point_at(across).xyz),
        array(normal_at(corner), normal_at(right), normal_at(below), normal_at(across)),
        f,
    );
#ifdef SECOND
    let first_00 = first_at(corner).xyz;
    let first_10 = first_at(right).xyz;
    let first_01 = first_at(below).xyz;
    let first_11 = first_at(across).xyz;
    out.first_x = mix(first_10 - first_00, first_11 - first_01, f.y);
    out.first_y = mix(first_01 - first_00, first_11 - first_10, f.x);
    out.first = mix(first_00, first_01, f.y) + f.x * out.first_x;
#endif
    return out;
}

// The patch at a place between four texel centres, row by row.
fn patch_between(p: array<vec3<f32>, 4>, n: array<vec3<f32>, 4>, f: vec2<f32>) -> Patch {
    var out: Patch;
    out.whole = true;
    out.p_x = mix(p[1] - p[0], p[3] - p[2], f.y);
    out.p_y = mix(p[2] - p[0], p[3] - p[1], f.x);
    out.p = mix(p[0], p[2], f.y) + f.x * out.p_x;
    // Of unit length up to the square of what they turn by in a texel; their slopes need no more.
    out.n_x = mix(n[1] - n[0], n[3] - n[2], f.y);
    out.n_y = mix(n[2] - n[0], n[3] - n[1], f.x);
    out.n = normalize(mix(n[0], n[2], f.y) + f.x * out.n_x);
    return out;
}

// How a unit direction towards a point `away` metres off turns as its start moves by `slope`.
fn turn(direction: vec3<f32>, away: f32, slope: vec3<f32>) -> vec3<f32> {
    return (direction * dot(direction, slope) - slope) / away;
}

// Unit direction towards where a patch is seen from, and how it turns a texel.
struct Sight {
    towards: vec3<f32>,
    x: vec3<f32>,
    y: vec3<f32>,
}

fn sight_of(at: Patch) -> Sight {
#ifdef SECOND
    // Every point of the second reflector has an eye of its own, which moves with it.
    let away = distance(at.first, at.p);
    let towards = (at.first - at.p) / away;
    let x = turn(towards, away, at.p_x - at.first_x);
    return Sight(towards, x, turn(towards, away, at.p_y - at.first_y));
#else
    let towards = -arriving(camera, at.p);
    // Parallel eye rays do not turn.
    let away = select(distance(camera.eye, at.p), 1e30, camera.orthographic == 1u);
    return Sight(towards, turn(towards, away, at.p_x), turn(towards, away, at.p_y));
#endif
}

// The Gauss-Newton step, texels, towards where `law`, of slopes `j_x` and `j_y`, is least.
fn step_towards(law: vec3<f32>, j_x: vec3<f32>, j_y: vec3<f32>) -> vec2<f32> {
    let a = dot(j_x, j_x);
    let b = dot(j_x, j_y);
    let c = dot(j_y, j_y);
    // Damped a little, so that a fold does not throw the step.
    let damping = 1e-5 * (a + c) + 1e-30;
    let determinant = (a + damping) * (c + damping) - b * b;
    let g_x = dot(j_x, law);
    let g_y = dot(j_y, law);
    return vec2(b * g_y - (c + damping) * g_x, b * g_x - (a + damping) * g_y) / determinant;
}

// Half way between the directions to where it is seen from and to the vertex, not of unit length, and its
// slopes a texel.
struct HalfWay {
    h: vec3<f32>,
    h_x: vec3<f32>,
    h_y: vec3<f32>,
}

fn half_way(at: Patch, v: vec3<f32>) -> HalfWay {
    let sight = sight_of(at);
    let away = max(distance(v, at.p), 1e-9);
    let towards_v = (v - at.p) / away;
#ifdef REFRACTED
    let index = search.index;
#else
    let index = 1.0;
#endif
    let h_x = sight.x + index * turn(towards_v, away, at.p_x);
    let h_y = sight.y + index * turn(towards_v, away, at.p_y);
    return HalfWay(sight.towards + index * towards_v, h_x, h_y);
}

// What the law of reflection, or Snell's, is broken by, and its slopes a texel.
struct Law {
    // As `HalfWay` has it.
    h: vec3<f32>,
    // N x H.
    left: vec3<f32>,
    x: vec3<f32>,
    y: vec3<f32>,
}

fn law_at(at: Patch, v: vec3<f32>) -> Law {
    let half = half_way(at, v);
    let x = cross(at.n_x, half.h) + cross(at.n, half.h_x);
    let y = cross(at.n_y, half.h) + cross(at.n, half.h_y);
    return Law(half.h, cross(at.n, half.h), x, y);
}

// The Gauss-Newton step, texels.
fn step_of(law: Law) -> vec2<f32> {
    return step_towards(law.left, law.x, law.y);
}

// From a place to the reflection point of `v`.
fn newton(begin: vec2<f32>, v: vec3<f32>) -> ReflectionPoint {
    var out: ReflectionPoint;
    var place = begin;
    for (var step = 0u; step < MOST_STEPS; step += 1u) {
        let at = patch_at(place);
        if !at.whole {
            // Beyond the rim: back half way.
            if step == 0u {
                break;
            }
            place = 0.5 * (place + out.place);
            continue;
        }
        evaluations += 1u;
        let law = law_at(at, v);
        out.place = place;
        out.position = at.p;
        out.normal = at.n;
        out.steps = step + 1u;
        var delta = step_of(law);
        delta *= min(1.0, REACH / max(length(delta), 1e-9));
        place += delta;
        let arrived = length(delta) < ARRIVED;
        var left = law.left;
        if arrived {
            left += law.x * delta.x + law.y * delta.y;
            out.place = place;
            out.position += at.p_x * delta.x + at.p_y * delta.y;
            out.normal = normalize(at.n + at.n_x * delta.x + at.n_y * delta.y);
        }
#ifdef REFRACTED
        // H is short where the index is near 1.
        out.found = dot(left, left) < LAW * LAW && !is_out_of_sight(v, at.p, at.n);
#else
        out.found = dot(left, left) < LAW * LAW * dot(law.h, law.h) && dot(at.n, law.h) > 0.0;
#endif
        if arrived {
            break;
        }
    }
    return out;
}
