// Every reflection point of every vertex: the pyramid of bounds is walked, what can hold none is left out,
// and in each patch that is left Newton's steps look for one.
#import bindings::record::count
#import bindings::scene::{objects, vertices, world_position}
#import virtual_objects::branch::{fold_of, root_in}
#import virtual_objects::newton::{law_at, patch_in}
#import virtual_objects::node::{MOST_ROOTS, Node, OWN, UNSOUGHT, is_same}
#import virtual_objects::reflector::{evaluations, search, texel_of}
#import virtual_objects::reject::{
    Cursor, cell_at, first_cell, is_patch, may_hold, mirror_balls, next_cell, visits
}

// Whose vertex each is.
@group(0) @binding(3) var<storage, read> owners: array<u32>;
@group(0) @binding(8) var<storage, read_write> nodes: array<Node>;
// How many are not the scene's: the fourth word.
@group(0) @binding(7) var<storage, read> nodes_made: array<u32>;

struct Sought {
    // The first node, and 1 where nodes are the scene's vertices.
    first: u32,
    of_scene: u32,
    // Which pass over them this is, and the last.
    round: u32,
    last: u32,
}
@group(0) @binding(9) var<storage, read> sought: Sought;

// Cells and places looked at in one pass: drivers end what loops on for long (lavapipe after 65,535 rounds of all
// loops of eight invocations together), so a search goes on in the next.
const PATIENCE: u32 = 2048u;

var<private> roots: array<vec4<f32>, 8>;
var<private> number: u32;
var<private> beyond: u32;

fn keep(root: vec4<f32>) {
    for (var i = 0u; i < number; i += 1u) {
        if is_same(roots[i], root) {
            return;
        }
    }
    if number == MOST_ROOTS {
        beyond += 1u;
        return;
    }
    roots[number] = root;
    number += 1u;
}

// A vertex nearer to a patch than this, in its radii, sees it so slanted that one start is not enough.
const CLOSE: f32 = 4.0;

// The law's slopes in a patch are at most so much steeper than at its corners.
const STEEPER: f32 = 1.5;

// Look for roots in a patch: none where what the law is broken by is further from 0 at all corners than it
// changes on the way to them; else from its middle; and, where the law's slopes turn over in it, so that there may
// be two, or where it is close, from near its corners, and from where it is seen directly.
fn look_in(corner: vec2<i32>, v: vec3<f32>) {
    var low = vec2(0.0);
    var high = vec2(1.0);
    low.x -= select(1.0, 0.0, is_patch(corner - vec2(1, 0)));
    low.y -= select(1.0, 0.0, is_patch(corner - vec2(0, 1)));
    high.x += select(1.0, 0.0, is_patch(corner + vec2(1, 0)));
    high.y += select(1.0, 0.0, is_patch(corner + vec2(0, 1)));
    var least = 1.0;
    var most = -1.0;
    var under = vec3(1e9);
    var over = vec3(-1e9);
    var slope_x = vec3(0.0);
    var slope_y = vec3(0.0);
    for (var i = 0; i < 4; i += 1) {
        let f = select(low, high, vec2(i % 2 == 1, i / 2 == 1));
        let at = patch_in(corner, f);
        let law = law_at(at, v);
        let fold = fold_of(law, at.n);
        least = min(least, fold);
        most = max(most, fold);
        under = min(under, law.left);
        over = max(over, law.left);
        slope_x = max(slope_x, abs(law.x));
        slope_y = max(slope_y, abs(law.y));
        evaluations += 1u;
    }
    // No place is further from a corner than half way.
    let change = STEEPER * 0.5 * ((high.x - low.x) * slope_x + (high.y - low.y) * slope_y) + 1e-6;
    let ball = textureLoad(mirror_balls, corner, 0);
    let is_close = distance(v, ball.xyz) < CLOSE * ball.w;
    if !is_close && any((under > change) | (over < -change)) {
        return;
    }
    let is_folded = least <= 0.0 && most >= 0.0;
    let starts = select(select(1, 5, is_folded), 6, is_close);
    for (var i = 0; i < starts; i += 1) {
        var share = vec2(0.5);
        if i > 0 {
            share = select(vec2(0.1), vec2(0.9), vec2(i % 2 == 1, i > 2));
        }
        if i == 5 {
            // From almost in the mirror it is shown almost where it is.
            share = clamp((texel_of(v) - 0.5 - vec2<f32>(corner) - low) / (high - low), vec2(0.0), vec2(1.0));
        }
        let root = root_in(corner, mix(low, high, share), low, high, v);
        if root.found {
            keep(vec4(root.place, root.fold, 0.0));
        }
    }
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let index = sought.first + id.x;
    let total = select(nodes_made[3], search.total, sought.of_scene == 1u);
    if id.x >= total || index >= arrayLength(&nodes) {
        return;
    }
    var at = first_cell();
    if sought.of_scene == 1u && sought.round == 0u {
        nodes[index].position = world_position(objects[owners[index]], vertices[index].position);
        nodes[index].number = 0u;
        if owners[index] == search.reflector {
            nodes[index].number = OWN;
            nodes[index].cursor.w = 1u;
            return;
        }
        count(0u, 1u);
    } else if nodes[index].number == UNSOUGHT {
        nodes[index].number = 0u;
        count(0u, 1u);
    } else if nodes[index].cursor.w == 0u {
        let cursor = nodes[index].cursor;
        at = Cursor(i32(cursor.x), i32(cursor.y), cursor.z, false);
        number = nodes[index].number;
        for (var i = 0u; i < number; i += 1u) {
            roots[i] = nodes[index].roots[i];
        }
    } else {
        return;
    }
    let before = number;
    let v = nodes[index].position;
    while !at.done && visits + evaluations < PATIENCE {
        let cell = cell_at(at);
        let held = may_hold(cell, at.level, v, 0.0);
        if held && at.level == 0 {
            look_in(cell, v);
        }
        at = next_cell(at, held && at.level > 0);
        at.done = at.done || beyond > 0u;
    }
    nodes[index].number = number;
    for (var i = before; i < number; i += 1u) {
        nodes[index].roots[i] = roots[i];
    }
    nodes[index].cursor = vec4(u32(at.top), u32(at.level), at.code, u32(at.done));
    count(2u, evaluations);
    count(7u, visits);
    count(8u, number - before);
    count(9u, beyond);
    if sought.round == sought.last {
        count(11u, u32(!at.done));
    }
}
