// Follows rays over a view's depth, to test which pixel they meet.
#import screen_space::trace::{ScreenRay, seen_along}

// Two a ray: start and change; in the first's w 1 where depths are inverted.
@group(0) @binding(10) var<storage, read> inputs: array<vec4<f32>>;
// One a ray: the pixel, 1 where one was found, the cells visited.
@group(0) @binding(11) var<storage, read_write> outputs: array<vec4<f32>>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let start = inputs[2u * id.x];
    let ray = ScreenRay(start.xyz, inputs[2u * id.x + 1u].xyz, start.w == 1.0);
    let seen = seen_along(ray, 0u);
    outputs[id.x] = vec4(vec2<f32>(seen.pixel), select(0.0, 1.0, seen.found), f32(seen.visits));
}
