enable primitive_index;
// The virtual objects of one reflector, drawn through its stencil; each fragment carries the scene
// point it shows (Estalella et al. 2006, section 3).
#import bindings::scene::objects
#import bindings::surface::{Surface, surface_colour, surface_vertex}
#import common::camera::Camera
#import common::record::{found_chain, packed_ids, packed_radiance}

@group(0) @binding(0) var<uniform> reflector: u32;
// V' of each vertex, world; the fourth is 1 where the vertex is hidden.
@group(0) @binding(1) var<storage, read> virtual_vertices: array<vec4<f32>>;
// The scene's triangle each triangle lies in, and where each object's begin.
@group(0) @binding(2) var<storage, read> source_triangles: array<u32>;
@group(0) @binding(3) var<storage, read> first_triangles: array<u32>;
@group(0) @binding(30) var<uniform> camera: Camera;
@group(0) @binding(31) var reflector_id: texture_2d<u32>;
@group(0) @binding(32) var reflector_position: texture_2d<f32>;

struct VirtualSurface {
    @builtin(position) clip: vec4<f32>,
    // Of the source: what is shown.
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
    @location(3) @interpolate(flat) object: u32,
    // 1 where the vertex is hidden.
    @location(4) hidden: f32,
}

@vertex
fn vertex(
    @builtin(vertex_index) index: u32,
    @builtin(instance_index) object: u32,
) -> VirtualSurface {
    let source = surface_vertex(index, object);
    let image = virtual_vertices[index];
    let clip = camera.clip_from_world * vec4(image.xyz, 1.0);
    return VirtualSurface(clip, source.position, source.normal, source.uv, object, image.w);
}

struct Reflected {
    @location(0) radiance: vec4<f32>,
#ifdef RECORD_FULL
    @location(1) point: vec4<f32>,
    @location(2) last: vec4<f32>,
    @location(3) ids: vec4<u32>,
#endif
}

// All three corners are hidden where the share of hidden corners is 1, but for rounding.
const ALL_HIDDEN: f32 = 0.9999;

@fragment
fn fragment(
    in: VirtualSurface,
    @builtin(primitive_index) primitive: u32,
    @builtin(front_facing) front: bool,
) -> Reflected {
    let pixel = vec2<u32>(in.clip.xy);
    // Two reflectors may share a stencil value; the id image decides.
    if textureLoad(reflector_id, pixel, 0).x != reflector {
        discard;
    }
#ifndef TWO_SIDED
    // A mirror turns the winding round, so what looks like a front is a back or was never mirrored.
    if front {
        discard;
    }
#endif
#ifndef DRAW_HIDDEN
    if in.hidden > ALL_HIDDEN {
        discard;
    }
#endif
    let bounce = textureLoad(reflector_position, pixel, 0).xyz;
    let source = Surface(in.clip, in.position, in.normal, in.uv, in.object);
    let colour = surface_colour(source, in.position - bounce);
    let rank = objects[reflector].rank;
    let triangle = source_triangles[first_triangles[in.object] + primitive];
    let chain = found_chain(colour, in.position, bounce, in.object, triangle, rank);
    var out: Reflected;
    out.radiance = packed_radiance(chain);
#ifdef RECORD_FULL
    out.point = chain.point;
    out.last = chain.last;
    out.ids = packed_ids(chain);
#endif
    return out;
}
