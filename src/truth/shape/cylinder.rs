//! Cylinders, closed by discs or open.

use glam::{DVec2, DVec3};

use super::{Form, Line, around, chord, within};

pub struct Cylinder {
    radius: f64,
    half_height: f64,
    capped: bool,
}

/// Leaves out what is along the axis.
const ACROSS: DVec3 = DVec3::new(1.0, 0.0, 1.0);

impl Cylinder {
    /// Metres; `capped` closes both ends.
    pub fn new(radius: f32, height: f32, capped: bool) -> Self {
        let half_height = 0.5 * f64::from(height);
        Cylinder { radius: f64::from(radius), half_height, capped }
    }

    /// Whether a point of the surface belongs to a cap rather than to the side: the one it is nearer
    /// to. On the rim itself it is the side.
    fn on_cap(&self, point: DVec3) -> bool {
        let below_cap = self.half_height - point.y.abs();
        let below_side = self.radius - (point * ACROSS).length();
        self.capped && below_cap < below_side
    }

    /// Where a line crosses the planes of the lower and the upper end, the nearer one first.
    fn ends(&self, line: &Line) -> [f64; 2] {
        let [low, high] = [-self.half_height, self.half_height]
            .map(|height| (height - line.origin.y) / line.direction.y);
        [low.min(high), low.max(high)]
    }
}

impl Form for Cylinder {
    fn nearest(&self, line: &Line, range: [f64; 2], own: Option<bool>) -> Option<(f64, bool)> {
        // Convex, or a sheet of something convex: a line that leaves it outwards stays away.
        if own == Some(true) {
            return None;
        }
        let [origin, direction] = [line.origin, line.direction].map(|v| v * ACROSS / self.radius);
        let [mut enter, mut leave] = chord(origin, direction, own.is_some())?;
        if self.capped {
            let [low, high] = self.ends(line);
            (enter, leave) = (enter.max(low), leave.min(high));
            if enter > leave {
                return None;
            }
        }
        let met = |t: f64| {
            let height = line.origin.y + t * line.direction.y;
            within(range, t) && (self.capped || height.abs() <= self.half_height)
        };
        match own {
            None if met(enter) => Some((enter, true)),
            _ => met(leave).then_some((leave, false)),
        }
    }

    fn snap(&self, point: DVec3) -> DVec3 {
        let across = point * ACROSS;
        if self.on_cap(point) {
            let end = self.half_height.copysign(point.y);
            return across.clamp_length_max(self.radius).with_y(end);
        }
        let height = point.y.clamp(-self.half_height, self.half_height);
        (across.normalize() * self.radius).with_y(height)
    }

    fn normal(&self, point: DVec3) -> DVec3 {
        if self.on_cap(point) {
            DVec3::new(0.0, 1f64.copysign(point.y), 0.0)
        } else {
            (point * ACROSS).normalize()
        }
    }

    /// Along the profile the side and each cap take the same share.
    fn uv(&self, point: DVec3) -> DVec2 {
        let up = 0.5 + 0.5 * point.y / self.half_height;
        let out = (point * ACROSS).length() / self.radius;
        let along = match (self.capped, self.on_cap(point)) {
            (false, _) => up,
            (true, false) => (1.0 + up) / 3.0,
            (true, true) if point.y < 0.0 => out / 3.0,
            (true, true) => 1.0 - out / 3.0,
        };
        DVec2::new(around(point), along)
    }
}
