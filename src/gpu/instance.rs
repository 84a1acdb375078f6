//! The Vulkan loader, the instance, the validation log, and what devices there are.

use std::ffi::{CStr, c_void};
use std::sync::{Arc, Mutex, PoisonError};

use ash::{ext, vk};

use super::{DeviceInfo, ray_query};
use crate::error::{Error, Result};

const VALIDATION_LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";

/// How a user gets a Vulkan device; part of every error about a missing one.
const REMEDY: &str = "install a Vulkan driver (Debian, Ubuntu: apt-get install libvulkan1 \
                      mesa-vulkan-drivers gives the software one), or point VK_DRIVER_FILES at one";

/// What the validation layers said, in order; outlives the device so that leaks are heard too.
#[derive(Clone, Default)]
pub struct ValidationLog(Arc<Mutex<Vec<String>>>);

impl ValidationLog {
    pub fn messages(&self) -> Vec<String> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn push(&self, message: String) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(message);
    }
}

/// A Vulkan instance and, with validation, its messenger.
pub(super) struct Instance {
    // Field order is drop order: the loader goes last.
    pub raw: ash::Instance,
    messenger: Option<(ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    /// Owned by the messenger's user data pointer until drop.
    pub log: Box<ValidationLog>,
    pub has_debug_utils: bool,
    _entry: ash::Entry,
}

impl Instance {
    pub fn new(validation: bool) -> Result<Instance> {
        // SAFETY: the loader is the system's Vulkan library; it stays loaded as long as `_entry`.
        let entry = unsafe { ash::Entry::load() }
            .map_err(|e| Error::Device(format!("no Vulkan loader ({e}); {REMEDY}")))?;
        // SAFETY: plain enumeration calls on a live entry.
        let (layers, extensions) = unsafe {
            (
                entry.enumerate_instance_layer_properties().unwrap_or_default(),
                entry.enumerate_instance_extension_properties(None).unwrap_or_default(),
            )
        };
        let named = |name: &[std::ffi::c_char], wanted: &CStr| {
            bytemuck::cast_slice::<_, u8>(name).starts_with(wanted.to_bytes_with_nul())
        };
        if validation && !layers.iter().any(|l| named(&l.layer_name, VALIDATION_LAYER)) {
            return Err(Error::Device(
                "validation was asked for, but the layer VK_LAYER_KHRONOS_validation is not \
                 installed (Debian, Ubuntu: apt-get install vulkan-validationlayers)"
                    .into(),
            ));
        }
        let has_debug_utils =
            extensions.iter().any(|e| named(&e.extension_name, ext::debug_utils::NAME));
        let log = Box::<ValidationLog>::default();
        let raw = create(&entry, validation, has_debug_utils)?;
        let messenger = if validation && has_debug_utils {
            let functions = ext::debug_utils::Instance::new(&entry, &raw);
            let info = messenger_info(&log);
            // SAFETY: `log` is boxed, so its address holds until after the messenger is destroyed.
            let messenger = unsafe { functions.create_debug_utils_messenger(&info, None) }
                .map_err(|e| Error::Device(format!("vkCreateDebugUtilsMessengerEXT: {e}")))?;
            Some((functions, messenger))
        } else {
            None
        };
        Ok(Instance { raw, messenger, log, has_debug_utils, _entry: entry })
    }

    /// Every physical device, in the driver's order.
    pub fn devices(&self) -> Result<Vec<(vk::PhysicalDevice, DeviceInfo)>> {
        // SAFETY: enumeration on a live instance.
        let found = unsafe { self.raw.enumerate_physical_devices() }
            .map_err(|e| Error::Device(format!("no Vulkan device ({e}); {REMEDY}")))?;
        if found.is_empty() {
            return Err(Error::Device(format!("no Vulkan device; {REMEDY}")));
        }
        Ok(found.into_iter().enumerate().map(|(i, d)| (d, self.describe(d, i))).collect())
    }

    fn describe(&self, device: vk::PhysicalDevice, index: usize) -> DeviceInfo {
        let mut driver = vk::PhysicalDeviceDriverProperties::default();
        let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut driver);
        // SAFETY: `device` came from this instance; the chain is of structures Vulkan 1.2 knows.
        unsafe { self.raw.get_physical_device_properties2(device, &mut properties) };
        let base = properties.properties;
        let text = |chars: &[std::ffi::c_char]| {
            CStr::from_bytes_until_nul(bytemuck::cast_slice(chars))
                .map_or_else(|_| String::new(), |c| c.to_string_lossy().into_owned())
        };
        let api = base.api_version;
        DeviceInfo {
            index,
            name: text(&base.device_name),
            driver: format!("{} {}", text(&driver.driver_name), text(&driver.driver_info)),
            api: format!(
                "{}.{}.{}",
                vk::api_version_major(api),
                vk::api_version_minor(api),
                vk::api_version_patch(api)
            ),
            is_software: base.device_type == vk::PhysicalDeviceType::CPU,
            ray_query: ray_query::is_offered(&self.raw, device),
        }
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        // SAFETY: the device is gone (it holds this instance), so nothing refers to these.
        unsafe {
            if let Some((functions, messenger)) = self.messenger.take() {
                functions.destroy_debug_utils_messenger(messenger, None);
            }
            self.raw.destroy_instance(None);
        }
    }
}

fn create(entry: &ash::Entry, validation: bool, debug_utils: bool) -> Result<ash::Instance> {
    let application = vk::ApplicationInfo::default()
        .application_name(c"mirrorbench")
        .engine_name(c"mirrorbench")
        .api_version(vk::API_VERSION_1_3);
    let layers = [VALIDATION_LAYER.as_ptr()];
    let extensions = [ext::debug_utils::NAME.as_ptr(), ext::validation_features::NAME.as_ptr()];
    let enabled = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
    let mut features = vk::ValidationFeaturesEXT::default().enabled_validation_features(&enabled);
    let mut info = vk::InstanceCreateInfo::default()
        .application_info(&application)
        .enabled_extension_names(&extensions[..usize::from(debug_utils)]);
    if validation {
        info = info.enabled_layer_names(&layers).push_next(&mut features);
        info = info.enabled_extension_names(&extensions);
    }
    // SAFETY: every pointer in `info` outlives the call.
    unsafe { entry.create_instance(&info, None) }
        .map_err(|e| Error::Device(format!("no Vulkan instance ({e}); {REMEDY}")))
}

fn messenger_info(log: &ValidationLog) -> vk::DebugUtilsMessengerCreateInfoEXT<'_> {
    use vk::{
        DebugUtilsMessageSeverityFlagsEXT as Severity, DebugUtilsMessageTypeFlagsEXT as Type,
    };
    vk::DebugUtilsMessengerCreateInfoEXT::default()
        .message_severity(Severity::WARNING | Severity::ERROR)
        .message_type(Type::VALIDATION | Type::GENERAL)
        .pfn_user_callback(Some(heard))
        .user_data(std::ptr::from_ref(log).cast_mut().cast())
}

/// The messenger's callback: keeps the message. Loader chatter without an id is left out.
unsafe extern "system" fn heard(
    _severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    kind: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    user: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: Vulkan hands back the pointer given at creation, alive until the messenger dies,
    // and message data valid during the call.
    let (log, message) = unsafe {
        let text = (*data).p_message;
        let message = if text.is_null() { c"" } else { CStr::from_ptr(text) };
        (&*user.cast::<ValidationLog>(), message.to_string_lossy().into_owned())
    };
    if kind.contains(vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION) {
        log.push(message);
    }
    vk::FALSE
}

/// What devices the machine has.
///
/// # Errors
/// [`Error::Device`] without a loader or a device, saying how to get one.
pub fn list_devices() -> Result<Vec<DeviceInfo>> {
    Ok(Instance::new(false)?.devices()?.into_iter().map(|(_, info)| info).collect())
}
