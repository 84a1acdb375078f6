//! The one shading function. Its twin on the GPU is `shaders/common/shading.wgsl`: the formulas,
//! and the order of their operations, are the same.

use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3};

use super::{Environment, Image, Material, ObjectId, Pattern, Scene};

/// Light a surface sends out, without what its mirror reflects: albedo times light.
///
/// `normal_ws` has unit length and points to the side the ray arrives from; `uv` are the mesh's
/// texture coordinates there.
pub fn shade(scene: &Scene, object: ObjectId, normal_ws: Vec3, uv: Vec2) -> Vec3 {
    let light = &scene.lighting;
    let cosine = normal_ws.dot(light.towards_sun).max(0.0);
    albedo(scene, scene.material_of(object), uv) * (light.ambient + light.sun * cosine)
}

/// Diffuse albedo of a material at texture coordinates.
pub fn albedo(scene: &Scene, material: &Material, uv: Vec2) -> Vec3 {
    match material.pattern {
        Pattern::Colour(colour) => colour,
        Pattern::Checker { even, odd, size } => {
            let cell = (uv / size).floor();
            let parity = cell.x + cell.y - 2.0 * (0.5 * (cell.x + cell.y)).floor();
            if parity == 0.0 { even } else { odd }
        }
        Pattern::Grid { ground, lines, size, line } => {
            let nearest = (uv / size + 0.5).floor();
            let distance = (uv - nearest * size).abs();
            if distance.min_element() < 0.5 * line { lines } else { ground }
        }
        Pattern::Image { image, size } => {
            let uv = uv / size;
            bilinear(&scene.images[image], Vec2::new(uv.x, 1.0 - uv.y), Edge::Wrap)
        }
    }
}

/// Radiance that arrives from infinitely far away along the unit vector towards it.
pub fn environment(scene: &Scene, direction: Vec3) -> Vec3 {
    match scene.environment {
        Environment::Colour(colour) => colour,
        Environment::Gradient { zenith, horizon, nadir } => {
            let end = if direction.y >= 0.0 { zenith } else { nadir };
            horizon + (end - horizon) * direction.y.abs()
        }
        Environment::LatLong { image } => {
            bilinear(&scene.images[image], lat_long(direction), Edge::Clamp)
        }
    }
}

/// Image coordinates of a unit direction in a latitude-longitude image: -z in the middle, +y on top.
pub fn lat_long(direction: Vec3) -> Vec2 {
    let u = 0.5 + direction.x.atan2(-direction.z) / TAU;
    let v = direction.y.clamp(-1.0, 1.0).acos() / PI;
    Vec2::new(u, v)
}

/// What lies above the top and below the bottom row of an image. Columns always wrap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edge {
    Wrap,
    Clamp,
}

/// Bilinear look-up between texel centres; (0, 0) is the upper left corner of the image.
pub fn bilinear(image: &Image, uv: Vec2, rows: Edge) -> Vec3 {
    let (width, height) = (image.width as i32, image.height as i32);
    let at = uv * Vec2::new(width as f32, height as f32) - 0.5;
    let base = at.floor();
    let f = at - base;
    let (x, y) = (base.x as i32, base.y as i32);
    let texel = |x: i32, y: i32| {
        let column = x.rem_euclid(width);
        let row = match rows {
            Edge::Wrap => y.rem_euclid(height),
            Edge::Clamp => y.clamp(0, height - 1),
        };
        image.texels[(row * width + column) as usize]
    };
    let upper = texel(x, y) * (1.0 - f.x) + texel(x + 1, y) * f.x;
    let lower = texel(x, y + 1) * (1.0 - f.x) + texel(x + 1, y + 1) * f.x;
    upper * (1.0 - f.y) + lower * f.y
}
