enable primitive_index;
// A picture of one object, without light: what light needs is stored with each texel, in the
// object's own space, so that neither moving the object nor its light spoils the picture.
#import bindings::portrait::{Portrait, portrait_axes, portrait_clip}
#import bindings::scene::{albedo, materials, objects, vertices}
#import bindings::surface::Surface

@group(0) @binding(0) var<uniform> portrait: Portrait;

@vertex
fn vertex(
    @builtin(vertex_index) index: u32,
    @builtin(instance_index) object: u32,
) -> Surface {
    // Never through the world: a picture is the same to the last bit wherever its object stands.
    let own = vertices[index];
    var out: Surface;
    out.position = own.position;
    out.normal = own.normal;
    out.uv = vec2(own.u, own.v);
    out.object = object;
    out.clip = portrait_clip(portrait, portrait_axes(portrait, own.position));
    return out;
}

struct Texel {
    @location(0) colour: vec4<f32>,
    @location(1) point: vec4<f32>,
    @location(2) normal: vec4<f32>,
    @location(3) ids: vec4<u32>,
}

@fragment
fn fragment(
    in: Surface,
    @builtin(primitive_index) triangle: u32,
    @builtin(front_facing) front: bool,
) -> Texel {
    let q = portrait_axes(portrait, in.position);
    // Towards the eye, which parallel rays have infinitely far away.
    let eye = portrait.eye_distance * portrait.towards
        - q.x * portrait.right - q.y * portrait.up - q.z * portrait.towards;
    let back = select(eye, portrait.towards, portrait.eye_distance == 0.0);
    let normal = normalize(in.normal);
    let side = select(0.0, 1.0, front);
    var out: Texel;
    out.colour = vec4(albedo(materials[objects[in.object].material], in.uv), 1.0);
    out.point = vec4(in.position, q.z);
    out.normal = vec4(select(normal, -normal, dot(normal, back) < 0.0), side);
    out.ids = vec4(in.object, triangle, 0u, 0u);
    return out;
}
