//! Ellipsoids, spheres among them.

use std::f64::consts::PI;

use glam::{DVec2, DVec3, Vec3};

use super::{Form, Line, around, chord, within};

pub struct Ellipsoid {
    radii: DVec3,
}

impl Ellipsoid {
    /// Half axes along x, y and z, metres.
    pub fn new(radii: Vec3) -> Self {
        Ellipsoid { radii: radii.as_dvec3() }
    }
}

impl Form for Ellipsoid {
    fn nearest(&self, line: &Line, range: [f64; 2], own: Option<bool>) -> Option<(f64, bool)> {
        let [enter, leave] =
            chord(line.origin / self.radii, line.direction / self.radii, own.is_some())?;
        match own {
            // Convex: a line that leaves it stays away, one that starts inward ends at the far side.
            Some(true) => None,
            None if within(range, enter) => Some((enter, true)),
            _ => within(range, leave).then_some((leave, false)),
        }
    }

    fn snap(&self, point: DVec3) -> DVec3 {
        (point / self.radii).normalize() * self.radii
    }

    /// The gradient of the implicit form.
    fn normal(&self, point: DVec3) -> DVec3 {
        (point / (self.radii * self.radii)).normalize()
    }

    fn uv(&self, point: DVec3) -> DVec2 {
        let unit = point / self.radii;
        // The angle from the lower pole, by both its sine and its cosine: exact near the poles too.
        let up = f64::atan2(unit.x.hypot(unit.z), -unit.y) / PI;
        DVec2::new(around(unit), up)
    }
}
