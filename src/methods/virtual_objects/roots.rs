//! Every reflection point of every vertex: mirrors that are hollow or saddles show one point at several
//! places, which the paper leaves open (Estalella et al. 2006, section 7).

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};

use super::bounds::Bounds;
use super::rule::Rule;
use super::search::{Mirror, Search};
use super::source::Source;
use crate::error::Result;
use crate::gpu::{Buffer, ComputePipeline, Device, Frame};
use crate::stages::{GpuScene, RecordMode, ReflectionRecord};

/// Most reflection points that are kept of one vertex.
pub const MOST_ROOTS: usize = 8;

/// Passes over the vertices: in each a search looks at some 2000 cells at most.
const ROUNDS: u32 = 8;

/// WGSL `Node` of `shaders/virtual_objects/node.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub struct Node {
    pub position: [f32; 3],
    pub number: u32,
    /// Place in texels, the law's determinant as a share, 0.
    pub roots: [[f32; 4]; MOST_ROOTS],
    /// Where the search goes on.
    pub cursor: [u32; 4],
}

/// WGSL `Sought` of `shaders/virtual_objects/roots.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct SoughtUniform {
    first: u32,
    of_scene: u32,
    round: u32,
    last: u32,
}

/// The search and its pyramid.
pub struct AllRoots {
    pub bounds: Bounds,
    pipeline: ComputePipeline,
}

/// Points whose reflections are sought, and what was found.
pub struct Nodes {
    /// [`Node`]s: the scene's vertices, then those made on edges.
    pub list: Buffer,
    /// Indirect arguments for those made, then how many.
    pub made: Buffer,
}

impl Nodes {
    /// For so many vertices and so many points made.
    ///
    /// # Errors
    /// [`crate::error::Error::Device`] with the numbers when a list is beyond the device's limits.
    pub fn new(device: &Arc<Device>, vertices: u32, made: u32) -> Result<Nodes> {
        let bytes = size_of::<Node>() as u64 * (u64::from(vertices) + u64::from(made));
        Ok(Nodes {
            list: Buffer::storage(device, "reflected nodes", bytes)?,
            made: Buffer::storage(device, "reflected nodes made", 32)?,
        })
    }
}

impl AllRoots {
    /// For textures of `texels` texels.
    ///
    /// # Errors
    /// As of pipelines and images.
    pub fn new(
        device: &Arc<Device>,
        rule: &Rule,
        mode: RecordMode,
        texels: [u32; 2],
    ) -> Result<Self> {
        let file = "virtual_objects/roots.wgsl";
        Ok(AllRoots {
            bounds: Bounds::new(device, texels)?,
            pipeline: ComputePipeline::new(device, file, &rule.defines(mode))?,
        })
    }

    /// Find the roots of the scene's vertices, or of all nodes made since.
    pub fn run(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        (source, nodes, search): (&Source, &Nodes, &Search),
        mirror: &Mirror,
        record: &ReflectionRecord,
        made: bool,
    ) -> Result<()> {
        if !made {
            self.bounds.build(frame, mirror.gbuffer)?;
        }
        for round in 0..ROUNDS {
            let first = if made { source.count } else { 0 };
            let last = ROUNDS - 1;
            let sought = SoughtUniform { first, of_scene: u32::from(!made), round, last };
            let pass = frame.pass("virtual-objects/roots").compute(&self.pipeline);
            let pass = search
                .bind(record.bind_counters(scene.bind(pass)), mirror)
                .storage_struct("sought", &sought)
                .buffer("vertices", &source.vertices)
                .buffer("owners", &source.owners)
                .buffer("nodes", &nodes.list)
                .buffer("nodes_made", &nodes.made);
            if made { pass.indirect(&nodes.made)? } else { pass.over(source.count)? }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::assert_layout;

    #[test]
    #[rustfmt::skip]
    fn structs_are_laid_out_as_their_wgsl_twins() {
        assert_layout!("virtual_objects/roots.wgsl", "Node", Node,
            position, number, roots, cursor);
        assert_layout!("virtual_objects/roots.wgsl", "Sought", SoughtUniform,
            first, of_scene, round, last);
    }
}
