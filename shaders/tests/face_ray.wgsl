// Cuts rays into their pieces over the faces of a cube, for the test that holds them against their Rust twin.
#import common::face_ray::{face_walk, next_segment}

// Start in the first, direction in the second.
@group(0) @binding(0) var<storage, read> rays: array<vec4<f32>>;
// For each ray and piece: where it begins and, in the fourth, the face; where it ends and, in the fourth, 1.
@group(0) @binding(1) var<storage, read_write> pieces: array<vec4<f32>>;

const SIZE: f32 = 64.0;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    var walk = face_walk(rays[2u * id.x].xyz, rays[2u * id.x + 1u].xyz);
    for (var i = 0u; i < 6u; i++) {
        let place = 2u * (6u * id.x + i);
        pieces[place + 1u] = vec4(0.0);
        if !walk.ended {
            let segment = next_segment(&walk, SIZE);
            pieces[place] = vec4(segment.begin, f32(segment.face));
            pieces[place + 1u] = vec4(segment.end, 1.0);
        }
    }
}
