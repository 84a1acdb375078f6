// A skirt about an open reflector: its points and normals carried on beyond its edge, so that a search may leave
// it and still find where a vertex would be reflected (region B of Estalella et al. 2006, section 5.1, without a
// closed partner). The stencil keeps what is reflected there from being drawn.
//
// Depths are carried on as 1 / depth, which is affine over the texture for a plane, quadratically along rows,
// columns and diagonals; of several directions the nearer edge counts more.
#import common::camera::{Camera, RIM, arriving}

struct Skirt {
    // How far it reaches beyond the edge: so many steps of so many texels.
    steps: i32,
    step: i32,
    // Texels between the three samples it is carried on from.
    stride: i32,
    pad: i32,
    size: vec2<i32>,
}
@group(0) @binding(0) var<storage, read> skirt: Skirt;
@group(0) @binding(1) var mirror_position: texture_2d<f32>;
@group(0) @binding(2) var mirror_normal: texture_2d<f32>;
@group(0) @binding(3) var position: texture_storage_2d<rgba32float, write>;
@group(0) @binding(4) var normal: texture_storage_2d<rgba32float, write>;
// That of the textures.
@group(0) @binding(30) var<uniform> camera: Camera;

fn point_at(texel: vec2<i32>) -> vec4<f32> {
    if any(texel < vec2(0)) || any(texel >= skirt.size) {
        return vec4(0.0);
    }
    return textureLoad(mirror_position, texel, 0);
}

// 1 / depth, or depth for parallel rays.
fn shallowness(p: vec3<f32>) -> f32 {
    let depth = dot(p - camera.eye, camera.forward);
    return select(1.0 / depth, depth, camera.orthographic == 1u);
}

// Where the eye ray through the middle of a texel has a shallowness.
fn on_ray(texel: vec2<i32>, shallow: f32) -> vec3<f32> {
    let ndc = 2.0 * (vec2<f32>(texel) + 0.5) / vec2<f32>(skirt.size) - 1.0;
    let across = ndc.x * camera.half_width * camera.right - ndc.y * camera.half_height * camera.up;
    if camera.orthographic == 1u {
        return camera.eye + across + shallow * camera.forward;
    }
    return camera.eye + (camera.forward + across) / shallow;
}

// A quantity at three places, one step apart and the first at 0, carried on to `t` steps before the first.
fn carried(t: f32) -> vec3<f32> {
    return vec3(0.5 * (t + 1.0) * (t + 2.0), -t * (t + 2.0), 0.5 * t * (t + 1.0));
}

struct Carried {
    // Sums of weighted values.
    shallow: f32,
    normal: vec3<f32>,
    weight: f32,
}

// What lies in one direction, where the edge is near enough, and open: at a silhouette the surface ends because
// it turns away, which it goes on to do.
fn carry(sum: Carried, texel: vec2<i32>, way: vec2<i32>) -> Carried {
    var away = 0;
    for (var i = 1; i <= skirt.steps; i += 1) {
        if point_at(texel + i * skirt.step * way).w == 1.0 {
            away = i * skirt.step;
            break;
        }
    }
    // Its first texel is after the last look before.
    var outside = away - skirt.step;
    while away - outside > 1 {
        let middle = (outside + away) / 2;
        if point_at(texel + middle * way).w == 1.0 {
            away = middle;
        } else {
            outside = middle;
        }
    }
    let places = array(
        texel + away * way,
        texel + (away + skirt.stride) * way,
        texel + (away + 2 * skirt.stride) * way,
    );
    var shallow: vec3<f32>;
    var n: array<vec3<f32>, 3>;
    var whole = away > 0;
    for (var i = 0; i < 3; i += 1) {
        let p = point_at(places[i]);
        n[i] = textureLoad(mirror_normal, places[i], 0).xyz;
        shallow[i] = shallowness(p.xyz);
        whole = whole && p.w == 1.0 && -dot(n[i], arriving(camera, p.xyz)) > RIM;
    }
    let parts = carried(f32(away) / f32(skirt.stride));
    let normal = normalize(parts.x * n[0] + parts.y * n[1] + parts.z * n[2]);
    let here = on_ray(texel, dot(parts, shallow));
    if !whole || !(-dot(normal, arriving(camera, here)) > RIM) {
        return sum;
    }
    let length_of_way = length(vec2<f32>(way)) * f32(away);
    let weight = 1.0 / (length_of_way * length_of_way);
    return Carried(
        sum.shallow + weight * dot(parts, shallow),
        sum.normal + weight * normal,
        sum.weight + weight,
    );
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let texel = vec2<i32>(id.xy);
    if any(texel >= skirt.size) {
        return;
    }
    var p = point_at(texel);
    var n = textureLoad(mirror_normal, texel, 0);
    if p.w == 0.0 {
        var sum: Carried;
        for (var i = 0; i < 9; i += 1) {
            let way = vec2(i % 3 - 1, i / 3 - 1);
            if i != 4 {
                sum = carry(sum, texel, way);
            }
        }
        let shallow = sum.shallow / sum.weight;
        if sum.weight > 0.0 && shallow > 0.0 {
            p = vec4(on_ray(texel, shallow), 1.0);
            n = vec4(normalize(sum.normal), 0.0);
        }
    }
    textureStore(position, texel, p);
    textureStore(normal, texel, n);
}
