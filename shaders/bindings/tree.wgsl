// Rays through the tree over all triangles of the scene.
// Rust twin: geometry/bvh.rs.
#define_import_path bindings::tree

#import bindings::rays::{FAR, RayHit, Start, ray_work}
#import bindings::tree_data::{Node, corners_at, node_at}

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

// Six times the volume between an edge and the ray; two triangles that share the edge compute the
// same number with opposite signs, so a ray cannot slip through between them.
fn edge_volume(a: vec3<f32>, b: vec3<f32>, direction: vec3<f32>) -> f32 {
    return dot(cross(b - a, b + a), direction);
}

// A triangle against a ray, as the nearest so far would have it.
fn with_triangle(
    nearest: RayHit,
    slot: u32,
    origin: vec3<f32>,
    direction: vec3<f32>,
    start: Start,
) -> RayHit {
    let corners = corners_at(slot);
    let a = corners.first - origin;
    let b = corners.second - origin;
    let c = corners.third - origin;
    let u = edge_volume(b, c, direction);
    let v = edge_volume(c, a, direction);
    let w = edge_volume(a, b, direction);
    if min(u, min(v, w)) < 0.0 && max(u, max(v, w)) > 0.0 {
        return nearest;
    }
    let sum = u + v + w;
    let normal = cross(b - a, c - a);
    let slope = dot(normal, direction);
    if sum == 0.0 || slope == 0.0 {
        return nearest;
    }
    let distance = dot(normal, a) / slope;
    let front = slope < 0.0;
    let own = corners.object == start.object
        && (corners.triangle == start.triangle || front != start.outside);
    if own || !(distance >= 0.0 && distance < nearest.distance) {
        return nearest;
    }
    return RayHit(distance, corners.object, corners.triangle, vec2(v, w) / sum, front);
}

// The nearest triangle a ray meets. The direction has unit length.
fn trace(origin: vec3<f32>, direction: vec3<f32>, start: Start) -> RayHit {
    var nearest = RayHit(FAR, 0u, 0u, vec2(0.0), false);
    let tiny = select(vec3(1.0e-20), vec3(-1.0e-20), direction < vec3(0.0));
    let ray = BoxRay(origin, 1.0 / select(direction, tiny, abs(direction) < vec3(1.0e-20)));
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
