//! Buffers: device memory filled once, host memory written or read each frame.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::Allocation;

use super::command::run_once;
use super::{Device, Pass};
use crate::error::{Error, Result};

/// A buffer and its memory.
pub struct Buffer {
    pub(super) raw: vk::Buffer,
    /// Frames that use the buffer hold this too, so it outlives their submit.
    pub(super) owner: Arc<Owner>,
    name: String,
    bytes: u64,
}

/// Frees the buffer when nobody needs it any more.
pub(super) struct Owner {
    device: Arc<Device>,
    raw: vk::Buffer,
    allocation: Mutex<Option<Allocation>>,
    /// What the memory really takes, alignment included.
    reserved: u64,
}

/// A range of a buffer that lives as long as the frame it was uploaded for.
#[derive(Clone, Copy, Debug)]
pub struct Slice {
    pub(super) buffer: vk::Buffer,
    pub(super) offset: u64,
    pub(super) bytes: u64,
}

impl Slice {
    pub(super) fn descriptor(&self) -> vk::DescriptorBufferInfo {
        let Slice { buffer, offset, bytes } = *self;
        vk::DescriptorBufferInfo::default().buffer(buffer).offset(offset).range(bytes)
    }
}

impl Buffer {
    /// Device memory for storage, indirect arguments and indices; contents undefined.
    ///
    /// # Errors
    /// [`Error::Device`] when it is larger than a shader can see, or memory is out.
    pub fn storage(device: &Arc<Device>, name: &str, bytes: u64) -> Result<Buffer> {
        let limit = device.storage_limit();
        if bytes > limit {
            return Err(Error::Device(format!(
                "{name} needs {bytes} bytes in one storage buffer, but {} allows {limit}",
                device.info().name
            )));
        }
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER
            | vk::BufferUsageFlags::INDEX_BUFFER
            | vk::BufferUsageFlags::INDIRECT_BUFFER
            | vk::BufferUsageFlags::TRANSFER_SRC
            | vk::BufferUsageFlags::TRANSFER_DST
            | build_input(device);
        Self::new(device, name, bytes, usage, MemoryLocation::GpuOnly)
    }

    /// Device memory filled with `data` through a staging copy.
    pub fn with_data<T: bytemuck::Pod>(
        device: &Arc<Device>,
        name: &str,
        data: &[T],
    ) -> Result<Buffer> {
        let bytes: &[u8] = bytemuck::cast_slice(data);
        // Vulkan knows no empty buffer, and shaders bind whole words.
        let size = (bytes.len() as u64).max(16);
        let buffer = Self::storage(device, name, size)?;
        let staging = Self::staging(device, name, bytes)?;
        run_once(device, name, |commands| {
            let region = vk::BufferCopy::default().size(size);
            // SAFETY: both buffers are `size` bytes long or longer and alive until `run_once` has waited.
            unsafe { device.raw.cmd_copy_buffer(commands, staging.raw, buffer.raw, &[region]) };
        })?;
        Ok(buffer)
    }

    /// Host-visible memory with `bytes` to be copied into the buffer `name`.
    fn staging(device: &Arc<Device>, name: &str, bytes: &[u8]) -> Result<Buffer> {
        let usage = vk::BufferUsageFlags::TRANSFER_SRC;
        let (name, size) = (format!("{name} staging"), (bytes.len() as u64).max(16));
        let staging = Self::new(device, &name, size, usage, MemoryLocation::CpuToGpu)?;
        staging.write(0, bytes)?;
        Ok(staging)
    }

    /// Host-visible memory that a frame's uniforms and small arrays are written into.
    pub(super) fn upload_ring(device: &Arc<Device>, bytes: u64) -> Result<Buffer> {
        let usage = vk::BufferUsageFlags::UNIFORM_BUFFER
            | vk::BufferUsageFlags::STORAGE_BUFFER
            | vk::BufferUsageFlags::TRANSFER_SRC
            | build_input(device);
        Self::new(device, "frame uploads", bytes, usage, MemoryLocation::CpuToGpu)
    }

    /// Host-visible memory for copies back from the device.
    pub(super) fn readback(device: &Arc<Device>, name: &str, bytes: u64) -> Result<Buffer> {
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        Self::new(device, name, bytes, usage, MemoryLocation::GpuToCpu)
    }

    /// Device memory an acceleration structure lives in.
    pub(super) fn structure(device: &Arc<Device>, name: &str, bytes: u64) -> Result<Buffer> {
        let usage = vk::BufferUsageFlags::ACCELERATION_STRUCTURE_STORAGE_KHR
            | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS;
        Self::new(device, name, bytes, usage, MemoryLocation::GpuOnly)
    }

    /// Device memory a build of acceleration structures works in, `bytes` of it after its address
    /// was rounded up to `alignment`.
    pub(super) fn scratch(
        device: &Arc<Device>,
        name: &str,
        bytes: u64,
        alignment: u64,
    ) -> Result<Buffer> {
        let usage =
            vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS;
        Self::new(device, name, bytes + alignment, usage, MemoryLocation::GpuOnly)
    }

    fn new(
        device: &Arc<Device>,
        name: &str,
        bytes: u64,
        usage: vk::BufferUsageFlags,
        location: MemoryLocation,
    ) -> Result<Buffer> {
        let info = vk::BufferCreateInfo::default().size(bytes.max(16)).usage(usage);
        // SAFETY: a live device and a complete description.
        let (raw, requirements) = unsafe {
            let raw = device
                .raw
                .create_buffer(&info, None)
                .map_err(|e| device.fail("vkCreateBuffer", name, e))?;
            (raw, device.raw.get_buffer_memory_requirements(raw))
        };
        // Made before the memory is, so that an early return frees the handle.
        let owner = Arc::new(Owner {
            device: device.clone(),
            raw,
            allocation: Mutex::new(None),
            reserved: requirements.size,
        });
        let allocation = device.allocate(name, requirements, location, true)?;
        // SAFETY: the memory was allocated for these requirements and is bound once.
        let bound =
            unsafe { device.raw.bind_buffer_memory(raw, allocation.memory(), allocation.offset()) };
        *owner.lock() = Some(allocation);
        bound.map_err(|e| device.fail("vkBindBufferMemory", name, e))?;
        device.name(raw, name);
        Ok(Buffer { raw, owner, name: name.to_owned(), bytes })
    }

    pub(super) fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Where it lies; only on devices with ray query.
    pub(super) fn address(&self) -> vk::DeviceAddress {
        self.owner.device.address(self.raw)
    }

    pub(super) fn whole(&self) -> Slice {
        Slice { buffer: self.raw, offset: 0, bytes: self.bytes }
    }

    /// Write host-visible memory.
    pub(super) fn write(&self, offset: u64, data: &[u8]) -> Result<()> {
        let start = offset as usize;
        let range = start..start + data.len();
        let mut allocation = self.owner.lock();
        let mapped = allocation.as_mut().and_then(|a| a.mapped_slice_mut());
        match mapped.and_then(|m| m.get_mut(range)) {
            Some(target) => {
                target.copy_from_slice(data);
                Ok(())
            }
            None => Err(Error::Device(format!("{}: no mapped memory to write", self.name))),
        }
    }

    /// The contents of a readback buffer.
    pub(super) fn contents<T: bytemuck::Pod>(&self) -> Result<Vec<T>> {
        let allocation = self.owner.lock();
        let mapped = allocation.as_ref().and_then(|a| a.mapped_slice());
        mapped
            .map(|m| bytemuck::pod_collect_to_vec(&m[..self.bytes as usize]))
            .ok_or_else(|| Error::Device(format!("{}: no mapped memory to read", self.name)))
    }

    /// Copy the contents back to the host; waits.
    pub fn read<T: bytemuck::Pod>(&self) -> Result<Vec<T>> {
        let device = &self.owner.device;
        let target = Self::readback(device, &format!("{} readback", self.name), self.bytes)?;
        run_once(device, &self.name, |commands| {
            let region = vk::BufferCopy::default().size(self.bytes);
            // SAFETY: both buffers hold `bytes` bytes and outlive the wait in `run_once`.
            unsafe { device.raw.cmd_copy_buffer(commands, self.raw, target.raw, &[region]) };
        })?;
        target.contents()
    }
}

impl Pass<'_> {
    /// Copy an array into a buffer from byte `offset` on: what changes from frame to frame in a buffer
    /// that was made with [`Buffer::with_data`].
    ///
    /// # Errors
    /// [`Error::Shader`] where the array is empty or reaches beyond the buffer, [`Error::Device`] where
    /// memory is out.
    pub fn copy<T: bytemuck::Pod>(self, buffer: &Buffer, offset: u64, data: &[T]) -> Result<()> {
        let bytes: &[u8] = bytemuck::cast_slice(data);
        let length = bytes.len() as u64;
        if length == 0 || offset + length > buffer.bytes {
            return Err(self.wrong(format_args!(
                "{length} bytes do not go at {offset} into `{}` of {} bytes",
                buffer.name, buffer.bytes
            )));
        }
        let device = self.frame.device().clone();
        let staging = Buffer::staging(&device, &buffer.name, bytes)?;
        self.frame.keep(staging.owner.clone());
        self.frame.keep(buffer.owner.clone());
        self.record(None, |pass| {
            let region = vk::BufferCopy::default().dst_offset(offset).size(length);
            let (commands, from, to) = (pass.frame.commands, staging.raw, buffer.raw);
            // SAFETY: recording; both ranges are inside their buffers, which the frame keeps.
            unsafe { device.raw.cmd_copy_buffer(commands, from, to, &[region]) };
            Ok(())
        })
    }
}

/// Where the device traces rays, builds of acceleration structures may read any buffer.
fn build_input(device: &Device) -> vk::BufferUsageFlags {
    if device.has_ray_query() {
        vk::BufferUsageFlags::ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_KHR
            | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS
    } else {
        vk::BufferUsageFlags::empty()
    }
}

impl Owner {
    fn lock(&self) -> MutexGuard<'_, Option<Allocation>> {
        self.allocation.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Owner {
    fn drop(&mut self) {
        // SAFETY: frames hold an owner until their submit was waited for: nothing uses it now.
        unsafe { self.device.raw.destroy_buffer(self.raw, None) };
        if let Some(allocation) = self.lock().take() {
            self.device.free(allocation, self.reserved);
        }
    }
}
