// Screen-space reflection: the mirrored ray is followed through the picture itself.
#import bindings::record::count
#import bindings::scene::{environment, materials, objects}
#import bindings::view::{MirrorPoint, camera}
#import common::record::{Chain, NO_OBJECT, environment_chain, found_chain}
#import screen_space::trace::{screen_ray, seen_along}

@group(0) @binding(3) var direct_colour: texture_2d<f32>;
@group(0) @binding(4) var direct_depth: texture_2d<f32>;
#ifdef RECORD_FULL
@group(0) @binding(5) var direct_triangle: texture_2d<u32>;
#endif

// The surface point a pixel's centre sees, from its depth.
fn point_seen(pixel: vec2<u32>, size: vec2<f32>) -> vec3<f32> {
    let depth = textureLoad(direct_depth, pixel, 0).x;
    let ndc = 2.0 * (vec2<f32>(pixel) + 0.5) / size - 1.0;
    let across = ndc.x * camera.half_width * camera.right - ndc.y * camera.half_height * camera.up;
    let spread = select(depth, 1.0, camera.orthographic == 1u);
    return camera.eye + depth * camera.forward + spread * across;
}

// A mirror or glass: the direct view has not what it shows.
fn is_reflector(object: u32) -> bool {
    let material = materials[objects[object].material];
    return material.reflectance >= 0.0 || material.index > 0.0;
}

// What the screen shows along the mirrored ray; status missing where the ray leaves it, passes behind
// what is on it, or comes to another reflector.
fn answer(at: MirrorPoint) -> Chain {
    let size = vec2<f32>(textureDimensions(direct_depth));
    let seen = seen_along(screen_ray(camera, size, at.position, at.outgoing), at.reflector);
    let rank = objects[at.reflector].rank;
    count(0u, seen.visits);
    if !seen.found || is_reflector(seen.object) {
        var missed: Chain;
#ifdef MISS_ENVIRONMENT
        missed = environment_chain(environment(at.outgoing), at.outgoing, at.position, rank);
        missed.flag = true;
#else
        missed.object = NO_OBJECT;
#endif
        return missed;
    }
    count(1u, 1u);
    let colour = textureLoad(direct_colour, seen.pixel, 0).rgb;
    var triangle = 0u;
#ifdef RECORD_FULL
    triangle = textureLoad(direct_triangle, seen.pixel, 0).x;
#endif
    let point = point_seen(seen.pixel, size);
    return found_chain(colour, point, at.position, seen.object, triangle, rank);
}

#include includes/answered_pixels.wgsl
