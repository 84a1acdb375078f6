//! The law of reflection.

use glam::Vec3;

/// The direction in which light travelling along `incident` leaves a mirror.
///
/// `normal` has unit length; its sign does not matter. The length of `incident` is kept.
pub fn reflect(incident: Vec3, normal: Vec3) -> Vec3 {
    incident - 2.0 * normal.dot(incident) * normal
}

/// `normal`, flipped where needed so that it points against `incident`: to the side a ray
/// travelling along `incident` arrives from.
pub fn face_forward(normal: Vec3, incident: Vec3) -> Vec3 {
    if normal.dot(incident) > 0.0 { -normal } else { normal }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn unit() -> impl Strategy<Value = Vec3> {
        (-1.0f32..1.0, 0.0f32..std::f32::consts::TAU).prop_map(|(y, angle)| {
            let radius = (1.0 - y * y).sqrt();
            Vec3::new(radius * angle.cos(), y, radius * angle.sin())
        })
    }

    proptest! {
        #[test]
        fn the_normal_bisects_the_two_directions(incident in unit(), normal in unit()) {
            let mirrored = reflect(incident, normal);
            prop_assert!((mirrored.dot(normal) + incident.dot(normal)).abs() < 1e-5);
            // What is left of both beside the normal is the same.
            let along = incident - incident.dot(normal) * normal;
            let along_mirrored = mirrored - mirrored.dot(normal) * normal;
            prop_assert!(along.abs_diff_eq(along_mirrored, 1e-5));
        }

        #[test]
        fn the_sign_of_the_normal_does_not_matter(incident in unit(), normal in unit()) {
            prop_assert_eq!(reflect(incident, normal), reflect(incident, -normal));
        }

        #[test]
        fn a_faced_normal_points_against_the_ray(incident in unit(), normal in unit()) {
            let faced = face_forward(normal, incident);
            prop_assert!(faced.dot(incident) <= 0.0);
            prop_assert!(faced == normal || faced == -normal);
        }
    }
}
