//! From times to the columns of a row.

use std::collections::BTreeMap;

use super::engine::{FrameTimes, PassTime};
use super::results::{FrameTime, PassRow, Prepare};
use super::timing::Timing;
use crate::measure::statistics::{Spread, median, median_ci95};

/// Cost of prepare, over all calls seen, warm-up included: a still scene is prepared only there.
pub fn prepare(timing: &Timing) -> Prepare {
    let frames = || timing.warm_up.iter().chain(timing.frames.iter().map(|(_, times)| times));
    let calls: Vec<&FrameTimes> = frames().filter(|times| !times.prepare.is_empty()).collect();
    let typical = |time: fn(&PassTime) -> f64| {
        let sums: Vec<f64> = calls.iter().map(|t| t.prepare.iter().map(time).sum()).collect();
        median(&sums).unwrap_or(0.0)
    };
    Prepare {
        calls: calls.len() as u64,
        gpu_ms: typical(|pass| pass.gpu_ms),
        cpu_ms: typical(|pass| pass.cpu_ms),
        bytes: frames().map(|times| times.prepare_bytes).max().unwrap_or(0),
    }
}

/// GPU time of the timed frames; `None` where there are none.
pub fn frame_time(timing: &Timing, seed: u64) -> Option<FrameTime> {
    let alone: Vec<f64> = timing.frames.iter().map(|(_, t)| t.frame_gpu_ms).collect();
    let prepared = timing.frames.iter().map(|(_, t)| {
        let prepare: f64 = t.prepare.iter().map(|pass| pass.gpu_ms).sum();
        t.frame_gpu_ms + prepare
    });
    let Spread { median: middle, min, p95 } = Spread::of(&alone)?;
    Some(FrameTime {
        median: middle,
        min,
        p95,
        n: alone.len() as u64,
        ci95: median_ci95(&alone, seed)?,
        with_prepare: median(&prepared.collect::<Vec<_>>())?,
    })
}

/// Every pass in the order first met, prepare's first. A pass that runs several times in a frame
/// counts with the sum.
pub fn passes(timing: &Timing) -> Vec<PassRow> {
    let frames = || timing.frames.iter().map(|(_, times)| times);
    let prepares = timing.warm_up.iter().chain(frames()).map(|times| &times.prepare);
    let mut rows = of_frames(prepares, true);
    rows.extend(of_frames(frames().map(|times| &times.passes), false));
    rows
}

fn of_frames<'t>(frames: impl Iterator<Item = &'t Vec<PassTime>>, prepare: bool) -> Vec<PassRow> {
    let mut order: Vec<&str> = Vec::new();
    let mut sums: BTreeMap<&str, Vec<[f64; 3]>> = BTreeMap::new();
    for frame in frames {
        let mut frame_sums: BTreeMap<&str, [f64; 3]> = BTreeMap::new();
        for pass in frame {
            if !order.contains(&pass.name.as_str()) {
                order.push(&pass.name);
            }
            let sum = frame_sums.entry(&pass.name).or_default();
            let pass = [pass.gpu_ms, pass.cpu_ms, pass.invocations as f64];
            *sum = std::array::from_fn(|i| sum[i] + pass[i]);
        }
        for (name, sum) in frame_sums {
            sums.entry(name).or_default().push(sum);
        }
    }
    let rows = order.into_iter().filter_map(|name| {
        let column = |i: usize| sums[name].iter().map(|sum| sum[i]).collect::<Vec<f64>>();
        Some(PassRow {
            name: name.to_owned(),
            prepare,
            gpu_ms: Spread::of(&column(0))?,
            cpu_ms: median(&column(1))?,
            invocations: median(&column(2))? as u64,
        })
    });
    rows.collect()
}

/// Work a frame, mean over the timed frames.
pub fn counters(timing: &Timing) -> BTreeMap<String, f64> {
    let mut means = BTreeMap::new();
    let part = 1.0 / timing.frames.len().max(1) as f64;
    for (name, count) in timing.frames.iter().flat_map(|(_, times)| &times.counters) {
        *means.entry(name.clone()).or_default() += part * *count as f64;
    }
    means
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::results::Clock;
    use super::*;

    pub fn pass(name: &str, gpu_ms: f64, begin_ms: f64) -> PassTime {
        PassTime { name: name.into(), gpu_ms, cpu_ms: 0.5, invocations: 10, begin_ms }
    }

    fn timing() -> Timing {
        let frame = |ms: f64| FrameTimes {
            prepare: Vec::new(),
            passes: vec![pass("a", ms, 0.0), pass("b", 1.0, ms), pass("a", ms, ms + 1.0)],
            frame_gpu_ms: 2.0 * ms + 1.0,
            prepare_bytes: 64,
            counters: vec![("rays".into(), ms as u64)],
        };
        let prepare = vec![pass("capture", 3.0, 0.0), pass("mip", 1.0, 3.0)];
        Timing {
            frames: (1..=5).map(|i| (i, frame(f64::from(i)))).collect(),
            warm_up: vec![FrameTimes { prepare, prepare_bytes: 128, ..frame(99.0) }],
            clock: Clock { before_mhz: None, after_mhz: None, throttled: 0, load: None },
        }
    }

    #[test]
    fn prepare_is_found_in_the_warm_up_too() {
        assert_eq!(prepare(&timing()), Prepare { calls: 1, gpu_ms: 4.0, cpu_ms: 1.0, bytes: 128 });
    }

    #[test]
    fn a_frame_is_timed_with_and_without_prepare() {
        let mut timing = timing();
        let time = frame_time(&timing, 1).unwrap();
        assert_eq!((time.median, time.min, time.n, time.with_prepare), (7.0, 3.0, 5, 7.0));
        assert!(time.ci95[0] <= 7.0 && time.ci95[1] >= 7.0);
        for (_, frame) in &mut timing.frames {
            frame.prepare = vec![pass("capture", 3.0, 0.0)];
        }
        assert_eq!(frame_time(&timing, 1).unwrap().with_prepare, 10.0);
        timing.frames.clear();
        assert_eq!(frame_time(&timing, 1), None);
    }

    #[test]
    fn passes_sum_within_a_frame_and_spread_over_frames() {
        let rows = passes(&timing());
        let names: Vec<(&str, bool)> = rows.iter().map(|r| (r.name.as_str(), r.prepare)).collect();
        assert_eq!(names, [("capture", true), ("mip", true), ("a", false), ("b", false)]);
        assert_eq!((rows[2].gpu_ms.median, rows[2].gpu_ms.min), (6.0, 2.0));
        assert_eq!((rows[2].cpu_ms, rows[2].invocations), (1.0, 20));
        let frame = frame_time(&timing(), 1).unwrap().median;
        let sum: f64 = rows.iter().filter(|r| !r.prepare).map(|r| r.gpu_ms.median).sum();
        assert_eq!(sum, frame);
        assert_eq!(counters(&timing())["rays"], 3.0);
    }
}
