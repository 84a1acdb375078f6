//! MORPH_VERTEX (Martin & Popescu 2004, section 6) on the device: eight look-ups a vertex, interpolated.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::sync::Arc;

use bytemuck::{Pod, Zeroable};

use super::grid;
use super::nodes::{Node, Nodes};
use super::trace::Trace;
use crate::error::Result;
use crate::gpu::{Buffer, ComputePipeline, Defines, Device, Frame, Pass};
use crate::methods::reflected::Corner;
use crate::methods::source::{Lists, Source};
use crate::scene::{ObjectId, Scene};
use crate::stages::{CameraUniform, GpuScene, ReflectionRecord};

/// Rays of a trace that are looked through one by one where leaves beside a vertex's own are searched: most leaves
/// hold none of a rare trace, so nearly all of them would be opened.
const MOST_SCANNED: usize = 512;

/// WGSL `Octree` of `shaders/reflection_morphing/octree.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct OctreeStruct {
    low: [f32; 3],
    trace: u32,
    high: [f32; 3],
    segments: u32,
    map: u32,
    first: u32,
    end: u32,
    scan: u32,
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
    order: u32,
    pad: u32,
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
    /// Of each trace met so far: for each location, and each vertex, where it is seen.
    pub points: BTreeMap<u32, Buffer>,
    /// [`Corner`]s for the trace morphed last.
    pub corners: Buffer,
}

/// Pipelines.
pub struct Morph {
    look_up: ComputePipeline,
    morph: ComputePipeline,
}

impl Vertices {
    /// # Errors
    /// [`crate::error::Error::Device`] with the numbers when a list is beyond the device's limits.
    pub fn new(device: &Arc<Device>, scene: &Scene, lists: &Lists) -> Result<Vertices> {
        let places = |moves: bool| {
            let owners = (0..).zip(&lists.owners);
            let chosen = owners.filter(|(_, owner)| scene.is_moving(**owner) == moves);
            let places: Vec<u32> = chosen.map(|(place, _)| place).collect();
            let buffer = Buffer::with_data(device, "morphed vertices", &places)?;
            Ok(Places { buffer, count: places.len() as u32 })
        };
        let count = lists.owners.len() as u64;
        let corners = size_of::<Corner>() as u64 * count;
        Ok(Vertices {
            still: places(false)?,
            moving: places(true)?,
            points: BTreeMap::new(),
            corners: Buffer::storage(device, "morphed corners", corners)?,
        })
    }

    /// Have room for what is seen by a trace of so many vertices.
    fn make_room(&mut self, device: &Arc<Device>, trace: Trace, count: u32) -> Result<()> {
        if let Entry::Vacant(room) = self.points.entry(trace.packed) {
            room.insert(Buffer::storage(device, "points seen", 8 * 16 * u64::from(count))?);
        }
        Ok(())
    }
}

impl Morph {
    /// `defines` say how to look up and how to weigh, and what is recorded.
    pub fn new(device: &Arc<Device>, defines: Defines) -> Result<Morph> {
        let pipeline = |file| ComputePipeline::new(device, file, defines);
        Ok(Morph {
            look_up: pipeline("reflection_morphing/look_up.wgsl")?,
            morph: pipeline("reflection_morphing/morph.wgsl")?,
        })
    }

    /// Look up by one trace all that moves, and what stands still in octrees that were not asked yet.
    pub fn look_up(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        (source, vertices): (&Source, &mut Vertices),
        nodes: &mut Nodes,
        trace: Trace,
        record: &ReflectionRecord,
    ) -> Result<()> {
        vertices.make_room(&frame.device().clone(), trace, source.count)?;
        let map = nodes.map();
        for (slot, node) in nodes.slots.iter_mut().enumerate() {
            let Some(node) = node else { continue };
            let first = slot as u32 * source.count;
            let mut ask = |name, places: &Places| {
                let look_up =
                    LookUpStruct { total: places.count, first, reflector: trace.last, pad: 0 };
                let pass = frame.pass(name).compute(&self.look_up);
                let pass = record.bind_counters(scene.bind(pass));
                node.bind(pass, trace, map)
                    .storage_struct("look_up", &look_up)
                    .buffer("vertices", &source.vertices)
                    .buffer("owners", &source.owners)
                    .buffer("asked", &places.buffer)
                    .buffer("points", &vertices.points[&trace.packed])
                    .over(places.count)
            };
            if !node.asked.contains(&trace.packed) && vertices.still.count > 0 {
                ask("reflection-morphing/look-up-still", &vertices.still)?;
            }
            if vertices.moving.count > 0 {
                ask("reflection-morphing/look-up-moving", &vertices.moving)?;
            }
            node.asked.insert(trace.packed);
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
        trace: Trace,
        (camera, record): (&CameraUniform, &ReflectionRecord),
    ) -> Result<()> {
        let morph = MorphStruct {
            weights: corners.map(|corner| corner.weight),
            total: source.count,
            reflector: trace.last,
            order: trace.order,
            pad: 0,
        };
        let pass = frame.pass("reflection-morphing/morph").compute(&self.morph);
        record
            .bind_counters(scene.bind(pass))
            .storage_struct("morph", &morph)
            .uniform("camera", camera)
            .buffer("vertices", &source.vertices)
            .buffer("owners", &source.owners)
            .buffer("points", &vertices.points[&trace.packed])
            .buffer("corners", &vertices.corners)
            .over(source.count)
    }
}

impl Node {
    /// Bind it, with maps whose faces are `map` texels wide, to be asked for rays of one trace.
    fn bind<'f>(&self, pass: Pass<'f>, trace: Trace, map: u32) -> Pass<'f> {
        let rays = self.rays_of(trace.packed);
        let octree = OctreeStruct {
            low: self.extent.low.to_array(),
            trace: trace.packed,
            high: self.extent.high.to_array(),
            segments: self.segment_count,
            map,
            first: rays.start,
            end: rays.end,
            scan: u32::from(rays.len() <= MOST_SCANNED),
        };
        pass.storage_struct("octree", &octree)
            .buffer("cells", &self.cells)
            .optional()
            .buffer("starts", &self.starts)
            .optional()
            .buffer("lists", &self.lists)
            .optional()
            .buffer("segments", &self.segments)
            .buffer("ray_map", &self.map)
            .optional()
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
        assert_layout!("reflection_morphing/look_up.wgsl", "Octree", OctreeStruct,
            low, trace, high, segments, map, first, end, scan);
        assert_layout!("reflection_morphing/look_up.wgsl", "RaySegment", RaySegment, start, trace, end, texel);
        assert_layout!("reflection_morphing/look_up.wgsl", "LookUp", LookUpStruct, total, first, reflector, pad);
        assert_layout!("reflection_morphing/morph.wgsl", "Morph", MorphStruct,
            weights, total, reflector, order, pad);
    }
}
