// Reflection points sought over a reflector's cube maps: by steps along B - N, our guess at the search of
// Estalella et al. 2005, or by Gauss-Newton steps on B - N, in the manner of Roger & Holzschuch 2006.
#define_import_path virtual_objects::cube_search

#import common::camera::arriving
#import common::cube::{cube_direction, cube_texel}
#import virtual_objects::newton::{Patch, ReflectionPoint, half_way, patch_between, step_towards}
#import virtual_objects::reflector::{camera, evaluations, mirrored, texel_of}

struct CubeSearch {
    // Rows of world from the reflector's own space.
    row_x: vec4<f32>,
    row_y: vec4<f32>,
    row_z: vec4<f32>,
    // Of the maps, own space.
    centre: vec3<f32>,
    // How much of B - N a step adds.
    step: f32,
    // Texels along a face's side; texels at a face's edge are of its edge.
    size: i32,
    most_steps: u32,
    pad_a: u32,
    pad_b: u32,
}
@group(0) @binding(50) var<storage, read> cube_search: CubeSearch;
// P, the fourth 1 where the reflector is, and N; own space.
@group(0) @binding(51) var cube_position: texture_2d_array<f32>;
@group(0) @binding(52) var cube_normal: texture_2d_array<f32>;

// |B - N| of a search that is done.
const DONE: f32 = 1e-4;
// The largest |B - N| that counts as a reflection point.
const LAW: f32 = 2e-3;
// Longest Gauss-Newton step, over a face at distance 1.
const REACH: f32 = 0.5;
// One too short to be of use, likewise.
const LEAST_STEP: f32 = 1e-6;

fn world_from_own(d: vec3<f32>) -> vec3<f32> {
    let s = cube_search;
    return vec3(dot(s.row_x.xyz, d), dot(s.row_y.xyz, d), dot(s.row_z.xyz, d));
}

// Poses are rigid.
fn own_from_world(d: vec3<f32>) -> vec3<f32> {
    let s = cube_search;
    return d.x * s.row_x.xyz + d.y * s.row_y.xyz + d.z * s.row_z.xyz;
}

fn world_centre() -> vec3<f32> {
    let s = cube_search;
    return world_from_own(s.centre) + vec3(s.row_x.w, s.row_y.w, s.row_z.w);
}

// The reflector in a direction of its own space: in the world, slopes a texel of the face.
fn cube_patch(d: vec3<f32>) -> Patch {
    let on_face = cube_texel(d);
    let g = on_face.uv * f32(cube_search.size - 1);
    let corner = clamp(vec2<i32>(g), vec2(0), vec2(cube_search.size - 2));
    let right = corner + vec2(1, 0);
    let below = corner + vec2(0, 1);
    let across = corner + vec2(1, 1);
    let a = textureLoad(cube_position, corner, on_face.face, 0);
    let b = textureLoad(cube_position, right, on_face.face, 0);
    let c = textureLoad(cube_position, below, on_face.face, 0);
    let e = textureLoad(cube_position, across, on_face.face, 0);
    let normals = array(
        textureLoad(cube_normal, corner, on_face.face, 0).xyz,
        textureLoad(cube_normal, right, on_face.face, 0).xyz,
        textureLoad(cube_normal, below, on_face.face, 0).xyz,
        textureLoad(cube_normal, across, on_face.face, 0).xyz,
    );
    var out: Patch;
    if a.w * b.w * c.w * e.w == 1.0 {
        evaluations += 1u;
        let points = array(a.xyz, b.xyz, c.xyz, e.xyz);
        out = in_world(patch_between(points, normals, g - vec2<f32>(corner)));
    }
    return out;
}

fn in_world(own: Patch) -> Patch {
    let origin = vec3(cube_search.row_x.w, cube_search.row_y.w, cube_search.row_z.w);
    var out = own;
    out.p = world_from_own(own.p) + origin;
    out.n = world_from_own(own.n);
    out.p_x = world_from_own(own.p_x);
    out.p_y = world_from_own(own.p_y);
    out.n_x = world_from_own(own.n_x);
    out.n_y = world_from_own(own.n_y);
    return out;
}

// Where a search of `v` starts, own space: half way between eye and vertex as the centre sees them.
fn first_direction(v: vec3<f32>) -> vec3<f32> {
    let centre = world_centre();
    let half = normalize(v - centre) - arriving(camera, centre);
    return own_from_world(select(-arriving(camera, centre), half, dot(half, half) > 1e-9));
}

// The direction of a point found, own space.
fn direction_of(position: vec3<f32>) -> vec3<f32> {
    return own_from_world(position - world_centre());
}

fn found_point(at: Patch, miss: vec3<f32>, steps: u32) -> ReflectionPoint {
#ifdef HIDDEN_CLIP
    let found = dot(miss, miss) < LAW * LAW;
#else
    // As long ago: where the steps ran out there is a point all the same.
    let found = true;
#endif
    return ReflectionPoint(texel_of(at.p), at.p, at.n, steps, found);
}

// d <- d + a (B - N) from `begin` on. Inverse: for the vertex that is reflected into `v`.
fn fixed_point(begin: vec3<f32>, v: vec3<f32>, inverse: bool) -> ReflectionPoint {
    var out: ReflectionPoint;
    var d = begin;
    for (var step = 1u; step <= cube_search.most_steps; step += 1u) {
        let at = cube_patch(d);
        if !at.whole {
            out.found = false;
            break;
        }
        let seen = select(v, mirrored(v, at.p, at.n), inverse);
        let half = normalize(seen - at.p) - arriving(camera, at.p);
        let miss = half / max(length(half), 1e-9) - at.n;
        out = found_point(at, miss, step);
        if dot(miss, miss) < DONE * DONE {
            break;
        }
        d = normalize(d) + cube_search.step * own_from_world(miss);
    }
    return out;
}

// The step over the face at distance 1 that Gauss and Newton take from a patch.
fn newton_step(at: Patch, d: vec3<f32>, v: vec3<f32>, miss: vec3<f32>) -> vec3<f32> {
    let half = half_way(at, v);
    let away = max(length(half.h), 1e-9);
    let b = half.h / away;
    let j_x = (half.h_x - b * dot(b, half.h_x)) / away - at.n_x;
    let j_y = (half.h_y - b * dot(b, half.h_y)) / away - at.n_y;
    // Faces are two wide.
    let across = step_towards(miss, j_x, j_y) * 2.0 / f32(cube_search.size - 1);
    let face = cube_texel(d).face;
    let middle = cube_direction(face, vec2(0.5));
    let right = cube_direction(face, vec2(1.0, 0.5)) - middle;
    let down = cube_direction(face, vec2(0.5, 1.0)) - middle;
    let step = across.x * right + across.y * down;
    return step * min(1.0, REACH / max(length(step), 1e-9));
}

// Gauss-Newton steps, each halved until B - N shrinks: N - B is monotone over a convex reflector, so it
// always does. Only over the side that faces the eye: of a hidden vertex B turns every way round the two
// points where the line to it pierces the reflector, and N is B somewhere round either.
fn newton_on_cube(begin: vec3<f32>, v: vec3<f32>) -> ReflectionPoint {
    var out: ReflectionPoint;
    var kept = own_from_world(-arriving(camera, world_centre()));
    var step = normalize(begin) - kept;
    var least = 1e9;
    for (var i = 1u; i <= cube_search.most_steps && length(step) > LEAST_STEP; i += 1u) {
        let d = kept + step;
        let at = cube_patch(d);
        let incident = arriving(camera, at.p);
        var error = 1e9;
        var miss = vec3(0.0);
        if at.whole && dot(at.n, incident) < 0.0 {
            let half = normalize(v - at.p) - incident;
            miss = half / max(length(half), 1e-9) - at.n;
            error = dot(miss, miss);
        }
        if error < least {
            least = error;
            out = found_point(at, miss, i);
            if error < DONE * DONE {
                break;
            }
            // As long as the face is away.
            kept = d / max(max(abs(d.x), abs(d.y)), abs(d.z));
            step = newton_step(at, d, v, miss);
        } else {
            step *= 0.5;
        }
        out.steps = i;
    }
    return out;
}

// The reflection point of a world point, without a memory.
fn cube_point(v: vec3<f32>) -> ReflectionPoint {
#ifdef CUBE_NEWTON
    return newton_on_cube(first_direction(v), v);
#else
    return fixed_point(first_direction(v), v, false);
#endif
}
