//! Rays of one reflector as the eye sees it, and the cells that list them or others: what a node's ray map and
//! octree are, made on the device in every frame.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use crate::error::Result;
use crate::geometry::ray_octree::Extent;
use crate::gpu::{Buffer, ComputePipeline, Device, Format, Frame, Pass};
use crate::scene::{Lobe, ObjectId};
use crate::stages::{CameraUniform, GBuffer, GpuScene, RecordMode, ReflectionRecord};

/// WGSL `Bins` of `shaders/reflection_morphing/eye_bins.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub struct BinsStruct {
    low: [f32; 3],
    size: u32,
    high: [f32; 3],
    side: u32,
    centre: [f32; 3],
    half: f32,
    levels: u32,
    room: u32,
    pub reflector: ObjectId,
    lobe: u32,
}

/// WGSL `EyeRay`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub struct RayStruct {
    origin: [f32; 3],
    kind: u32,
    direction: [f32; 3],
    length: f32,
}

/// WGSL `Sheaf`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct SheafStruct {
    low: [f32; 3],
    rays: u32,
    high: [f32; 3],
    length: f32,
    low_slope: [f32; 3],
    pad_a: u32,
    high_slope: [f32; 3],
    pad_b: u32,
}

/// Cells along a side of each cube.
const SIDE: u32 = 16;
/// Most cubes: a block of cells each invocation of the last sum adds up.
const MOST_LEVELS: u32 = 7;
/// WGSL `SHEAF`: bundles along a side of what cells list.
const SHEAF: u32 = 4;
/// WGSL `BLOCK`.
const BLOCK: u32 = 1024;

/// Entries that lists have room for, where the device allows it: forty times as many a sheaf as were seen before a
/// sphere, as hollow mirrors have their rays cross; and so many at least, as few rays are wide apart.
const ENTRIES_A_SHEAF: u64 = 2048;
const LEAST_ENTRIES: u64 = 1 << 20;

/// Pipelines and lists.
pub struct Bins {
    rays_of: ComputePipeline,
    count: ComputePipeline,
    sum: [ComputePipeline; 2],
    fill: ComputePipeline,
    gbuffer: GBuffer,
    /// [`RayStruct`], one of each texel.
    pub rays: Buffer,
    sheaves: Buffer,
    counts: Buffer,
    /// Where each cell's list begins, within its block and for each block.
    starts: Buffer,
    blocks: Buffer,
    lists: Buffer,
    /// Entries that there is room for.
    room: u32,
    /// Texels a side.
    pub size: u32,
    /// What all rays are clipped with.
    extent: Extent,
}

/// What rays are wanted of.
pub struct Mirror {
    pub object: ObjectId,
    pub lobe: Lobe,
}

impl Bins {
    /// For textures of `size` x `size` texels.
    ///
    /// # Errors
    /// As of pipelines, images and lists.
    pub fn new(device: &Arc<Device>, mode: RecordMode, size: u32, extent: Extent) -> Result<Bins> {
        let pipeline = |file: &str, define: Option<&'static str>| {
            let mut defines = mode.defines();
            defines.extend(define.map(|define| (define, 1)));
            ComputePipeline::new(device, &format!("reflection_morphing/{file}.wgsl"), &defines)
        };
        let texels = u64::from(size) * u64::from(size);
        let words = |name, words: u64| Buffer::storage(device, name, 4 * words);
        let sheaves = u64::from((size - 1).div_ceil(SHEAF).pow(2));
        let room = (ENTRIES_A_SHEAF * sheaves).max(LEAST_ENTRIES).min(device.storage_limit() / 4);
        // One block more, so that every list ends where another begins.
        let cells = u64::from(MOST_LEVELS * SIDE.pow(3) + BLOCK);
        Ok(Bins {
            rays_of: pipeline("eye_rays", None)?,
            count: pipeline("eye_list", None)?,
            sum: [pipeline("eye_sum", None)?, pipeline("eye_sum", Some("BLOCKS"))?],
            fill: pipeline("eye_list", Some("FILL"))?,
            gbuffer: GBuffer::new(device, [size; 2], Format::Rgba32Float)?,
            rays: Buffer::storage(device, "eye's rays", size_of::<RayStruct>() as u64 * texels)?,
            sheaves: Buffer::storage(device, "sheaves", size_of::<SheafStruct>() as u64 * sheaves)?,
            counts: words("bundles of cells", cells)?,
            starts: words("cells' lists", cells)?,
            blocks: words("blocks' lists", 256)?,
            lists: words("bundles listed", room)?,
            room: room as u32,
            size,
            extent,
        })
    }

    /// Trace the rays of a reflector that a camera sees, which has these points.
    pub fn trace(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        view: &CameraUniform,
        (bins, points): (&BinsStruct, &[Vec3]),
    ) -> Result<()> {
        let camera = view.fitted(points).unwrap_or_else(|| view.widened(2.0));
        self.gbuffer.draw(frame, scene, "reflection-morphing", bins.reflector, &camera)?;
        let pass = frame.pass("reflection-morphing/rays").compute(&self.rays_of);
        scene
            .bind(pass)
            .storage_struct("bins", bins)
            .uniform("camera", &camera)
            .sample("mirror_position", &self.gbuffer.position)
            .sample("mirror_normal", &self.gbuffer.normal)
            .buffer("rays", &self.rays)
            .over_pixels([self.size; 2])
    }

    /// Have cells list rays, one of each texel.
    pub fn list(
        &self,
        frame: &mut Frame,
        bins: &BinsStruct,
        rays: &Buffer,
        record: &ReflectionRecord,
    ) -> Result<()> {
        frame.pass("reflection-morphing/clear").fill(&[&self.counts], 0)?;
        let pass = frame.pass("reflection-morphing/count").compute(&self.count);
        let count = pass.storage_struct("bins", bins).buffer("rays", rays);
        let sheaves = (self.size - 1).div_ceil(SHEAF).pow(2);
        count.buffer("sheaves", &self.sheaves).buffer("counts", &self.counts).over(sheaves)?;
        let cells = bins.levels * SIDE.pow(3) + BLOCK;
        for (sum, invocations) in self.sum.iter().zip([cells / 4, 1]) {
            let pass = frame.pass("reflection-morphing/sum").compute(sum);
            let pass = record.bind_counters(pass).storage_struct("bins", bins).optional();
            let pass = pass.buffer("counts", &self.counts).optional();
            let pass = pass.buffer("starts", &self.starts).optional();
            pass.buffer("blocks", &self.blocks).over(invocations)?;
        }
        let pass = frame.pass("reflection-morphing/fill").compute(&self.fill);
        let pass = pass.storage_struct("bins", bins).buffer("counts", &self.counts);
        self.bind(pass).over(sheaves)
    }

    /// Bind what lists hold.
    pub fn bind<'f>(&self, pass: Pass<'f>) -> Pass<'f> {
        let lists = [
            ("sheaves", &self.sheaves),
            ("starts", &self.starts),
            ("blocks", &self.blocks),
            ("lists", &self.lists),
        ];
        lists.into_iter().fold(pass, |pass, (name, list)| pass.buffer(name, list).optional())
    }

    /// Cubes about the points of a reflector, the last of which holds the scene.
    pub fn cubes(&self, points: &[Vec3], mirror: &Mirror) -> BinsStruct {
        let (low, high) = points
            .iter()
            .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(a, b), p| (a.min(*p), b.max(*p)));
        let centre = 0.5 * (low + high);
        let farthest = (self.extent.high - centre).max(centre - self.extent.low).max_element();
        let own = (0.5 * (high - low)).max_element();
        let half = own.max(farthest / (1 << (MOST_LEVELS - 1)) as f32).max(f32::MIN_POSITIVE);
        let levels = 1 + (farthest / half).log2().ceil().max(0.0) as u32;
        BinsStruct {
            low: self.extent.low.to_array(),
            size: self.size,
            high: self.extent.high.to_array(),
            side: SIDE,
            centre: centre.to_array(),
            half,
            levels: levels.min(MOST_LEVELS),
            room: self.room,
            reflector: mirror.object,
            lobe: mirror.lobe as u32,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::assert_layout;

    #[test]
    #[rustfmt::skip]
    fn structs_are_laid_out_as_their_wgsl_twins() {
        assert_layout!("reflection_morphing/eye_list.wgsl", "Bins", BinsStruct,
            low, size, high, side, centre, half, levels, room, reflector, lobe);
        assert_layout!("reflection_morphing/eye_list.wgsl", "EyeRay", RayStruct, origin, kind, direction, length);
        assert_layout!("reflection_morphing/eye_list.wgsl", "Sheaf", SheafStruct,
            low, rays, high, length, low_slope, pad_a, high_slope, pad_b);
    }
}
