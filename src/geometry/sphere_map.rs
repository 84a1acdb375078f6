//! Sphere maps: the picture of a mirrored ball under parallel rays, taken as a map of directions
//! (lecture 18, "How to index into a sphere map?").
//!
//! The eye looks along -z from infinitely far, so v = (0, 0, 1) everywhere. The point of the unit
//! ball with normal n = (s, t, sqrt(1 - s² - t²)) mirrors it into r = 2 (n·v) n - v; solved for the
//! place in the picture,
//!
//! (s, t) = (rx, ry) / sqrt(rx² + ry² + (rz + 1)²).
//!
//! Every direction is on the disc once but (0, 0, -1), straight behind the ball: the whole rim shows it.
//!
//! A step on the disc at the distance sin a from its centre turns the direction by 2 / cos a times the
//! step away from the centre, 2 cos a across. So a texel has the same solid angle everywhere, 4 times its
//! area; what is poor at the rim is its shape.

use glam::{Vec2, Vec3, Vec3Swizzles};

/// Where on the unit disc a unit direction is shown, t up.
///
/// The singular direction (0, 0, -1) gives the rim's point (1, 0): any of the rim would do. Nothing
/// gives NaN. Twin: `shaders/common/sphere_map.wgsl`.
pub fn place(r: Vec3) -> Vec2 {
    let m = (r.x * r.x + r.y * r.y + (r.z + 1.0) * (r.z + 1.0)).sqrt();
    if m == 0.0 { Vec2::X } else { r.xy() / m }
}

/// The unit direction shown at a place of the disc; beyond the rim the rim's, (0, 0, -1).
pub fn direction(st: Vec2) -> Vec3 {
    let normal = normal(st);
    Vec3::new(2.0 * normal.z * normal.x, 2.0 * normal.z * normal.y, 2.0 * normal.z * normal.z - 1.0)
}

/// The unit normal of the ball at a place of the disc; beyond the rim that of the nearest point of it.
pub fn normal(st: Vec2) -> Vec3 {
    let squared = st.length_squared();
    if squared >= 1.0 {
        return (st / squared.sqrt()).extend(0.0);
    }
    st.extend((1.0 - squared).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::optics::reflect;

    fn places() -> impl Iterator<Item = Vec2> {
        (0..64)
            .flat_map(|i| (0..64).map(move |j| Vec2::new(i as f32, j as f32)))
            .map(|p| (p + 0.5) / 32.0 - 1.0)
    }

    #[test]
    fn every_place_of_the_disc_comes_back() {
        for st in places().filter(|p| p.length() < 0.9999) {
            let r = direction(st);
            assert!((r.length() - 1.0).abs() < 1e-6);
            assert!(r.abs_diff_eq(reflect(Vec3::NEG_Z, normal(st)), 1e-6), "{st}: {r}");
            assert!(place(r).abs_diff_eq(st, 2e-4), "{st} became {}", place(r));
        }
    }

    #[test]
    fn the_singular_direction_is_a_point_of_the_rim() {
        for r in [
            Vec3::NEG_Z,
            Vec3::new(0.0, -0.0, -1.0),
            Vec3::new(1e-30, 0.0, -1.0),
            Vec3::new(1e-19, -1e-19, -1.0),
            Vec3::new(0.0, 1e-4, -1.0),
        ] {
            let st = place(r);
            assert!(st.is_finite() && (st.length() - 1.0).abs() < 1e-3, "{r}: {st}");
            assert!(direction(st).abs_diff_eq(Vec3::NEG_Z, 2e-2), "{r}: {}", direction(st));
        }
        assert_eq!(place(Vec3::NEG_Z), Vec2::X);
        assert_eq!(direction(Vec2::new(0.9, -0.9)), Vec3::NEG_Z);
    }

    #[test]
    fn a_texel_covers_the_same_solid_angle_everywhere_but_is_stretched_at_the_rim() {
        let step = 1e-3;
        for st in places().filter(|p| p.length() < 0.97 && p.length() > 0.02) {
            let out = step * st.normalize();
            let turned =
                |by: Vec2| (direction(st + by) - direction(st - by)).length() / (2.0 * step);
            let cosine = (1.0 - st.length_squared()).sqrt();
            let (away, across) = (turned(out), turned(out.perp()));
            assert!((away * cosine / 2.0 - 1.0).abs() < 0.02, "{st}: {away}");
            assert!((across / cosine / 2.0 - 1.0).abs() < 0.02, "{st}: {across}");
            assert!((away * across / 4.0 - 1.0).abs() < 0.02, "{st}");
        }
    }
}
