// Vertices where one reflector shows them to the eye (MORPH_VERTEX of Martin & Popescu 2004, section 6).
#import bindings::record::count
#import bindings::scene::{objects, vertices, world_position}
#import common::camera::{Camera, arriving}
#import virtual_objects::corner::{Corner, LOST, SHOWN, packed_found}

struct Morph {
    // Of the sampling locations, in the order of `points`.
    weights: array<vec4<f32>, 2>,
    total: u32,
    reflector: u32,
    pad_a: u32,
    pad_b: u32,
}
@group(0) @binding(0) var<storage, read> morph: Morph;
@group(0) @binding(1) var<storage, read> owners: array<u32>;
// For each of the eight locations the point of the reflector where it sees each vertex; w: 1 where it does.
@group(0) @binding(2) var<storage, read> points: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read_write> corners: array<Corner>;
@group(0) @binding(4) var<uniform> camera: Camera;

const VALID: u32 = 2u;

// "Compute the reflected point by trilinearly interpolating these eight points"; w is 1 where all eight are.
fn interpolated(vertex: u32) -> vec4<f32> {
    var sum = vec3(0.0);
    for (var slot = 0u; slot < 8u; slot += 1u) {
        let seen = points[slot * morph.total + vertex];
        if seen.w == 0.0 {
            return vec4(0.0);
        }
        sum += morph.weights[slot / 4u][slot % 4u] * seen.xyz;
    }
    return vec4(sum, 1.0);
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
    if owner != morph.reflector {
        let point = interpolated(vertex);
        if point.w == 1.0 {
            // "Push this point along the ray from the desired view to itself", by "the distance between itself
            // and the actual scene vertex" (figure 7).
            let away = distance(position, point.xyz);
            corner.image = point.xyz + away * arriving(camera, point.xyz);
            corner.found = packed_found(vec2(0.0), SHOWN);
            count(VALID, 1u);
        }
    }
    corners[vertex] = corner;
}
