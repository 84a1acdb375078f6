//! Clock rates and load, read where Linux tells them: a timing is only as good as its machine.

use std::fs;

/// Reads the clock of the device that does the work.
#[derive(Clone, Copy, Debug)]
pub enum ClockSource {
    /// All processors, for a software rasteriser.
    Processor,
    /// The graphics card, where its driver has a file for it.
    Graphics,
}

impl ClockSource {
    /// The current rate in MHz, or `None` where the system does not tell.
    pub fn mhz(self) -> Option<f64> {
        match self {
            ClockSource::Processor => processor_mhz(&fs::read_to_string("/proc/cpuinfo").ok()?),
            ClockSource::Graphics => graphics_mhz(),
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

/// The first card that tells: i915 and xe write a number, amdgpu marks a line with a star.
fn graphics_mhz() -> Option<f64> {
    let cards = fs::read_dir("/sys/class/drm").ok()?.flatten().map(|entry| entry.path());
    cards.into_iter().find_map(|card| {
        let read = |name: &str| fs::read_to_string(card.join(name)).ok();
        read("gt_act_freq_mhz")
            .and_then(|text| text.trim().parse().ok())
            .or_else(|| active_level_mhz(&read("device/pp_dpm_sclk")?))
    })
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
}
