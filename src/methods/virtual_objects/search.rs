//! The published search: one walk a vertex over the reflector's points and normals (section 4).

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use glam::Vec2;

use super::source::Source;
use crate::error::Result;
use crate::gpu::{Buffer, ComputePipeline, Device, Frame};
use crate::methods::Values;
use crate::scene::ObjectId;
use crate::stages::{CameraUniform, GBuffer, GpuScene, RecordMode, ReflectionRecord};

/// WGSL `Search` of `shaders/virtual_objects/search.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub struct SearchUniform {
    total: u32,
    history: u32,
    cut: u32,
    cap: u32,
    threshold: f32,
    reflector: u32,
    pad_a: u32,
    pad_b: u32,
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
    start: ComputePipeline,
    walk: ComputePipeline,
    cap: u32,
    threshold: f32,
    /// Every frame starts from the middle.
    forgets: bool,
}

/// What searches find.
pub struct Found {
    /// V' of each vertex for the reflector searched last, world.
    pub vertices: Buffer,
    /// x | y << 16 of the texel each search ended at, for one reflector after the other.
    pub texels: Buffer,
    /// Where the searches of the reflector at hand start.
    start: Buffer,
    /// Vertices of one reflector.
    count: u32,
}

/// One reflector to be searched.
pub struct Mirror<'a> {
    pub object: ObjectId,
    /// Its place among those whose texels are kept.
    pub place: usize,
    pub gbuffer: &'a GBuffer,
    /// The camera the G-buffer was drawn with.
    pub camera: &'a CameraUniform,
    /// What the frame before found is void.
    pub cut: bool,
}

impl Found {
    /// For so many vertices and reflectors.
    ///
    /// # Errors
    /// [`crate::error::Error::Device`] with the numbers when a list is beyond the device's limits.
    pub fn new(device: &Arc<Device>, count: u32, reflectors: usize) -> Result<Found> {
        let bytes = 4 * u64::from(count) * reflectors as u64;
        Ok(Found {
            vertices: Buffer::storage(device, "virtual vertices", 16 * u64::from(count))?,
            texels: Buffer::storage(device, "search texels", bytes)?,
            start: Buffer::storage(device, "search start", 16)?,
            count,
        })
    }
}

impl Search {
    pub fn new(device: &Arc<Device>, values: &Values, mode: RecordMode) -> Result<Search> {
        let mut defines = mode.defines();
        for (parameter, value, define) in [
            ("pattern", "crosshair-diagonals", "PATTERN_DIAGONALS"),
            ("pattern", "eight", "PATTERN_EIGHT"),
            ("hidden", "inverse", "HIDDEN_INVERSE"),
            ("equation", "printed", "EQUATION_PRINTED"),
        ] {
            if values.is(parameter, value) {
                defines.push((define, 1));
            }
        }
        Ok(Search {
            start: ComputePipeline::new(device, "virtual_objects/start.wgsl", &[])?,
            walk: ComputePipeline::new(device, "virtual_objects/search.wgsl", &defines)?,
            cap: values.u32("cap"),
            threshold: values.f32("threshold"),
            forgets: values.is("start", "centre"),
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
        let gbuffer = mirror.gbuffer;
        let texel = middle(scene, mirror);
        frame
            .pass("virtual-objects/start")
            .compute(&self.start)
            .uniform("middle", &MiddleUniform { texel, pad: [0; 2] })
            .sample("mirror_position", &gbuffer.position)
            .buffer("start", &found.start)
            .over(1)?;
        let search = SearchUniform {
            total: found.count,
            history: found.count * mirror.place as u32,
            cut: u32::from(mirror.cut || self.forgets),
            cap: self.cap,
            threshold: self.threshold,
            reflector: mirror.object,
            ..Zeroable::zeroed()
        };
        let pass = frame.pass("virtual-objects/search").compute(&self.walk);
        record
            .bind_counters(scene.bind(pass))
            .buffer("vertices", &source.vertices)
            .buffer("owners", &source.owners)
            .uniform("search", &search)
            .uniform("camera", mirror.camera)
            .sample("mirror_position", &gbuffer.position)
            .sample("mirror_normal", &gbuffer.normal)
            .buffer("start", &found.start)
            .buffer("texels", &found.texels)
            .buffer("virtual_vertices", &found.vertices)
            .over(found.count)
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
            total, history, cut, cap, threshold, reflector, pad_a, pad_b);
        assert_layout!("virtual_objects/start.wgsl", "Middle", MiddleUniform, texel, pad);
    }
}
