// Every layer of a layered capture before anything is drawn: nothing there, and behind it the
// environment.
#import bindings::scene::environment
#import common::cover::cover
#import common::cube::cube_direction
#import common::record::NO_OBJECT

// The layer drawn into: 6 * surface layer + face.
var<immediate> layer: u32;

struct Varying {
    @builtin(position) position: vec4<f32>,
    @location(0) uv: vec2<f32>,
    @location(1) @interpolate(flat) face: u32,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Varying {
    let corner = cover(index);
    return Varying(vec4(corner, 0.0, 1.0), 0.5 * (corner + 1.0), layer % 6u);
}

struct Texel {
    @location(0) surface: vec4<u32>,
    @location(1) radiance: vec4<f32>,
#ifdef RECORD_FULL
    @location(2) ids: vec4<u32>,
#endif
}

@fragment
fn fragment(in: Varying) -> Texel {
    var out: Texel;
    out.radiance = vec4(environment(normalize(cube_direction(in.face, in.uv))), 1.0);
#ifdef RECORD_FULL
    out.ids = vec4(NO_OBJECT, 0u, 0u, 0u);
#endif
    return out;
}
