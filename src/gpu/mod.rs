//! gpu

use std::sync::Arc;

use crate::error::{Error, Result};

/// The device a result was made on.
#[derive(Clone, Debug, PartialEq)]
pub struct DeviceInfo {
    pub name: String,
    pub driver: String,
    pub api: String,
    pub is_software: bool,
    pub index: usize,
}

pub struct Device;

impl Device {
    pub fn open(_select: &str, _validation: bool) -> Result<Arc<Device>> {
        Err(Error::Device("not built yet".into()))
    }

    pub fn info(&self) -> DeviceInfo {
        DeviceInfo {
            name: String::new(),
            driver: String::new(),
            api: String::new(),
            is_software: true,
            index: 0,
        }
    }

    pub fn validation_messages(&self) -> Vec<String> {
        Vec::new()
    }
}

pub fn list_devices() -> Result<Vec<DeviceInfo>> {
    Err(Error::Device("not built yet".into()))
}
