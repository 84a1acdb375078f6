// Which edges are to be halved: those along which a branch ends, where that would be seen. One invocation an edge.
#import bindings::record::count
#import virtual_objects::generation::take
#import virtual_objects::linked::{NOT_JOINED, last_root, next_root, node_of, nodes, position_of, roots_of}
#import virtual_objects::newton::{law_at, patch_at, step_of}
#import virtual_objects::node::MOST_ROOTS
#import virtual_objects::reflector::camera
#import virtual_objects::reject::{place_for, visits}

// Bit by edge, of each triangle.
@group(0) @binding(17) var<storage, read_write> torn: array<atomic<u32>>;

// An edge along which a root would go less far than this, texels, is cut, not halved.
const FAR: f32 = 3.0;
// And one longer than this share of its distance from there is halved.
const LONG: f32 = 0.05;

// Whether what is seen near a place moves far from one end of an edge to the other, or the edge is too long to
// tell from there.
fn goes_far(place: vec2<f32>, edge: u32) -> bool {
    let there = patch_at(place);
    if !there.whole {
        return true;
    }
    let tail = position_of(edge);
    let head = position_of(edge + 1u);
    let long = distance(tail, head);
    let away = distance(0.5 * (tail + head), there.p);
    // As long as what a texel would show there in a flat mirror: what is shorter is cut, however far the law's
    // slopes throw it, as near a focus they do so without end.
    let texel = 0.5 * (length(there.p_x) + length(there.p_y)) * (1.0 + away / distance(camera.eye, there.p));
    if long < texel {
        return false;
    }
    return long > LONG * away || distance(step_of(law_at(there, tail)), step_of(law_at(there, head))) > FAR;
}

// Not all of an edge's roots are joined, and one that is not would go far; or its ends have none, but there may
// be some between them.
fn is_torn(edge: u32) -> bool {
    if roots_of(edge) + roots_of(edge + 1u) == 0u {
        let tail = position_of(edge);
        let head = position_of(edge + 1u);
        let cell = place_for(0.5 * (tail + head), 0.5 * distance(tail, head));
        return cell.x >= 0.0 && goes_far(cell, edge);
    }
    for (var k = 0u; k < 2u * MOST_ROOTS; k += 1u) {
        let root = k % MOST_ROOTS;
        let is_tail = k < MOST_ROOTS;
        let corner = select(edge + 1u, edge, is_tail);
        if root < roots_of(corner) {
            var joined = next_root(edge, root);
            if !is_tail {
                joined = last_root(corner, root);
            }
            if joined == NOT_JOINED && goes_far(nodes[node_of(corner)].roots[root].xy, edge) {
                return true;
            }
        }
    }
    return false;
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.y >= 3u || !take(id.x) {
        return;
    }
    if is_torn(id.y) {
        atomicOr(&torn[id.x], 1u << id.y);
    }
    count(7u, visits);
}
