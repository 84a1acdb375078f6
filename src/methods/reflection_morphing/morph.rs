//! MORPH_VERTEX (Martin & Popescu 2004, section 6) on the device: eight look-ups a vertex, interpolated.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};

use super::grid;
use super::nodes::{Node, Nodes};
use crate::error::Result;
use crate::gpu::{Buffer, ComputePipeline, Device, Frame, Pass};
use crate::methods::reflected::Corner;
use crate::methods::source::{Lists, Source};
use crate::scene::{Ids, ObjectId, Scene};
use crate::stages::{GpuScene, RecordMode, ReflectionRecord, View};

/// WGSL `Octree` of `shaders/reflection_morphing/octree.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct OctreeStruct {
    low: [f32; 3],
    trace: u32,
    high: [f32; 3],
    segments: u32,
}

/// WGSL `LookUp` of `shaders/reflection_morphing/look_up.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct LookUpStruct {
    total: u32,
    first: u32,
    reflector: ObjectId,
    pad: u32,
}

/// WGSL `Morph` of `shaders/reflection_morphing/morph.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct MorphStruct {
    weights: [f32; 8],
    total: u32,
    reflector: ObjectId,
    pad_a: u32,
    pad_b: u32,
}

/// Places of vertices in the source.
struct Places {
    buffer: Buffer,
    count: u32,
}

/// What is looked up, and what was found.
pub struct Vertices {
    /// Of objects that stand still, and of those that move at any time.
    still: Places,
    moving: Places,
    /// Of each reflector: for each location, and each vertex, where it is seen.
    points: Vec<Buffer>,
    /// [`Corner`]s for the reflector morphed last.
    pub corners: Buffer,
}

/// The reflector at hand.
pub struct Mirror {
    pub object: ObjectId,
    /// Among those of [`Vertices::points`].
    pub place: usize,
    /// Among the scene's reflectors.
    pub rank: u32,
}

/// Pipelines.
pub struct Morph {
    look_up: ComputePipeline,
    morph: ComputePipeline,
}

impl Vertices {
    /// # Errors
    /// [`crate::error::Error::Device`] with the numbers when a list is beyond the device's limits.
    pub fn new(
        device: &Arc<Device>,
        scene: &Scene,
        lists: &Lists,
        reflectors: usize,
    ) -> Result<Vertices> {
        let places = |moves: bool| {
            let owners = (0..).zip(&lists.owners);
            let chosen = owners.filter(|(_, owner)| scene.is_moving(**owner) == moves);
            let places: Vec<u32> = chosen.map(|(place, _)| place).collect();
            let buffer = Buffer::with_data(device, "morphed vertices", &places)?;
            Ok(Places { buffer, count: places.len() as u32 })
        };
        let count = lists.owners.len() as u64;
        let points = || Buffer::storage(device, "points seen", 8 * 16 * count);
        let corners = size_of::<Corner>() as u64 * count;
        Ok(Vertices {
            still: places(false)?,
            moving: places(true)?,
            points: (0..reflectors).map(|_| points()).collect::<Result<_>>()?,
            corners: Buffer::storage(device, "morphed corners", corners)?,
        })
    }
}

impl Morph {
    pub fn new(device: &Arc<Device>, mode: RecordMode, brute_force: bool) -> Result<Morph> {
        let mut defines = mode.defines();
        let morph = ComputePipeline::new(device, "reflection_morphing/morph.wgsl", &defines)?;
        if brute_force {
            defines.push(("BRUTE_FORCE", 1));
        }
        let look_up = ComputePipeline::new(device, "reflection_morphing/look_up.wgsl", &defines)?;
        Ok(Morph { look_up, morph })
    }

    /// Look up all that moves, and what stands still in octrees that were not asked yet.
    pub fn look_up(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        (source, vertices): (&Source, &Vertices),
        nodes: &Nodes,
        mirror: &Mirror,
        record: &ReflectionRecord,
    ) -> Result<()> {
        for (slot, node) in nodes.slots.iter().enumerate() {
            let Some(node) = node else { continue };
            let first = slot as u32 * source.count;
            let mut ask = |name, places: &Places| {
                let look_up =
                    LookUpStruct { total: places.count, first, reflector: mirror.object, pad: 0 };
                let pass = frame.pass(name).compute(&self.look_up);
                let pass = record.bind_counters(scene.bind(pass));
                node.bind(pass, mirror)
                    .storage_struct("look_up", &look_up)
                    .buffer("vertices", &source.vertices)
                    .buffer("owners", &source.owners)
                    .buffer("asked", &places.buffer)
                    .buffer("points", &vertices.points[mirror.place])
                    .over(places.count)
            };
            if !node.is_asked && vertices.still.count > 0 {
                ask("reflection-morphing/look-up-still", &vertices.still)?;
            }
            if vertices.moving.count > 0 {
                ask("reflection-morphing/look-up-moving", &vertices.moving)?;
            }
        }
        Ok(())
    }

    /// Interpolate what was looked up, into [`Vertices::corners`].
    pub fn run(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        (source, vertices): (&Source, &Vertices),
        corners: &[grid::Corner; 8],
        mirror: &Mirror,
        (view, record): (&View, &ReflectionRecord),
    ) -> Result<()> {
        let morph = MorphStruct {
            weights: corners.map(|corner| corner.weight),
            total: source.count,
            reflector: mirror.object,
            pad_a: 0,
            pad_b: 0,
        };
        let pass = frame.pass("reflection-morphing/morph").compute(&self.morph);
        record
            .bind_counters(scene.bind(pass))
            .storage_struct("morph", &morph)
            .uniform("camera", &view.camera)
            .buffer("vertices", &source.vertices)
            .buffer("owners", &source.owners)
            .buffer("points", &vertices.points[mirror.place])
            .buffer("corners", &vertices.corners)
            .over(source.count)
    }
}

impl Node {
    /// Bind it, to be asked for rays that met one reflector.
    fn bind<'f>(&self, pass: Pass<'f>, mirror: &Mirror) -> Pass<'f> {
        let octree = OctreeStruct {
            low: self.extent.low.to_array(),
            trace: Ids::extended(0, 0, mirror.rank),
            high: self.extent.high.to_array(),
            segments: self.segment_count,
        };
        pass.storage_struct("octree", &octree)
            .buffer("cells", &self.cells)
            .optional()
            .buffer("starts", &self.starts)
            .optional()
            .buffer("lists", &self.lists)
            .optional()
            .buffer("segments", &self.segments)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::ray_octree::RaySegment;
    use crate::gpu::layout::assert_layout;

    #[test]
    #[rustfmt::skip]
    fn structs_are_laid_out_as_their_wgsl_twins() {
        assert_layout!("reflection_morphing/look_up.wgsl", "Octree", OctreeStruct, low, trace, high, segments);
        assert_layout!("reflection_morphing/look_up.wgsl", "RaySegment", RaySegment, start, trace, end, texel);
        assert_layout!("reflection_morphing/look_up.wgsl", "LookUp", LookUpStruct, total, first, reflector, pad);
        assert_layout!("reflection_morphing/morph.wgsl", "Morph", MorphStruct,
            weights, total, reflector, pad_a, pad_b);
    }
}
