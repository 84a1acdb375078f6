//! Reflection morphing without its preprocess (`nodes=eye`): one sampling location, the eye itself, its rays made
//! on the device in every frame. Nothing is left to interpolate between, nothing is kept, and reflectors may
//! move: "it might also be extended to allow moving reflectors" (Martin & Popescu 2004, section 9).
//!
//! The first hit is drawn: a texture of the reflector's points and normals gives a ray a texel. Four neighbours are
//! a bundle, and a vertex is projected by the bundle it lies in, between its rays: an octree's nearest ray is
//! constant from ray to ray, which shows as steps. Cells list the bundles that cross them; which of a cell's
//! bundles is taken does not depend on the list's order, so a frame is the same bit for bit whatever the order
//! in which the device fills lists.
//!
//! Choices of ours: cells are those of cubes about the reflector, each twice the size of the last, since rays part
//! as they go; the eye's own rays that just miss the reflector take part, so that bundles reach to the border of
//! what it hides, where light only grazes it; bundles across a jump in depth are left out; of several bundles
//! that hold a vertex (hollow mirrors) the one that is turned over least often before it is taken, and of those
//! the one of the shortest path. Every vertex is shown once: where a reflector shows things twice, as a bowl does
//! that is seen from outside and within, triangles between its images cover both.
//!
//! Glass: "if the ray octrees contained refracted rays instead of reflected rays, it would be possible to render
//! curved refractive surfaces quickly and correctly" (section 9). They do, of its first surface: what lies behind it
//! is taken to be within it, as under water.
//!
//! More than one reflector: see `further`.

mod bins;
mod further;
#[cfg(test)]
mod tests;

use crate::error::{Error, Result};
use crate::geometry::ray_octree::Extent;
use crate::gpu::{Buffer, ComputePipeline, Frame};
use crate::methods::reflected::{Corner, Reflected};
use crate::methods::source::{Lists, Source};
use crate::methods::{ReflectionMethod, Setup, Want};
use crate::scene::Lobe;
use crate::stages::{CameraUniform, GpuScene, MirroredEnvironment, ReflectionRecord, View};

use super::orders::Drawing;
use super::trace::Trace;
use bins::{Bins, BinsStruct, Mirror};
use further::Further;

pub struct EyeNode {
    /// Longest edge of diffuse meshes, metres; 0 as modelled.
    edge: f32,
    bins: Bins,
    environment: MirroredEnvironment,
    project: ComputePipeline,
    reflected: Reflected,
    /// Draws what glass lets through, where there is any.
    refracted: Option<Reflected>,
    /// Of chains of more than one reflector, where there can be any.
    further: Option<Further>,
    /// What is reflected, and the [`Corner`]s found for the trace at hand; made by the first `prepare`.
    state: Option<(Source, Buffer)>,
}

impl EyeNode {
    /// `extent`: what rays are clipped with.
    ///
    /// # Errors
    /// As of pipelines, images and lists; [`Error::Usage`] for traces that are not kept apart.
    pub fn new(setup: &Setup, extent: Extent) -> Result<EyeNode> {
        let &Setup { device, mode, values, .. } = setup;
        if values.is("traces", "mixed") {
            return Err(Error::Usage(
                "reflection-morphing:nodes=eye,traces=mixed: rays of one bundle are of one trace, and with \
                 nodes=eye no others are looked up; valid: traces=apart, or nodes=grid"
                    .to_owned(),
            ));
        }
        let defines = look_up_defines(setup);
        let project =
            ComputePipeline::new(device, "reflection_morphing/eye_project.wgsl", &defines)?;
        let drawing = |lobe: &[(&'static str, u32)]| {
            let defines = [&mode.defines()[..], &[("TWO_SIDED", 1)], lobe].concat();
            Reflected::new(device, mode, &defines, 0.0)
        };
        let scene = &setup.scene.scene;
        let goes_on = values.u32("bounces") > 1 && scene.reflectors().len() > 1;
        Ok(EyeNode {
            edge: values.f32("subdivide"),
            bins: Bins::new(device, mode, values.u32("map"), extent)?,
            environment: MirroredEnvironment::new(device, mode)?,
            project,
            reflected: drawing(&[])?,
            refracted: scene.refracts().then(|| drawing(&[("REFRACTED", 1)])).transpose()?,
            further: goes_on.then(|| Further::new(setup, &defines)).transpose()?,
            state: None,
        })
    }

    /// Find where a reflector shows each vertex, by its rays.
    fn project(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        (camera, record): (&CameraUniform, &ReflectionRecord),
        bins: &BinsStruct,
        (source, corners): (&Source, &Buffer),
    ) -> Result<()> {
        let pass = frame.pass("reflection-morphing/project").compute(&self.project);
        let pass = record.bind_counters(scene.bind(pass)).storage_struct("bins", bins);
        self.bins
            .bind(pass)
            .buffer("rays", &self.bins.rays)
            .uniform("camera", camera)
            .buffer("vertices", &source.vertices)
            .buffer("owners", &source.owners)
            .buffer("corners", corners)
            .over(source.count)
    }

    /// Trace and list the rays of a reflector that the eye sees, and find where it shows each vertex by them.
    fn find(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        to: (&CameraUniform, &ReflectionRecord),
        mirror: &Mirror,
        found: (&Source, &Buffer),
    ) -> Result<()> {
        let points = scene.scene.closed_points_of(scene.moment(), mirror.object);
        let bins = self.bins.cubes(&points, mirror);
        self.bins.trace(frame, scene, to.0, (&bins, &points))?;
        self.bins.list(frame, &bins, &self.bins.rays, to.1)?;
        self.project(frame, scene, to, &bins, found)
    }
}

/// How vertices are looked up.
fn look_up_defines(setup: &Setup) -> Vec<(&'static str, u32)> {
    let mut defines = setup.mode.defines();
    if setup.values.is("lookup", "brute-force") {
        defines.push(("BRUTE_FORCE", 1));
    }
    defines
}

impl ReflectionMethod for EyeNode {
    fn prepare(&mut self, frame: &mut Frame, scene: &GpuScene, _: &Want) -> Result<()> {
        if self.state.is_none() {
            let device = frame.device().clone();
            let edge = self.edge;
            let lists =
                frame.cpu("reflection-morphing/subdivide", || Lists::new(&scene.scene, edge))?;
            let source = lists.upload(&device)?;
            let bytes = size_of::<Corner>() as u64 * u64::from(source.count.max(1));
            self.state = Some((source, Buffer::storage(&device, "projected corners", bytes)?));
        }
        match &mut self.further {
            Some(further) => further.prepare(frame, scene),
            None => Ok(()),
        }
    }

    fn reflect(
        &mut self,
        frame: &mut Frame,
        scene: &GpuScene,
        view: &View,
        record: &mut ReflectionRecord,
    ) -> Result<()> {
        let Some((source, corners)) = &self.state else { return Ok(()) };
        let drawing = match (view.lobe, &self.refracted) {
            (Lobe::Reflected, _) => &self.reflected,
            (Lobe::Refracted, Some(refracted)) => refracted,
            (Lobe::Refracted, None) => return Ok(()),
        };
        source.pose(frame, scene, "reflection-morphing")?;
        self.environment.fill(frame, scene, "reflection-morphing", view, record)?;
        let record = &*record;
        for &object in view.reflectors {
            let mirror = Mirror { object, lobe: view.lobe };
            let drawn = (source, corners);
            self.find(frame, scene, (&view.camera, record), &mirror, drawn)?;
            let name = "reflection-morphing";
            drawing.draw(frame, scene, name, (view, record), object, drawn)?;
            if let (Lobe::Reflected, Some(further)) = (view.lobe, &self.further) {
                let to = Drawing { view, record, source, corners };
                further.run(frame, scene, &self.bins, to, Trace::of(&scene.scene, object))?;
            }
        }
        Ok(())
    }
}
