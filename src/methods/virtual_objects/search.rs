//! Searches: for each vertex of the scene a reflection point (section 4), and what is remembered of it.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use glam::Vec2;

use super::cube::BoundCube;
use super::pyramid::Pyramid;
use super::roots::{AllRoots, Nodes};
use super::rule::Rule;
use super::source::Source;
use crate::error::Result;
use crate::gpu::{Buffer, ComputePipeline, Device, Frame, Pass};
use crate::methods::reflected::Corner;
use crate::scene::ObjectId;
use crate::stages::{CameraUniform, GBuffer, GpuScene, RecordMode, ReflectionRecord};

/// WGSL `Search` of `shaders/virtual_objects/reflector.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub struct SearchUniform {
    total: u32,
    history: u32,
    cut: u32,
    cap: u32,
    size: [u32; 2],
    threshold: f32,
    reflector: u32,
    top: i32,
    index: f32,
    bounds_top: i32,
    pad: u32,
}

/// WGSL `Middle` of `shaders/virtual_objects/start.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub struct MiddleUniform {
    texel: [i32; 2],
    pad: [i32; 2],
}

/// Pipelines of the search and its rules.
pub struct Search {
    /// Finds the first texel, where there is no pyramid to start from.
    start: Option<ComputePipeline>,
    pyramid: Option<Pyramid>,
    /// Finds one reflection point a vertex, or all.
    vertices: Option<ComputePipeline>,
    pub all: Option<AllRoots>,
    cap: u32,
    threshold: f32,
    /// Every frame starts anew.
    forgets: bool,
}

/// What searches find.
pub struct Found {
    /// [`Corner`]s: one for each vertex, for the reflector searched last; then those made by cuts.
    pub corners: Buffer,
    /// x | y << 16 of the texel each search ended at, for one reflector after the other.
    pub texels: Buffer,
    /// Where the searches of the reflector at hand start.
    start: Buffer,
    /// All reflection points of each vertex, where they are sought.
    pub nodes: Option<Nodes>,
}

/// One reflector to be searched.
pub struct Mirror<'a> {
    pub object: ObjectId,
    /// Its place among those whose texels are kept, and how many those are of each.
    pub place: usize,
    pub vertices: u32,
    pub gbuffer: &'a GBuffer,
    /// Its cube maps, where those are searched.
    pub cube: Option<BoundCube<'a>>,
    /// The camera the G-buffer was drawn with.
    pub camera: &'a CameraUniform,
    /// What the frame before found is void.
    pub cut: bool,
    /// Refractive index behind its surface over that before it, where what is refracted is sought.
    pub index: f32,
    /// Where it is seen, if not by the eye.
    pub first: Option<First<'a>>,
}

/// The reflector that another one is seen in.
#[derive(Clone, Copy)]
pub struct First<'a> {
    /// Its points and normals, at the texels of the other's.
    pub gbuffer: &'a GBuffer,
    /// Pixels of the view that show the other in it, by object.
    pub shown_pixels: &'a Buffer,
}

impl Found {
    /// For so many vertices, so many reflectors whose texels are kept, and so many corners made beside
    /// the vertices.
    ///
    /// # Errors
    /// [`crate::error::Error::Device`] with the numbers when a list is beyond the device's limits.
    pub fn new(device: &Arc<Device>, count: u32, reflectors: usize, made: u32) -> Result<Found> {
        let bytes = (4 * u64::from(count) * reflectors as u64).max(16);
        let corners = size_of::<Corner>() as u64 * (u64::from(count) + u64::from(made));
        Ok(Found {
            corners: Buffer::storage(device, "reflected corners", corners)?,
            texels: Buffer::storage(device, "search texels", bytes)?,
            start: Buffer::storage(device, "search start", 16)?,
            nodes: None,
        })
    }
}

impl Search {
    /// For textures of `texels` texels.
    ///
    /// # Errors
    /// As of pipelines and images.
    pub fn new(
        device: &Arc<Device>,
        rule: &Rule,
        mode: RecordMode,
        texels: [u32; 2],
    ) -> Result<Search> {
        let pipeline = |file, defines| ComputePipeline::new(device, file, defines);
        let starts = rule.cube.is_none() && !rule.starts_at_pyramid && !rule.all;
        let file = "virtual_objects/search.wgsl";
        let vertices = || ComputePipeline::new(device, file, &rule.defines(mode));
        let all = || AllRoots::new(device, rule, mode, texels);
        Ok(Search {
            start: starts.then(|| pipeline("virtual_objects/start.wgsl", &[])).transpose()?,
            pyramid: rule.pyramid.then(|| Pyramid::new(device, texels)).transpose()?,
            vertices: (!rule.all).then(vertices).transpose()?,
            all: rule.all.then(all).transpose()?,
            cap: rule.cap,
            threshold: rule.threshold,
            forgets: rule.forgets,
        })
    }

    /// Find the virtual vertex of every vertex in one reflector.
    pub fn run(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        source: &Source,
        found: &Found,
        mirror: &Mirror,
        record: &ReflectionRecord,
    ) -> Result<()> {
        if let (Some(all), Some(nodes)) = (&self.all, &found.nodes) {
            return all.run(frame, scene, (source, nodes, self), mirror, record, false);
        }
        let Some(vertices) = &self.vertices else { return Ok(()) };
        if let Some(start) = &self.start {
            let texel = middle(scene, mirror);
            frame
                .pass("virtual-objects/start")
                .compute(start)
                .uniform("middle", &MiddleUniform { texel, pad: [0; 2] })
                .sample("mirror_position", &mirror.gbuffer.position)
                .buffer("start", &found.start)
                .over(1)?;
        }
        if let Some(pyramid) = &self.pyramid {
            pyramid.build(frame, mirror.gbuffer)?;
        }
        let pass = frame.pass("virtual-objects/search").compute(vertices);
        self.bind(record.bind_counters(scene.bind(pass)), mirror)
            .buffer("vertices", &source.vertices)
            .buffer("owners", &source.owners)
            .buffer("start", &found.start)
            .optional()
            .buffer("texels", &found.texels)
            .optional()
            .buffer("corners", &found.corners)
            .over(source.count)
    }

    /// Bind what searches of a reflector look at; who knows some of it needs no more.
    pub fn bind<'f>(&'f self, pass: Pass<'f>, mirror: &Mirror<'f>) -> Pass<'f> {
        let search = SearchUniform {
            total: mirror.vertices,
            history: mirror.vertices * mirror.place as u32,
            cut: u32::from(mirror.cut || self.forgets),
            cap: self.cap,
            size: mirror.gbuffer.size,
            threshold: self.threshold,
            reflector: mirror.object,
            top: self.pyramid.as_ref().map_or(0, Pyramid::top),
            index: mirror.index,
            bounds_top: self.all.as_ref().map_or(0, |all| all.bounds.top()),
            pad: 0,
        };
        let pass = pass
            .storage_struct("search", &search)
            .optional()
            .uniform("camera", mirror.camera)
            .optional()
            .sample("mirror_position", &mirror.gbuffer.position)
            .optional()
            .sample("mirror_normal", &mirror.gbuffer.normal)
            .optional();
        let pass = match &mirror.cube {
            Some(cube) => cube.bind(pass),
            None => pass,
        };
        let pass = match &self.all {
            Some(all) => all.bounds.bind(pass),
            None => pass,
        };
        let pass = match &self.pyramid {
            Some(pyramid) => pass.sample("mirror_cells", &pyramid.cells).optional(),
            None => pass,
        };
        match mirror.first {
            Some(first) => pass
                .sample("first_position", &first.gbuffer.position)
                .optional()
                .sample("first_normal", &first.gbuffer.normal)
                .optional()
                .buffer("shown_pixels", first.shown_pixels)
                .optional(),
            None => pass,
        }
    }
}

/// "The central texel of the reflector's bounding box projection", of what the texture shows of it.
fn middle(scene: &GpuScene, mirror: &Mirror) -> [i32; 2] {
    let (low, high) = scene.scene.bounds_of(scene.moment(), &[mirror.object]);
    let corner =
        |i: u32| glam::Vec3::from_array([0, 1, 2].map(|k| [low, high][(i >> k & 1) as usize][k]));
    let corners: Option<Vec<Vec2>> = (0..8).map(|i| mirror.camera.project(corner(i))).collect();
    // Where the eye stands among the corners, the whole texture.
    let corners = corners.unwrap_or_else(|| vec![Vec2::NEG_ONE, Vec2::ONE]);
    let clamped = |p: &Vec2| p.clamp(Vec2::NEG_ONE, Vec2::ONE);
    let least = corners.iter().map(clamped).fold(Vec2::ONE, Vec2::min);
    let most = corners.iter().map(clamped).fold(Vec2::NEG_ONE, Vec2::max);
    let size = Vec2::from(mirror.gbuffer.size.map(|n| n as f32));
    let texel = (0.25 * (least + most) + 0.5) * size;
    texel.min(size - 1.0).as_ivec2().to_array()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::assert_layout;

    #[test]
    #[rustfmt::skip]
    fn uniforms_are_laid_out_as_their_wgsl_twins() {
        assert_layout!("virtual_objects/search.wgsl", "Search", SearchUniform,
            total, history, cut, cap, size, threshold, reflector, top, index, bounds_top, pad);
        assert_layout!("virtual_objects/start.wgsl", "Middle", MiddleUniform, texel, pad);
    }
}
