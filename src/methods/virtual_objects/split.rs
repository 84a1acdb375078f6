//! Triangles of the reflected scene halved where they are drawn too far from where they belong, and cut
//! along the reflector's shadow volume.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};

use super::edges::Edges;
use super::link::{self, Link};
use super::rule::Rule;
use super::search::{Found, Mirror, Search};
use super::source::Source;
use crate::error::Result;
use crate::gpu::{Buffer, ComputePipeline, Device, Draw, Frame, Pass};
use crate::scene::ObjectId;
use crate::stages::{GpuScene, RecordMode, ReflectionRecord, View};

/// WGSL `Split` of `shaders/virtual_objects/spans.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub struct SplitUniform {
    vertices: u32,
    triangles: u32,
    edges: u32,
    reflector: ObjectId,
    corner_room: u32,
    span_room: u32,
    generation: u32,
    most: u32,
    size: [u32; 2],
    tolerance: f32,
    pad: u32,
}

/// Pipelines and lists.
pub struct Split {
    pipelines: Pipelines,
    /// Makes the first generation where a vertex has several images.
    link: Option<Link>,
    edges: Arc<Edges>,
    /// Spans that are not the scene's edges, and what all are cut into.
    made_spans: Buffer,
    parts: Buffer,
    /// Those to measure and those to look at in a generation.
    fresh: Buffer,
    looks: Buffer,
    far_looks: Buffer,
    /// Triangles of a generation and of the next.
    triangles: [Buffer; 2],
    /// Triangles that cross the border of what is hidden.
    cuts: Buffer,
    /// Indirect arguments, then the triangles to draw.
    pub drawn: Buffer,
    /// Corners and spans beyond the scene's.
    corner_room: u32,
    span_room: u32,
    tolerance: f32,
    most: u32,
}

/// What is cut: one reflector's virtual objects.
pub struct Reflection<'a> {
    pub scene: &'a GpuScene,
    pub view: &'a View<'a>,
    pub source: &'a Source,
    pub found: &'a Found,
    pub search: &'a Search,
    pub mirror: &'a Mirror<'a>,
    pub record: &'a ReflectionRecord,
}

struct Pipelines {
    measure: ComputePipeline,
    /// From where the drawn middle has its point, and anew.
    look: [ComputePipeline; 2],
    split: ComputePipeline,
    cut: ComputePipeline,
}

/// Corners that can be made: one for so many pixels of the view, a few times what half a pixel's tolerance
/// was seen to make; and so many at least, as coarse scenes need some whatever the view.
const PIXELS_A_CORNER: u32 = 4;
const LEAST_CORNERS: u32 = 1 << 16;

/// Spans that can be made, for each corner: an edge between two triangles is cut into two, and each triangle
/// once more; and some are looked at within.
const SPANS_A_CORNER: u32 = 5;
/// Corners that a cut along the border makes.
const CUT_CORNERS: u32 = 5;

/// Bytes before the entries of the longest head of a list; what is not counted there is never read.
const HEAD: u64 = 32;

/// Corners that can be made for a view of `size` pixels.
pub fn corners_made(rule: &Rule, source: &Source, size: [u32; 2]) -> u32 {
    let [width, height] = size;
    let linked = if rule.all { link::corners_made(source.triangle_count, size) } else { 0 };
    (width * height / PIXELS_A_CORNER).max(LEAST_CORNERS) + linked
}

impl Pipelines {
    fn new(device: &Arc<Device>, defines: &[(&'static str, u32)]) -> Result<Pipelines> {
        let pipeline = |file| ComputePipeline::new(device, file, defines);
        let look = "virtual_objects/look.wgsl";
        let far = [defines, &[("FAR", 1)]].concat();
        Ok(Pipelines {
            measure: pipeline("virtual_objects/measure.wgsl")?,
            look: [pipeline(look)?, ComputePipeline::new(device, look, &far)?],
            split: pipeline("virtual_objects/split.wgsl")?,
            cut: pipeline("virtual_objects/cut.wgsl")?,
        })
    }
}

impl Split {
    /// For views of `size` pixels and so many corners made.
    ///
    /// # Errors
    /// [`crate::error::Error::Device`] with the numbers when a list is beyond the device's limits.
    pub fn new(
        device: &Arc<Device>,
        rule: &Rule,
        mode: RecordMode,
        (source, edges): (&Source, &Arc<Edges>),
        size: [u32; 2],
    ) -> Result<Split> {
        let corner_room = corners_made(rule, source, size);
        let span_room = SPANS_A_CORNER * corner_room;
        let storage = |name, words: u64| Buffer::storage(device, name, HEAD + 4 * words);
        let corners = u64::from(corner_room);
        let spans = u64::from(span_room);
        let looks = u64::from(edges.count).max(spans);
        // Two triangles are added for a corner at most, and each in two new ones in its generation.
        let triangles = |name| storage(name, 4 * 4 * corners);
        let link = || Link::new(device, rule, mode, source.triangle_count, size);
        Ok(Split {
            link: rule.all.then(link).transpose()?,
            pipelines: Pipelines::new(device, &rule.defines(mode))?,
            made_spans: storage("spans made", 3 * spans)?,
            parts: storage("spans' parts", u64::from(edges.count) + spans)?,
            fresh: storage("spans to measure", 0)?,
            looks: storage("spans to look at", looks)?,
            far_looks: storage("spans to search anew", looks)?,
            triangles: [triangles("triangles to settle")?, triangles("triangles settled")?],
            cuts: storage("triangles to cut", 8 * (corners / u64::from(CUT_CORNERS)))?,
            drawn: storage(
                "reflected triangles drawn",
                4 * (u64::from(source.triangle_count) + 2 * corners),
            )?,
            edges: edges.clone(),
            corner_room,
            span_room,
            tolerance: rule.split_px,
            most: if rule.split_px > 0.0 { rule.generations } else { 0 },
        })
    }

    /// Fill [`Split::drawn`] from the corners found for one reflector.
    pub fn run(
        &self,
        frame: &mut Frame,
        (scene, view): (&GpuScene, &View),
        (source, found, search): (&Source, &Found, &Search),
        mirror: &Mirror,
        record: &ReflectionRecord,
    ) -> Result<()> {
        let it = Reflection { scene, view, source, found, search, mirror, record };
        let mut heads = vec![&self.drawn, &self.cuts];
        // The scene's triangles are the first generation, or those that are linked the second.
        let [_, linked] = &self.triangles;
        if self.link.is_some() {
            heads.extend([&self.fresh, linked]);
        }
        frame.pass("virtual-objects/clear").fill_first(&heads, HEAD, 0)?;
        if let Some(link) = &self.link {
            link.run(frame, &it, self, linked)?;
        }
        let first = u32::from(self.link.is_some());
        for generation in first..=self.most.max(first) {
            let [before, after] = match generation % 2 {
                0 => [&self.triangles[0], &self.triangles[1]],
                _ => [&self.triangles[1], &self.triangles[0]],
            };
            let heads = [&self.looks, &self.far_looks, after];
            frame.pass("virtual-objects/clear").fill_first(&heads, HEAD, 0)?;
            if generation < self.most {
                self.look(frame, &it, generation)?;
            }
            let pass = frame.pass("virtual-objects/split").compute(&self.pipelines.split);
            let pass = self
                .bind(pass, &it, generation)
                .buffer("source_indices", &source.indices)
                .buffer("triangle_edges", &self.edges.of_triangles)
                .buffer("before", before)
                .buffer("after", after);
            match generation {
                0 => pass.over(source.triangle_count)?,
                _ => pass.indirect(before)?,
            }
        }
        let pass = frame.pass("virtual-objects/cut").compute(&self.pipelines.cut);
        self.bind(pass, &it, self.most).indirect(&self.cuts)
    }

    /// Cut the spans that are new in a generation where they err.
    fn look(&self, frame: &mut Frame, it: &Reflection, generation: u32) -> Result<()> {
        let pass = frame.pass("virtual-objects/measure").compute(&self.pipelines.measure);
        let pass = self.bind(pass, it, generation).buffer("looks", &self.looks);
        match generation {
            0 => pass.over(self.edges.count)?,
            _ => pass.indirect(&self.fresh)?,
        }
        for (pipeline, looks) in self.pipelines.look.iter().zip([&self.looks, &self.far_looks]) {
            let pass = frame.pass("virtual-objects/look").compute(pipeline);
            self.bind(pass, it, generation)
                .buffer("looks", looks)
                .buffer("far_looks", &self.far_looks)
                .optional()
                .indirect(looks)?;
        }
        Ok(())
    }

    /// Bind what passes share; each uses some.
    pub fn bind<'f>(&self, pass: Pass<'f>, it: &Reflection<'f>, generation: u32) -> Pass<'f> {
        let split = SplitUniform {
            vertices: it.source.count,
            triangles: it.source.triangle_count,
            edges: self.edges.count,
            reflector: it.mirror.object,
            corner_room: self.corner_room,
            span_room: self.span_room,
            generation,
            most: self.most,
            size: it.view.size,
            tolerance: self.tolerance,
            pad: 0,
        };
        let lists = [
            ("owners", &it.source.owners),
            ("source_edges", &self.edges.pairs),
            ("corners", &it.found.corners),
            ("made_spans", &self.made_spans),
            ("parts", &self.parts),
            ("fresh", &self.fresh),
            ("drawn", &self.drawn),
            ("cuts", &self.cuts),
        ];
        let pass = it
            .search
            .bind(it.record.bind_counters(pass), it.mirror)
            .storage_struct("split", &split)
            .optional()
            .uniform("view_camera", &it.view.camera)
            .optional();
        lists.into_iter().fold(pass, |pass, (name, list)| pass.buffer(name, list).optional())
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
            vertices, triangles, edges, reflector, corner_room, span_room, generation, most, size, tolerance, pad);
    }
}
