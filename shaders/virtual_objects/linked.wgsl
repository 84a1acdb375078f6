// Triangles of nodes, and which root of each corner the roots of the others become along its edges. Rust twin:
// methods/virtual_objects/link.rs.
#define_import_path virtual_objects::linked

#import virtual_objects::node::{MOST_ROOTS, Node, OWN}

struct Link {
    // Of the scene.
    vertices: u32,
    triangles: u32,
    // Nodes that there is room for, the scene's vertices included.
    node_room: u32,
    // Generations of halved triangles made so far, and the most.
    generation: u32,
    most: u32,
    pad: array<u32, 3>,
}
@group(0) @binding(27) var<storage, read> link: Link;
@group(0) @binding(7) var<storage, read_write> nodes: array<Node>;

const NOT_JOINED: u32 = 0xffffffffu;

// Three nodes and the scene's triangle they lie in. Six words of four bits a root: what the roots of the first
// corner become at the second, those of the second at the first, and so round; 15 where they end before.
struct Linked {
    t: vec4<u32>,
    joined: array<u32, 6>,
    pad: array<u32, 2>,
}

// The triangle at hand.
var<private> it: Linked;

fn node_of(corner: u32) -> u32 {
    return it.t[corner % 3u];
}

fn position_of(corner: u32) -> vec3<f32> {
    return nodes[node_of(corner)].position;
}

fn roots_of(corner: u32) -> u32 {
    let number = nodes[node_of(corner)].number;
    return select(number, 0u, number == OWN);
}

// What a root of an edge's tail becomes at its head; or, not `forth`, the other way.
fn joined_to(edge: u32, root: u32, forth: bool) -> u32 {
    let found = (it.joined[2u * (edge % 3u) + select(1u, 0u, forth)] >> (4u * root)) & 15u;
    return select(found, NOT_JOINED, found == 15u);
}

// The root of the next corner in the same branch, both ways round.
fn next_root(corner: u32, root: u32) -> u32 {
    let next = joined_to(corner, root, true);
    if next == NOT_JOINED || joined_to(corner, next, false) != root {
        return NOT_JOINED;
    }
    return next;
}

fn last_root(corner: u32, root: u32) -> u32 {
    let last = joined_to(corner + 2u, root, false);
    if last == NOT_JOINED || joined_to(corner + 2u, last, true) != root {
        return NOT_JOINED;
    }
    return last;
}
