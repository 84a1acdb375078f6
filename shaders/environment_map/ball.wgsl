// The picture of a mirrored ball under parallel rays along -z: "any image of a sphere can be used as
// an environment map" (lecture 18). Each texel's ray is traced from the ball's own surface, so the
// picture has the parallax of a ball of that size. What it meets shows its own shade, as in a capture.
#import bindings::rays::{FAR, Start, surface_point}
#import bindings::scene::{environment, materials, objects, shade}
#ifdef TREE_WIDE
#import bindings::wide_tree::trace
#else
#import bindings::tree::trace
#endif
#import common::record::NO_OBJECT
#import common::sphere_map::{ball_normal, disc_place}
#import environment_map::flat::{map_size, texel_direction, texel_uv, write_texel}

struct Ball {
    // World.
    centre: vec3<f32>,
    // Metres.
    radius: f32,
}
@group(0) @binding(0) var<uniform> ball: Ball;

// Surfaces of the reflectors the ball stands in for that a ray may pass.
const PASSED: u32 = 64u;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= map_size()) {
        return;
    }
    let direction = texel_direction(id.xy);
    var origin = ball.centre + ball.radius * ball_normal(disc_place(texel_uv(id.xy)));
    var start = Start(NO_OBJECT, 0u, true);
    for (var passed = 0u; passed < PASSED; passed += 1u) {
        let hit = trace(origin, direction, start);
        if hit.distance == FAR {
            break;
        }
        if objects[hit.object].selected == 0u {
            let met = surface_point(hit, direction);
            let light = shade(materials[objects[met.object].material], met.normal, met.uv);
            write_texel(id.xy, light, vec4(met.position, 1.0), vec2(met.object, met.triangle));
            return;
        }
        origin += hit.distance * direction;
        start = Start(hit.object, hit.triangle, !hit.front);
    }
    let nothing = vec2(NO_OBJECT, 0u);
    write_texel(id.xy, environment(direction), vec4(direction, 0.0), nothing);
}
