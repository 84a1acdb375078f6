enable primitive_index;
// The scene mirrored in a plane and drawn through the stencil (Diefenbach & Badler 1997;
// McReynolds & Blythe 1997): what lies behind the mirror's plane is clipped away.
#import bindings::scene::{vertices, objects, materials, world_position, world_direction, shade}
#import common::camera::{Camera, arriving, facing}
#import common::record::{Chain, STATUS_FOUND, packed_ids, packed_radiance, trace_of}

@group(0) @binding(30) var<uniform> camera: Camera;

struct Plane {
    // Unit normal on the eye's side, and its dot product with the plane's points.
    normal: vec3<f32>,
    offset: f32,
    // The reflector.
    object: u32,
    pad_a: u32,
    pad_b: u32,
    pad_c: u32,
}
@group(0) @binding(0) var<uniform> plane: Plane;
@group(0) @binding(31) var reflector_id: texture_2d<u32>;

struct Varying {
    @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
    @location(3) @interpolate(flat) object: u32,
}

fn mirrored(p: vec3<f32>) -> vec3<f32> {
    return p - 2.0 * (dot(p, plane.normal) - plane.offset) * plane.normal;
}

@vertex
fn vertex(
    @builtin(vertex_index) index: u32,
    @builtin(instance_index) object: u32,
) -> Varying {
    let v = vertices[index];
    let o = objects[object];
    let position = world_position(o, v.position);
    let clip = camera.clip_from_world * vec4(mirrored(position), 1.0);
    return Varying(clip, position, world_direction(o, v.normal), vec2(v.u, v.v), object);
}

struct Reflected {
    @location(0) radiance: vec4<f32>,
#ifdef RECORD_FULL
    @location(1) point: vec4<f32>,
    @location(2) last: vec4<f32>,
    @location(3) ids: vec4<u32>,
#endif
}

@fragment
fn fragment(in: Varying, @builtin(primitive_index) triangle: u32) -> Reflected {
    let height = dot(in.position, plane.normal) - plane.offset;
    // Two reflectors may share a stencil value; the id image decides.
    let seen = textureLoad(reflector_id, vec2<u32>(in.clip.xy), 0).x;
    if height <= 0.0 || seen != plane.object {
        discard;
    }
    // The eye ray towards the virtual point meets the mirror where its height falls to zero.
    let virtual_point = mirrored(in.position);
    let incident = arriving(camera, virtual_point);
    let bounce = virtual_point - incident * (height / -dot(incident, plane.normal));
    let normal = facing(in.normal, in.position - bounce);
    var chain: Chain;
    chain.radiance = shade(materials[objects[in.object].material], normal, in.uv);
    chain.point = vec4(in.position, 1.0);
    chain.last = vec4(bounce, distance(bounce, in.position));
    chain.object = in.object;
    chain.triangle = triangle;
    chain.trace = trace_of(objects[plane.object].rank);
    chain.order = 1u;
    chain.status = STATUS_FOUND;
    var out: Reflected;
    out.radiance = packed_radiance(chain);
#ifdef RECORD_FULL
    out.point = chain.point;
    out.last = chain.last;
    out.ids = packed_ids(chain);
#endif
    return out;
}
