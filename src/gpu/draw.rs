//! What a graphics pass draws, and what its attachments start from.

use ash::vk;

use super::pass::{Colour, Pass, Program};
use super::{Buffer, Frame, Image};
use crate::error::Result;

/// What an attachment holds when the pass starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Load {
    Keep,
    /// Floats; for depth the first.
    Clear([f32; 4]),
    /// Words; for stencil the first.
    ClearWords([u32; 4]),
}

impl Load {
    fn op(self) -> vk::AttachmentLoadOp {
        if self == Load::Keep { vk::AttachmentLoadOp::LOAD } else { vk::AttachmentLoadOp::CLEAR }
    }

    pub(super) fn colour(self) -> vk::ClearColorValue {
        match self {
            Load::Keep => vk::ClearColorValue::default(),
            Load::Clear(float32) => vk::ClearColorValue { float32 },
            Load::ClearWords(uint32) => vk::ClearColorValue { uint32 },
        }
    }

    fn depth_stencil(depth: Load, stencil: Load) -> vk::ClearDepthStencilValue {
        let depth = if let Load::Clear([d, ..]) = depth { d } else { 0.0 };
        let stencil = if let Load::ClearWords([s, ..]) = stencil { s } else { 0 };
        vk::ClearDepthStencilValue { depth, stencil }
    }
}

impl Pass<'_> {
    /// Draw into the attachments.
    pub fn draw(self, draws: impl FnOnce(&mut Draw<'_>)) -> Result<()> {
        let mut draws = Some(draws);
        self.draw_layers(1, |draw| {
            if let Some(draws) = draws.take() {
                draws(draw);
            }
        })
    }

    /// Draw into so many layers of the attachments, one after the other, from the first each was
    /// given on; a shader's `var<immediate>` of one word counts them from 0.
    ///
    /// Multiview would do this in one go, but clipped triangles land in layer 0 with it on
    /// lavapipe (Mesa 22.3).
    pub fn draw_layers(self, layers: u32, mut draws: impl FnMut(&mut Draw<'_>)) -> Result<()> {
        let Program::Graphics(pipeline) = self.program else {
            return Err(self.wrong("no graphics pipeline to draw with"));
        };
        let first = self.colours.first().map(|colour| colour.image.size);
        let Some(size) = first.or(self.depth_stencil.map(|(image, ..)| image.size)) else {
            return Err(self.wrong("nothing to draw into"));
        };
        let owner = &pipeline.owner;
        self.record(Some((owner, vk::PipelineBindPoint::GRAPHICS)), |pass| {
            for layer in 0..layers {
                pass.begin_rendering(size, layer);
                if owner.layout.has_immediate {
                    let (raw, commands) = (&pass.frame.device.raw, pass.frame.commands);
                    let word = layer.to_ne_bytes();
                    // SAFETY: recording; the layout has this range.
                    unsafe {
                        raw.cmd_push_constants(
                            commands,
                            owner.layout.raw,
                            owner.layout.stages,
                            0,
                            &word,
                        );
                    }
                }
                draws(&mut Draw { frame: &mut *pass.frame });
                let frame = &pass.frame;
                // SAFETY: rendering was begun just above.
                unsafe { frame.device.raw.cmd_end_rendering(frame.commands) };
            }
            Ok(())
        })
    }

    fn begin_rendering(&self, size: [u32; 2], layer: u32) {
        let attachment = |image: &Image, layer: u32, load: Load, value| {
            vk::RenderingAttachmentInfo::default()
                .image_view(image.attachment_view(layer))
                .image_layout(vk::ImageLayout::GENERAL)
                .load_op(load.op())
                .store_op(vk::AttachmentStoreOp::STORE)
                .clear_value(value)
        };
        let colours: Vec<_> = self
            .colours
            .iter()
            .map(|&Colour { image, first, load, .. }| {
                attachment(image, first + layer, load, vk::ClearValue { color: load.colour() })
            })
            .collect();
        let depth_stencil = self.depth_stencil.map(|(image, depth, stencil)| {
            let value = Load::depth_stencil(depth, stencil);
            let value = vk::ClearValue { depth_stencil: value };
            (attachment(image, layer, depth, value), attachment(image, layer, stencil, value))
        });
        let extent = vk::Extent2D { width: size[0], height: size[1] };
        let area = vk::Rect2D { offset: vk::Offset2D::default(), extent };
        let mut info = vk::RenderingInfo::default()
            .render_area(area)
            .layer_count(1)
            .color_attachments(&colours);
        if let Some((depth, stencil)) = &depth_stencil {
            info = info.depth_attachment(depth).stencil_attachment(stencil);
        }
        let viewport = vk::Viewport {
            x: 0.0,
            y: 0.0,
            width: size[0] as f32,
            height: size[1] as f32,
            min_depth: 0.0,
            max_depth: 1.0,
        };
        let (raw, commands) = (&self.frame.device.raw, self.frame.commands);
        // SAFETY: recording; attachments are kept by the frame and have the pipeline's formats,
        // which validation checks; `info` and what it points to live until the call returns.
        unsafe {
            raw.cmd_begin_rendering(commands, &info);
            raw.cmd_set_viewport(commands, 0, &[viewport]);
            raw.cmd_set_scissor(commands, 0, &[area]);
            raw.cmd_set_stencil_reference(commands, vk::StencilFaceFlags::FRONT_AND_BACK, 0);
        }
    }
}

/// Draws inside a graphics pass.
pub struct Draw<'a> {
    frame: &'a mut Frame,
}

impl Draw<'_> {
    /// What the stencil test compares with, or marks.
    pub fn stencil_reference(&mut self, reference: u32) {
        let both = vk::StencilFaceFlags::FRONT_AND_BACK;
        let raw = &self.frame.device.raw;
        // SAFETY: recording inside a rendering scope.
        unsafe { raw.cmd_set_stencil_reference(self.frame.commands, both, reference) };
    }

    /// Triangles of a buffer of 32-bit indices; shaders see `instance` as the instance index.
    pub fn indexed(&mut self, indices: &Buffer, first: u32, count: u32, instance: u32) {
        self.frame.keep(indices.owner.clone());
        let (raw, commands) = (&self.frame.device.raw, self.frame.commands);
        // SAFETY: recording inside a rendering scope; the caller's range lies in the kept buffer,
        // which validation checks.
        unsafe {
            raw.cmd_bind_index_buffer(commands, indices.raw, 0, vk::IndexType::UINT32);
            raw.cmd_draw_indexed(commands, count, 1, first, 0, instance);
        }
    }

    /// Vertices the shader makes itself from the vertex index.
    pub fn vertices(&mut self, count: u32) {
        let (raw, commands) = (&self.frame.device.raw, self.frame.commands);
        // SAFETY: recording inside a rendering scope.
        unsafe { raw.cmd_draw(commands, count, 1, 0, 0) };
    }

    /// Vertices the shader makes itself, as many as four words at the start of `arguments` say: vertices,
    /// instances, the first of each.
    pub fn vertices_indirect(&mut self, arguments: &Buffer) {
        self.frame.keep(arguments.owner.clone());
        let (raw, commands) = (&self.frame.device.raw, self.frame.commands);
        // SAFETY: recording inside a rendering scope; the kept buffer holds at least 16 bytes.
        unsafe { raw.cmd_draw_indirect(commands, arguments.raw, 0, 1, 0) };
    }
}
