// Settled triangles as each branch of the reflector shows them: those that all three corners share whole, the
// others cut off where they end. No triangle lies across a fold: a branch is followed under one sign of the
// law's determinant. One invocation a root of a corner.
#import bindings::record::count
#import virtual_objects::branch::{branch_corner, goes_on, root_near}
#import virtual_objects::corner::Corner
#import virtual_objects::linked::{Linked, NOT_JOINED, it, last_root, next_root, node_of, nodes, position_of, roots_of}
#import virtual_objects::newton::patch_at
#import virtual_objects::node::MOST_ROOTS
#import virtual_objects::reflector::evaluations
#import virtual_objects::spans::{
    GROUP, Generation, NONE, Span, corners, fresh, made_spans, room_for_corners, room_to_add, split
}

struct Settled {
    groups_x: u32,
    groups_y: u32,
    groups_z: u32,
    total: u32,
    triangles: array<Linked>,
}
@group(0) @binding(9) var<storage, read> settled: Settled;
// As split.wgsl has them.
@group(0) @binding(15) var<storage, read_write> linked: Generation;

// Halvings of an edge in search of a branch's end.
const HALVINGS: u32 = 12u;

// Corners of a part of the triangle in one branch, in order.
var<private> ring: array<Corner, 5>;
var<private> around: u32;

fn add(corner: Corner) {
    ring[around] = corner;
    around += 1u;
}

// As far as a root is followed from one corner towards another; the corner itself where that is 0.
fn add_end(start: u32, root: u32, to: u32) {
    var at = nodes[node_of(start)].roots[root];
    let patch_here = patch_at(at.xy);
    var p = patch_here.p;
    var n = patch_here.n;
    var share = 0.0;
    var stride = 0.5;
    for (var i = 0u; i < HALVINGS; i += 1u) {
        let v = mix(position_of(start), position_of(to), share + stride);
        let next = root_near(at.xy, v);
        if goes_on(next, at) {
            at = vec4(next.place, next.fold, 0.0);
            p = next.position;
            n = next.normal;
            share += stride;
        }
        stride *= 0.5;
    }
    let v = mix(position_of(start), position_of(to), share);
    add(branch_corner(v, at, p, n));
}

fn add_corner(corner: u32, root: u32) {
    let node = node_of(corner);
    let at = nodes[node].roots[root];
    let patch_there = patch_at(at.xy);
    add(branch_corner(nodes[node].position, at, patch_there.p, patch_there.n));
}

// Hand the part on as triangles about its first corner, and the spans that bound them: first those round
// it, then those across.
fn emit() {
    let number = around;
    around = 0u;
    let first = room_for_corners(number);
    let spans = room_to_add(number - 2u, 2u * number - 3u);
    if first == NONE || spans == NONE {
        return;
    }
    for (var i = 0u; i < number; i += 1u) {
        corners[first + i] = ring[i];
        made_spans[spans + i - split.edges] = Span(first + i, first + (i + 1u) % number, NONE);
    }
    let across = spans + number;
    let place = atomicAdd(&linked.total, number - 2u);
    for (var i = 2u; i < number; i += 1u) {
        let is_last = i + 1u == number;
        if !is_last {
            made_spans[across + i - 2u - split.edges] = Span(first, first + i, NONE);
        }
        let left = select(across + i - 3u, spans, i == 2u);
        let right = select(across + i - 2u, spans + i, is_last);
        linked.triangles[place + i - 2u] = vec4(left, spans + i - 1u, right, it.t.w);
    }
    atomicMax(&linked.groups_x, (place + number - 2u + GROUP - 1u) / GROUP);
    linked.groups_y = 1u;
    linked.groups_z = 1u;
}

// Whether a branch's part of the triangle begins at a root of a corner: at the first corner where the branch
// goes round; else where it ends behind, and after each three corners, as more are not drawn at once.
fn begins(corner: u32, root: u32) -> bool {
    var at = corner;
    var branch = root;
    for (var i = 0u; i < 3u * MOST_ROOTS; i += 1u) {
        let last = last_root(at, branch);
        if last == NOT_JOINED {
            return i % 3u == 0u;
        }
        branch = last;
        at = (at + 2u) % 3u;
        if at == corner && branch == root {
            return corner == 0u;
        }
    }
    return false;
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if all(id == vec3(0u)) {
        // Who measures spans begins with this group.
        atomicAdd(&fresh.groups_x, 1u);
        fresh.groups_y = 1u;
        fresh.groups_z = 1u;
    }
    let corner = id.y / MOST_ROOTS;
    let root = id.y % MOST_ROOTS;
    if id.x >= settled.total {
        return;
    }
    it = settled.triangles[id.x];
    if root >= roots_of(corner) || !begins(corner, root) {
        return;
    }
    var branches = vec3(root, NOT_JOINED, NOT_JOINED);
    for (var i = 1u; i < 3u; i += 1u) {
        if branches[i - 1u] != NOT_JOINED {
            branches[i] = next_root(corner + i - 1u, branches[i - 1u]);
        }
    }
    let goes_round = branches.z != NOT_JOINED && next_root(corner + 2u, branches.z) == root;
    if !goes_round {
        count(10u, 1u);
        add_end(corner, root, corner + 2u);
    }
    var last = 0u;
    for (var i = 0u; i < 3u; i += 1u) {
        if branches[i] != NOT_JOINED {
            add_corner(corner + i, branches[i]);
            last = i;
        }
    }
    if !goes_round {
        add_end(corner + last, branches[last], corner + last + 1u);
    }
    emit();
    count(2u, evaluations);
}
