// Rays through the scene, whoever follows them: where they start, what they meet, what lies there.
// Rust twin: truth/surfaces.rs.
#define_import_path bindings::rays

#import bindings::scene::{indices, objects, vertices, world_direction, world_position}
#import common::camera::facing

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
struct RayHit {
    // `FAR` where it meets none.
    distance: f32,
    object: u32,
    triangle: u32,
    // Weights of the second and third corner.
    weights: vec2<f32>,
    front: bool,
}

// One over a direction, finite also along an axis.
fn inverse_of(direction: vec3<f32>) -> vec3<f32> {
    let tiny = select(vec3(1.0e-20), vec3(-1.0e-20), direction < vec3(0.0));
    return 1.0 / select(direction, tiny, abs(direction) < vec3(1.0e-20));
}

// What following rays took.
struct RayWork {
    rays: u32,
    // Of the tree; those a device visits by itself nobody counts.
    nodes: u32,
    triangles: u32,
}

var<private> ray_work: RayWork;

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
fn surface_point(hit: RayHit, incident: vec3<f32>) -> SurfacePoint {
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
