//! The truth: a Whitted ray tracer on the CPU that fills the same record as every method.
//!
//! It traces the triangles the GPU draws, with the same interpolated normals and the same shading,
//! so that what differs between its record and a method's is the method. T. Whitted, "An improved
//! illumination model for shaded display", CACM 1980.

mod cache;
mod chain;
mod frame;
mod shape;
mod surfaces;

pub use cache::Cache;
pub use chain::{Bounce, Chain};
pub use surfaces::Hit;

use crate::geometry::Ray;
use crate::scene::{Moment, ObjectId, Scene};
use surfaces::Surfaces;

/// How objects with a closed form are intersected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shapes {
    /// As the meshes the GPU draws.
    Tessellated,
    /// By their closed form, where they have one ([`crate::scene::Surface`]); their triangle is 0.
    Analytic,
}

/// What a truth is traced with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TruthOptions {
    /// Rays a pixel for the picture, stratified: one at a random place of each cell of a grid
    /// within the pixel, their number rounded up to a square; a single one goes through the pixel's
    /// centre. The record is always that of the centre.
    pub spp: u32,
    /// Longest chain of mirrors; `None` for the scene's own.
    pub bounces: Option<u32>,
    pub shapes: Shapes,
}

impl Default for TruthOptions {
    fn default() -> Self {
        TruthOptions { spp: 1, bounces: None, shapes: Shapes::Tessellated }
    }
}

/// One moment of a scene, ready to be traced.
pub struct Tracer<'s> {
    scene: &'s Scene,
    moment: Moment,
    options: TruthOptions,
    surfaces: Surfaces<'s>,
    /// Rank of each object among the scene's reflectors, for packed traces; 0 for the others.
    ranks: Vec<u32>,
}

impl<'s> Tracer<'s> {
    /// Build the trees for `moment`, a frame of `scene`.
    pub fn new(scene: &'s Scene, moment: &Moment, options: TruthOptions) -> Self {
        Tracer::among(scene, moment, options, |_| true)
    }

    /// The same where rays meet only the objects asked for.
    pub fn among(
        scene: &'s Scene,
        moment: &Moment,
        options: TruthOptions,
        met: impl Fn(ObjectId) -> bool,
    ) -> Self {
        let mut ranks = vec![0; scene.objects.len()];
        for (rank, reflector) in scene.reflectors().into_iter().enumerate() {
            ranks[reflector as usize] = rank as u32;
        }
        let surfaces = Surfaces::new(scene, moment, options.shapes, met);
        Tracer { scene, moment: moment.clone(), options, surfaces, ranks }
    }

    pub fn scene(&self) -> &'s Scene {
        self.scene
    }

    pub fn moment(&self) -> &Moment {
        &self.moment
    }

    pub fn options(&self) -> TruthOptions {
        self.options
    }

    /// Longest chain of mirrors followed.
    pub fn bounces(&self) -> u32 {
        self.options.bounces.unwrap_or(self.scene.bounces).max(1)
    }

    /// The surface seen along a ray of the camera, between its near and far plane.
    pub fn look(&self, eye_ray: &Ray) -> Option<Hit> {
        let camera = &self.moment.camera;
        let [_, _, back] = camera.axes();
        // The planes are flat, distances along the ray are not.
        let stretch = -1.0 / eye_ray.direction.dot(back);
        self.surfaces.nearest(eye_ray, [camera.near * stretch, camera.far * stretch], None)
    }

    /// The surface met by a ray from anywhere but a surface.
    pub fn first(&self, ray: &Ray) -> Option<Hit> {
        self.surfaces.nearest(ray, [0.0, f32::INFINITY], None)
    }

    /// The surface met by the ray that leaves a bounce, by the rule of [`Hit`] for a ray and the
    /// object it starts on.
    pub fn leave(&self, bounce: &Bounce) -> Option<Hit> {
        let ray = Ray { origin: bounce.hit.point, direction: bounce.outgoing };
        self.surfaces.nearest(&ray, [0.0, f32::INFINITY], Some(bounce))
    }

    /// What lies at `point` of one triangle of an object, as seen by a ray travelling along
    /// `incident`: `None` when the scene has no such triangle.
    pub fn surface_at(
        &self,
        object: ObjectId,
        triangle: u32,
        point: glam::Vec3,
        incident: glam::Vec3,
    ) -> Option<Hit> {
        self.surfaces.at(object, triangle, point, incident)
    }

    /// The weights of the second and third corner at a point that was met on a triangle.
    pub fn barycentrics(&self, hit: &Hit) -> glam::Vec2 {
        self.surfaces.barycentrics(hit.object, hit.triangle, hit.point)
    }

    /// Where on a triangle of the scene such weights are at this moment.
    pub fn point_on(
        &self,
        object: ObjectId,
        triangle: u32,
        barycentrics: glam::Vec2,
    ) -> glam::Vec3 {
        self.surfaces.point(object, triangle, barycentrics)
    }
}
