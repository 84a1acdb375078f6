// The camera. Rust twin: stages/view.rs.
#define_import_path common::camera

struct Camera {
    // Reversed depth, y down.
    clip_from_world: mat4x4<f32>,
    eye: vec3<f32>,
    // 1 for parallel rays.
    orthographic: u32,
    forward: vec3<f32>,
    pad: u32,
    right: vec3<f32>,
    // Half the image's width and height at distance 1, or in metres where orthographic.
    half_width: f32,
    up: vec3<f32>,
    half_height: f32,
}

// Unit direction of the eye ray that arrives at a point.
fn arriving(camera: Camera, position: vec3<f32>) -> vec3<f32> {
    if camera.orthographic == 1u {
        return camera.forward;
    }
    return normalize(position - camera.eye);
}

// Unit direction of the eye ray through a position on the image, -1 to 1, y down.
fn eye_direction(camera: Camera, ndc: vec2<f32>) -> vec3<f32> {
    if camera.orthographic == 1u {
        return camera.forward;
    }
    return normalize(camera.forward + ndc.x * camera.half_width * camera.right
        - ndc.y * camera.half_height * camera.up);
}

// Normal on the side of the arriving ray.
fn facing(normal: vec3<f32>, incident: vec3<f32>) -> vec3<f32> {
    let n = normalize(normal);
    return select(n, -n, dot(n, incident) > 0.0);
}

// The largest cosine between eye ray and normal that is the rim of a surface seen from outside.
const RIM: f32 = 0.25;

// The normal on the eye's side. Interpolated ones may turn from the eye just at the rim: turned round they
// would mirror what is behind the reflector, so they are turned back to where the eye ray grazes.
fn seen_normal(in: vec3<f32>, incident: vec3<f32>) -> vec3<f32> {
    let n = normalize(in);
    let away = dot(n, incident);
    if away <= 0.0 {
        return n;
    }
    return select(-n, normalize(n - away * incident), away < RIM);
}
