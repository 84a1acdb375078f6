//! The logical device: one queue, one allocator, a few samplers.

use std::mem::ManuallyDrop;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use ash::{ext, khr, vk};
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{
    Allocation, AllocationCreateDesc, AllocationScheme, Allocator, AllocatorCreateDesc,
};
use serde::Serialize;

use super::instance::{Instance, ValidationLog};
use super::ray_query::{self, RayQuery};
use super::{Sampler, Shaders};
use crate::error::{Error, Result};

/// What a device calls itself.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DeviceInfo {
    pub index: usize,
    pub name: String,
    pub driver: String,
    pub api: String,
    /// A software rasteriser: its times say nothing about GPUs.
    pub is_software: bool,
    /// Shaders can have it trace rays (`VK_KHR_ray_query`).
    pub ray_query: bool,
}

/// A Vulkan device with everything the other objects need from it.
pub struct Device {
    pub(super) raw: ash::Device,
    pub(super) push_descriptor: khr::push_descriptor::Device,
    pub(super) debug_utils: Option<ext::debug_utils::Device>,
    pub(super) queue: vk::Queue,
    pub(super) queue_family: u32,
    /// Nanoseconds a timestamp tick.
    pub(super) timestamp_period: f64,
    pub(super) timestamp_mask: u64,
    pub(super) has_statistics: bool,
    pub(super) ray_query: Option<RayQuery>,
    samplers: [vk::Sampler; 2],
    shaders: Mutex<Shaders>,
    allocator: ManuallyDrop<Mutex<Allocator>>,
    allocated: AtomicU64,
    limits: vk::PhysicalDeviceLimits,
    info: DeviceInfo,
    instance: Instance,
}

impl Device {
    /// Open a device: `auto` (the first that is no software rasteriser, else the first), `cpu` (the
    /// first software rasteriser), an index, or a part of a name.
    ///
    /// # Errors
    /// [`Error::Device`] when none is there, none matches, or it lacks a feature;
    /// [`Error::Shader`] when a shared shader module does not compile.
    pub fn open(select: &str, validation: bool) -> Result<Arc<Device>> {
        let shaders = Shaders::new(None)?;
        let instance = Instance::new(validation)?;
        let (physical, info) = choose(&instance, select)?;
        // SAFETY: `physical` came from this instance.
        let (properties, families) = unsafe {
            (
                instance.raw.get_physical_device_properties(physical),
                instance.raw.get_physical_device_queue_family_properties(physical),
            )
        };
        if properties.api_version < vk::API_VERSION_1_3 {
            return Err(lacks(&info, "Vulkan 1.3"));
        }
        let wanted = vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE;
        let queue_family = families
            .iter()
            .position(|f| f.queue_flags.contains(wanted) && f.timestamp_valid_bits > 0)
            .ok_or_else(|| lacks(&info, "a graphics and compute queue with timestamps"))?;
        let valid_bits = families[queue_family].timestamp_valid_bits;
        let queue_family = queue_family as u32;
        let (raw, has_statistics) = create(&instance, physical, queue_family, &info)?;
        let allocator = Allocator::new(&AllocatorCreateDesc {
            instance: instance.raw.clone(),
            device: raw.clone(),
            physical_device: physical,
            debug_settings: Default::default(),
            buffer_device_address: info.ray_query,
            allocation_sizes: Default::default(),
        })
        .map_err(|e| Error::Device(format!("{}: no memory allocator: {e}", info.name)))?;
        // SAFETY: the family and index were just asked for in `create`.
        let queue = unsafe { raw.get_device_queue(queue_family, 0) };
        Ok(Arc::new(Device {
            push_descriptor: khr::push_descriptor::Device::new(&instance.raw, &raw),
            debug_utils: instance
                .has_debug_utils
                .then(|| ext::debug_utils::Device::new(&instance.raw, &raw)),
            queue,
            queue_family,
            timestamp_period: f64::from(properties.limits.timestamp_period),
            timestamp_mask: if valid_bits == 64 { u64::MAX } else { (1 << valid_bits) - 1 },
            has_statistics,
            ray_query: RayQuery::new(&instance.raw, physical, &raw, &info),
            samplers: samplers(&raw)?,
            shaders: Mutex::new(shaders),
            allocator: ManuallyDrop::new(Mutex::new(allocator)),
            allocated: AtomicU64::new(0),
            limits: properties.limits,
            info,
            raw,
            instance,
        }))
    }

    pub fn info(&self) -> &DeviceInfo {
        &self.info
    }

    /// Compile from a folder of shaders instead of the embedded ones, from now on.
    ///
    /// # Errors
    /// [`Error::Shader`] when a file is missing, or a shared module does not compile.
    pub fn read_shaders(&self, folder: &Path) -> Result<()> {
        *self.shaders() = Shaders::new(Some(folder.to_owned()))?;
        Ok(())
    }

    /// What the validation layers have said; keep it to hear of leaks after the device is gone.
    pub fn validation(&self) -> ValidationLog {
        (*self.instance.log).clone()
    }

    /// Bytes of device memory that live buffers and images hold.
    pub fn allocated_bytes(&self) -> u64 {
        self.allocated.load(Ordering::Relaxed)
    }

    /// Largest storage buffer a shader can see, bytes.
    pub fn storage_limit(&self) -> u64 {
        u64::from(self.limits.max_storage_buffer_range)
    }

    /// Where a buffer lies; only on devices with ray query.
    pub(super) fn address(&self, buffer: vk::Buffer) -> vk::DeviceAddress {
        let info = vk::BufferDeviceAddressInfo::default().buffer(buffer);
        // SAFETY: the buffer is of this device, which gives all that builds read an address.
        unsafe { self.raw.get_buffer_device_address(&info) }
    }

    pub(super) fn offset_alignment(&self) -> u64 {
        self.limits
            .min_uniform_buffer_offset_alignment
            .max(self.limits.min_storage_buffer_offset_alignment)
    }

    pub(super) fn max_image_side(&self) -> u32 {
        self.limits.max_image_dimension2_d.min(self.limits.max_image_dimension_cube)
    }

    pub(super) fn max_image_layers(&self) -> u32 {
        self.limits.max_image_array_layers
    }

    pub(super) fn shaders(&self) -> MutexGuard<'_, Shaders> {
        self.shaders.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(super) fn sampler(&self, sampler: Sampler) -> vk::Sampler {
        self.samplers[sampler as usize]
    }

    pub(super) fn allocate(
        &self,
        name: &str,
        requirements: vk::MemoryRequirements,
        location: MemoryLocation,
        linear: bool,
    ) -> Result<Allocation> {
        let allocation = self
            .allocator
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .allocate(&AllocationCreateDesc {
                name,
                requirements,
                location,
                linear,
                allocation_scheme: AllocationScheme::GpuAllocatorManaged,
            })
            .map_err(|e| {
                Error::Device(format!(
                    "{}: no memory for {name} ({} bytes): {e}",
                    self.info.name, requirements.size
                ))
            })?;
        self.allocated.fetch_add(requirements.size, Ordering::Relaxed);
        Ok(allocation)
    }

    pub(super) fn free(&self, allocation: Allocation, size: u64) {
        self.allocated.fetch_sub(size, Ordering::Relaxed);
        let mut allocator = self.allocator.lock().unwrap_or_else(PoisonError::into_inner);
        // Only an allocation of another allocator can fail here; ours come from this one.
        let _ = allocator.free(allocation);
    }

    /// Give a Vulkan object the name that validation messages and captures show.
    pub(super) fn name<H: vk::Handle>(&self, handle: H, name: &str) {
        let (Some(debug), Ok(text)) = (&self.debug_utils, std::ffi::CString::new(name)) else {
            return;
        };
        let info =
            vk::DebugUtilsObjectNameInfoEXT::default().object_handle(handle).object_name(&text);
        // SAFETY: the handle belongs to this device. A name is an aid; failing to set it is no error.
        let _ = unsafe { debug.set_debug_utils_object_name(&info) };
    }

    /// An error that names the call and the object it was for.
    pub(super) fn fail(&self, call: &str, what: &str, result: vk::Result) -> Error {
        Error::Device(format!("{}: {call} for {what}: {result}", self.info.name))
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        // SAFETY: every buffer, image, pipeline and frame holds an Arc of this device, so none is
        // left; the allocator's blocks go before the device they came from.
        unsafe {
            let _ = self.raw.device_wait_idle();
            for sampler in self.samplers {
                self.raw.destroy_sampler(sampler, None);
            }
            ManuallyDrop::drop(&mut self.allocator);
            self.raw.destroy_device(None);
        }
    }
}

fn lacks(info: &DeviceInfo, what: &str) -> Error {
    Error::Device(format!("{} ({}) lacks {what}, which mirrorbench needs", info.name, info.driver))
}

fn choose(instance: &Instance, select: &str) -> Result<(vk::PhysicalDevice, DeviceInfo)> {
    let devices = instance.devices()?;
    let names: Vec<String> =
        devices.iter().map(|(_, i)| format!("{} \"{}\"", i.index, i.name)).collect();
    let found = match select {
        "auto" => devices.iter().find(|(_, i)| !i.is_software).or(devices.first()),
        "cpu" => devices.iter().find(|(_, i)| i.is_software),
        other => match other.parse::<usize>() {
            Ok(index) => devices.get(index),
            Err(_) => {
                let wanted = other.to_lowercase();
                devices.iter().find(|(_, i)| i.name.to_lowercase().contains(&wanted))
            }
        },
    };
    found.cloned().ok_or_else(|| {
        Error::Device(format!("no device matches `{select}`; there are: {}", names.join(", ")))
    })
}

/// Create the device with the features the renderer needs; says which one is missing.
fn create(
    instance: &Instance,
    physical: vk::PhysicalDevice,
    queue_family: u32,
    info: &DeviceInfo,
) -> Result<(ash::Device, bool)> {
    let mut has12 = vk::PhysicalDeviceVulkan12Features::default();
    let mut has13 = vk::PhysicalDeviceVulkan13Features::default();
    let mut has =
        vk::PhysicalDeviceFeatures2::default().push_next(&mut has12).push_next(&mut has13);
    // SAFETY: `physical` is of this instance and reports Vulkan 1.3, which knows these structures.
    let extensions = unsafe {
        instance.raw.get_physical_device_features2(physical, &mut has);
        instance.raw.enumerate_device_extension_properties(physical).unwrap_or_default()
    };
    let base = has.features;
    let needed = [
        (base.geometry_shader, "primitive ids in fragment shaders (geometryShader)"),
        (base.fragment_stores_and_atomics, "fragmentStoresAndAtomics"),
        (base.independent_blend, "independentBlend"),
        (has12.host_query_reset, "hostQueryReset"),
        (has13.dynamic_rendering, "dynamicRendering"),
        (has13.synchronization2, "synchronization2"),
    ];
    if let Some((_, name)) = needed.iter().find(|(has, _)| *has == vk::FALSE) {
        return Err(lacks(info, name));
    }
    let push = khr::push_descriptor::NAME;
    if !extensions.iter().any(|e| e.extension_name_as_c_str() == Ok(push)) {
        return Err(lacks(info, "VK_KHR_push_descriptor"));
    }
    let has_statistics = base.pipeline_statistics_query == vk::TRUE;
    let base = vk::PhysicalDeviceFeatures::default()
        .geometry_shader(true)
        .fragment_stores_and_atomics(true)
        .independent_blend(true)
        .pipeline_statistics_query(has_statistics);
    let mut use12 = vk::PhysicalDeviceVulkan12Features::default()
        .host_query_reset(true)
        .buffer_device_address(info.ray_query);
    let mut use13 = vk::PhysicalDeviceVulkan13Features::default()
        .dynamic_rendering(true)
        .synchronization2(true);
    let queues = [vk::DeviceQueueCreateInfo::default()
        .queue_family_index(queue_family)
        .queue_priorities(&[1.0])];
    let mut structures =
        vk::PhysicalDeviceAccelerationStructureFeaturesKHR::default().acceleration_structure(true);
    let mut queries = vk::PhysicalDeviceRayQueryFeaturesKHR::default().ray_query(true);
    let mut names = vec![push.as_ptr()];
    if info.ray_query {
        names.extend(ray_query::EXTENSIONS.map(std::ffi::CStr::as_ptr));
    }
    let mut create = vk::DeviceCreateInfo::default()
        .queue_create_infos(&queues)
        .enabled_extension_names(&names)
        .enabled_features(&base)
        .push_next(&mut use12)
        .push_next(&mut use13);
    if info.ray_query {
        create = create.push_next(&mut structures).push_next(&mut queries);
    }
    // SAFETY: every pointer in `create` outlives the call; features and extension were checked.
    let device = unsafe { instance.raw.create_device(physical, &create, None) }
        .map_err(|e| Error::Device(format!("{}: vkCreateDevice: {e}", info.name)))?;
    Ok((device, has_statistics))
}

/// One sampler a [`Sampler`], in its order; both clamp to the edge.
fn samplers(device: &ash::Device) -> Result<[vk::Sampler; 2]> {
    let sampler = |filter, between_levels| {
        let clamp = vk::SamplerAddressMode::CLAMP_TO_EDGE;
        let info = vk::SamplerCreateInfo::default()
            .mag_filter(filter)
            .min_filter(filter)
            .mipmap_mode(between_levels)
            .address_mode_u(clamp)
            .address_mode_v(clamp)
            .address_mode_w(clamp)
            .max_lod(vk::LOD_CLAMP_NONE);
        // SAFETY: a live device and a complete description.
        unsafe { device.create_sampler(&info, None) }
            .map_err(|e| Error::Device(format!("vkCreateSampler: {e}")))
    };
    let nearest = sampler(vk::Filter::NEAREST, vk::SamplerMipmapMode::NEAREST)?;
    Ok([nearest, sampler(vk::Filter::LINEAR, vk::SamplerMipmapMode::LINEAR)?])
}
