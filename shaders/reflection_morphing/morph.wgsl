// Vertices where one reflector shows them to the eye (MORPH_VERTEX of Martin & Popescu 2004, section 6).
#import bindings::record::count
#import bindings::scene::{materials, objects, vertices, world_position}
#import common::camera::{Camera, arriving}
#import virtual_objects::corner::{Corner, HIDDEN, LOST, SHOWN, packed_found}

struct Morph {
    // Of the sampling locations, in the order of `points`.
    weights: array<vec4<f32>, 2>,
    total: u32,
    // The last of the trace.
    reflector: u32,
    // Reflectors in the trace.
    order: u32,
    pad: u32,
}
@group(0) @binding(0) var<storage, read> morph: Morph;
@group(0) @binding(1) var<storage, read> owners: array<u32>;
// For each of the eight locations the point of the first reflector where it sees each vertex; w as in
// look_up.wgsl.
@group(0) @binding(2) var<storage, read> points: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read_write> corners: array<Corner>;
@group(0) @binding(4) var<uniform> camera: Camera;

const VALID: u32 = 2u;

// Software drivers take time by the words that an invocation reads for itself. What all invocations share is read
// once, but only outside of branches and loops: here there is none before the last `if`.

struct Morphed {
    point: vec3<f32>,
    // Metres from there to the vertex along the trace.
    way: f32,
    status: u32,
}

// What the eight locations see, a column each, and how; the latter as in look_up.wgsl's w.
struct Eight {
    near: mat4x4<f32>,
    far: mat4x4<f32>,
    how_near: vec4<f32>,
    how_far: vec4<f32>,
}

fn eight_of(vertex: u32) -> Eight {
    let n = morph.total;
    let a = mat4x4(points[vertex], points[n + vertex], points[2u * n + vertex], points[3u * n + vertex]);
    let b = mat4x4(points[4u * n + vertex], points[5u * n + vertex], points[6u * n + vertex], points[7u * n + vertex]);
    return Eight(a, b, vec4(a[0].w, a[1].w, a[2].w, a[3].w), vec4(b[0].w, b[1].w, b[2].w, b[3].w));
}

// The mean by these weights, whose sum is `weight`.
fn mean(eight: Eight, near: vec4<f32>, far: vec4<f32>, weight: f32, status: u32) -> Morphed {
    let point = (eight.near * near + eight.far * far).xyz;
    let way = dot(near, abs(eight.how_near)) + dot(far, abs(eight.how_far));
    return Morphed(point / weight, way / weight - 1.0, status);
}

#ifdef WEIGHTS_VALID
// The eye sees what locations of this weight see.
const MOST: f32 = 0.5;

// From the locations that see the vertex.
fn interpolated(eight: Eight, near: vec4<f32>, far: vec4<f32>) -> Morphed {
    let none = vec4(0.0);
    let any_near = select(near, none, eight.how_near == none);
    let any_far = select(far, none, eight.how_far == none);
    let within_near = select(none, near, eight.how_near > none);
    let within_far = select(none, far, eight.how_far > none);
    let all = dot(any_near + any_far, vec4(1.0));
    let within = dot(within_near + within_far, vec4(1.0));
    let is_shown = within >= MOST;
    let status = select(select(LOST, HIDDEN, all >= MOST), SHOWN, is_shown);
    let by_near = select(any_near, within_near, is_shown);
    let by_far = select(any_far, within_far, is_shown);
    return mean(eight, by_near, by_far, max(select(all, within, is_shown), 1e-6), status);
}
#else
// "Compute the reflected point by trilinearly interpolating these eight points", where all eight are.
fn interpolated(eight: Eight, near: vec4<f32>, far: vec4<f32>) -> Morphed {
    let none = vec4(0.0);
    let is_lost = any(eight.how_near == none) || any(eight.how_far == none);
    let is_hidden = any(eight.how_near < none) || any(eight.how_far < none);
    return mean(eight, near, far, 1.0, select(select(SHOWN, HIDDEN, is_hidden), LOST, is_lost));
}
#endif

// Whether the trace shows an object. In pictures by the nearest ray of any trace reflectors have none of their
// own, as "they should be considered as being part of the camera" (section 1.2).
fn is_shown(owner: u32) -> bool {
#ifdef TRACES_MIXED
    return materials[objects[owner].material].reflectance < 0.0;
#else
    return owner != morph.reflector;
#endif
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let vertex = min(id.x, morph.total - 1u);
    let owner = owners[vertex];
    let position = world_position(objects[owner], vertices[vertex].position);
    let seen = interpolated(eight_of(vertex), morph.weights[0], morph.weights[1]);
    // "Push this point along the ray from the desired view to itself", by "the distance between itself and the
    // actual scene vertex" (figure 7); over more reflectors, by the way over all of them.
#ifdef TRACES_MIXED
    let away = seen.way;
#else
    let away = select(seen.way, distance(position, seen.point), morph.order == 1u);
#endif
    let image = seen.point + away * arriving(camera, seen.point);
    let status = select(LOST, seen.status, is_shown(owner));
    // Triangles that touch the eye cover no pixel: none but whole ones are drawn.
    let drawn_at = select(image, camera.eye, status == LOST);
    if id.x < morph.total {
        corners[vertex] = Corner(position, 0u, drawn_at, packed_found(vec2(0.0), status));
        count(VALID, select(0u, 1u, status == SHOWN));
    }
}
