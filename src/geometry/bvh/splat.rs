//! A ray made ready for four boxes or triangles at once.

use glam::{Vec3, Vec4};

use crate::geometry::Ray;

/// A ray with every coordinate in all lanes; arrays are by axis.
pub(super) struct SplatRay {
    pub origin: [Vec4; 3],
    pub direction: [Vec4; 3],
    /// One over the direction, finite.
    pub inverse: [Vec4; 3],
    /// The side of a box the ray comes in by: 0 the low one, 1 the high one.
    pub entry_side: [usize; 3],
}

impl SplatRay {
    pub fn new(ray: &Ray) -> Self {
        // Zero would turn a plane the origin lies on into 0 / 0.
        let inverse = |d: f32| 1.0 / d.abs().max(1e-18).copysign(d);
        let splat = |vector: Vec3| vector.to_array().map(Vec4::splat);
        SplatRay {
            origin: splat(ray.origin),
            direction: splat(ray.direction),
            inverse: splat(ray.direction.map(inverse)),
            entry_side: ray.direction.to_array().map(|d| usize::from(d.is_sign_negative())),
        }
    }
}
