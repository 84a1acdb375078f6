//! Spheres in closed form.

use std::f32::consts::{PI, TAU};

use glam::{Affine3A, DVec3, Vec2, Vec3};

use crate::geometry::Ray;

/// A sphere about the origin of `pose`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sphere {
    pub pose: Affine3A,
    pub radius: f32,
}

impl Sphere {
    fn centre(&self) -> Vec3 {
        self.pose.translation.into()
    }

    /// Unit normal pointing out, at a point of the sphere.
    pub fn normal(&self, point: Vec3) -> Vec3 {
        (point - self.centre()).normalize()
    }

    /// Texture coordinates as [`crate::geometry::shapes`] gives them to a sphere: u once around
    /// the y axis from +x by way of -z, v from the bottom to the top.
    pub fn uv(&self, point: Vec3) -> Vec2 {
        let local = self.pose.inverse().transform_vector3(self.normal(point));
        let around = f32::atan2(-local.z, local.x).rem_euclid(TAU);
        Vec2::new(around / TAU, 1.0 - local.y.clamp(-1.0, 1.0).acos() / PI)
    }

    /// The nearest point of the sphere along `ray` within `range`, and whether it is met from
    /// outside. A ray that starts on this very sphere and travels outside (`own` is true) never
    /// meets it again; one that travels inside meets it once more, at the other end of the chord.
    pub fn nearest(&self, ray: &Ray, range: [f32; 2], own: Option<bool>) -> Option<(Vec3, bool)> {
        // Doubles: the points feed closed forms whose digits are compared.
        let origin = (ray.origin - self.centre()).as_dvec3();
        let direction = ray.direction.as_dvec3().normalize();
        let [near, far] = roots(origin, direction, f64::from(self.radius))?;
        let within = |t: f64| t >= f64::from(range[0]) && t <= f64::from(range[1]);
        let (t, front) = match own {
            Some(true) => return None,
            Some(false) => (within(far).then_some(far)?, false),
            None if within(near) => (near, true),
            None => (within(far).then_some(far)?, false),
        };
        let local = (origin + t * direction).normalize() * f64::from(self.radius);
        Some(((local + self.centre().as_dvec3()).as_vec3(), front))
    }
}

/// Where a line meets the sphere of that radius about the origin; the direction has unit length.
fn roots(origin: DVec3, direction: DVec3, radius: f64) -> Option<[f64; 2]> {
    let middle = -origin.dot(direction);
    // The squared distance of the line from the centre, free of cancellation.
    let off = (origin + middle * direction).length_squared();
    let half = radius * radius - off;
    (half >= 0.0).then(|| [middle - half.sqrt(), middle + half.sqrt()])
}
