//! Rays traced by the device itself: what it must offer, and what a request says where it does not.

use std::ffi::CStr;

use ash::{khr, vk};

use super::{Device, DeviceInfo};
use crate::error::{Error, Result};

/// Extensions a device needs; none is asked for unless all are there.
pub(super) const EXTENSIONS: [&CStr; 3] = [
    khr::acceleration_structure::NAME,
    khr::ray_query::NAME,
    // Required by the first, and otherwise unused.
    khr::deferred_host_operations::NAME,
];

/// What building structures needs of a device that traces rays.
pub(super) struct RayQuery {
    pub functions: khr::acceleration_structure::Device,
    /// Alignment of a build's scratch memory, bytes.
    pub scratch_alignment: u64,
    pub max_placements: u64,
    /// Triangles of one mesh.
    pub max_triangles: u64,
}

impl RayQuery {
    /// `None` where the device does not trace rays.
    pub fn new(
        instance: &ash::Instance,
        physical: vk::PhysicalDevice,
        device: &ash::Device,
        info: &DeviceInfo,
    ) -> Option<RayQuery> {
        if !info.ray_query {
            return None;
        }
        let mut limits = vk::PhysicalDeviceAccelerationStructurePropertiesKHR::default();
        let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut limits);
        // SAFETY: `physical` is of this instance and has the extension the structure belongs to.
        unsafe { instance.get_physical_device_properties2(physical, &mut properties) };
        Some(RayQuery {
            functions: khr::acceleration_structure::Device::new(instance, device),
            scratch_alignment: limits
                .min_acceleration_structure_scratch_offset_alignment
                .max(1)
                .into(),
            max_placements: limits.max_instance_count,
            max_triangles: limits.max_primitive_count,
        })
    }
}

/// Whether a physical device has the extensions and features of ray queries.
pub(super) fn is_offered(instance: &ash::Instance, physical: vk::PhysicalDevice) -> bool {
    // SAFETY: `physical` is of this instance.
    let found =
        unsafe { instance.enumerate_device_extension_properties(physical) }.unwrap_or_default();
    let has = |name| found.iter().any(|e| e.extension_name_as_c_str() == Ok(name));
    if !EXTENSIONS.into_iter().all(has) {
        return false;
    }
    let mut structure = vk::PhysicalDeviceAccelerationStructureFeaturesKHR::default();
    let mut query = vk::PhysicalDeviceRayQueryFeaturesKHR::default();
    let mut address = vk::PhysicalDeviceBufferDeviceAddressFeatures::default();
    let mut features = vk::PhysicalDeviceFeatures2::default()
        .push_next(&mut structure)
        .push_next(&mut query)
        .push_next(&mut address);
    // SAFETY: as above; the extensions these structures belong to are there, and the first
    // of them requires buffer addresses.
    unsafe { instance.get_physical_device_features2(physical, &mut features) };
    let needed = [structure.acceleration_structure, query.ray_query, address.buffer_device_address];
    needed.iter().all(|has| *has == vk::TRUE)
}

impl Device {
    /// Whether the device traces rays itself, through `VK_KHR_ray_query`.
    pub fn has_ray_query(&self) -> bool {
        self.ray_query.is_some()
    }

    /// Check that the device traces rays itself.
    ///
    /// # Errors
    /// [`Error::Device`] where it does not, naming what does without.
    pub fn require_ray_query(&self) -> Result<()> {
        self.ray_query().map(drop)
    }

    pub(super) fn ray_query(&self) -> Result<&RayQuery> {
        self.ray_query.as_ref().ok_or_else(|| {
            let DeviceInfo { name, driver, .. } = self.info();
            Error::Device(format!(
                "{name} ({driver}) has no ray query (VK_KHR_ray_query); backend=software traces \
                 rays on every device"
            ))
        })
    }
}
