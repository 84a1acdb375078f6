// Torn triangles halved; the others are settled.
#import bindings::record::count
#import virtual_objects::generation::{GROUP, Generation, take}
#import virtual_objects::linked::{Linked, it, link, node_of, nodes, position_of, roots_of}
#import virtual_objects::node::UNSOUGHT

@group(0) @binding(17) var<storage, read_write> torn: array<u32>;
@group(0) @binding(18) var<storage, read_write> after: Generation;

struct Settled {
    groups_x: atomic<u32>,
    groups_y: u32,
    groups_z: u32,
    total: atomic<u32>,
    triangles: array<Linked>,
}
@group(0) @binding(19) var<storage, read_write> settled: Settled;

struct Made {
    groups_x: atomic<u32>,
    groups_y: u32,
    groups_z: u32,
    total: atomic<u32>,
}
@group(0) @binding(12) var<storage, read_write> nodes_made: Made;

fn longest_edge() -> u32 {
    var longest = 0u;
    var most = 0.0;
    for (var edge = 0u; edge < 3u; edge += 1u) {
        let away = distance(position_of(edge), position_of(edge + 1u));
        if away > most {
            most = away;
            longest = edge;
        }
    }
    return longest;
}

fn look_again(a: u32, b: u32, c: u32) {
    let place = atomicAdd(&after.total, 1u);
    after.triangles[place] = vec4(a, b, c, it.t.w);
    if place % GROUP == 0u {
        atomicAdd(&after.groups_x, 1u);
        after.groups_y = 6u;
        after.groups_z = 1u;
    }
}

// The node in the middle of an edge.
fn made_node(edge: u32, place: u32) {
    if (place - link.vertices) % GROUP == 0u {
        atomicAdd(&nodes_made.groups_x, 1u);
        nodes_made.groups_y = 1u;
        nodes_made.groups_z = 1u;
    }
    nodes[place].position = 0.5 * (position_of(edge) + position_of(edge + 1u));
    nodes[place].number = UNSOUGHT;
}

// Halve the edges marked; false where there is no room.
fn halve(marked: array<bool, 3>) -> bool {
    var at = marked;
    var number = 0u;
    for (var i = 0u; i < 3u; i += 1u) {
        number += select(0u, 1u, at[i]);
    }
    var place = link.vertices + atomicAdd(&nodes_made.total, number);
    if place + number > link.node_room {
        count(6u, 1u);
        return false;
    }
    var middle: array<u32, 3>;
    for (var i = 0u; i < 3u; i += 1u) {
        if at[i] {
            middle[i] = place;
            made_node(i, place);
            place += 1u;
        }
    }
    if number == 3u {
        look_again(it.t.x, middle[0], middle[2]);
        look_again(middle[0], it.t.y, middle[1]);
        look_again(middle[2], middle[1], it.t.z);
        look_again(middle[0], middle[1], middle[2]);
        return true;
    }
    // Turned so that the first edge is halved, and where one is not, that it is the third.
    var turn = 0u;
    for (var i = 0u; i < 3u; i += 1u) {
        if at[i] && !at[(i + 2u) % 3u] {
            turn = i;
        }
    }
    let a = node_of(turn);
    let b = node_of(turn + 1u);
    let c = node_of(turn + 2u);
    let ab = middle[turn];
    if number == 1u {
        look_again(a, ab, c);
        look_again(ab, b, c);
        return true;
    }
    let bc = middle[(turn + 1u) % 3u];
    look_again(ab, b, bc);
    look_again(a, ab, c);
    look_again(ab, bc, c);
    return true;
}

// Each root of a corner is looked at: 24 a triangle.
fn settle() {
    let place = atomicAdd(&settled.total, 1u);
    settled.triangles[place] = it;
    if place % GROUP == 0u {
        atomicAdd(&settled.groups_x, 1u);
        settled.groups_y = 24u;
        settled.groups_z = 1u;
    }
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.y > 0u || !take(id.x) {
        return;
    }
    let bits = torn[id.x];
    torn[id.x] = 0u;
    if bits != 0u && link.generation < link.most {
        // The longest as well: else what is left grows ever thinner.
        let marked = bits | (1u << longest_edge());
        if halve(array((marked & 1u) != 0u, (marked & 2u) != 0u, (marked & 4u) != 0u)) {
            return;
        }
    }
    if roots_of(0u) + roots_of(1u) + roots_of(2u) > 0u {
        settle();
    }
}
