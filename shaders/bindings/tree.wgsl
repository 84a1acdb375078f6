// Rays through the tree over all triangles of the scene.
// Rust twins: geometry/bvh.rs for the triangles, truth/surfaces.rs for the rules.
#define_import_path bindings::tree

#import bindings::scene::{indices, objects, vertices, world_direction, world_position}
#import bindings::tree_data::{Node, corners_at, node_at}
#import common::camera::facing

// Nodes on the way down from the root, at most; the host checks.
const DEEPEST: u32 = 64u;
// Farther than anything.
const FAR: f32 = 3.0e38;

// The surface a ray starts on. It never meets the triangle it starts on, and meets its own object
// only by the faces it can come to: front ones outside, back ones inside.
struct Start {
    object: u32,
    triangle: u32,
    outside: bool,
}

// Where a ray meets a triangle.
struct TreeHit {
    // `FAR` where it meets none.
    distance: f32,
    object: u32,
    triangle: u32,
    // Weights of the second and third corner.
    weights: vec2<f32>,
    front: bool,
}

// What following rays took.
struct TreeWork {
    rays: u32,
    nodes: u32,
    triangles: u32,
}

var<private> tree_work: TreeWork;

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
    nearest: TreeHit,
    slot: u32,
    origin: vec3<f32>,
    direction: vec3<f32>,
    start: Start,
) -> TreeHit {
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
    return TreeHit(distance, corners.object, corners.triangle, vec2(v, w) / sum, front);
}

// The nearest triangle a ray meets. The direction has unit length.
fn trace(origin: vec3<f32>, direction: vec3<f32>, start: Start) -> TreeHit {
    var nearest = TreeHit(FAR, 0u, 0u, vec2(0.0), false);
    let tiny = select(vec3(1.0e-20), vec3(-1.0e-20), direction < vec3(0.0));
    let ray = BoxRay(origin, 1.0 / select(direction, tiny, abs(direction) < vec3(1.0e-20)));
    var open = 0u;
    var node = node_at(0u);
    tree_work.rays += 1u;
    tree_work.nodes += 1u;
    var descend = enters(node, ray, FAR) < FAR;
    loop {
        if descend && node.count == 0u {
            tree_work.nodes += 2u;
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
            tree_work.triangles += node.count;
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

// What lies where a ray meets a triangle.
struct SurfacePoint {
    object: u32,
    triangle: u32,
    position: vec3<f32>,
    // Unit, on the side the ray comes from.
    normal: vec3<f32>,
    uv: vec2<f32>,
    front: bool,
}

// From the interpolated corners, as the rasteriser has it.
fn surface_point(hit: TreeHit, incident: vec3<f32>) -> SurfacePoint {
    let object = objects[hit.object];
    let first = object.first_index + 3u * hit.triangle;
    let a = vertices[indices[first]];
    let b = vertices[indices[first + 1u]];
    let c = vertices[indices[first + 2u]];
    let v = hit.weights.x;
    let w = hit.weights.y;
    let u = 1.0 - v - w;
    let position = u * a.position + v * b.position + w * c.position;
    let normal = world_direction(object, u * a.normal + v * b.normal + w * c.normal);
    var out: SurfacePoint;
    out.object = hit.object;
    out.triangle = hit.triangle;
    out.position = world_position(object, position);
    out.normal = facing(normal, incident);
    out.uv = vec2(u * a.u + v * b.u + w * c.u, u * a.v + v * b.v + w * c.v);
    out.front = hit.front;
    return out;
}
