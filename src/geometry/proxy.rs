//! Proxies: simple shapes that stand for the scene around an environment map. Looked up is the
//! direction from the map's centre to where the mirrored ray leaves the shape, so a scene that *is* the
//! shape is shown without parallax error.

use glam::Vec3;

/// The unit direction, from the centre of a sphere, of where a ray leaves it: the finite sphere of
/// Patow 1995, section 1. `start` is relative to the centre; `along` is a unit vector, and what a ray
/// that misses gets. Twin: `shaders/common/proxy.wgsl`.
pub fn from_sphere(start: Vec3, along: Vec3, radius: f32) -> Vec3 {
    let ahead = start.dot(along);
    let across = radius * radius - (start.length_squared() - ahead * ahead);
    if across < 0.0 {
        return along;
    }
    let t = across.sqrt() - ahead;
    if t < 0.0 { along } else { unit_or(start + t * along, along) }
}

/// The same for a box: parallax-corrected cube maps. `low` and `high` are its corners relative to the
/// centre, which may lie anywhere.
pub fn from_box(start: Vec3, along: Vec3, low: Vec3, high: Vec3) -> Vec3 {
    let inverse = along.to_array().map(|d| {
        // As good as parallel: a slab is then met nearly infinitely far away.
        let tiny = if d < 0.0 { -1e-20 } else { 1e-20 };
        1.0 / if d.abs() < 1e-20 { tiny } else { d }
    });
    let inverse = Vec3::from_array(inverse);
    let (a, b) = ((low - start) * inverse, (high - start) * inverse);
    let enter = a.min(b).max_element();
    let leave = a.max(b).min_element();
    if leave < enter.max(0.0) { along } else { unit_or(start + leave * along, along) }
}

/// A vector at unit length; `other` where it has none.
fn unit_or(v: Vec3, other: Vec3) -> Vec3 {
    let squared = v.length_squared();
    if squared < 1e-30 { other } else { v / squared.sqrt() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_leave_the_sphere_on_it() {
        let start = Vec3::new(0.5, -0.3, 0.2);
        let along = Vec3::new(-0.4, 0.8, 0.3).normalize();
        let exit = 2.0 * from_sphere(start, along, 2.0);
        assert!((exit - start).normalize().abs_diff_eq(along, 1e-6));
        // From outside, the far side; a miss and a sphere behind leave the direction as it is.
        let far = from_sphere(Vec3::new(-5.0, 0.0, 0.0), Vec3::X, 1.0);
        assert!(far.abs_diff_eq(Vec3::X, 1e-6));
        assert_eq!(from_sphere(Vec3::new(-5.0, 2.0, 0.0), Vec3::X, 1.0), Vec3::X);
        assert_eq!(from_sphere(Vec3::new(5.0, 0.5, 0.0), Vec3::X, 1.0), Vec3::X);
        assert_eq!(from_sphere(Vec3::ZERO, Vec3::Y, 3.0), Vec3::Y);
    }

    #[test]
    fn rays_leave_the_box_on_it() {
        let (low, high) = (Vec3::new(-2.0, -1.0, -3.0), Vec3::new(4.0, 1.5, 2.0));
        let start = Vec3::new(0.5, -0.3, 0.2);
        let exit = from_box(start, Vec3::X, low, high);
        assert!(exit.abs_diff_eq(Vec3::new(4.0, -0.3, 0.2).normalize(), 1e-6), "{exit}");
        let exit = from_box(start, Vec3::NEG_Y, low, high);
        assert!(exit.abs_diff_eq(Vec3::new(0.5, -1.0, 0.2).normalize(), 1e-6), "{exit}");
        // On a face, inwards; past the box; with nothing between exit and centre.
        let inwards = from_box(Vec3::new(4.0, 0.0, 0.0), Vec3::NEG_X, low, high);
        assert!(inwards.abs_diff_eq(Vec3::NEG_X, 1e-6), "{inwards}");
        assert_eq!(from_box(Vec3::new(9.0, 0.0, 0.0), Vec3::X, low, high), Vec3::X);
        let centred = from_box(Vec3::X, Vec3::NEG_X, Vec3::ZERO, Vec3::splat(2.0));
        assert_eq!(centred, Vec3::NEG_X);
    }
}
