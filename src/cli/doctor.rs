//! `doctor`: is this machine fit, which driver was picked, what to install.

use serde_json::json;

use super::console::{Console, table};
use crate::error::Result;
use crate::experiment::clock::ClockSource;
use crate::experiment::results::COMMIT;
use crate::gpu::{self, Device};
use crate::scene;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Vulkan device to examine: auto, cpu, part of a name, or an index of `list devices`
    #[arg(long, default_value = "auto", value_name = "WHICH")]
    device: String,
    /// One JSON object a line on stdout; text for people goes to stderr
    #[arg(long)]
    json: bool,
}

/// What to do about missing validation layers; the tests need them, results do not.
const NO_LAYERS: &str = "not found (Debian, Ubuntu: apt-get install vulkan-validationlayers)";

/// Examines everything, reports everything, and only then fails with what is worst.
pub fn doctor(args: &Args) -> Result<()> {
    let console = Console::new(args.json);
    let opened = Device::open(&args.device, false);
    let validation = Device::open(&args.device, true).is_ok();
    let devices = gpu::list_devices().unwrap_or_default();
    let scenes = scene::list();
    let picked = opened.as_ref().ok().map(|device| device.info().clone());
    let driver = picked.as_ref().map_or("none".to_owned(), |d| {
        let kind = if d.is_software { ", software: its times are a processor's" } else { "" };
        format!("{} ({}, Vulkan {}{kind})", d.name, d.driver, d.api)
    });
    let rays = picked.as_ref().map_or("none", |d| if d.ray_query { "yes" } else { "no" });
    let clock = if picked.as_ref().is_none_or(|d| d.is_software) {
        ClockSource::Processor
    } else {
        ClockSource::Graphics
    };
    let mhz = clock.mhz();
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let facts = [
        ("mirrorbench", format!("{} at {COMMIT}", env!("CARGO_PKG_VERSION"))),
        ("device", driver),
        ("ray query", rays.to_owned()),
        ("devices", devices.len().to_string()),
        ("VK_DRIVER_FILES", std::env::var("VK_DRIVER_FILES").unwrap_or("not set".into())),
        ("validation layers", if validation { "found" } else { NO_LAYERS }.to_owned()),
        ("clock", mhz.map_or("not readable".into(), |mhz| format!("{mhz:.0} MHz"))),
        ("threads", threads.to_string()),
        ("scenes", scenes.as_ref().map_or_else(ToString::to_string, |s| s.len().to_string())),
    ];
    console.object(&json!({
        "version": env!("CARGO_PKG_VERSION"), "commit": COMMIT,
        "device": picked,
        "devices": devices.len(), "validation_layers": validation, "clock_mhz": mhz,
        "threads": threads, "scenes": scenes.as_ref().ok().map(Vec::len),
    }))?;
    console.report(&table(&facts.map(|(name, value)| vec![name.to_owned(), value])))?;
    opened?;
    scenes.map(drop)
}
