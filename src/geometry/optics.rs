//! The laws of reflection and refraction, and how a dielectric splits light between the two.

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

/// The direction in which light travelling along `incident` goes on behind a surface (Snell), of
/// unit length; `None` where all of it is reflected.
///
/// `incident` and `normal` have unit length, the normal points against it. `ratio` is the
/// refractive index before the surface over the one behind.
pub fn refract(incident: Vec3, normal: Vec3, ratio: f32) -> Option<Vec3> {
    let cosine = -incident.dot(normal);
    let squared = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
    (squared >= 0.0).then(|| {
        // The length of the sum is one but for rounding, which long chains would gather.
        (ratio * incident + (ratio * cosine - squared.sqrt()) * normal).normalize()
    })
}

/// Share of unpolarised light that a dielectric reflects (Fresnel), 0 to 1; 1 beyond the critical
/// angle. `cosine` is that between the light and the normal, 0 to 1; `ratio` as for [`refract`].
pub fn fresnel(cosine: f32, ratio: f32) -> f32 {
    let squared = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
    if squared < 0.0 {
        return 1.0;
    }
    let behind = squared.sqrt();
    let across = (ratio * cosine - behind) / (ratio * cosine + behind);
    let along = (cosine - ratio * behind) / (cosine + ratio * behind);
    0.5 * (across * across + along * along)
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

    #[test]
    fn snells_law_holds_and_ends_at_the_critical_angle() {
        let normal = Vec3::Y;
        for (ratio, degrees) in [(1.0 / 1.5, 60.0f32), (1.5, 30.0), (1.0, 80.0), (1.33, 48.0)] {
            let (sine, cosine) = degrees.to_radians().sin_cos();
            let behind = refract(Vec3::new(sine, -cosine, 0.0), normal, ratio).unwrap();
            assert!((behind.x - ratio * sine).abs() < 1e-6, "{ratio} at {degrees}: {behind}");
            assert!(behind.y < 0.0 && behind.z == 0.0 && (behind.length() - 1.0).abs() < 1e-6);
        }
        // Asin(1 / 1.5) is 41.81 degrees.
        for (degrees, passes) in [(41.8f32, true), (41.82, false)] {
            let (sine, cosine) = degrees.to_radians().sin_cos();
            let behind = refract(Vec3::new(sine, -cosine, 0.0), normal, 1.5);
            assert_eq!(behind.is_some(), passes);
            assert_eq!(fresnel(cosine, 1.5) < 1.0, passes);
        }
    }

    #[test]
    fn fresnels_shares_are_the_known_ones() {
        // Straight on: ((n - 1) / (n + 1))^2, from either side.
        for ratio in [1.5, 1.0 / 1.5] {
            assert!((fresnel(1.0, ratio) - 0.04).abs() < 1e-6);
        }
        // At Brewster's angle only one polarisation is reflected: half of
        // ((n^2 - 1) / (n^2 + 1))^2.
        let brewster = 1.5f32.atan().cos();
        let half = 0.5 * (1.25f32 / 3.25).powi(2);
        assert!((fresnel(brewster, 1.0 / 1.5) - half).abs() < 1e-6);
        assert!((fresnel(0.0, 1.0 / 1.5) - 1.0).abs() < 1e-6, "grazing");
        // The way back splits as the way in did.
        let (cosine, ratio) = (0.6f32, 1.0 / 1.5);
        let back = (1.0 - ratio * ratio * (1.0 - cosine * cosine)).sqrt();
        assert!((fresnel(cosine, ratio) - fresnel(back, 1.5)).abs() < 1e-6);
    }
}
