// Work of a known amount, for the referee of timings (tools/referees/self_comparison.rs).

struct Params {
    iterations: u32,
}
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> sink: array<f32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    var x = f32(id.x);
    for (var i = 0u; i < params.iterations; i++) {
        x = fract(1.7 * x + 0.3);
    }
    sink[id.x] = x;
}
