//! Tori.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::{Form, Line, around};
use crate::geometry::polynomial::{Quartic, zeros};

/// Bounding spheres are taken this much larger, so that rounding cuts no zero off.
const SLACK: f64 = 1.01;

pub struct Torus {
    ring: f64,
    tube: f64,
}

impl Torus {
    /// Radii of the circle the tube follows and of the tube, metres; `tube < ring`.
    pub fn new(ring: f32, tube: f32) -> Self {
        Torus { ring: f64::from(ring), tube: f64::from(tube) }
    }

    /// The point on the circle the tube follows that is nearest.
    fn middle(&self, point: DVec3) -> DVec3 {
        point.with_y(0.0).normalize() * self.ring
    }

    /// The implicit form (|p|^2 + R^2 - r^2)^2 - 4 R^2 (x^2 + z^2), positive outside, along a line
    /// p = foot + t direction, for R = 1. At the foot, the point nearest to the centre,
    /// foot * direction = 0, and the cubic term drops out.
    fn quartic(&self, foot: DVec3, direction: DVec3) -> Quartic {
        let tube = self.tube / self.ring;
        let k = foot.length_squared() + 1.0 - tube * tube;
        let [flat_foot, flat] = [foot, direction].map(|v| v.with_y(0.0));
        [
            k * k - 4.0 * flat_foot.length_squared(),
            -8.0 * flat_foot.dot(flat),
            2.0 * k - 4.0 * flat.length_squared(),
            0.0,
            1.0,
        ]
    }
}

/// The quartic (without cubic term, leading coefficient 1) divided by t - zero.
fn without(zero: f64, [_, q1, q2, _, _]: Quartic) -> Quartic {
    let c1 = zero * zero + q2;
    [zero * c1 + q1, c1, zero, 1.0, 0.0]
}

impl Form for Torus {
    fn nearest(&self, line: &Line, range: [f64; 2], own: Option<bool>) -> Option<(f64, bool)> {
        // Distances are counted in rings from the foot.
        let origin = line.origin / self.ring;
        let start = origin.dot(line.direction);
        let foot = origin - start * line.direction;
        let bound = SLACK * (1.0 + self.tube / self.ring);
        let half = (bound * bound - foot.length_squared()).max(0.0).sqrt();
        let [from, to] = range.map(|t| t / self.ring + start);
        let interval = [from.max(-half), to.min(half)];
        if interval[0] >= interval[1] {
            return None;
        }
        let mut quartic = self.quartic(foot, line.direction);
        if own.is_some() {
            // The signs beyond the zero taken out stay what they were.
            quartic = without(start, quartic);
        }
        // The form falls where the line enters.
        let met = zeros(quartic, interval).find(|zero| own.is_none_or(|own| zero.falls == own))?;
        Some(((met.at - start) * self.ring, met.falls))
    }

    fn snap(&self, point: DVec3) -> DVec3 {
        let middle = self.middle(point);
        middle + (point - middle).normalize() * self.tube
    }

    fn normal(&self, point: DVec3) -> DVec3 {
        (point - self.middle(point)).normalize()
    }

    fn uv(&self, point: DVec3) -> DVec2 {
        let out = point.with_y(0.0).length() - self.ring;
        DVec2::new(around(point), f64::atan2(point.y, out).rem_euclid(TAU) / TAU)
    }
}
