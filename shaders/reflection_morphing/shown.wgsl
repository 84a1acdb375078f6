// The reflectors that a trace shows: morphed as everything is, and what they mirror on is looked for next. What
// stands before them covers them.
#import bindings::departure::{LOBE_REFLECTED, depart, is_heaviest}
#import bindings::scene::{materials, objects, shade}
#import common::camera::facing
#import reflection_morphing::morphed::{Morphed, is_drawn, morphed_vertex, order}
#ifdef FURTHER
#import reflection_morphing::chain::along_at
#endif

@group(0) @binding(32) var reflector_position: texture_2d<f32>;

@vertex
fn vertex(
    @builtin(vertex_index) index: u32,
    @builtin(instance_index) object: u32,
) -> Morphed {
    return morphed_vertex(index, object);
}

// As chain.wgsl reads them.
struct Along {
    @location(0) position: vec4<f32>,
    @location(1) outgoing: vec4<f32>,
    @location(2) light: vec4<f32>,
    @location(3) weight: vec4<f32>,
}

@fragment
fn fragment(in: Morphed) -> Along {
    let pixel = vec2<u32>(in.clip.xy);
    if !is_drawn(in) {
        discard;
    }
#ifdef FURTHER
    let before = along_at(pixel);
    if before.reflector != order.last + 1u {
        discard;
    }
    let from_here = before.position;
    let way = before.way;
    let light = before.light;
    let weight = before.weight;
#else
    let from_here = textureLoad(reflector_position, pixel, 0).xyz;
    let way = 0.0;
    let light = vec3(0.0);
    let weight = vec3(1.0);
#endif
    let material = materials[objects[in.object].material];
    let incident = normalize(in.position - from_here);
    let normal = facing(in.normal, incident);
    let on = depart(material, LOBE_REFLECTED, incident, normal, true);
    if !on.exists || material.index > 0.0 || !is_heaviest(LOBE_REFLECTED, on.share) {
        return Along(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
    }
    let own = weight * shade(material, normal, in.uv);
    return Along(
        vec4(in.position, 1.0 + f32(in.object)),
        vec4(on.direction, way + distance(from_here, in.position)),
        vec4(light + own, 0.0),
        vec4(weight * on.weight, 0.0),
    );
}
