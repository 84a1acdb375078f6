//! The plane of a mirrored ray and a map's centre (Patow 1995, section 2): where in the map the
//! point that the ray meets may be.
//!
//! All vectors are relative to the map's centre: `w` is the reflector point (W), `b` the unit
//! mirrored direction (B). The ray's points S = W + lambda B lie, seen from the centre, on the arc
//! of directions between W (lambda = 0) and B (lambda infinite).
//! Shader twin: `shaders/common/reflection_plane.wgsl`.

use glam::{Vec2, Vec3};

/// Sine of the angle between B and the line of W below which the arc is taken for one direction:
/// 0.06 degrees, a fifth of a texel of his 300 x 300 faces.
pub const PARALLEL_SINE: f32 = 1e-3;

/// Equation (1): the direction at parameter `t`, 0 for B and 1 for W; not normalised.
pub fn direction_at(b: Vec3, w: Vec3, t: f32) -> Vec3 {
    (1.0 - t) * b + t * w
}

/// The theorem of section 2: the parameter of the point `lambda` from the reflector, in the unit
/// that `w` has. It depends on that unit, as the paper's t does.
pub fn parameter_of(lambda: f32) -> f32 {
    1.0 / (lambda + 1.0)
}

/// Whether B . \[W\] = +-1: then B and W span no plane. So it is where W has no direction.
pub fn is_parallel(b: Vec3, w: Vec3) -> bool {
    b.cross(w).length_squared() <= PARALLEL_SINE * PARALLEL_SINE * w.length_squared()
}

/// Expression (2), the angle between B and S' - W, as a number that rises with it: the squared sine
/// up to a right angle, 2 beyond and where S' is W. `towards` is S' - W in any positive scale.
pub fn deviation(b: Vec3, towards: Vec3) -> f32 {
    if b.dot(towards) > 0.0 {
        b.cross(towards).length_squared() / towards.length_squared()
    } else {
        2.0
    }
}

/// A direction in the coordinates of a cube face: to the right, down, along its axis.
pub fn in_face(face: u32, d: Vec3) -> Vec3 {
    match face {
        0 => Vec3::new(-d.z, -d.y, d.x),
        1 => Vec3::new(d.z, -d.y, -d.x),
        2 => Vec3::new(d.x, d.z, d.y),
        3 => Vec3::new(d.x, -d.z, -d.y),
        4 => Vec3::new(d.x, -d.y, d.z),
        _ => Vec3::new(-d.x, -d.y, -d.z),
    }
}

/// The part of the arc from `b` to `w` that lies on a face, both in the face's coordinates: its
/// ends as positions on the face, (0, 0) to (1, 1), B's end first. `None` where it misses the face.
pub fn on_face(b: Vec3, w: Vec3) -> Option<[Vec2; 2]> {
    let (mut enter, mut leave) = (0.0f32, 1.0f32);
    // A direction is on the face while it is no further off the axis than along it, to either side.
    let sides = |d: Vec3| [d.z - d.x, d.z + d.x, d.z - d.y, d.z + d.y];
    for (at_b, at_w) in sides(b).into_iter().zip(sides(w)) {
        if at_b < 0.0 && at_w < 0.0 {
            return None;
        }
        let crossing = at_b / (at_b - at_w);
        if at_b < 0.0 {
            enter = enter.max(crossing);
        } else if at_w < 0.0 {
            leave = leave.min(crossing);
        }
    }
    let position = |t: f32| {
        let d = direction_at(b, w, t);
        (0.5 + 0.5 * d.truncate() / d.z).clamp(Vec2::ZERO, Vec2::ONE)
    };
    (enter < leave).then(|| [position(enter), position(leave)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::cube;
    use proptest::prelude::*;

    fn unit() -> impl Strategy<Value = Vec3> {
        let component = || -1.0f32..1.0;
        (component(), component(), component())
            .prop_map(|(x, y, z)| Vec3::new(x, y, z))
            .prop_filter("too short to have a direction", |v| v.length() > 0.1)
            .prop_map(Vec3::normalize)
    }

    fn log(low: f32, high: f32) -> impl Strategy<Value = f32> {
        (low.log10()..high.log10()).prop_map(|e| 10.0f32.powf(e))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        /// The theorem: S = W + lambda B lies on the arc, at t = 1 / (1 + lambda), and is there
        /// 1 + lambda times as far as equation (1) has it.
        #[test]
        fn every_point_of_the_ray_lies_on_the_arc(
            b in unit(), towards in unit(), far in log(0.01, 100.0), lambda in log(1e-4, 1e4)
        ) {
            let w = far * towards;
            let (s, t) = (w + lambda * b, parameter_of(lambda));
            prop_assert!((0.0..=1.0).contains(&t));
            let p = (lambda + 1.0) * direction_at(b, w, t);
            prop_assert!(p.abs_diff_eq(s, 1e-5 * (far + lambda + 1.0)), "{p} is not {s}");
        }

        /// Its limits: at the reflector the arc begins with [W], infinitely far it ends with B.
        #[test]
        fn the_limits_are_the_reflector_and_the_mirrored_direction(
            b in unit(), towards in unit(), far in log(0.01, 100.0)
        ) {
            let w = far * towards;
            prop_assert_eq!(direction_at(b, w, parameter_of(0.0)), w);
            prop_assert_eq!(direction_at(b, w, parameter_of(f32::INFINITY)), b);
            let near = direction_at(b, w, parameter_of(1e-6 * far)).normalize();
            prop_assert!(near.abs_diff_eq(towards, 1e-5));
            let distant = direction_at(b, w, parameter_of(1e6 * far)).normalize();
            prop_assert!(distant.abs_diff_eq(b, 1e-5));
        }

        /// Expression (2) is zero on the ray and rises with the angle; it is a number always.
        #[test]
        fn the_deviation_orders_by_angle(
            b in unit(), across in unit(), angles in (0.0f32..3.1, 0.0f32..3.1), scale in log(1e-3, 1e3)
        ) {
            let side = across.reject_from(b);
            prop_assume!(side.length() > 0.1);
            let side = side.normalize();
            let at = |angle: f32| deviation(b, scale * (angle.cos() * b + angle.sin() * side));
            prop_assert!(at(0.0) < 1e-10);
            let (small, large) = (angles.0.min(angles.1), angles.0.max(angles.1));
            prop_assert!(at(small) <= at(large) + 1e-6);
            prop_assert!((at(small).min(1.0) - small.min(1.5707964).sin().powi(2)).abs() < 1e-5);
        }

        /// At B . [W] = +-1, next to it, and for a reflector point at the centre.
        #[test]
        fn nothing_is_undefined_where_no_plane_is(
            b in unit(), off in unit(), tilt in prop_oneof![Just(0.0f32), log(1e-8, 1e-2)],
            far in prop_oneof![Just(0.0f32), log(0.01, 100.0)], ahead in any::<bool>(),
        ) {
            let w = far * (if ahead { b } else { -b } + tilt * off);
            if far == 0.0 || tilt < 0.9 * PARALLEL_SINE {
                prop_assert!(is_parallel(b, w));
            }
            prop_assert!(deviation(b, w).is_finite() && deviation(b, Vec3::ZERO) == 2.0);
            for face in 0..6 {
                for end in on_face(in_face(face, b), in_face(face, w)).into_iter().flatten() {
                    prop_assert!(is_parallel(b, w) || end.is_finite(), "{end}");
                }
            }
        }

        /// The parts on the six faces are the whole arc, each direction on the face it falls on.
        #[test]
        fn the_faces_share_the_arc(b in unit(), towards in unit(), far in log(0.1, 10.0)) {
            let w = far * towards;
            prop_assume!(b.cross(towards).length() > 0.05);
            let parts: Vec<_> = (0..6).map(|f| on_face(in_face(f, b), in_face(f, w))).collect();
            for i in 0..=64 {
                let (face, uv) = cube::face_uv(direction_at(b, w, i as f32 / 64.0));
                let inside = (uv - 0.5).abs().max_element() < 0.499;
                let Some([start, end]) = parts[face as usize] else {
                    prop_assert!(!inside, "face {face} is missed");
                    continue;
                };
                let along = (end - start).normalize_or_zero();
                let off = (uv - start).perp_dot(along).abs();
                let between = (uv - start).dot(along) / (end - start).length().max(1e-9);
                prop_assert!(!inside || off < 1e-3, "{uv} is {off} off {start} to {end}");
                prop_assert!(!inside || (-0.01..1.01).contains(&between), "{between}");
            }
        }
    }

    #[test]
    fn face_coordinates_are_those_of_the_cube() {
        for face in 0..6 {
            let d = cube::direction(face, Vec2::new(0.8, 0.3));
            assert!(in_face(face, d).abs_diff_eq(Vec3::new(0.6, -0.4, 1.0), 1e-6), "face {face}");
        }
    }
}
