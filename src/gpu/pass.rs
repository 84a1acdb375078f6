//! A pass: a pipeline, what it binds by name, and how much of it to run.

use std::sync::Arc;

use ash::vk;

use super::pipeline::{Owner, descriptor_type};
use super::{BindingKind, Buffer, ComputePipeline, Frame, GraphicsPipeline, Image, Sampler, Slice};
use crate::error::{Error, Result};

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

    fn colour(self) -> vk::ClearColorValue {
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

enum Resource<'f> {
    Image { image: &'f Image, written: bool },
    Slice(Slice),
    Sampler(Sampler),
}

struct Bound<'f> {
    name: &'static str,
    resource: Resource<'f>,
    /// Left out silently where the shader does not use it.
    offered: bool,
    uniform: bool,
}

/// The pipeline of a pass.
enum Program<'f> {
    None,
    Compute(&'f ComputePipeline),
    Graphics(&'f GraphicsPipeline),
}

/// A pass being put together. `over`, `over_pixels`, `indirect`, `draw` and `clear` record it;
/// errors met on the way come out there.
#[must_use = "a pass records nothing until over, over_pixels, indirect, draw or clear is called"]
pub struct Pass<'f> {
    frame: &'f mut Frame,
    name: String,
    program: Program<'f>,
    bound: Vec<Bound<'f>>,
    colours: Vec<(&'static str, &'f Image, Load)>,
    depth_stencil: Option<(&'f Image, Load, Load)>,
    error: Option<Error>,
}

impl<'f> Pass<'f> {
    pub(super) fn new(frame: &'f mut Frame, name: &str) -> Self {
        Pass {
            frame,
            name: name.to_owned(),
            program: Program::None,
            bound: Vec::new(),
            colours: Vec::new(),
            depth_stencil: None,
            error: None,
        }
    }

    /// Run a compute shader.
    pub fn compute(mut self, pipeline: &'f ComputePipeline) -> Self {
        self.program = Program::Compute(pipeline);
        self
    }

    /// Draw triangles.
    pub fn graphics(mut self, pipeline: &'f GraphicsPipeline) -> Self {
        self.program = Program::Graphics(pipeline);
        self
    }

    /// The next colour attachment; `name` is its dump's.
    pub fn colour(mut self, name: &'static str, image: &'f Image, load: Load) -> Self {
        self.colours.push((name, image, load));
        self
    }

    /// The depth and stencil attachment.
    pub fn depth_stencil(mut self, image: &'f Image, depth: Load, stencil: Load) -> Self {
        self.depth_stencil = Some((image, depth, stencil));
        self
    }

    fn bind(mut self, name: &'static str, resource: Resource<'f>) -> Self {
        self.bound.push(Bound { name, resource, offered: false, uniform: false });
        self
    }

    /// A texture.
    pub fn sample(self, name: &'static str, image: &'f Image) -> Self {
        self.bind(name, Resource::Image { image, written: false })
    }

    /// A storage image the pass writes.
    pub fn store(self, name: &'static str, image: &'f Image) -> Self {
        self.bind(name, Resource::Image { image, written: true })
    }

    pub fn buffer(self, name: &'static str, buffer: &Buffer) -> Self {
        self.frame.keep(buffer.owner.clone());
        self.bind(name, Resource::Slice(buffer.whole()))
    }

    /// Something uploaded for this frame.
    pub fn slice(self, name: &'static str, slice: Slice) -> Self {
        self.bind(name, Resource::Slice(slice))
    }

    pub fn sampler(self, name: &'static str, sampler: Sampler) -> Self {
        self.bind(name, Resource::Sampler(sampler))
    }

    /// A uniform struct; its size must be the WGSL struct's.
    pub fn uniform<T: bytemuck::Pod>(mut self, name: &'static str, value: &T) -> Self {
        match self.frame.upload(std::slice::from_ref(value)) {
            Ok(mut slice) => {
                slice.bytes = size_of::<T>() as u64;
                self.bound.push(Bound {
                    name,
                    resource: Resource::Slice(slice),
                    offered: false,
                    uniform: true,
                });
            }
            Err(e) => self.error = self.error.or(Some(e)),
        }
        self
    }

    /// The binding added last is bound only where the shader has the variable: for groups of
    /// variables (the scene, the record) of which a shader uses some.
    pub fn optional(mut self) -> Self {
        if let Some(last) = self.bound.last_mut() {
            last.offered = true;
        }
        self
    }

    /// An error that names the pass.
    fn wrong(&self, what: impl std::fmt::Display) -> Error {
        Error::Shader(format!("pass `{}`: {what}", self.name))
    }

    /// Push the descriptors the pipeline wants, by name.
    fn push(&mut self, owner: &Owner, point: vk::PipelineBindPoint) -> Result<()> {
        if let Some(error) = self.error.take() {
            return Err(error);
        }
        let wanted = &owner.layout.bindings;
        let unknown =
            self.bound.iter().find(|b| !b.offered && !wanted.iter().any(|w| w.name == b.name));
        if let Some(unknown) = unknown {
            let names: Vec<_> = wanted.iter().map(|w| w.name.as_str()).collect();
            let list = names.join(", ");
            return Err(self.wrong(format_args!(
                "the shader has no variable `{}`; it has: {list}",
                unknown.name
            )));
        }
        let mut buffers = Vec::with_capacity(wanted.len());
        let mut images = Vec::with_capacity(wanted.len());
        for binding in wanted {
            let Some(bound) = self.bound.iter().rev().find(|b| b.name == binding.name) else {
                return Err(self.wrong(format_args!("`{}` is not bound", binding.name)));
            };
            let (buffer, image) = self.descriptor(bound, binding.kind)?;
            buffers.push([buffer]);
            images.push([image]);
        }
        let writes: Vec<_> = wanted
            .iter()
            .zip(&buffers)
            .zip(&images)
            .map(|((binding, buffer), image)| {
                let kind = descriptor_type(binding.kind);
                let write = vk::WriteDescriptorSet::default()
                    .dst_binding(binding.number)
                    .descriptor_type(kind);
                match binding.kind {
                    BindingKind::Uniform { .. } | BindingKind::Buffer { .. } => {
                        write.buffer_info(buffer)
                    }
                    _ => write.image_info(image),
                }
            })
            .collect();
        let device = &self.frame.device;
        let commands = self.frame.commands;
        // SAFETY: recording; the layout is the pipeline's, and every resource is alive: slices
        // belong to the frame, images and buffers are kept by it.
        unsafe {
            device.raw.cmd_bind_pipeline(commands, point, owner.raw);
            device.push_descriptor.cmd_push_descriptor_set(
                commands,
                point,
                owner.layout.raw,
                0,
                &writes,
            );
        }
        Ok(())
    }

    /// The Vulkan description of one binding; the half that does not apply stays empty.
    fn descriptor(
        &self,
        bound: &Bound<'f>,
        kind: BindingKind,
    ) -> Result<(vk::DescriptorBufferInfo, vk::DescriptorImageInfo)> {
        let mut buffer = vk::DescriptorBufferInfo::default();
        let mut image = vk::DescriptorImageInfo::default();
        match (&bound.resource, kind) {
            (Resource::Slice(slice), BindingKind::Uniform { bytes }) if bound.uniform => {
                if slice.bytes != bytes {
                    return Err(self.wrong(format_args!(
                        "uniform `{}` is {} bytes in Rust and {bytes} in WGSL",
                        bound.name, slice.bytes
                    )));
                }
                buffer = buffer.buffer(slice.buffer).offset(slice.offset).range(slice.bytes);
            }
            (Resource::Slice(slice), BindingKind::Buffer { .. }) if !bound.uniform => {
                buffer = buffer.buffer(slice.buffer).offset(slice.offset).range(slice.bytes);
            }
            (
                &Resource::Image { image: i, .. },
                BindingKind::Texture { .. } | BindingKind::Storage { .. },
            ) => {
                let view = i.bound_view(kind).map_err(|e| self.wrong(e))?;
                image = image.image_view(view).image_layout(vk::ImageLayout::GENERAL);
            }
            (&Resource::Sampler(sampler), BindingKind::Sampler) => {
                image = image.sampler(self.frame.device.sampler(sampler));
            }
            _ => {
                return Err(self.wrong(format_args!(
                    "`{}` is bound as something else than {kind:?}",
                    bound.name
                )));
            }
        }
        Ok((buffer, image))
    }

    /// Record the pass between label and timestamps, then copy out what is to be dumped.
    fn record(
        mut self,
        program: Option<(&Arc<Owner>, vk::PipelineBindPoint)>,
        work: impl FnOnce(&mut Self) -> Result<()>,
    ) -> Result<()> {
        for bound in &self.bound {
            if let Resource::Image { image, .. } = bound.resource {
                self.frame.keep(image.owner.clone());
            }
        }
        let depth_stencil = self.depth_stencil.iter().map(|(image, ..)| *image);
        for image in self.colours.iter().map(|(_, image, _)| *image).chain(depth_stencil) {
            self.frame.keep(image.owner.clone());
        }
        self.frame.begin_label(&self.name);
        self.frame.profiler.begin(self.frame.commands, &self.name)?;
        if let Some((owner, point)) = program {
            self.frame.keep(owner.clone());
            self.push(owner, point)?;
        }
        work(&mut self)?;
        self.frame.profiler.end(self.frame.commands);
        self.frame.end_label();
        if !self.frame.wants_dump(&self.name) {
            return Ok(());
        }
        for bound in &self.bound {
            if let Resource::Image { image, written: true } = bound.resource {
                self.frame.dump(&self.name, bound.name, image)?;
            }
        }
        for (name, image, _) in &self.colours {
            self.frame.dump(&self.name, name, image)?;
        }
        Ok(())
    }

    /// Run at least `count` invocations in one dimension; the shader checks the excess.
    pub fn over(self, count: u32) -> Result<()> {
        self.dispatch([count, 1])
    }

    /// Run at least one invocation a pixel; the shader checks the excess.
    pub fn over_pixels(self, size: [u32; 2]) -> Result<()> {
        self.dispatch(size)
    }

    fn dispatch(self, extent: [u32; 2]) -> Result<()> {
        let pipeline = self.compute_pipeline()?;
        let [x, y, _] = pipeline.workgroup;
        let groups = [extent[0].div_ceil(x), extent[1].div_ceil(y)];
        self.record(Some((&pipeline.owner, vk::PipelineBindPoint::COMPUTE)), |pass| {
            let frame = &pass.frame;
            // SAFETY: recording, with pipeline and descriptors bound by `record`.
            unsafe { frame.device.raw.cmd_dispatch(frame.commands, groups[0], groups[1], 1) };
            Ok(())
        })
    }

    /// Run as many workgroups as three words at the start of `arguments` say.
    pub fn indirect(self, arguments: &Buffer) -> Result<()> {
        let pipeline = self.compute_pipeline()?;
        self.frame.keep(arguments.owner.clone());
        self.record(Some((&pipeline.owner, vk::PipelineBindPoint::COMPUTE)), |pass| {
            let frame = &pass.frame;
            // SAFETY: as in `dispatch`; the buffer is kept and holds at least 16 bytes.
            unsafe { frame.device.raw.cmd_dispatch_indirect(frame.commands, arguments.raw, 0) };
            Ok(())
        })
    }

    fn compute_pipeline(&self) -> Result<&'f ComputePipeline> {
        match self.program {
            Program::Compute(pipeline) => Ok(pipeline),
            _ => Err(self.wrong("no compute pipeline to dispatch")),
        }
    }

    /// Fill images, each with one value; names are their dumps'.
    pub fn clear(mut self, images: &[(&'static str, &'f Image, Load)]) -> Result<()> {
        for &(name, image, _) in images {
            self = self.store(name, image);
        }
        self.record(None, |pass| {
            let frame = &pass.frame;
            for (_, image, load) in images {
                // SAFETY: recording; the image is kept, its format takes clears of this kind.
                unsafe {
                    frame.device.raw.cmd_clear_color_image(
                        frame.commands,
                        image.owner.raw,
                        vk::ImageLayout::GENERAL,
                        &load.colour(),
                        &[image.range()],
                    );
                }
            }
            Ok(())
        })
    }

    /// Fill buffers with one word.
    pub fn fill(self, buffers: &[&Buffer], word: u32) -> Result<()> {
        self.record(None, |pass| {
            for buffer in buffers {
                pass.frame.keep(buffer.owner.clone());
                let (raw, commands) = (&pass.frame.device.raw, pass.frame.commands);
                // SAFETY: recording; the buffer is kept.
                unsafe { raw.cmd_fill_buffer(commands, buffer.raw, 0, vk::WHOLE_SIZE, word) };
            }
            Ok(())
        })
    }

    /// Draw into the attachments.
    pub fn draw(self, draws: impl FnOnce(&mut Draw<'_>)) -> Result<()> {
        let Program::Graphics(pipeline) = self.program else {
            return Err(self.wrong("no graphics pipeline to draw with"));
        };
        let first = self.colours.first().map(|(_, image, _)| image.size);
        let Some(size) = first.or(self.depth_stencil.map(|(image, ..)| image.size)) else {
            return Err(self.wrong("nothing to draw into"));
        };
        self.record(Some((&pipeline.owner, vk::PipelineBindPoint::GRAPHICS)), |pass| {
            pass.begin_rendering(size, pipeline.views);
            draws(&mut Draw { frame: &mut *pass.frame });
            let frame = &pass.frame;
            // SAFETY: rendering was begun just above.
            unsafe { frame.device.raw.cmd_end_rendering(frame.commands) };
            Ok(())
        })
    }

    fn begin_rendering(&self, size: [u32; 2], views: u32) {
        let attachment = |image: &Image, load: Load, value| {
            vk::RenderingAttachmentInfo::default()
                .image_view(image.attachment_view())
                .image_layout(vk::ImageLayout::GENERAL)
                .load_op(load.op())
                .store_op(vk::AttachmentStoreOp::STORE)
                .clear_value(value)
        };
        let colours: Vec<_> = self
            .colours
            .iter()
            .map(|&(_, i, load)| attachment(i, load, vk::ClearValue { color: load.colour() }))
            .collect();
        let depth_stencil = self.depth_stencil.map(|(image, depth, stencil)| {
            let value = Load::depth_stencil(depth, stencil);
            let value = vk::ClearValue { depth_stencil: value };
            (attachment(image, depth, value), attachment(image, stencil, value))
        });
        let extent = vk::Extent2D { width: size[0], height: size[1] };
        let area = vk::Rect2D { offset: vk::Offset2D::default(), extent };
        let mut info = vk::RenderingInfo::default()
            .render_area(area)
            .layer_count(1)
            .view_mask(views)
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
}
