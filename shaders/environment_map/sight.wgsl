// Which direction of the map stands for a mirrored ray.
#define_import_path environment_map::sight

#import common::proxy::{from_box, from_sphere, unit_or}

struct Params {
    // Centre of the map, world.
    centre: vec3<f32>,
    // Of the proxy sphere, metres.
    radius: f32,
    // Corners of the proxy box, relative to the centre.
    low: vec3<f32>,
    pad_a: u32,
    high: vec3<f32>,
    pad_b: u32,
}
@group(0) @binding(0) var<uniform> params: Params;

// For a ray that leaves the reflector at `position` along the unit vector `outgoing`: that direction
// itself, as if the scene were infinitely far away (Blinn & Newell 1976); that to the reflector's
// own point (Patow 1995, section 1, figure 2); or to where the ray leaves a proxy of the scene.
fn sight(position: vec3<f32>, outgoing: vec3<f32>) -> vec3<f32> {
    let start = position - params.centre;
#ifdef INDEX_SURFACE
    return unit_or(start, outgoing);
#else ifdef PROXY_SPHERE
    return from_sphere(start, outgoing, params.radius);
#else ifdef PROXY_BOX
    return from_box(start, outgoing, params.low, params.high);
#else
    return outgoing;
#endif
}
