// Runs the shared functions on arrays, for the test that holds them against their Rust twins.
#import bindings::departure::depart
#import bindings::scene::{environment, materials, shade}
#import common::camera::{Camera, arriving, eye_direction, facing}
#import common::cube::{cube_direction, cube_texel}

@group(0) @binding(0) var<storage, read> inputs: array<vec4<f32>>;
@group(0) @binding(1) var<storage, read_write> outputs: array<vec4<f32>>;
@group(0) @binding(30) var<uniform> camera: Camera;

@compute @workgroup_size(64)
fn cube(@builtin(global_invocation_id) id: vec3<u32>) {
    let texel = cube_texel(inputs[id.x].xyz);
    outputs[2u * id.x] = vec4(vec3(texel.uv, f32(texel.face)), 0.0);
    outputs[2u * id.x + 1u] = vec4(cube_direction(texel.face, texel.uv), 0.0);
}

@compute @workgroup_size(64)
fn sky(@builtin(global_invocation_id) id: vec3<u32>) {
    outputs[id.x] = vec4(environment(inputs[id.x].xyz), 0.0);
}

// Normal in xyz of the first input, material in its w; texture coordinates in the second.
@compute @workgroup_size(64)
fn surface(@builtin(global_invocation_id) id: vec3<u32>) {
    let a = inputs[2u * id.x];
    let b = inputs[2u * id.x + 1u];
    outputs[id.x] = vec4(shade(materials[u32(a.w)], a.xyz, b.xy), 0.0);
}

@compute @workgroup_size(64)
fn eye(@builtin(global_invocation_id) id: vec3<u32>) {
    let i = inputs[id.x];
    outputs[2u * id.x] = vec4(eye_direction(camera, i.xy), 0.0);
    outputs[2u * id.x + 1u] = vec4(facing(i.yzw, arriving(camera, i.xyz)), 0.0);
}

// Incident direction in xyz of the first input, material in its w; normal in the second, 1 in its w
// where the outside is met. Both lobes: direction and whether there is one, weight and share.
@compute @workgroup_size(64)
fn departures(@builtin(global_invocation_id) id: vec3<u32>) {
    let a = inputs[2u * id.x];
    let b = inputs[2u * id.x + 1u];
    for (var lobe = 0u; lobe < 2u; lobe += 1u) {
        let way = depart(materials[u32(a.w)], lobe, a.xyz, b.xyz, b.w == 1.0);
        outputs[4u * id.x + 2u * lobe] = vec4(way.direction, select(0.0, 1.0, way.exists));
        outputs[4u * id.x + 2u * lobe + 1u] = vec4(way.weight, way.share);
    }
}
