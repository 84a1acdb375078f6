//! The reflected scene of forward methods, drawn through a reflector's stencil.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};

use super::source::Source;
use crate::error::Result;
use crate::gpu::{
    Attachments, Buffer, Defines, Depth, Device, Frame, GraphicsPipeline, Load, Pass, Stencil,
};
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

/// WGSL `Corner` of `shaders/virtual_objects/corner.wgsl`: a vertex and where a reflector shows it.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub struct Corner {
    pub position: [f32; 3],
    pub pad: u32,
    pub image: [f32; 3],
    /// Texel found, in halves: x | y << 14 | status << 28.
    pub found: u32,
}

/// Pipeline of the draw.
pub struct Reflected {
    pipeline: GraphicsPipeline,
    residual_px: f32,
}

impl Reflected {
    /// `residual_px`: pixels a fragment may break the law of reflection by before it is flagged; 0: none is.
    ///
    /// # Errors
    /// As of pipelines.
    pub fn new(
        device: &Arc<Device>,
        mode: RecordMode,
        defines: Defines,
        residual_px: f32,
    ) -> Result<Reflected> {
        let attachments = Attachments {
            colours: mode.formats(),
            depth_stencil: true,
            depth: Depth::Nearest,
            stencil: Stencil::Within,
        };
        let file = "virtual_objects/reflected.wgsl";
        let pipeline = GraphicsPipeline::new(device, file, defines, &attachments)?;
        Ok(Reflected { pipeline, residual_px })
    }

    /// The pass that draws what one reflector shows, its [`Corner`]s found, into the record of a view: into
    /// the pixels of `first`, which is that reflector or one that shows it, to be drawn with the stencil of
    /// `first`. `name` begins the pass's name.
    pub fn pass<'f>(
        &'f self,
        frame: &'f mut Frame,
        scene: &GpuScene,
        name: &str,
        (view, record): (&'f View, &'f ReflectionRecord),
        (reflector, first): (ObjectId, ObjectId),
        (source, corners): (&Source, &Buffer),
    ) -> Pass<'f> {
        let reflected = ReflectedUniform {
            reflector,
            vertices: source.count,
            residual: self.residual_px,
            first,
        };
        let pass = frame.pass(&format!("{name}/reflected")).graphics(&self.pipeline);
        record
            .attach(view.bind(scene.bind(pass)))
            .uniform("reflected", &reflected)
            .buffer("vertices", &source.vertices)
            .buffer("corners", corners)
            .buffer("source_triangles", &source.triangles)
            .buffer("first_triangles", &source.first_triangles)
            .optional()
            .buffer("source_indices", &source.indices)
            .optional()
            .depth_stencil(&view.footprint.depth_stencil, Load::Clear([0.0; 4]), Load::Keep)
    }

    /// Draw all of the source but `reflector` as that shows it, into its own pixels.
    pub fn draw(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        name: &str,
        to: (&View, &ReflectionRecord),
        reflector: ObjectId,
        (source, corners): (&Source, &Buffer),
    ) -> Result<()> {
        let mirrors = (reflector, reflector);
        self.pass(frame, scene, name, to, mirrors, (source, corners)).draw(|draw| {
            draw.stencil_reference(Footprint::stencil_of(reflector));
            source.draw(draw, reflector);
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::assert_layout;

    #[test]
    #[rustfmt::skip]
    fn structs_are_laid_out_as_their_wgsl_twins() {
        assert_layout!("virtual_objects/reflected.wgsl", "Reflected", ReflectedUniform,
            reflector, vertices, residual, first);
        assert_layout!("virtual_objects/reflected.wgsl", "Corner", Corner, position, pad, image, found);
    }
}
