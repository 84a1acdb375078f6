//! The scene's surfaces at one moment, in world space, and where rays meet them.

use std::borrow::Cow;
use std::ops::Range;

use glam::{Affine3A, Vec2, Vec3};

use super::shape::Shape;
use super::{Bounce, Shapes};
use crate::geometry::bvh::Bvh;
use crate::geometry::optics::face_forward;
use crate::geometry::{Mesh, Ray};
use crate::scene::{Moment, ObjectId, Scene};

/// A point of a surface, met by a ray.
///
/// A ray that starts here never meets the triangle it starts on, and meets its own object only by
/// faces it can come to: outside it ignores back faces of the object, inside front faces. It is
/// outside when mirrored off a front side or refracted through a back side. So a grazing ray, which
/// an interpolated normal may send slightly below the triangles, does not get caught in a closed
/// mirror, and a concave mirror still sees itself. For convex closed shapes the rule is exact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    pub object: ObjectId,
    /// Triangle of the object's mesh; 0 on a closed form.
    pub triangle: u32,
    pub point: Vec3,
    /// Unit shading normal, on the side the ray came from.
    pub normal: Vec3,
    pub uv: Vec2,
    /// Whether the ray met the side the triangle's corners run counter-clockwise on.
    pub front: bool,
    /// Metres from the ray's origin.
    pub distance: f32,
}

pub(super) struct Surfaces<'s> {
    scene: &'s Scene,
    poses: Vec<Affine3A>,
    /// The scene's, as they are at the moment.
    meshes: Vec<Cow<'s, Mesh>>,
    bvh: Bvh,
    /// Object and triangle of each triangle in the tree.
    owners: Vec<(ObjectId, u32)>,
    /// Which triangles of the tree are an object's.
    ranges: Vec<Range<u32>>,
    /// Closed forms standing for objects' meshes.
    shapes: Vec<Shape>,
}

impl<'s> Surfaces<'s> {
    /// Of the objects to be met.
    pub fn new(
        scene: &'s Scene,
        moment: &Moment,
        option: Shapes,
        met: impl Fn(ObjectId) -> bool,
    ) -> Self {
        let mut triangles = Vec::new();
        let mut owners = Vec::new();
        let mut ranges = Vec::new();
        let mut shapes = Vec::new();
        for (id, object) in scene.objects.iter().enumerate() {
            let (id, pose) = (id as ObjectId, moment.poses[id]);
            let first = owners.len() as u32;
            if !met(id) {
                ranges.push(first..first);
                continue;
            }
            if let (Some(surface), Shapes::Analytic) = (object.surface, option) {
                shapes.push(Shape::new(id, &pose, surface));
                ranges.push(first..first);
                continue;
            }
            for (corners, number) in scene.world_triangles(moment, id).zip(0..) {
                triangles.push(corners);
                owners.push((id, number));
            }
            ranges.push(first..owners.len() as u32);
        }
        let (poses, meshes) = (moment.poses.clone(), scene.meshes_at(moment));
        Surfaces { scene, poses, meshes, bvh: Bvh::new(&triangles), owners, ranges, shapes }
    }

    /// The nearest surface along `ray` within `range` metres; `from` is where the ray leaves a
    /// surface, if it does.
    pub fn nearest(&self, ray: &Ray, range: [f32; 2], from: Option<&Bounce>) -> Option<Hit> {
        let may_meet = self.may_meet(from);
        let mut found = self.bvh.nearest(ray, range, may_meet).map(|hit| {
            let (object, triangle) = self.owners[hit.triangle as usize];
            let surface = self.interpolate(object, triangle, hit.barycentrics);
            self.met(surface, ray, hit.front)
        });
        for shape in &self.shapes {
            let end = found.map_or(range[1], |hit| hit.distance);
            let own = from.filter(|from| from.hit.object == shape.object).map(Bounce::outside);
            if let Some((point, front)) = shape.nearest(ray, [range[0], end], own) {
                found = Some(self.met(SurfacePoint::of_shape(shape, point), ray, front));
            }
        }
        found
    }

    /// Whether anything for which `blocks` is met by the ray that leaves a bounce.
    pub fn is_blocked(&self, from: &Bounce, blocks: impl Fn(ObjectId) -> bool) -> bool {
        let ray = Ray { origin: from.hit.point, direction: from.outgoing };
        let range = [0.0, f32::INFINITY];
        let may_meet = self.may_meet(Some(from));
        let accept = |index: u32, front: bool| {
            blocks(self.owners[index as usize].0) && may_meet(index, front)
        };
        let by_shape = |shape: &Shape| {
            let own = (from.hit.object == shape.object).then(|| from.outside());
            blocks(shape.object) && shape.nearest(&ray, range, own).is_some()
        };
        self.bvh.nearest(&ray, range, accept).is_some() || self.shapes.iter().any(by_shape)
    }

    /// The rule of [`Hit`] for the triangles that a ray meets, which leaves a surface or does not:
    /// by their numbers alone, as looking up the owner of each would cost more than the rule.
    fn may_meet(&self, from: Option<&Bounce>) -> impl Fn(u32, bool) -> bool + use<> {
        let own = from.map_or(0..0, |from| self.ranges[from.hit.object as usize].clone());
        let start = from.map_or(0, |from| own.start + from.hit.triangle);
        let outside = from.is_some_and(Bounce::outside);
        move |index, front| !own.contains(&index) || index != start && front == outside
    }

    /// See [`super::Tracer::surface_at`].
    pub fn at(&self, object: ObjectId, triangle: u32, point: Vec3, incident: Vec3) -> Option<Hit> {
        let ray = Ray { origin: point, direction: incident };
        if let Some(shape) = self.shapes.iter().find(|shape| shape.object == object) {
            let surface = SurfacePoint::of_shape(shape, point);
            return Some(self.met(surface, &ray, surface.normal.dot(incident) < 0.0));
        }
        self.scene.objects.get(object as usize)?;
        let mesh = self.mesh(object);
        mesh.triangles.get(triangle as usize)?;
        let [a, b, c] = mesh.corners(triangle as usize);
        let facing = self.poses[object as usize].transform_vector3((b - a).cross(c - a));
        let surface =
            self.interpolate(object, triangle, self.barycentrics(object, triangle, point));
        Some(self.met(surface, &ray, facing.dot(incident) < 0.0))
    }

    /// The weights of the second and third corner at a point of a triangle.
    pub fn barycentrics(&self, object: ObjectId, triangle: u32, point: Vec3) -> Vec2 {
        let local = self.poses[object as usize].inverse().transform_point3(point);
        let [a, b, c] = self.mesh(object).corners(triangle as usize);
        let (ab, ac, ap) = (b - a, c - a, local - a);
        let normal = ab.cross(ac);
        let area = normal.length_squared();
        // The point may lie beside the triangle; what is meant is its nearest point.
        let v = (ap.cross(ac).dot(normal) / area).clamp(0.0, 1.0);
        let w = (ab.cross(ap).dot(normal) / area).clamp(0.0, 1.0 - v);
        Vec2::new(v, w)
    }

    /// Where on a triangle such weights are now.
    pub fn point(&self, object: ObjectId, triangle: u32, barycentrics: Vec2) -> Vec3 {
        self.interpolate(object, triangle, barycentrics).point
    }

    fn mesh(&self, object: ObjectId) -> &Mesh {
        &self.meshes[self.scene.objects[object as usize].mesh]
    }

    /// A point of a triangle from the weights of its second and third corner, as the rasteriser
    /// interpolates it.
    fn interpolate(&self, object: ObjectId, triangle: u32, barycentrics: Vec2) -> SurfacePoint {
        let mesh = self.mesh(object);
        let pose = &self.poses[object as usize];
        let [a, b, c] = mesh.triangles[triangle as usize].map(|corner| corner as usize);
        let Vec2 { x: v, y: w } = barycentrics;
        let u = 1.0 - v - w;
        let position = u * mesh.positions[a] + v * mesh.positions[b] + w * mesh.positions[c];
        let normal = u * mesh.normals[a] + v * mesh.normals[b] + w * mesh.normals[c];
        SurfacePoint {
            object,
            triangle,
            point: pose.transform_point3(position),
            // Motions are rigid, so normals turn as vectors do.
            normal: pose.transform_vector3(normal).normalize(),
            uv: u * mesh.uvs[a] + v * mesh.uvs[b] + w * mesh.uvs[c],
        }
    }

    fn met(&self, surface: SurfacePoint, ray: &Ray, front: bool) -> Hit {
        let SurfacePoint { object, triangle, point, normal, uv } = surface;
        let normal = face_forward(normal, ray.direction);
        let distance = (point - ray.origin).dot(ray.direction);
        Hit { object, triangle, point, normal, uv, front, distance }
    }
}

/// A [`Hit`] before it is known from where it is seen.
#[derive(Clone, Copy)]
struct SurfacePoint {
    object: ObjectId,
    triangle: u32,
    point: Vec3,
    normal: Vec3,
    uv: Vec2,
}

impl SurfacePoint {
    fn of_shape(shape: &Shape, point: Vec3) -> Self {
        let (object, normal, uv) = (shape.object, shape.normal(point), shape.uv(point));
        SurfacePoint { object, triangle: 0, point, normal, uv }
    }
}
