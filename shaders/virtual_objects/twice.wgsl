// What a pixel shows of a reflector within another one, and the record of a path over both.
#define_import_path virtual_objects::twice

#import bindings::departure::{LOBE_REFLECTED, depart}
#import bindings::scene::{materials, objects}
#import common::record::{Chain, extended_trace, trace_of}

// As shown.wgsl leaves them.
@group(0) @binding(36) var shown_position: texture_2d<f32>;
@group(0) @binding(37) var shown_normal: texture_2d<f32>;
@group(0) @binding(38) var shown_light: texture_2d<f32>;

struct Twice {
    is_shown: bool,
    first: u32,
    second: u32,
    // P2.
    position: vec3<f32>,
    // From P1 to P2, metres.
    way: f32,
    // Unit: in which the second reflector mirrors.
    outgoing: vec3<f32>,
    // Light of its own surface, and what light from further on is multiplied by.
    light: vec3<f32>,
    weight: vec3<f32>,
}

// At a pixel that shows the reflector `first` at `bounce`.
fn twice_at(pixel: vec2<u32>, first: u32, bounce: vec3<f32>) -> Twice {
    let position = textureLoad(shown_position, pixel, 0);
    var out: Twice;
    out.is_shown = position.w > 0.0;
    if !out.is_shown {
        return out;
    }
    out.first = first;
    out.second = u32(position.w) - 1u;
    out.position = position.xyz;
    out.way = distance(bounce, position.xyz);
    let normal = textureLoad(shown_normal, pixel, 0).xyz;
    let material = materials[objects[out.second].material];
    let incident = (position.xyz - bounce) / out.way;
    let on = depart(material, LOBE_REFLECTED, incident, normal, true);
    out.outgoing = on.direction;
    out.weight = on.weight;
    out.light = textureLoad(shown_light, pixel, 0).xyz;
    return out;
}

// The chain over both reflectors of one that leaves the second.
fn second_of(once: Chain, twice: Twice) -> Chain {
    var out = once;
    out.radiance = twice.light + twice.weight * once.radiance;
    out.last.w += twice.way;
    out.order = 2u;
    out.trace = extended_trace(trace_of(objects[twice.first].rank), 1u, objects[twice.second].rank);
    return out;
}
