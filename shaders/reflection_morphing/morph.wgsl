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

struct Morphed {
    point: vec3<f32>,
    // Metres from there to the vertex along the trace.
    way: f32,
    status: u32,
}

fn morphed(sum: vec4<f32>, weight: f32, status: u32) -> Morphed {
    return Morphed(sum.xyz / weight, sum.w / weight, status);
}

#ifdef WEIGHTS_VALID
// The eye sees what locations of this weight see.
const MOST: f32 = 0.5;

// From the locations that see the vertex.
fn interpolated(vertex: u32) -> Morphed {
    var within = vec4(0.0);
    var beside = vec4(0.0);
    var weights = vec2(0.0);
    for (var slot = 0u; slot < 8u; slot += 1u) {
        let seen = points[slot * morph.total + vertex];
        let weight = morph.weights[slot / 4u][slot % 4u];
        let part = weight * vec4(seen.xyz, abs(seen.w) - 1.0);
        within += select(vec4(0.0), part, seen.w > 0.0);
        beside += select(vec4(0.0), part, seen.w < 0.0);
        weights += select(vec2(0.0), vec2(weight), vec2(seen.w > 0.0, seen.w < 0.0));
    }
    if weights.x >= MOST {
        return morphed(within, weights.x, SHOWN);
    }
    if weights.x + weights.y >= MOST {
        return morphed(within + beside, weights.x + weights.y, HIDDEN);
    }
    return Morphed(vec3(0.0), 0.0, LOST);
}
#else
// "Compute the reflected point by trilinearly interpolating these eight points", where all eight are.
fn interpolated(vertex: u32) -> Morphed {
    var sum = vec4(0.0);
    var status = SHOWN;
    for (var slot = 0u; slot < 8u; slot += 1u) {
        let seen = points[slot * morph.total + vertex];
        if seen.w == 0.0 {
            return Morphed(vec3(0.0), 0.0, LOST);
        }
        if seen.w < 0.0 {
            status = HIDDEN;
        }
        sum += morph.weights[slot / 4u][slot % 4u] * vec4(seen.xyz, abs(seen.w) - 1.0);
    }
    return morphed(sum, 1.0, status);
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
    let vertex = id.x;
    if vertex >= morph.total {
        return;
    }
    let owner = owners[vertex];
    let position = world_position(objects[owner], vertices[vertex].position);
    // Triangles that touch the eye cover no pixel: none but whole ones are drawn.
    var corner = Corner(position, 0u, camera.eye, packed_found(vec2(0.0), LOST));
    if is_shown(owner) {
        let seen = interpolated(vertex);
        if seen.status != LOST {
            // "Push this point along the ray from the desired view to itself", by "the distance between itself
            // and the actual scene vertex" (figure 7); over more reflectors, by the way over all of them.
#ifdef TRACES_MIXED
            let away = seen.way;
#else
            let away = select(seen.way, distance(position, seen.point), morph.order == 1u);
#endif
            corner.image = seen.point + away * arriving(camera, seen.point);
            corner.found = packed_found(vec2(0.0), seen.status);
            count(VALID, select(0u, 1u, seen.status == SHOWN));
        }
    }
    corners[vertex] = corner;
}
