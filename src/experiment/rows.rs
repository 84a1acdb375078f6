//! From times to the columns of a row.

use std::collections::BTreeMap;

use super::comparison::with_prepare;
use super::engine::{FrameTimes, PassTime};
use super::results::{FrameTime, PassRow, Prepare};
use super::timing::Timing;
use crate::measure::statistics::{Spread, blocks_median_ci95, median};

/// Cost of prepare, over all calls seen, warm-up included: a still scene is prepared only there.
pub fn prepare(timing: &Timing) -> Prepare {
    let frames = || timing.warm_up.iter().chain(timing.frames().map(|(_, times)| times));
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
    let blocks: Vec<Vec<f64>> = timing
        .bursts
        .iter()
        .map(|burst| burst.frames.iter().map(|(_, times)| times.frame_gpu_ms).collect())
        .collect();
    let alone = blocks.concat();
    let prepared: Vec<f64> = timing.frames().map(|(_, times)| with_prepare(times)).collect();
    let Spread { median: middle, min, p95 } = Spread::of(&alone)?;
    Some(FrameTime {
        median: middle,
        min,
        p95,
        n: alone.len() as u64,
        ci95: blocks_median_ci95(&blocks, seed)?,
        with_prepare: median(&prepared)?,
    })
}

/// Every pass in the order first met, prepare's first. A pass that runs several times in a frame
/// counts with the sum.
pub fn passes(timing: &Timing) -> Vec<PassRow> {
    let frames = || timing.frames().map(|(_, times)| times);
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

/// Fills in the invocations that bursts do not count from a frame that did.
pub fn add_invocations(rows: &mut [PassRow], counted: &FrameTimes) {
    for row in rows {
        let passes = if row.prepare { &counted.prepare } else { &counted.passes };
        let passes = passes.iter().filter(|pass| pass.name == row.name);
        row.invocations = row.invocations.max(passes.map(|pass| pass.invocations).sum());
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::clock::Clock;
    use super::super::timing::Burst;
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
            counters: Vec::new(),
        };
        let prepare = vec![pass("capture", 3.0, 0.0), pass("mip", 1.0, 3.0)];
        let burst =
            |i: u32| Burst { round: i as usize, frames: vec![(i, frame(f64::from(i)))], mhz: None };
        Timing {
            bursts: (1..=5).map(burst).collect(),
            warm_up: vec![FrameTimes { prepare, prepare_bytes: 128, ..frame(99.0) }],
            clock: Clock::default(),
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
        for (_, frame) in timing.bursts.iter_mut().flat_map(|burst| &mut burst.frames) {
            frame.prepare = vec![pass("capture", 3.0, 0.0)];
        }
        assert_eq!(frame_time(&timing, 1).unwrap().with_prepare, 10.0);
        timing.bursts.clear();
        assert_eq!(frame_time(&timing, 1), None);
    }

    #[test]
    fn invocations_come_from_the_frame_that_counted_them() {
        let mut rows = passes(&timing());
        let counted = PassTime { invocations: 700, ..pass("b", 1.0, 0.0) };
        add_invocations(&mut rows, &FrameTimes { passes: vec![counted], ..Default::default() });
        let invocations: Vec<u64> = rows.iter().map(|row| row.invocations).collect();
        assert_eq!(invocations, [10, 10, 20, 700]);
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
    }
}
