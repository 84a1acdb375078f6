// Runs the maths of the reflection plane and the walks along lines on arrays, for the test that
// holds them against their Rust twins.
#import common::reflection_plane::{deviation, direction_at, in_face, is_parallel, on_face}
#import common::texel_line::{line_between, next_bresenham, next_touched, touched_texels}

@group(0) @binding(0) var<storage, read> inputs: array<vec4<f32>>;
@group(0) @binding(1) var<storage, read_write> outputs: array<vec4<f32>>;

// B in xyz of the first input, t in its w; W in the second. Eight outputs: the direction and the
// deviation of W from B; whether they are parallel; the part of the arc on each face.
@compute @workgroup_size(64)
fn plane(@builtin(global_invocation_id) id: vec3<u32>) {
    let b = inputs[2u * id.x].xyz;
    let w = inputs[2u * id.x + 1u].xyz;
    let direction = direction_at(b, w, inputs[2u * id.x].w);
    outputs[8u * id.x] = vec4(direction, deviation(b, w));
    outputs[8u * id.x + 1u] = vec4(select(0.0, 1.0, is_parallel(b, w)), 0.0, 0.0, 0.0);
    for (var face = 0u; face < 6u; face += 1u) {
        let part = on_face(in_face(face, b), in_face(face, w));
        let ends = vec4(part.start, part.end);
        outputs[8u * id.x + 2u + face] = select(vec4(-1.0), ends, part.exists);
    }
}

const SIZE: u32 = 40u;
// A line's texels, and what follows its last.
const ROOM: u32 = 80u;

// Start and end of a line; its texels, touched ones first, then Bresenham's; then how many.
@compute @workgroup_size(64)
fn lines(@builtin(global_invocation_id) id: vec3<u32>) {
    let ends = inputs[id.x];
    let first = 2u * ROOM * id.x;
    var line = line_between(ends.xy, ends.zw, SIZE);
    let count = touched_texels(line);
    for (var i = 0u; i < ROOM; i += 1u) {
        outputs[first + i] = vec4(vec2<f32>(line.cell), 1.0, f32(count));
        if !next_touched(&line) {
            break;
        }
    }
    line = line_between(ends.xy, ends.zw, SIZE);
    for (var i = 0u; i < ROOM; i += 1u) {
        outputs[first + ROOM + i] = vec4(vec2<f32>(line.cell), 1.0, f32(count));
        if !next_bresenham(&line) {
            break;
        }
    }
}
