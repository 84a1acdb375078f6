//! Clock rates and load, read where Linux tells them: a timing is only as good as its machine.

use std::fs;
use std::path::Path;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The state of the machine around the timing; null where the system does not tell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Clock {
    /// Clock of what did the work: the GPU, or the processor for a software rasteriser.
    pub before_mhz: Option<f64>,
    pub after_mhz: Option<f64>,
    /// Bursts dropped because the clock had fallen by more than a tenth.
    pub throttled: u64,
    /// Load average over a minute, before timing.
    pub load: Option<f64>,
    /// The same after timing, its own load included.
    pub load_after: Option<f64>,
    /// Whether times had stopped drifting when the warm-up ended.
    pub steady: bool,
}

/// Reads the clock of the device that does the work.
#[derive(Clone, Copy, Debug)]
pub enum ClockSource {
    /// All processors, for a software rasteriser.
    Processor,
    /// The graphics card, where its driver has a file for it and no other card has one.
    Graphics,
}

impl ClockSource {
    /// The current rate in MHz, or `None` where the system does not tell.
    pub fn mhz(self) -> Option<f64> {
        match self {
            ClockSource::Processor => processor_mhz(&fs::read_to_string("/proc/cpuinfo").ok()?),
            ClockSource::Graphics => graphics_mhz(Path::new("/sys/class/drm")),
        }
    }
}

/// The load average over the last minute.
pub fn load() -> Option<f64> {
    fs::read_to_string("/proc/loadavg").ok()?.split_whitespace().next()?.parse().ok()
}

/// The mean over all cores.
fn processor_mhz(cpuinfo: &str) -> Option<f64> {
    let lines = cpuinfo.lines().filter(|line| line.starts_with("cpu MHz"));
    let rates: Vec<f64> =
        lines.filter_map(|line| line.split_once(':')?.1.trim().parse().ok()).collect();
    (!rates.is_empty()).then(|| rates.iter().sum::<f64>() / rates.len() as f64)
}

/// Where i915 and xe keep the rate in a file of its own, from a card's folder.
const INTEL: [&str; 2] = ["gt_act_freq_mhz", "device/tile0/gt0/freq0/act_freq"];

/// The rate of the only card that tells: of several, nothing says which one does the work. A card
/// that sleeps tells 0, which is no rate.
fn graphics_mhz(folder: &Path) -> Option<f64> {
    let entries = fs::read_dir(folder).ok()?.flatten().map(|entry| entry.path());
    let mut rates = entries.filter(|path| is_card(path)).filter_map(|card| card_mhz(&card));
    rates.next().filter(|mhz| *mhz > 0.0 && rates.next().is_none())
}

/// `card0`, but not its connectors `card0-HDMI-A-1`, nor its other face `renderD128`.
fn is_card(path: &Path) -> bool {
    let name = path.file_name().and_then(|name| name.to_str());
    let number = name.and_then(|name| name.strip_prefix("card"));
    number.is_some_and(|number| number.bytes().all(|byte| byte.is_ascii_digit()))
}

fn card_mhz(card: &Path) -> Option<f64> {
    let read = |name: &str| fs::read_to_string(card.join(name)).ok();
    let intel = INTEL.iter().find_map(|name| read(name)?.trim().parse().ok());
    intel.or_else(|| active_level_mhz(&read("device/pp_dpm_sclk")?))
}

/// `1: 1500Mhz *` among the levels of amdgpu.
fn active_level_mhz(levels: &str) -> Option<f64> {
    let line = levels.lines().find(|line| line.ends_with('*'))?;
    let rate = line.split_whitespace().nth(1)?.to_ascii_lowercase();
    rate.strip_suffix("mhz")?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_are_read_from_what_linux_writes() {
        let cpuinfo = "processor\t: 0\ncpu MHz\t\t: 2000.0\nprocessor\t: 1\ncpu MHz\t\t: 3000.0\n";
        assert_eq!(processor_mhz(cpuinfo), Some(2500.0));
        assert_eq!(processor_mhz("processor : 0\n"), None);
        assert_eq!(active_level_mhz("0: 500Mhz\n1: 1500Mhz *\n2: 2100Mhz"), Some(1500.0));
        assert_eq!(active_level_mhz("0: 500Mhz\n"), None);
    }

    #[test]
    fn the_only_card_that_tells_is_heard() {
        let folder = tempfile::tempdir().unwrap();
        let write = |path: &str, text: &str| {
            let path = folder.path().join(path);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        };
        let rate = || graphics_mhz(folder.path());
        assert_eq!(graphics_mhz(&folder.path().join("none")), None);
        write("card0/dev", "226:0");
        assert_eq!(rate(), None, "no driver tells");
        write("card1/device/pp_dpm_sclk", "0: 500Mhz\n1: 1500Mhz *\n");
        write("renderD128/device/pp_dpm_sclk", "0: 500Mhz\n1: 1500Mhz *\n");
        write("card1-DP-1/gt_act_freq_mhz", "7");
        assert_eq!(rate(), Some(1500.0));
        write("card0/gt_act_freq_mhz", "1100\n");
        assert_eq!(rate(), None, "which of two it is, nobody says");
        fs::remove_dir_all(folder.path().join("card1")).unwrap();
        assert_eq!(rate(), Some(1100.0));
        write("card0/gt_act_freq_mhz", "0\n");
        assert_eq!(rate(), None, "asleep");
    }
}
