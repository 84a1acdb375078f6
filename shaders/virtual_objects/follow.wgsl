// Along every edge each root of one end is followed to the other. One invocation an edge and direction.
#import bindings::record::count
#import virtual_objects::branch::{goes_on, root_near}
#import virtual_objects::generation::{joined, take}
#import virtual_objects::linked::{NOT_JOINED, node_of, nodes, position_of, roots_of}
#import virtual_objects::node::is_same
#import virtual_objects::reflector::evaluations

// An edge is followed in so many steps.
const STRIDES: u32 = 4u;

// The root of the corner `to` that a root of the corner `start` becomes along their edge.
fn followed(start: u32, root: u32, to: u32) -> u32 {
    var at = nodes[node_of(start)].roots[root];
    for (var stride = 1u; stride <= STRIDES; stride += 1u) {
        let v = mix(position_of(start), position_of(to), f32(stride) / f32(STRIDES));
        let next = root_near(at.xy, v);
        if !goes_on(next, at) {
            return NOT_JOINED;
        }
        at = vec4(next.place, next.fold, 0.0);
    }
    for (var i = 0u; i < roots_of(to); i += 1u) {
        if is_same(nodes[node_of(to)].roots[i], at) {
            return i;
        }
    }
    return NOT_JOINED;
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if !take(id.x) {
        return;
    }
    let edge = id.y / 2u;
    let forth = id.y % 2u == 0u;
    let start = select(edge + 1u, edge, forth);
    let to = select(edge, edge + 1u, forth);
    var word = 0xffffffffu;
    if roots_of(to) > 0u {
        for (var root = 0u; root < roots_of(start); root += 1u) {
            word ^= (15u & ~followed(start, root, to)) << (4u * root);
        }
    }
    joined[6u * id.x + id.y] = word;
    count(2u, evaluations);
}
