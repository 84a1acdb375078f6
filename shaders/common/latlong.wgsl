// Latitude-longitude maps: the polar look-up of Blinn & Newell 1976. -z in the middle, +y on top.
// Rust twin: geometry/latlong.rs.
#define_import_path common::latlong

#import common::angle::{PI, angle}

// Image coordinates of a unit direction, row 0 on top.
fn latlong_place(d: vec3<f32>) -> vec2<f32> {
    let u = 0.5 + angle(d.x, -d.z) / (2.0 * PI);
    let v = angle(length(d.xz), d.y) / PI;
    return vec2(u, v);
}

// The unit direction of image coordinates.
fn latlong_direction(uv: vec2<f32>) -> vec3<f32> {
    let turn = 2.0 * PI * (uv.x - 0.5);
    let fall = PI * uv.y;
    return vec3(sin(fall) * sin(turn), cos(fall), -sin(fall) * cos(turn));
}
