//! Triangles of the reflected scene halved where they are drawn too far from where they belong, and cut
//! along the reflector's shadow volume.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};

use super::rule::Rule;
use super::search::{Found, Mirror, Search};
use super::source::Source;
use crate::error::Result;
use crate::gpu::{Buffer, ComputePipeline, Device, Draw, Frame};
use crate::scene::ObjectId;
use crate::stages::{RecordMode, ReflectionRecord, View};

/// WGSL `Split` of `shaders/virtual_objects/split.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub struct SplitUniform {
    vertices: u32,
    triangles: u32,
    room: u32,
    generation: u32,
    most: u32,
    reflector: ObjectId,
    size: [u32; 2],
    tolerance: f32,
    pad_a: u32,
    pad_b: u32,
    pad_c: u32,
}

/// Pipeline and lists.
pub struct Split {
    pipeline: ComputePipeline,
    /// Triangles to look at: a generation and the next.
    generations: [Buffer; 2],
    /// Indirect arguments, then the triangles to draw.
    pub drawn: Buffer,
    /// Corners beyond the scene's vertices.
    made: u32,
    tolerance: f32,
    most: u32,
}

/// Corners that can be made: one for so many pixels of the view, a few times what half a pixel's tolerance
/// was seen to make; and so many at least, as coarse scenes need some whatever the view.
const PIXELS_A_CORNER: u32 = 2;
const LEAST_CORNERS: u32 = 1 << 16;

/// Bytes before the triangles of the longest head of a list; what is not counted there is never read.
const HEAD: u64 = 32;

/// Corners that can be made for a view of `size` pixels.
pub fn corners_made([width, height]: [u32; 2]) -> u32 {
    (width * height / PIXELS_A_CORNER).max(LEAST_CORNERS)
}

impl Split {
    /// For views of `size` pixels.
    ///
    /// # Errors
    /// [`crate::error::Error::Device`] with the numbers when a list is beyond the device's limits.
    pub fn new(
        device: &Arc<Device>,
        rule: &Rule,
        mode: RecordMode,
        source: &Source,
        size: [u32; 2],
    ) -> Result<Split> {
        let made = corners_made(size);
        // A corner made in a triangle's middle leaves three for one, any other fewer.
        let waiting = 16 + 16 * 3 * u64::from(made);
        let drawn = 32 + 16 * (u64::from(source.triangle_count) + 2 * u64::from(made));
        let file = "virtual_objects/split.wgsl";
        let generation = |name| Buffer::storage(device, name, waiting);
        Ok(Split {
            pipeline: ComputePipeline::new(device, file, &rule.defines(mode))?,
            generations: [generation("triangles to halve")?, generation("triangles halved")?],
            drawn: Buffer::storage(device, "reflected triangles drawn", drawn)?,
            made,
            tolerance: rule.split_px,
            most: if rule.split_px > 0.0 { rule.generations } else { 0 },
        })
    }

    /// Fill [`Split::drawn`] from the corners found for one reflector.
    pub fn run(
        &self,
        frame: &mut Frame,
        view: &View,
        (source, found, search): (&Source, &Found, &Search),
        mirror: &Mirror,
        record: &ReflectionRecord,
    ) -> Result<()> {
        let lists = [&self.drawn, &self.generations[0]];
        frame.pass("virtual-objects/clear").fill_first(&lists, HEAD, 0)?;
        for generation in 0..=self.most {
            let [before, after] = match generation % 2 {
                0 => [&self.generations[0], &self.generations[1]],
                _ => [&self.generations[1], &self.generations[0]],
            };
            frame.pass("virtual-objects/clear").fill_first(&[after], HEAD, 0)?;
            let split = SplitUniform {
                vertices: source.count,
                triangles: source.triangle_count,
                room: source.count + self.made,
                generation,
                most: self.most,
                reflector: mirror.object,
                size: view.size,
                tolerance: self.tolerance,
                ..Zeroable::zeroed()
            };
            let pass = frame.pass("virtual-objects/split").compute(&self.pipeline);
            let pass = search
                .bind(record.bind_counters(pass), mirror)
                .storage_struct("split", &split)
                .uniform("view_camera", &view.camera)
                .buffer("owners", &source.owners)
                .buffer("source_indices", &source.indices)
                .buffer("corners", &found.corners)
                .buffer("before", before)
                .buffer("after", after)
                .buffer("drawn", &self.drawn);
            match generation {
                0 => pass.over(source.triangle_count)?,
                _ => pass.indirect(before)?,
            }
        }
        Ok(())
    }

    /// Draw what [`Split::run`] left.
    pub fn draw(&self, draw: &mut Draw) {
        draw.vertices_indirect(&self.drawn);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::assert_layout;

    #[test]
    #[rustfmt::skip]
    fn the_uniform_is_laid_out_as_its_wgsl_twin() {
        assert_layout!("virtual_objects/split.wgsl", "Split", SplitUniform,
            vertices, triangles, room, generation, most, reflector, size, tolerance, pad_a, pad_b, pad_c);
    }
}
