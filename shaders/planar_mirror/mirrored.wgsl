enable primitive_index;
// The scene mirrored in a plane and drawn through the stencil (Diefenbach & Badler 1997;
// McReynolds & Blythe 1997): what lies behind the mirror's plane is clipped away.
#import bindings::record::{RecordTargets, record_targets}
#import bindings::scene::objects
#import bindings::surface::{Surface, surface_colour, surface_vertex}
#import common::camera::{Camera, arriving}
#import common::record::found_chain

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

fn mirrored(p: vec3<f32>) -> vec3<f32> {
    return p - 2.0 * (dot(p, plane.normal) - plane.offset) * plane.normal;
}

@vertex
fn vertex(
    @builtin(vertex_index) index: u32,
    @builtin(instance_index) object: u32,
) -> Surface {
    var out = surface_vertex(index, object);
    out.clip = camera.clip_from_world * vec4(mirrored(out.position), 1.0);
    return out;
}

@fragment
fn fragment(in: Surface, @builtin(primitive_index) triangle: u32) -> RecordTargets {
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
    let colour = surface_colour(in, in.position - bounce);
    let rank = objects[plane.object].rank;
    return record_targets(found_chain(colour, in.position, bounce, in.object, triangle, rank));
}
