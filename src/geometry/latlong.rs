//! Latitude-longitude maps: the polar look-up of Blinn & Newell 1976. -z in the middle, +y on top.

use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3, Vec3Swizzles};

use super::angle::angle;

/// Image coordinates of a unit direction, (0, 0) the upper left corner. At the poles the column,
/// which any would be, is the middle one. Twin: `shaders/common/latlong.wgsl`.
pub fn place(direction: Vec3) -> Vec2 {
    let u = 0.5 + angle(direction.x, -direction.z) / TAU;
    let v = angle(direction.xz().length(), direction.y) / PI;
    Vec2::new(u, v)
}

/// The unit direction of image coordinates.
pub fn direction(uv: Vec2) -> Vec3 {
    let (turn, fall) = (TAU * (uv.x - 0.5), PI * uv.y);
    Vec3::new(fall.sin() * turn.sin(), fall.cos(), -fall.sin() * turn.cos())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_place_comes_back() {
        for i in 0..64 {
            for j in 0..32 {
                let uv = (Vec2::new(i as f32, j as f32) + 0.5) / Vec2::new(64.0, 32.0);
                let back = place(direction(uv));
                assert!(back.abs_diff_eq(uv, 1e-5), "{uv} became {back}");
            }
        }
    }

    #[test]
    fn poles_and_seam_have_a_place() {
        assert!(place(Vec3::Y).abs_diff_eq(Vec2::new(0.5, 0.0), 1e-6));
        assert!(place(Vec3::NEG_Y).abs_diff_eq(Vec2::new(0.5, 1.0), 1e-6));
        assert!(place(Vec3::NEG_Z).abs_diff_eq(Vec2::splat(0.5), 1e-6));
        assert!((place(Vec3::Z).x - 0.5).abs() > 0.4999);
    }
}
