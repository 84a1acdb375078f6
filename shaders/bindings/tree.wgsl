// Rays through the tree over all triangles of the scene.
// Rust twin: geometry/bvh.rs.
#define_import_path bindings::tree

#import bindings::rays::{FAR, RayHit, Start, inverse_of, ray_work}
#import bindings::tree_data::{Node, node_at}
#import bindings::triangle::with_triangle

// Nodes on the way down from the root, at most; the host checks.
const DEEPEST: u32 = 64u;
// Nodes still to be visited, and how far away they begin.
var<private> open_nodes: array<u32, DEEPEST>;
var<private> open_at: array<f32, DEEPEST>;

struct BoxRay {
    origin: vec3<f32>,
    inverse: vec3<f32>,
}

// Distance at which a ray enters a box; `FAR` where it misses it. The far side is drawn out by a few
// roundings, so that no ray slips between boxes that touch (Ize 2013).
fn enters(node: Node, ray: BoxRay, end: f32) -> f32 {
    let a = (node.low - ray.origin) * ray.inverse;
    let b = (node.high - ray.origin) * ray.inverse;
    let low = min(a, b);
    let high = max(a, b) * 1.0000005;
    let near = max(max(low.x, low.y), max(low.z, 0.0));
    let leave = min(min(high.x, high.y), min(high.z, end));
    return select(FAR, near, near <= leave);
}

// The nearest triangle a ray meets. The direction has unit length.
fn trace(origin: vec3<f32>, direction: vec3<f32>, start: Start) -> RayHit {
    var nearest = RayHit(FAR, 0u, 0u, vec2(0.0), false);
    let ray = BoxRay(origin, inverse_of(direction));
    var open = 0u;
    var node = node_at(0u);
    ray_work.rays += 1u;
    ray_work.nodes += 1u;
    var descend = enters(node, ray, FAR) < FAR;
    loop {
        if descend && node.count == 0u {
            ray_work.nodes += 2u;
            let left = node_at(node.first);
            let right = node_at(node.first + 1u);
            let to_left = enters(left, ray, nearest.distance);
            let to_right = enters(right, ray, nearest.distance);
            let left_first = to_left <= to_right;
            if max(to_left, to_right) < FAR {
                open_nodes[open] = select(node.first, node.first + 1u, left_first);
                open_at[open] = max(to_left, to_right);
                open += 1u;
            }
            descend = min(to_left, to_right) < FAR;
            if left_first {
                node = left;
            } else {
                node = right;
            }
            if descend {
                continue;
            }
        } else if descend {
            ray_work.triangles += node.count;
            for (var i = 0u; i < node.count; i += 1u) {
                nearest = with_triangle(nearest, node.first + i, origin, direction, start);
            }
        }
        // Up to what is still open and near enough.
        descend = false;
        while open > 0u && !descend {
            open -= 1u;
            if open_at[open] < nearest.distance {
                node = node_at(open_nodes[open]);
                descend = true;
            }
        }
        if !descend {
            return nearest;
        }
    }
    return nearest;
}
