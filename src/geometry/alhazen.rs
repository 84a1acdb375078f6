//! Alhazen's problem: where on a sphere is a point seen mirrored?
//!
//! The eye, the point and the sphere's centre span a plane, and the reflected point lies on the
//! circle that plane cuts. Outside the sphere the law of reflection has exactly one solution
//! between the two directions, and what it sets to zero is monotone there, so it is bracketed
//! and bisected: no quartic, no loss of digits.

use glam::DVec3;

/// The point of the sphere around `centre` in which an eye at `eye` sees the point `seen`
/// mirrored. Metres.
///
/// `None` unless both points lie outside the sphere and are seen from the point found: nothing is
/// seen mirrored in the sphere that hides it.
pub fn reflected_point(centre: DVec3, radius: f64, eye: DVec3, seen: DVec3) -> Option<DVec3> {
    let (e, v) = (eye - centre, seen - centre);
    if !(radius > 0.0 && e.length() > radius && v.length() > radius) {
        return None;
    }
    // In the plane of e and v: angles from e's direction `x` towards v.
    let x = e.normalize();
    let across = v - v.dot(x) * x;
    let angle = f64::atan2(across.length(), v.dot(x));
    if across.length() < 1e-14 * v.length() {
        return (v.dot(x) > 0.0).then(|| centre + radius * x);
    }
    let y = across.normalize();
    // Sum of the tangential parts of the unit directions to both: positive while the point is
    // still too close to the eye's direction.
    let imbalance = |a: f64| {
        let (sin, cos) = a.sin_cos();
        let p = radius * (cos * x + sin * y);
        let tangent = cos * y - sin * x;
        (e - p).normalize().dot(tangent) + (v - p).normalize().dot(tangent)
    };
    let (mut low, mut high) = (0.0, angle);
    // Each step gains a bit; 60 exhaust the mantissa.
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if imbalance(middle) > 0.0 { low = middle } else { high = middle }
    }
    let (sin, cos) = (0.5 * (low + high)).sin_cos();
    let p = radius * (cos * x + sin * y);
    ((e - p).dot(p) > 0.0 && (v - p).dot(p) > 0.0).then(|| centre + p)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn outside() -> impl Strategy<Value = DVec3> {
        let range = -6.0..6.0f64;
        (range.clone(), range.clone(), range)
            .prop_map(|(x, y, z)| DVec3::new(x, y, z))
            .prop_filter("outside the sphere", |p| p.length() > 1.05)
    }

    proptest! {
        #[test]
        fn the_normal_bisects_eye_and_point(eye in outside(), seen in outside()) {
            let centre = DVec3::new(0.3, -0.2, 0.7);
            let found = reflected_point(centre, 1.0, eye + centre, seen + centre);
            prop_assume!(found.is_some());
            let p = found.unwrap() - centre;
            prop_assert!((p.length() - 1.0).abs() < 1e-12);
            let half = (eye - p).normalize() + (seen - p).normalize();
            prop_assert!(half.cross(p).length() < 1e-9);
            prop_assert!(half.dot(p) > 0.0);
        }

        #[test]
        fn the_path_is_the_shortest_by_way_of_the_sphere(
            eye in outside(), seen in outside(), turn in 0.01..0.5f64,
        ) {
            let found = reflected_point(DVec3::ZERO, 1.0, eye, seen);
            let normal = eye.cross(seen);
            prop_assume!(normal.length() > 1e-3 && found.is_some());
            let p = found.unwrap();
            let length = |q: DVec3| (eye - q).length() + (seen - q).length();
            for sign in [-1.0, 1.0] {
                let q = glam::DQuat::from_axis_angle(normal.normalize(), sign * turn) * p;
                prop_assert!(length(q) > length(p) - 1e-12);
            }
        }
    }

    #[test]
    fn points_inside_or_opposite_have_no_answer() {
        let eye = DVec3::new(3.0, 0.0, 0.0);
        assert_eq!(reflected_point(DVec3::ZERO, 1.0, eye, DVec3::new(0.5, 0.0, 0.0)), None);
        assert_eq!(reflected_point(DVec3::ZERO, 1.0, eye, DVec3::new(-2.0, 0.0, 0.0)), None);
        assert_eq!(reflected_point(DVec3::ZERO, 1.0, eye, 2.0 * eye), Some(DVec3::X));
    }
}
