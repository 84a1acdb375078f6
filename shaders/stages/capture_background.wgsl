// The environment into the six faces of a cube: colour, and each texel's direction.
#import bindings::scene::environment
#import common::cover::cover
#import common::cube::cube_direction
#import common::record::NO_OBJECT

// The layer drawn into.
var<immediate> face: u32;

struct Varying {
    @builtin(position) position: vec4<f32>,
    @location(0) uv: vec2<f32>,
    @location(1) @interpolate(flat) face: u32,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Varying {
    let corner = cover(index);
    return Varying(vec4(corner, 0.0, 1.0), 0.5 * (corner + 1.0), face);
}

struct Texel {
    @location(0) radiance: vec4<f32>,
    // w = 0: a direction.
    @location(1) point: vec4<f32>,
    @location(2) ids: vec4<u32>,
}

@fragment
fn fragment(in: Varying) -> Texel {
    let direction = normalize(cube_direction(in.face, in.uv));
    let radiance = vec4(environment(direction), 1.0);
    return Texel(radiance, vec4(direction, 0.0), vec4(NO_OBJECT, 0u, 0u, 0u));
}
