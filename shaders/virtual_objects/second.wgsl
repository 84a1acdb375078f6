// A reflector seen in another one. Every texel shows the second at P2, met by the ray that the first
// mirrors at P1: to the second reflector each point of the first is an eye (Estalella et al. 2006,
// section 7, leave this open).
#define_import_path virtual_objects::second

#import common::camera::arriving
#import virtual_objects::newton::step_towards
#import virtual_objects::reflector::{
    NOWHERE, camera, evaluations, first_at, first_normal, search, unpacked_texel
}
#import virtual_objects::walk::{cells_across, texel_in}

// Steps that bring any start home, and the longest as a share of the textures.
const MOST_STEPS: u32 = 12u;
const REACH: f32 = 0.25;
// A last step shorter than this, texels, needs no other.
const ARRIVED: f32 = 0.1;
// Sine of the largest angle between a mirrored ray and the direction to what it passes through.
const LAW: f32 = 2e-3;

// Where the last point looked for was, texels, below zero before the first: others are near.
var<private> last_place: vec2<f32> = vec2(-1.0);

// Unit direction in which the first reflector mirrors the eye ray of a texel.
fn mirrored_at(texel: vec2<i32>) -> vec3<f32> {
    return reflect(arriving(camera, first_at(texel).xyz), textureLoad(first_normal, texel, 0).xyz);
}

// The middle of the texel, of those that stand for the top's cells, whose mirrored ray passes `v` at the
// least angle; below zero where none shows the second reflector.
fn likely_place(v: vec3<f32>) -> vec2<f32> {
    let across = cells_across(search.top);
    var best = -2.0;
    var place = vec2(-1.0);
    for (var i = 0; i < across.x * across.y; i += 1) {
        let packed = texel_in(vec2(i % across.x, i / across.x), search.top);
        if packed != NOWHERE {
            let texel = unpacked_texel(packed);
            let cosine = dot(mirrored_at(texel), normalize(v - first_at(texel).xyz));
            if cosine > best {
                best = cosine;
                place = vec2<f32>(texel) + 0.5;
            }
        }
    }
    return place;
}

// Where the first reflector shows a world point, by Gauss-Newton steps on A x (V - P1), A the mirrored
// direction; below zero where it does not, or by its rim alone.
fn texel_of(v: vec3<f32>) -> vec2<f32> {
    var place = last_place;
    if place.x < 0.0 {
        place = likely_place(v);
    }
    var whole = place;
    for (var step = 0u; step < MOST_STEPS && place.x >= 0.0; step += 1u) {
        let corner = vec2<i32>(floor(place - 0.5));
        let p_00 = first_at(corner);
        let p_10 = first_at(corner + vec2(1, 0));
        let p_01 = first_at(corner + vec2(0, 1));
        let p_11 = first_at(corner + vec2(1, 1));
        if p_00.w * p_10.w * p_01.w * p_11.w == 0.0 {
            // Beyond the rim: back half way.
            if step == 0u {
                break;
            }
            place = 0.5 * (place + whole);
            continue;
        }
        whole = place;
        evaluations += 1u;
        let f = place - 0.5 - vec2<f32>(corner);
        let a_00 = mirrored_at(corner);
        let a_10 = mirrored_at(corner + vec2(1, 0));
        let a_01 = mirrored_at(corner + vec2(0, 1));
        let a_11 = mirrored_at(corner + vec2(1, 1));
        let p_x = mix(p_10 - p_00, p_11 - p_01, f.y).xyz;
        let p_y = mix(p_01 - p_00, p_11 - p_10, f.x).xyz;
        let a_x = mix(a_10 - a_00, a_11 - a_01, f.y);
        let a_y = mix(a_01 - a_00, a_11 - a_10, f.x);
        let towards = v - (mix(p_00, p_01, f.y).xyz + f.x * p_x);
        let a = mix(a_00, a_01, f.y) + f.x * a_x;
        let law = cross(a, towards);
        let j_x = cross(a_x, towards) - cross(a, p_x);
        let j_y = cross(a_y, towards) - cross(a, p_y);
        var delta = step_towards(law, j_x, j_y);
        delta *= min(1.0, REACH * f32(search.size.x) / max(length(delta), 1e-9));
        let left = law + j_x * delta.x + j_y * delta.y;
        place += delta;
        if length(delta) < ARRIVED {
            let is_met = dot(left, left) < LAW * LAW * dot(towards, towards);
            if !is_met || dot(a, towards) <= 0.0 {
                break;
            }
            last_place = place;
            return place;
        }
    }
    return vec2(-1.0);
}
