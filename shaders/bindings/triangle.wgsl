// A ray against a triangle of the scene's tree, whichever tree led to it.
// Rust twin: geometry/bvh.rs.
#define_import_path bindings::triangle

#import bindings::rays::{RayHit, Start}
#import bindings::tree_data::corners_at

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
