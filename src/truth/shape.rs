//! Objects in closed form: what their meshes come to when cut ever more finely.

mod cylinder;
mod ellipsoid;
mod rectangle;
mod torus;

#[cfg(test)]
mod tests;

use std::f64::consts::TAU;

use glam::{Affine3A, DAffine3, DVec2, DVec3, Vec2, Vec3};

use crate::geometry::Ray;
use crate::scene::{ObjectId, Surface};

/// An object in closed form, in the world. Reckoned in doubles: its points feed measures whose digits
/// are compared.
pub(super) struct Shape {
    pub object: ObjectId,
    form: Box<dyn Form>,
    world_from_object: DAffine3,
    object_from_world: DAffine3,
}

/// A surface in object space, metres.
trait Form: Send + Sync {
    /// As [`Shape::nearest`], but with distances along the line in place of points. The line starts on
    /// the surface where `own` is given.
    fn nearest(&self, line: &Line, range: [f64; 2], own: Option<bool>) -> Option<(f64, bool)>;

    /// The nearest point of the surface, for a point that is off it by rounding.
    fn snap(&self, point: DVec3) -> DVec3;

    /// Outward unit normal.
    fn normal(&self, point: DVec3) -> DVec3;

    /// Texture coordinates as [`crate::geometry::shapes`] gives them to the mesh.
    fn uv(&self, point: DVec3) -> DVec2;
}

/// A line in object space. `direction` has unit length.
struct Line {
    origin: DVec3,
    direction: DVec3,
}

impl Line {
    fn at(&self, t: f64) -> DVec3 {
        self.origin + t * self.direction
    }
}

impl Shape {
    pub fn new(object: ObjectId, pose: &Affine3A, surface: Surface) -> Self {
        let form: Box<dyn Form> = match surface {
            Surface::Sphere { radius } => Box::new(ellipsoid::Ellipsoid::new(Vec3::splat(radius))),
            Surface::Ellipsoid { radii } => Box::new(ellipsoid::Ellipsoid::new(radii)),
            Surface::Cylinder { radius, height, capped } => {
                Box::new(cylinder::Cylinder::new(radius, height, capped))
            }
            Surface::Rectangle { size } => Box::new(rectangle::Rectangle::new(size)),
            Surface::Torus { ring, tube } => Box::new(torus::Torus::new(ring, tube)),
        };
        let world_from_object = pose.as_daffine3();
        Shape { object, form, world_from_object, object_from_world: world_from_object.inverse() }
    }

    /// The nearest point along `ray` within `range` metres, and whether it is met from outside (on a
    /// sheet: from the side of its normals).
    ///
    /// `own` is given where the ray starts on this very shape: whether it travels on its outside. It
    /// then meets only what can be met from that side, and never the point it starts at: the
    /// start is put onto the surface exactly, and the crossing there is left out by name rather
    /// than by a least distance, which would also leave out the second crossing of a grazing ray.
    pub fn nearest(&self, ray: &Ray, range: [f32; 2], own: Option<bool>) -> Option<(Vec3, bool)> {
        let start = self.local(ray.origin);
        let line = Line {
            origin: if own.is_some() { self.form.snap(start) } else { start },
            // Motions are rigid, so metres along it are metres in the world.
            direction: self
                .object_from_world
                .transform_vector3(ray.direction.as_dvec3())
                .normalize(),
        };
        let (t, front) = self.form.nearest(&line, range.map(f64::from), own)?;
        let point = self.world_from_object.transform_point3(self.form.snap(line.at(t)));
        Some((point.as_vec3(), front))
    }

    /// Unit normal pointing out, at a point of the surface.
    pub fn normal(&self, point: Vec3) -> Vec3 {
        let normal = self.form.normal(self.local(point));
        self.world_from_object.transform_vector3(normal).as_vec3().normalize()
    }

    /// Texture coordinates of a point of the surface, as its mesh has them.
    pub fn uv(&self, point: Vec3) -> Vec2 {
        self.form.uv(self.local(point)).as_vec2()
    }

    fn local(&self, point: Vec3) -> DVec3 {
        self.object_from_world.transform_point3(point.as_dvec3())
    }
}

fn within(range: [f64; 2], t: f64) -> bool {
    (range[0]..=range[1]).contains(&t)
}

/// Share of a turn about the y axis, from +x by way of -z.
fn around(point: DVec3) -> f64 {
    f64::atan2(-point.z, point.x).rem_euclid(TAU) / TAU
}

/// Where a line enters and leaves the unit sphere. Directions have any length; none is that of a line
/// along the axis of a cylinder, whose points are taken without their height. A line that starts on
/// the surface, `own`, meets it whatever the rounding says.
fn chord(origin: DVec3, direction: DVec3, own: bool) -> Option<[f64; 2]> {
    let square = direction.length_squared();
    if square == 0.0 {
        let inside = own || origin.length_squared() <= 1.0;
        return inside.then_some([f64::NEG_INFINITY, f64::INFINITY]);
    }
    let middle = -origin.dot(direction) / square;
    // The squared distance of the line from the centre, free of cancellation.
    let off = (origin + middle * direction).length_squared();
    let half = ((1.0 - off) / square).max(if own { 0.0 } else { f64::NEG_INFINITY });
    (half >= 0.0).then(|| [middle - half.sqrt(), middle + half.sqrt()])
}
