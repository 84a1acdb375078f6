//! Drawing what was found for one reflector into its pixels, or into those that show it in another.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};

use super::rule::Rule;
use super::search::Found;
use super::second::Shown;
use super::source::Source;
use super::split::Split;
use crate::error::Result;
use crate::gpu::{Attachments, Depth, Device, Frame, GraphicsPipeline, Load, Stencil};
use crate::scene::ObjectId;
use crate::stages::{Footprint, GpuScene, RecordMode, ReflectionRecord, View};

/// WGSL `Reflected` of `shaders/virtual_objects/reflected.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct ReflectedUniform {
    reflector: ObjectId,
    vertices: u32,
    residual: f32,
    first: ObjectId,
}

/// The pipeline.
pub struct Drawing {
    pipeline: GraphicsPipeline,
    residual_px: f32,
}

/// What is drawn.
#[derive(Clone, Copy)]
pub struct Reflected<'a> {
    pub source: &'a Source,
    pub found: &'a Found,
    pub split: Option<&'a Split>,
    /// In what.
    pub reflector: ObjectId,
    /// The reflector that shows that one, where it is not the eye that sees it.
    pub first: Option<(ObjectId, &'a Shown)>,
}

impl Drawing {
    /// # Errors
    /// As of pipelines.
    pub fn new(device: &Arc<Device>, rule: &Rule, mode: RecordMode) -> Result<Drawing> {
        let attachments = Attachments {
            colours: mode.formats(),
            depth_stencil: true,
            depth: Depth::Nearest,
            stencil: Stencil::Within,
        };
        let file = "virtual_objects/reflected.wgsl";
        let pipeline = GraphicsPipeline::new(device, file, &rule.defines(mode), &attachments)?;
        Ok(Drawing { pipeline, residual_px: rule.residual_px })
    }

    pub fn run(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        view: &View,
        record: &ReflectionRecord,
        what: Reflected,
    ) -> Result<()> {
        let Reflected { source, found, split, reflector, first } = what;
        let seen_first = first.map_or(reflector, |(object, _)| object);
        let reflected = ReflectedUniform {
            reflector,
            vertices: source.count,
            residual: self.residual_px,
            first: seen_first,
        };
        let pass = frame.pass("virtual-objects/reflected").graphics(&self.pipeline);
        let mut pass = record
            .attach(view.bind(scene.bind(pass)))
            .uniform("reflected", &reflected)
            .buffer("vertices", &source.vertices)
            .buffer("corners", &found.corners)
            .buffer("source_triangles", &source.triangles)
            .buffer("first_triangles", &source.first_triangles)
            .optional();
        if let Some(split) = split {
            pass = pass
                .buffer("owners", &source.owners)
                .buffer("source_indices", &source.indices)
                .buffer("drawn", &split.drawn);
        }
        if let Some((_, shown)) = first {
            pass = shown.bind(pass);
        }
        pass.depth_stencil(&view.footprint.depth_stencil, Load::Clear([0.0; 4]), Load::Keep).draw(
            |draw| {
                draw.stencil_reference(Footprint::stencil_of(seen_first));
                match split {
                    Some(split) => split.draw(draw),
                    None => source.draw(draw, reflector),
                }
            },
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::assert_layout;

    #[test]
    #[rustfmt::skip]
    fn the_uniform_is_laid_out_as_its_wgsl_twin() {
        assert_layout!("virtual_objects/reflected.wgsl", "Reflected", ReflectedUniform,
            reflector, vertices, residual, first);
    }
}
