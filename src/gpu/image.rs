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
    /// Two words.
    Rg32Uint,
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
            Format::Rg32Uint => vk::Format::R32G32_UINT,
            Format::Rgba32Uint => vk::Format::R32G32B32A32_UINT,
            Format::DepthStencil => vk::Format::D32_SFLOAT_S8_UINT,
        }
    }

    /// Bytes a texel takes in a readback.
    pub fn texel_bytes(self) -> u64 {
        match self {
            Format::Rgba16Float | Format::Rg32Uint => 8,
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
    /// So many layers, seen as an array.
    Array(u32),
}

impl Shape {
    pub fn layers(self) -> u32 {
        match self {
            Shape::Flat => 1,
            Shape::Cube => 6,
            Shape::Array(layers) => layers,
        }
    }

    /// The view of all its layers that stores and fetches take.
    fn view_type(self) -> vk::ImageViewType {
        match self {
            Shape::Flat => vk::ImageViewType::TYPE_2D,
            Shape::Cube | Shape::Array(_) => vk::ImageViewType::TYPE_2D_ARRAY,
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
    /// Width and height in pixels, of level 0.
    pub size: [u32; 2],
    /// Mip levels; each has half the side of the one before, rounded down, and at least 1.
    pub levels: u32,
}

/// Frees the image when nobody needs it any more.
pub(super) struct Owner {
    device: Arc<Device>,
    pub raw: vk::Image,
    view: vk::ImageView,
    cube: Option<vk::ImageView>,
    /// One a layer, to draw into level 0.
    layers: Vec<vk::ImageView>,
    /// One a mip level with all its layers, to store into.
    levels: Vec<vk::ImageView>,
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
        Self::with_levels(device, name, format, size, shape, 1)
    }

    /// An image with mip levels.
    ///
    /// # Errors
    /// As [`Image::new`]; more layers than the device allows count as too large.
    pub fn with_levels(
        device: &Arc<Device>,
        name: &str,
        format: Format,
        size: [u32; 2],
        shape: Shape,
        levels: u32,
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
        let most = device.max_image_layers();
        if shape.layers() > most {
            return Err(Error::Device(format!(
                "{name}: {} layers, but {} allows {most}",
                shape.layers(),
                device.info().name
            )));
        }
        let flags = match shape {
            Shape::Flat | Shape::Array(_) => vk::ImageCreateFlags::empty(),
            Shape::Cube => vk::ImageCreateFlags::CUBE_COMPATIBLE,
        };
        let info = vk::ImageCreateInfo::default()
            .flags(flags)
            .image_type(vk::ImageType::TYPE_2D)
            .format(format.raw())
            .extent(vk::Extent3D { width: size[0], height: size[1], depth: 1 })
            .mip_levels(levels)
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
            layers: Vec::new(),
            levels: Vec::new(),
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
        owner.make_views(name, format, shape, levels)?;
        let (owner, name) = (Arc::new(owner), name.to_owned());
        let image = Image { owner, name, format, shape, size, levels };
        image.enter_general()?;
        Ok(image)
    }

    /// An image with one level of given texels, laid out as [`Image::read`] gives them; waits.
    ///
    /// # Errors
    /// As [`Image::new`].
    pub fn with_data<T: bytemuck::Pod>(
        device: &Arc<Device>,
        name: &str,
        (format, shape): (Format, Shape),
        size: [u32; 2],
        texels: &[T],
    ) -> Result<Image> {
        let image = Self::new(device, name, format, size, shape)?;
        let bytes = size_of_val(texels) as u64;
        assert_eq!(bytes, image.readback_bytes(), "{name}: bytes given");
        let source = Buffer::with_data(device, name, texels)?;
        run_once(device, name, |commands| {
            // SAFETY: recording; `source` has a texel for each of the image's, and both outlive the wait in
            // `run_once`.
            unsafe {
                device.raw.cmd_copy_buffer_to_image(
                    commands,
                    source.raw,
                    image.owner.raw,
                    vk::ImageLayout::GENERAL,
                    &[image.all_layers()],
                );
            }
        })?;
        Ok(image)
    }

    pub fn name(&self) -> &str {
        &self.name
    }

    pub(super) fn attachment_view(&self, layer: u32) -> vk::ImageView {
        self.owner.layers[layer as usize]
    }

    /// The view a shader variable of this kind wants, or why there is none.
    /// A storage variable sees one mip level, a texture all of them.
    pub(super) fn bound_view(
        &self,
        kind: BindingKind,
        level: u32,
    ) -> Result<vk::ImageView, String> {
        let array = self.shape != Shape::Flat;
        match kind {
            BindingKind::Texture { cube: true, .. } => {
                self.owner.cube.ok_or_else(|| format!("{} is no cube", self.name))
            }
            BindingKind::Texture { array: wanted, .. } if wanted == array => Ok(self.owner.view),
            BindingKind::Storage { array: wanted } if wanted == array => {
                let views = &self.owner.levels;
                let missing = || format!("{} has {} levels", self.name, views.len());
                views.get(level as usize).copied().ok_or_else(missing)
            }
            _ => Err(format!(
                "{} is {}, the shader wants {kind:?}",
                self.name,
                if array { "an array of layers" } else { "a flat image" }
            )),
        }
    }

    pub(super) fn range(&self) -> vk::ImageSubresourceRange {
        range(self.format, self.shape, self.levels)
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

    /// Level 0 of all layers, packed in a buffer. Colour formats only.
    fn all_layers(&self) -> vk::BufferImageCopy {
        vk::BufferImageCopy::default()
            .image_subresource(
                vk::ImageSubresourceLayers::default()
                    .aspect_mask(vk::ImageAspectFlags::COLOR)
                    .layer_count(self.shape.layers()),
            )
            .image_extent(vk::Extent3D { width: self.size[0], height: self.size[1], depth: 1 })
    }

    /// Record a copy of all layers into a readback buffer. Colour formats only.
    pub(super) fn copy_to(&self, commands: vk::CommandBuffer, target: &Buffer) {
        // SAFETY: recording; `target` was made `readback_bytes` long by the callers, and both
        // outlive the submit, which is waited for.
        unsafe {
            self.owner.device.raw.cmd_copy_image_to_buffer(
                commands,
                self.owner.raw,
                vk::ImageLayout::GENERAL,
                target.raw,
                &[self.all_layers()],
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

fn range(format: Format, shape: Shape, levels: u32) -> vk::ImageSubresourceRange {
    vk::ImageSubresourceRange::default()
        .aspect_mask(format.aspect())
        .level_count(levels)
        .layer_count(shape.layers())
}

impl Owner {
    fn make_views(&mut self, name: &str, format: Format, shape: Shape, levels: u32) -> Result<()> {
        let whole = range(format, shape, levels);
        let new = |kind, range| {
            let info = vk::ImageViewCreateInfo::default()
                .image(self.raw)
                .view_type(kind)
                .format(format.raw())
                .subresource_range(range);
            // SAFETY: the image is alive and bound, and the range lies in it.
            unsafe { self.device.raw.create_image_view(&info, None) }
                .map_err(|e| self.device.fail("vkCreateImageView", name, e))
        };
        let flat = vk::ImageViewType::TYPE_2D;
        let layer = |layer| whole.base_array_layer(layer).layer_count(1).level_count(1);
        let layers: Result<_> = (0..shape.layers()).map(|l| new(flat, layer(l))).collect();
        let level = |level| whole.base_mip_level(level).level_count(1);
        let levels: Result<_> = (0..levels).map(|l| new(shape.view_type(), level(l))).collect();
        let view = new(shape.view_type(), whole);
        let is_cube = shape == Shape::Cube && format != Format::DepthStencil;
        let cube = is_cube.then(|| new(vk::ImageViewType::CUBE, whole)).transpose();
        (self.layers, self.levels, self.view, self.cube) = (layers?, levels?, view?, cube?);
        Ok(())
    }
}

impl Drop for Owner {
    fn drop(&mut self) {
        // SAFETY: frames hold an owner until their submit was waited for: nothing uses it now. A
        // view that was never made is null, which Vulkan ignores.
        unsafe {
            let parts = self.layers.iter().chain(&self.levels).copied();
            for view in parts.chain(self.cube).chain([self.view]) {
                self.device.raw.destroy_image_view(view, None);
            }
            self.device.raw.destroy_image(self.raw, None);
        }
        if let Some(allocation) = self.allocation.take() {
            self.device.free(allocation, self.reserved);
        }
    }
}
