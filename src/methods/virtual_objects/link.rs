//! Triangles of the reflected scene, once for each branch of reflection points that their corners share;
//! halved and cut where a branch ends.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};

use super::rule::Rule;
use super::split::{Reflection, Split};
use crate::error::Result;
use crate::gpu::{Buffer, ComputePipeline, Device, Frame, Pass};
use crate::stages::RecordMode;

/// Most times an edge is halved in search of where a branch ends.
const GENERATIONS: u32 = 10;

/// Nodes that can be made: one for so many pixels of the view, and so many at least.
const PIXELS_A_NODE: u32 = 4;
const LEAST_NODES: u32 = 1 << 16;

/// Invocations of a triangle: one for each edge and direction.
const SLOTS: u32 = 6;

/// Corners a triangle may take, in two branches or cut.
const CORNERS_A_TRIANGLE: u32 = 6;

/// Bytes of a list's head.
const HEAD: u64 = 16;

/// WGSL `Link` of `shaders/virtual_objects/linked.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct LinkUniform {
    vertices: u32,
    triangles: u32,
    node_room: u32,
    generation: u32,
    most: u32,
    pad: [u32; 3],
}

/// WGSL `Linked` of the same.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Linked {
    t: [u32; 4],
    joined: [u32; 6],
    pad: [u32; 2],
}

/// Nodes that can be made for a view of `size` pixels.
pub fn nodes_made([width, height]: [u32; 2]) -> u32 {
    (width * height / PIXELS_A_NODE).max(LEAST_NODES)
}

/// Corners made for a view of `size` pixels and the scene's triangles.
pub fn corners_made(triangles: u32, size: [u32; 2]) -> u32 {
    CORNERS_A_TRIANGLE * (triangles + nodes_made(size))
}

/// Pipelines and lists.
pub struct Link {
    follow: ComputePipeline,
    tear: ComputePipeline,
    halve: ComputePipeline,
    branches: ComputePipeline,
    /// Triangles of nodes to look at: a generation and the next.
    generations: [Buffer; 2],
    /// Which roots of each triangle are joined, and which of its edges torn.
    joined: Buffer,
    torn: Buffer,
    /// Triangles that are not halved any more.
    settled: Buffer,
    nodes: u32,
}

impl Link {
    /// For views of `size` pixels and a scene of so many triangles.
    ///
    /// # Errors
    /// [`crate::error::Error::Device`] with the numbers when a list is beyond the device's limits.
    pub fn new(
        device: &Arc<Device>,
        rule: &Rule,
        mode: RecordMode,
        triangles: u32,
        size: [u32; 2],
    ) -> Result<Link> {
        let nodes = nodes_made(size);
        // A node made in an edge leaves two triangles for one, three in all edges four.
        let made = 2 * u64::from(nodes);
        let most = made.max(triangles.into());
        let storage = |name, bytes| Buffer::storage(device, name, bytes);
        let pipeline = |file| ComputePipeline::new(device, file, &rule.defines(mode));
        let settled = size_of::<Linked>() as u64 * u64::from(triangles + nodes);
        Ok(Link {
            follow: pipeline("virtual_objects/follow.wgsl")?,
            tear: pipeline("virtual_objects/tear.wgsl")?,
            halve: pipeline("virtual_objects/halve.wgsl")?,
            branches: pipeline("virtual_objects/branches.wgsl")?,
            generations: [
                storage("triangles to link", HEAD + 16 * made)?,
                storage("triangles torn", HEAD + 16 * made)?,
            ],
            joined: storage("roots joined", 4 * 6 * most)?,
            torn: storage("edges torn", 4 * most)?,
            settled: storage("triangles linked", HEAD + settled)?,
            nodes,
        })
    }

    /// Fill `linked` with triangles and their spans, in the form of a generation to halve.
    pub fn run(
        &self,
        frame: &mut Frame,
        it: &Reflection,
        split: &Split,
        linked: &Buffer,
    ) -> Result<()> {
        let (Some(all), Some(nodes)) = (&it.search.all, &it.found.nodes) else { return Ok(()) };
        let heads = [&nodes.made, &self.settled];
        frame.pass("virtual-objects/clear").fill_first(&heads, HEAD, 0)?;
        frame.pass("virtual-objects/clear").fill(&[&self.torn], 0)?;
        for generation in 0..=GENERATIONS {
            let [before, after] = match generation % 2 {
                0 => [&self.generations[0], &self.generations[1]],
                _ => [&self.generations[1], &self.generations[0]],
            };
            frame.pass("virtual-objects/clear").fill_first(&[after], HEAD, 0)?;
            for (name, pipeline) in [
                ("virtual-objects/follow", &self.follow),
                ("virtual-objects/tear", &self.tear),
                ("virtual-objects/halve", &self.halve),
            ] {
                let pass = self.bind(frame.pass(name).compute(pipeline), it, generation);
                let pass = pass
                    .buffer("source_indices", &it.source.indices)
                    .buffer("before", before)
                    .buffer("after", after)
                    .optional()
                    .buffer("joined", &self.joined)
                    .buffer("torn", &self.torn)
                    .optional()
                    .buffer("settled", &self.settled)
                    .optional()
                    .buffer("nodes_made", &nodes.made)
                    .optional();
                match generation {
                    0 => pass.over_pixels([it.source.triangle_count, SLOTS])?,
                    _ => pass.indirect(before)?,
                }
            }
            if generation < GENERATIONS {
                let what = (it.source, nodes, it.search);
                all.run(frame, it.scene, what, it.mirror, it.record, true)?;
            }
        }
        let pass = frame.pass("virtual-objects/branches").compute(&self.branches);
        let pass = self.bind(split.bind(pass, it, 0), it, GENERATIONS);
        pass.buffer("settled", &self.settled).buffer("linked", linked).indirect(&self.settled)
    }

    /// Bind what all passes share.
    fn bind<'f>(&self, pass: Pass<'f>, it: &Reflection<'f>, generation: u32) -> Pass<'f> {
        let link = LinkUniform {
            vertices: it.source.count,
            triangles: it.source.triangle_count,
            node_room: it.source.count + self.nodes,
            generation,
            most: GENERATIONS,
            pad: [0; 3],
        };
        let pass = it.record.bind_counters(pass).storage_struct("link", &link).optional();
        let pass = it.search.bind(pass, it.mirror);
        match &it.found.nodes {
            Some(nodes) => pass.buffer("nodes", &nodes.list),
            None => pass,
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
        assert_layout!("virtual_objects/halve.wgsl", "Link", LinkUniform,
            vertices, triangles, node_room, generation, most, pad);
        assert_layout!("virtual_objects/branches.wgsl", "Linked", Linked,
            t, joined, pad);
    }
}
