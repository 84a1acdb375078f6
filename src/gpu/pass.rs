//! A pass: a pipeline and what it binds by name. How much of it runs is in `dispatch` and `draw`;
//! `acceleration` has the builds.

use std::sync::Arc;

use ash::vk;

use super::draw::Load;
use super::pipeline::{Owner, descriptor_type};
use super::{
    Acceleration, BindingKind, Buffer, ComputePipeline, Frame, GraphicsPipeline, Image, Sampler,
    Slice,
};
use crate::error::{Error, Result};

enum Resource<'f> {
    /// `level`: the mip level written, `None` where the image is only read.
    Image {
        image: &'f Image,
        level: Option<u32>,
    },
    Slice(Slice),
    Sampler(Sampler),
    Structure(vk::AccelerationStructureKHR),
}

/// The Vulkan description of one binding: the part its kind asks for, the rest empty.
#[derive(Default)]
struct Description {
    buffer: [vk::DescriptorBufferInfo; 1],
    image: [vk::DescriptorImageInfo; 1],
    structure: [vk::AccelerationStructureKHR; 1],
}

struct Bound<'f> {
    name: &'static str,
    resource: Resource<'f>,
    /// Left out silently where the shader does not use it.
    offered: bool,
    uniform: bool,
}

/// The pipeline of a pass.
pub(super) enum Program<'f> {
    None,
    Compute(&'f ComputePipeline),
    Graphics(&'f GraphicsPipeline),
}

/// A colour attachment: its dump's name, the image, the first layer drawn into.
pub(super) struct Colour<'f> {
    name: &'static str,
    pub image: &'f Image,
    pub first: u32,
    pub load: Load,
}

/// A pass being put together. `over`, `over_pixels`, `indirect`, `draw`, `clear`, `fill`, `build`
/// and `place` record it; errors met on the way come out there.
#[must_use = "a pass records nothing until over, draw, clear or another of its ends is called"]
pub struct Pass<'f> {
    pub(super) frame: &'f mut Frame,
    name: String,
    pub(super) program: Program<'f>,
    bound: Vec<Bound<'f>>,
    pub(super) colours: Vec<Colour<'f>>,
    pub(super) depth_stencil: Option<(&'f Image, Load, Load)>,
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
    pub fn colour(self, name: &'static str, image: &'f Image, load: Load) -> Self {
        self.colour_from(name, image, 0, load)
    }

    /// The next colour attachment, drawn into from a layer on.
    pub fn colour_from(
        mut self,
        name: &'static str,
        image: &'f Image,
        first: u32,
        load: Load,
    ) -> Self {
        self.colours.push(Colour { name, image, first, load });
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
        self.bind(name, Resource::Image { image, level: None })
    }

    /// A storage image the pass writes; of one with mip levels, the largest.
    pub fn store(self, name: &'static str, image: &'f Image) -> Self {
        self.store_level(name, image, 0)
    }

    /// One mip level of a storage image the pass writes. Dumps show level 0 alone.
    pub fn store_level(self, name: &'static str, image: &'f Image, level: u32) -> Self {
        self.bind(name, Resource::Image { image, level: Some(level) })
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

    /// What ray queries search: a WGSL `acceleration_structure`.
    pub fn acceleration(mut self, name: &'static str, structure: &Acceleration) -> Self {
        match structure.placed() {
            Ok(levels) => {
                let top = levels.top();
                self.frame.keep(levels);
                self.bind(name, Resource::Structure(top))
            }
            Err(what) => {
                self.error = self.error.take().or(Some(self.wrong(what)));
                self
            }
        }
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

    /// A struct as read-only storage. For a struct that loops depend on: lavapipe (Mesa 22.3) copies such
    /// uniforms into the shader it compiles, and crashes over some.
    pub fn storage_struct<T: bytemuck::Pod>(mut self, name: &'static str, value: &T) -> Self {
        match self.frame.upload(std::slice::from_ref(value)) {
            Ok(slice) => self.slice(name, slice),
            Err(e) => {
                self.error = self.error.or(Some(e));
                self
            }
        }
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
    pub(super) fn wrong(&self, what: impl std::fmt::Display) -> Error {
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
        let mut descriptions = Vec::with_capacity(wanted.len());
        for binding in wanted {
            let Some(bound) = self.bound.iter().rev().find(|b| b.name == binding.name) else {
                return Err(self.wrong(format_args!("`{}` is not bound", binding.name)));
            };
            descriptions.push(self.describe(bound, binding.kind)?);
        }
        let mut structures: Vec<_> = descriptions
            .iter()
            .map(|d| {
                vk::WriteDescriptorSetAccelerationStructureKHR::default()
                    .acceleration_structures(&d.structure)
            })
            .collect();
        let writes: Vec<_> = wanted
            .iter()
            .zip(&descriptions)
            .zip(&mut structures)
            .map(|((binding, description), structure)| {
                let kind = descriptor_type(binding.kind);
                let write = vk::WriteDescriptorSet::default()
                    .dst_binding(binding.number)
                    .descriptor_type(kind);
                match binding.kind {
                    BindingKind::Uniform { .. } | BindingKind::Buffer { .. } => {
                        write.buffer_info(&description.buffer)
                    }
                    BindingKind::Acceleration => write.descriptor_count(1).push_next(structure),
                    _ => write.image_info(&description.image),
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

    fn describe(&self, bound: &Bound<'f>, kind: BindingKind) -> Result<Description> {
        let mut description = Description::default();
        let Description { buffer: [buffer], image: [image], structure: [structure] } =
            &mut description;
        match (&bound.resource, kind) {
            (Resource::Slice(slice), BindingKind::Uniform { bytes }) if bound.uniform => {
                if slice.bytes != bytes {
                    return Err(self.wrong(format_args!(
                        "uniform `{}` is {} bytes in Rust and {bytes} in WGSL",
                        bound.name, slice.bytes
                    )));
                }
                *buffer = slice.descriptor();
            }
            (Resource::Slice(slice), BindingKind::Buffer { .. }) if !bound.uniform => {
                *buffer = slice.descriptor();
            }
            (
                &Resource::Image { image: i, level },
                BindingKind::Texture { .. } | BindingKind::Storage { .. },
            ) => {
                let view = i.bound_view(kind, level.unwrap_or(0)).map_err(|e| self.wrong(e))?;
                *image = image.image_view(view).image_layout(vk::ImageLayout::GENERAL);
            }
            (&Resource::Sampler(sampler), BindingKind::Sampler) => {
                *image = image.sampler(self.frame.device.sampler(sampler));
            }
            (&Resource::Structure(raw), BindingKind::Acceleration) => *structure = raw,
            _ => {
                return Err(self.wrong(format_args!(
                    "`{}` is bound as something else than {kind:?}",
                    bound.name
                )));
            }
        }
        Ok(description)
    }

    /// Record the pass between label and timestamps, then copy out what is to be dumped.
    pub(super) fn record(
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
        for image in self.colours.iter().map(|colour| colour.image).chain(depth_stencil) {
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
        for bound in &self.bound {
            match &bound.resource {
                Resource::Image { image, level: Some(0) } => {
                    self.frame.dump_image(&self.name, bound.name, image)?;
                }
                Resource::Slice(slice) => self.frame.dump_buffer(&self.name, bound.name, slice)?,
                _ => {}
            }
        }
        for Colour { name, image, .. } in &self.colours {
            self.frame.dump_image(&self.name, name, image)?;
        }
        Ok(())
    }
}
