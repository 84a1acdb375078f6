//! Images: always in the GENERAL layout, usable as attachment, storage image and texture.

use std::sync::Arc;

use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::Allocation;

use super::buffer::Buffer;
use super::command::run_once;
use super::{BindingKind, Device};
use crate::error::{Error, Result};

/// The formats the renderer uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Colour: four half floats.
    Rgba16Float,
    /// Points and directions: four floats.
    Rgba32Float,
    /// Distances: one float.
    R32Float,
    /// Object ids: one word.
    R32Uint,
    /// Identities: four words.
    Rgba32Uint,
    /// Depth test (reversed, float) and stencil in one view, as Vulkan wants attachments.
    DepthStencil,
}

impl Format {
    pub(super) fn raw(self) -> vk::Format {
        match self {
            Format::Rgba16Float => vk::Format::R16G16B16A16_SFLOAT,
            Format::Rgba32Float => vk::Format::R32G32B32A32_SFLOAT,
            Format::R32Float => vk::Format::R32_SFLOAT,
            Format::R32Uint => vk::Format::R32_UINT,
            Format::Rgba32Uint => vk::Format::R32G32B32A32_UINT,
            Format::DepthStencil => vk::Format::D32_SFLOAT_S8_UINT,
        }
    }

    /// Bytes a texel takes in a readback.
    pub fn texel_bytes(self) -> u64 {
        match self {
            Format::Rgba16Float => 8,
            Format::Rgba32Float | Format::Rgba32Uint => 16,
            Format::R32Float | Format::R32Uint | Format::DepthStencil => 4,
        }
    }

    fn usage(self) -> vk::ImageUsageFlags {
        let common = vk::ImageUsageFlags::TRANSFER_SRC | vk::ImageUsageFlags::TRANSFER_DST;
        common
            | if self == Format::DepthStencil {
                vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT
            } else {
                vk::ImageUsageFlags::COLOR_ATTACHMENT
                    | vk::ImageUsageFlags::STORAGE
                    | vk::ImageUsageFlags::SAMPLED
            }
    }

    fn aspect(self) -> vk::ImageAspectFlags {
        match self {
            Format::DepthStencil => vk::ImageAspectFlags::DEPTH | vk::ImageAspectFlags::STENCIL,
            _ => vk::ImageAspectFlags::COLOR,
        }
    }
}

/// How an image's layers are seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    Flat,
    /// Six square layers in Vulkan's face order: seen as an array by stores and fetches, as a
    /// cube by `texture_cube`.
    Cube,
}

impl Shape {
    pub fn layers(self) -> u32 {
        match self {
            Shape::Flat => 1,
            Shape::Cube => 6,
        }
    }
}

/// An image, its memory and its views.
pub struct Image {
    /// Frames that use the image hold this too, so it outlives their submit.
    pub(super) owner: Arc<Owner>,
    name: String,
    pub format: Format,
    pub shape: Shape,
    /// Width and height in pixels.
    pub size: [u32; 2],
}

/// Frees the image when nobody needs it any more.
pub(super) struct Owner {
    device: Arc<Device>,
    pub raw: vk::Image,
    view: vk::ImageView,
    cube: Option<vk::ImageView>,
    allocation: Option<Allocation>,
    reserved: u64,
}

impl Image {
    /// # Errors
    /// [`Error::Device`] when it is larger than the device allows, or memory is out.
    pub fn new(
        device: &Arc<Device>,
        name: &str,
        format: Format,
        size: [u32; 2],
        shape: Shape,
    ) -> Result<Image> {
        let limit = device.max_image_side();
        if size.iter().any(|&s| s == 0 || s > limit) {
            return Err(Error::Device(format!(
                "{name}: {}x{} pixels, but {} allows 1 to {limit} a side",
                size[0],
                size[1],
                device.info().name
            )));
        }
        let flags = match shape {
            Shape::Flat => vk::ImageCreateFlags::empty(),
            Shape::Cube => vk::ImageCreateFlags::CUBE_COMPATIBLE,
        };
        let info = vk::ImageCreateInfo::default()
            .flags(flags)
            .image_type(vk::ImageType::TYPE_2D)
            .format(format.raw())
            .extent(vk::Extent3D { width: size[0], height: size[1], depth: 1 })
            .mip_levels(1)
            .array_layers(shape.layers())
            .samples(vk::SampleCountFlags::TYPE_1)
            .tiling(vk::ImageTiling::OPTIMAL)
            .usage(format.usage());
        // SAFETY: a live device and a complete description within its limits.
        let (raw, requirements) = unsafe {
            let raw = device
                .raw
                .create_image(&info, None)
                .map_err(|e| device.fail("vkCreateImage", name, e))?;
            (raw, device.raw.get_image_memory_requirements(raw))
        };
        // Made before the memory is, so that an early return frees the handle.
        let mut owner = Owner {
            device: device.clone(),
            raw,
            view: vk::ImageView::null(),
            cube: None,
            allocation: None,
            reserved: requirements.size,
        };
        let allocation = device.allocate(name, requirements, MemoryLocation::GpuOnly, false)?;
        // SAFETY: the memory was allocated for these requirements and is bound once.
        let bound =
            unsafe { device.raw.bind_image_memory(raw, allocation.memory(), allocation.offset()) };
        owner.allocation = Some(allocation);
        bound.map_err(|e| device.fail("vkBindImageMemory", name, e))?;
        device.name(raw, name);
        owner.make_views(name, format, shape)?;
        let image = Image { owner: Arc::new(owner), name: name.to_owned(), format, shape, size };
        image.enter_general()?;
        Ok(image)
    }

    pub fn name(&self) -> &str {
        &self.name
    }

    pub(super) fn attachment_view(&self) -> vk::ImageView {
        self.owner.view
    }

    /// The view a shader variable of this kind wants, or why there is none.
    pub(super) fn bound_view(&self, kind: BindingKind) -> Result<vk::ImageView, String> {
        let array = self.shape == Shape::Cube;
        match kind {
            BindingKind::Texture { cube: true, .. } => {
                self.owner.cube.ok_or_else(|| format!("{} is no cube", self.name))
            }
            BindingKind::Texture { array: wanted, .. }
            | BindingKind::Storage { array: wanted, .. }
                if wanted == array =>
            {
                Ok(self.owner.view)
            }
            _ => Err(format!(
                "{} is {}, the shader wants {kind:?}",
                self.name,
                if array { "an array of layers" } else { "a flat image" }
            )),
        }
    }

    pub(super) fn range(&self) -> vk::ImageSubresourceRange {
        range(self.format, self.shape)
    }

    fn enter_general(&self) -> Result<()> {
        let all = vk::PipelineStageFlags2::ALL_COMMANDS;
        let barriers = [vk::ImageMemoryBarrier2::default()
            .src_stage_mask(all)
            .dst_stage_mask(all)
            .dst_access_mask(vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE)
            .old_layout(vk::ImageLayout::UNDEFINED)
            .new_layout(vk::ImageLayout::GENERAL)
            .image(self.owner.raw)
            .subresource_range(self.range())];
        let dependency = vk::DependencyInfo::default().image_memory_barriers(&barriers);
        let device = &self.owner.device;
        run_once(device, &self.name, |commands| {
            // SAFETY: recording; the image is alive until the wait in `run_once`.
            unsafe { device.raw.cmd_pipeline_barrier2(commands, &dependency) };
        })
    }

    /// Bytes of a readback: all layers, rows packed.
    pub fn readback_bytes(&self) -> u64 {
        let texels = u64::from(self.size[0]) * u64::from(self.size[1]);
        texels * u64::from(self.shape.layers()) * self.format.texel_bytes()
    }

    /// Record a copy of all layers into a readback buffer. Colour formats only.
    pub(super) fn copy_to(&self, commands: vk::CommandBuffer, target: &Buffer) {
        let region = vk::BufferImageCopy::default()
            .image_subresource(
                vk::ImageSubresourceLayers::default()
                    .aspect_mask(vk::ImageAspectFlags::COLOR)
                    .layer_count(self.shape.layers()),
            )
            .image_extent(vk::Extent3D { width: self.size[0], height: self.size[1], depth: 1 });
        // SAFETY: recording; `target` was made `readback_bytes` long by the callers, and both
        // outlive the submit, which is waited for.
        unsafe {
            self.owner.device.raw.cmd_copy_image_to_buffer(
                commands,
                self.owner.raw,
                vk::ImageLayout::GENERAL,
                target.raw,
                &[region],
            );
        }
    }

    /// Copy all layers back to the host, row-major, layer after layer; waits.
    pub fn read<T: bytemuck::Pod>(&self) -> Result<Vec<T>> {
        let name = format!("{} readback", self.name);
        let device = &self.owner.device;
        let target = Buffer::readback(device, &name, self.readback_bytes())?;
        run_once(device, &self.name, |commands| self.copy_to(commands, &target))?;
        target.contents()
    }
}

fn range(format: Format, shape: Shape) -> vk::ImageSubresourceRange {
    vk::ImageSubresourceRange::default()
        .aspect_mask(format.aspect())
        .level_count(1)
        .layer_count(shape.layers())
}

impl Owner {
    fn make_views(&mut self, name: &str, format: Format, shape: Shape) -> Result<()> {
        let new = |kind| {
            let info = vk::ImageViewCreateInfo::default()
                .image(self.raw)
                .view_type(kind)
                .format(format.raw())
                .subresource_range(range(format, shape));
            // SAFETY: the image is alive and bound, and the range is all of it.
            unsafe { self.device.raw.create_image_view(&info, None) }
                .map_err(|e| self.device.fail("vkCreateImageView", name, e))
        };
        match shape {
            Shape::Flat => self.view = new(vk::ImageViewType::TYPE_2D)?,
            Shape::Cube => {
                self.view = new(vk::ImageViewType::TYPE_2D_ARRAY)?;
                if format != Format::DepthStencil {
                    self.cube = Some(new(vk::ImageViewType::CUBE)?);
                }
            }
        }
        Ok(())
    }
}

impl Drop for Owner {
    fn drop(&mut self) {
        // SAFETY: frames hold an owner until their submit was waited for: nothing uses it now. A
        // view that was never made is null, which Vulkan ignores.
        unsafe {
            self.device.raw.destroy_image_view(self.view, None);
            if let Some(cube) = self.cube {
                self.device.raw.destroy_image_view(cube, None);
            }
            self.device.raw.destroy_image(self.raw, None);
        }
        if let Some(allocation) = self.allocation.take() {
            self.device.free(allocation, self.reserved);
        }
    }
}
