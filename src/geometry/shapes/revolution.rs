//! Surfaces of revolution about the y axis: sphere, ellipsoid, cylinder, torus and free profiles.

use std::f32::consts::TAU;

use glam::{Vec2, Vec3};

use crate::geometry::Mesh;

/// A smooth stretch of a profile: points (radius, height) with their unit normals in the same
/// plane, ordered so that the outside lies to the right. A profile's stretches meet at creases.
pub type Stretch = Vec<(Vec2, Vec2)>;

/// How far and how finely a profile is turned about the y axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sweep {
    /// Steps about the axis.
    pub slices: u32,
    /// Radians counter-clockwise seen from above, starting at +x; a full turn closes the surface.
    pub angle: f32,
}

impl Sweep {
    pub fn full(slices: u32) -> Self {
        Sweep { slices, angle: TAU }
    }

    /// Cosine and sine at a slice. The last slice of a full turn is the first, bit by bit.
    fn direction(self, slice: u32) -> Vec2 {
        if self.angle >= TAU {
            turned(slice % self.slices, self.slices)
        } else {
            Vec2::from_angle(self.angle * slice as f32 / self.slices as f32)
        }
    }
}

/// Cosine and sine of `step / steps` of a full turn, exact at the quarters.
fn turned(step: u32, steps: u32) -> Vec2 {
    match (4 * step).checked_rem(steps) {
        Some(0) => [Vec2::X, Vec2::Y, Vec2::NEG_X, Vec2::NEG_Y][(4 * step / steps) as usize % 4],
        _ => Vec2::from_angle(TAU * step as f32 / steps as f32),
    }
}

/// A sphere about the origin with `slices` steps about the y axis and `stacks` from pole to pole.
pub fn sphere(radius: f32, slices: u32, stacks: u32) -> Mesh {
    ellipsoid(Vec3::splat(radius), slices, stacks)
}

/// An ellipsoid about the origin with the half axes `radii`: a unit sphere stretched.
pub fn ellipsoid(radii: Vec3, slices: u32, stacks: u32) -> Mesh {
    let arc = (0..=stacks).map(|stack| {
        let up = half_turned(stack, stacks);
        (up, up)
    });
    let mut mesh = revolution(&[arc.collect()], Sweep::full(slices));
    for (position, normal) in mesh.positions.iter_mut().zip(&mut mesh.normals) {
        *position *= radii;
        // The gradient of the implicit form; equals the unit normal itself on a sphere.
        *normal = (*normal / radii).normalize();
    }
    mesh
}

/// Half circle from the bottom to the top: (radius, height) after `step / steps` of it.
fn half_turned(step: u32, steps: u32) -> Vec2 {
    // -90 degrees plus step / steps of 180: quarters stay exact, so the poles have radius zero.
    let turned = turned(step, 2 * steps);
    Vec2::new(turned.y, -turned.x)
}

/// A cylinder about the y axis and the origin. `capped` closes both ends with flat discs.
pub fn cylinder(radius: f32, height: f32, capped: bool, slices: u32) -> Mesh {
    let (low, high) = (Vec2::new(radius, -0.5 * height), Vec2::new(radius, 0.5 * height));
    let (axis_low, axis_high) = (Vec2::new(0.0, low.y), Vec2::new(0.0, high.y));
    let points = if capped { vec![axis_low, low, high, axis_high] } else { vec![low, high] };
    revolution(&polyline_profile(&points), Sweep::full(slices))
}

/// A torus about the y axis: a circle of radius `tube` (`stacks` steps) led along a circle of
/// radius `ring` by the sweep. With less than a full turn the ends stay open. `ring > tube`.
pub fn torus(ring: f32, tube: f32, stacks: u32, sweep: Sweep) -> Mesh {
    let circle = (0..=stacks).map(|stack| {
        let around = turned(stack % stacks, stacks);
        (Vec2::new(ring, 0.0) + tube * around, around)
    });
    revolution(&[circle.collect()], sweep)
}

/// The profile of straight lines through `points` (radius, height), creased at every point.
/// Consecutive points differ.
pub fn polyline_profile(points: &[Vec2]) -> Vec<Stretch> {
    let line = |ends: &[Vec2]| {
        let normal = right_of(ends[1] - ends[0]);
        vec![(ends[0], normal), (ends[1], normal)]
    };
    points.windows(2).map(line).collect()
}

/// The profile of cubic Bezier curves through `points` (radius, height): `3 n + 1` control points,
/// each curve cut into `steps`. Curves meet in creases unless their tangents agree.
pub fn bezier_profile(points: &[Vec2], steps: u32) -> Vec<Stretch> {
    let curve = |first: usize| {
        let control = &points[first..first + 4];
        let at = |step: u32| {
            let (point, tangent) = bezier(control, step as f32 / steps as f32);
            (point, right_of(tangent))
        };
        (0..=steps).map(at).collect()
    };
    (0..points.len().saturating_sub(3)).step_by(3).map(curve).collect()
}

/// Point and tangent direction of a cubic Bezier curve. Where the first control points coincide,
/// the tangent is the limit: towards the first that differs.
fn bezier(p: &[Vec2], t: f32) -> (Vec2, Vec2) {
    let s = 1.0 - t;
    let point =
        s * s * s * p[0] + 3.0 * s * s * t * p[1] + 3.0 * s * t * t * p[2] + t * t * t * p[3];
    let tangent = s * s * (p[1] - p[0]) + 2.0 * s * t * (p[2] - p[1]) + t * t * (p[3] - p[2]);
    let limits = [tangent, p[2] - p[0], p[3] - p[1], p[3] - p[0]];
    let limit = limits.into_iter().find(|d| d.length_squared() > 0.0);
    (point, limit.unwrap_or(Vec2::Y))
}

fn right_of(tangent: Vec2) -> Vec2 {
    Vec2::new(tangent.y, -tangent.x).normalize()
}

/// The surface a profile sweeps. Radii are not negative; a point with radius zero is a pole.
/// Texture coordinates: u along the sweep, v along the profile, both from 0 to 1.
pub fn revolution(profile: &[Stretch], sweep: Sweep) -> Mesh {
    let mut mesh = Mesh::default();
    for (index, stretch) in profile.iter().enumerate() {
        let rows = stretch.len() as u32 - 1;
        mesh.append_grid(sweep.slices, rows, |slice, row| {
            let direction = sweep.direction(slice);
            let (point, normal) = stretch[row as usize];
            let out = |p: Vec2| Vec3::new(p.x * direction.x, p.y, -p.x * direction.y);
            let along = (index as f32 + row as f32 / rows as f32) / profile.len() as f32;
            (out(point), out(normal), Vec2::new(slice as f32 / sweep.slices as f32, along))
        });
    }
    mesh.without_unused()
}

/// How many steps cut an arc of `angle` radians and `radius` metres into edges of at most `edge`.
pub fn arc_steps(radius: f32, angle: f32, edge: f32) -> u32 {
    (radius * angle / edge).ceil().max(3.0) as u32
}
