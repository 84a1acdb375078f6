//! The arc tangent, the same on CPU and GPU: Vulkan allows its own 4096 units in the last place.

use std::f32::consts::{FRAC_PI_2, PI};

/// Angle of (x, y) from the x axis, -pi to pi, to 1e-6 radians. Both zero gives 0.
///
/// Abramowitz & Stegun 4.4.49 inside an octant. Twin: `shaders/common/angle.wgsl`.
pub fn angle(y: f32, x: f32) -> f32 {
    let (a, b) = (x.abs(), y.abs());
    let t = a.min(b) / a.max(b).max(f32::MIN_POSITIVE);
    let s = t * t;
    let mut p = -0.004_054_058;
    for c in [
        0.021_861_23,
        -0.055_909_887,
        0.096_420_04,
        -0.139_085_34,
        0.199_465_36,
        -0.333_298_56,
        0.999_999_33,
    ] {
        p = p * s + c;
    }
    let octant = t * p;
    let quadrant = if b > a { FRAC_PI_2 - octant } else { octant };
    let half = if x < 0.0 { PI - quadrant } else { quadrant };
    if y < 0.0 { -half } else { half }
}

#[cfg(test)]
mod tests {
    use super::angle;

    #[test]
    fn agrees_with_the_standard_library() {
        for i in 0..10_000 {
            let phi = (i as f32 / 5_000.0 - 1.0) * 0.999 * std::f32::consts::PI;
            let (y, x) = (2.5 * phi.sin(), 2.5 * phi.cos());
            assert!((angle(y, x) - y.atan2(x)).abs() < 1e-6, "{phi}: {}", angle(y, x));
        }
        assert_eq!(angle(0.0, 0.0), 0.0);
    }
}
