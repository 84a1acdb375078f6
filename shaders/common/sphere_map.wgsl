// Sphere maps: the picture of a mirrored ball under parallel rays along -z (lecture 18, "How to index
// into a sphere map?"). Rust twin: geometry/sphere_map.rs.
#define_import_path common::sphere_map

// Where on the unit disc a unit direction is shown, t up. The whole rim shows (0, 0, -1), for which
// the formula is 0 / 0: it gets the rim's point (1, 0).
fn sphere_place(r: vec3<f32>) -> vec2<f32> {
    let m = sqrt(r.x * r.x + r.y * r.y + (r.z + 1.0) * (r.z + 1.0));
    if m == 0.0 {
        return vec2(1.0, 0.0);
    }
    return r.xy / m;
}

// The ball's unit normal at a place of the disc; beyond the rim that of the nearest point of it.
fn ball_normal(st: vec2<f32>) -> vec3<f32> {
    let squared = dot(st, st);
    if squared >= 1.0 {
        return vec3(st / sqrt(squared), 0.0);
    }
    return vec3(st, sqrt(1.0 - squared));
}

// The unit direction shown at a place of the disc: r = 2 (n.v) n - v with v = (0, 0, 1).
fn sphere_direction(st: vec2<f32>) -> vec3<f32> {
    let n = ball_normal(st);
    return 2.0 * n.z * n - vec3(0.0, 0.0, 1.0);
}

// Between places on the disc and coordinates of the picture around it, row 0 on top.
fn disc_uv(st: vec2<f32>) -> vec2<f32> {
    return 0.5 + vec2(0.5, -0.5) * st;
}

fn disc_place(uv: vec2<f32>) -> vec2<f32> {
    return vec2(2.0, -2.0) * (uv - 0.5);
}
