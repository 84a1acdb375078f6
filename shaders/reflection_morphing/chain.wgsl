// The way light takes from the first reflector's point to the reflector that a pixel shows last so far.
#define_import_path reflection_morphing::chain

#import bindings::scene::objects
#import common::record::{Chain, extended_trace}

// As shown.wgsl leaves them. Where the last reflector is met, and 1 + its object; 0 where none is.
@group(0) @binding(36) var chain_position: texture_2d<f32>;
// Unit direction in which it mirrors, and the metres from the first reflector's point.
@group(0) @binding(37) var chain_outgoing: texture_2d<f32>;
// Light of the surfaces on the way, and what light from further on is multiplied by.
@group(0) @binding(38) var chain_light: texture_2d<f32>;
@group(0) @binding(39) var chain_weight: texture_2d<f32>;

struct Along {
    position: vec3<f32>,
    // 1 + the object; 0 where no reflector is shown.
    reflector: u32,
    outgoing: vec3<f32>,
    way: f32,
    light: vec3<f32>,
    weight: vec3<f32>,
}

fn along_at(pixel: vec2<u32>) -> Along {
    let position = textureLoad(chain_position, pixel, 0);
    let outgoing = textureLoad(chain_outgoing, pixel, 0);
    let light = textureLoad(chain_light, pixel, 0).xyz;
    let weight = textureLoad(chain_weight, pixel, 0).xyz;
    return Along(position.xyz, u32(position.w), outgoing.xyz, outgoing.w, light, weight);
}

// The whole chain of one that leaves the last reflector, over `order` of them by `trace`.
fn whole(once: Chain, along: Along, trace: u32, order: u32) -> Chain {
    var out = once;
    out.radiance = along.light + along.weight * once.radiance;
    out.last.w += along.way;
    out.order = order;
    out.trace = trace;
    return out;
}
