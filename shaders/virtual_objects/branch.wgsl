// Reflection points by Newton's steps that stay with their patch or their branch, where a vertex may have
// several.
#define_import_path virtual_objects::branch

#import virtual_objects::corner::{Corner, LOST, SHOWN, is_turned, packed_found, packed_turn}
#import virtual_objects::newton::{Law, Patch, law_at, patch_at, patch_in, step_of}
#import virtual_objects::reflector::{evaluations, image_of, search}

const STEPS: u32 = 24u;
// A last step shorter than this, texels, ends where it leads.
const SETTLED: f32 = 0.01;
// What is left then, in texels of the law's slopes.
const LEFT: f32 = 0.01;
// N . H above this, in texels of the law's slopes: behind the reflector on the eye ray to a vertex H is 0, which
// fulfils the law and is no reflection.
const GRAZING: f32 = 0.05;
// Rounding of the law.
const ROUNDING: f32 = 1e-6;
// Beyond a patch's sides by less than this, texels, is on them.
const EDGE: f32 = 2e-3;
// Longest step in a patch, and along a branch, texels.
const PATCH_REACH: f32 = 0.5;
const BRANCH_REACH: f32 = 8.0;

struct Branch {
    place: vec2<f32>,
    // See `Node`.
    fold: f32,
    found: bool,
    position: vec3<f32>,
    normal: vec3<f32>,
}

// The determinant of the law's slopes, seen against the normal, as a share of the sum of their squares.
fn fold_of(law: Law, normal: vec3<f32>) -> f32 {
    let scale = max(dot(law.x, law.x) + dot(law.y, law.y), 1e-30);
    return dot(cross(law.x, law.y), normal) / scale;
}

// Whether a step from here ends on a root.
fn ends(at: Patch, law: Law, delta: vec2<f32>) -> bool {
    let left = law.left + law.x * delta.x + law.y * delta.y;
    let scale = dot(law.x, law.x) + dot(law.y, law.y);
    let least = ROUNDING * ROUNDING * dot(law.h, law.h);
    return length(delta) < SETTLED && dot(at.n, law.h) > GRAZING * sqrt(scale)
        && dot(left, left) < LEFT * LEFT * scale + least;
}

fn branch_at(at: Patch, law: Law, place: vec2<f32>, delta: vec2<f32>) -> Branch {
    let position = at.p + at.p_x * delta.x + at.p_y * delta.y;
    let normal = normalize(at.n + at.n_x * delta.x + at.n_y * delta.y);
    return Branch(place + delta, fold_of(law, at.n), ends(at, law, delta), position, normal);
}

// From a place in a patch to a root on it, carried on to `low` and `high`; in texels from its first
// texel's centre.
fn root_in(corner: vec2<i32>, begin: vec2<f32>, low: vec2<f32>, high: vec2<f32>, v: vec3<f32>) -> Branch {
    var out: Branch;
    var f = begin;
    for (var step = 0u; step < STEPS; step += 1u) {
        evaluations += 1u;
        let at = patch_in(corner, f);
        let law = law_at(at, v);
        var delta = step_of(law);
        delta *= min(1.0, PATCH_REACH / max(length(delta), 1e-9));
        out = branch_at(at, law, vec2<f32>(corner) + 0.5 + f, delta);
        f += delta;
        if out.found || any(f < low - 1.0) || any(f > high + 1.0) {
            break;
        }
    }
    out.found = out.found && all(f >= low - EDGE) && all(f <= high + EDGE)
        && patch_at(out.place).whole;
    return out;
}

// From a place near a root to it, over patches.
fn root_near(begin: vec2<f32>, v: vec3<f32>) -> Branch {
    var out: Branch;
    var place = begin;
    for (var step = 0u; step < STEPS; step += 1u) {
        let at = patch_at(place);
        if !at.whole {
            out.found = false;
            break;
        }
        evaluations += 1u;
        let law = law_at(at, v);
        var delta = step_of(law);
        delta *= min(1.0, BRANCH_REACH / max(length(delta), 1e-9));
        out = branch_at(at, law, place, delta);
        place += delta;
        if out.found {
            break;
        }
    }
    return out;
}

// Longest way of a root from one look at it to the next, texels.
fn longest_way() -> f32 {
    return max(8.0, f32(max(search.size.x, search.size.y)) / 12.0);
}

// Whether what is found next is on the branch of a root of a point near by.
fn goes_on(next: Branch, root: vec4<f32>) -> bool {
    return next.found && next.fold * root.z > 0.0 && distance(next.place, root.xy) < longest_way();
}

// The corner of a point at a root of its.
fn branch_corner(v: vec3<f32>, root: vec4<f32>, p: vec3<f32>, n: vec3<f32>) -> Corner {
    let found = packed_found(root.xy, SHOWN) | packed_turn(root.z > 0.0);
    return Corner(v, 0u, image_of(v, root.xy, p, n), found);
}

// The corner at a point whose root is likely to be near a place, in the branch of another corner.
fn corner_on(v: vec3<f32>, place: vec2<f32>, like: Corner) -> Corner {
    let at = root_near(place, v);
    if !at.found || (at.fold > 0.0) != is_turned(like) {
        return Corner(v, 0u, v, packed_found(place, LOST));
    }
    return branch_corner(v, vec4(at.place, at.fold, 0.0), at.position, at.normal);
}
