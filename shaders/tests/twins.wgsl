// Runs the shared functions on arrays, for the test that holds them against their Rust twins.
#import bindings::departure::depart
#import bindings::scene::{environment, materials, shade}
#import common::camera::{Camera, arriving, eye_direction, facing}
#import common::cube::{cube_direction, cube_texel}
#import common::latlong::{latlong_direction, latlong_place}
#import common::proxy::{from_box, from_sphere}
#import common::sphere_map::{ball_normal, sphere_direction, sphere_place}

@group(0) @binding(0) var<storage, read> inputs: array<vec4<f32>>;
@group(0) @binding(1) var<storage, read_write> outputs: array<vec4<f32>>;
@group(0) @binding(30) var<uniform> camera: Camera;

@compute @workgroup_size(64)
fn cube(@builtin(global_invocation_id) id: vec3<u32>) {
    let texel = cube_texel(inputs[id.x].xyz);
    outputs[2u * id.x] = vec4(vec3(texel.uv, f32(texel.face)), 0.0);
    outputs[2u * id.x + 1u] = vec4(cube_direction(texel.face, texel.uv), 0.0);
}

// The place of a direction in a sphere and in a polar map, and back.
@compute @workgroup_size(64)
fn flat_maps(@builtin(global_invocation_id) id: vec3<u32>) {
    let d = inputs[id.x].xyz;
    let st = sphere_place(d);
    let uv = latlong_place(d);
    outputs[4u * id.x] = vec4(st, uv);
    outputs[4u * id.x + 1u] = vec4(sphere_direction(st), 0.0);
    outputs[4u * id.x + 2u] = vec4(latlong_direction(uv), 0.0);
    outputs[4u * id.x + 3u] = vec4(ball_normal(2.0 * d.xy), 0.0);
}

// Where rays leave the sphere of radius 1.2 and the box from -1 to (0.9, 1.1, 1.3): start in xyz of the
// first input, direction of the second.
@compute @workgroup_size(64)
fn proxies(@builtin(global_invocation_id) id: vec3<u32>) {
    let start = inputs[2u * id.x].xyz;
    let along = inputs[2u * id.x + 1u].xyz;
    outputs[2u * id.x] = vec4(from_sphere(start, along, 1.2), 0.0);
    outputs[2u * id.x + 1u] = vec4(from_box(start, along, vec3(-1.0), vec3(0.9, 1.1, 1.3)), 0.0);
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
