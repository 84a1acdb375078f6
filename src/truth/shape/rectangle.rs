//! Rectangles.

use glam::{DVec2, DVec3, Vec2};

use super::{Form, Line, within};

pub struct Rectangle {
    /// Half the lengths along x and z.
    half: DVec2,
}

impl Rectangle {
    /// Lengths along x and z, metres.
    pub fn new(size: Vec2) -> Self {
        Rectangle { half: 0.5 * size.as_dvec2() }
    }
}

impl Form for Rectangle {
    fn nearest(&self, line: &Line, range: [f64; 2], own: Option<bool>) -> Option<(f64, bool)> {
        // A line meets a plane once.
        if own.is_some() || line.direction.y == 0.0 {
            return None;
        }
        let t = -line.origin.y / line.direction.y;
        let point = line.at(t);
        let met = point.x.abs() <= self.half.x && point.z.abs() <= self.half.y;
        (met && within(range, t)).then_some((t, line.direction.y < 0.0))
    }

    fn snap(&self, point: DVec3) -> DVec3 {
        point.with_y(0.0)
    }

    fn normal(&self, _: DVec3) -> DVec3 {
        DVec3::Y
    }

    fn uv(&self, point: DVec3) -> DVec2 {
        DVec2::new(point.x, -point.z)
    }
}
