//! Timing frames so that the numbers mean something.
//!
//! Bursts without readback, after a warm-up until steady; the cases of a scene interleaved in random
//! order, so that a slow minute of the machine hits all of them; until the bootstrap interval of each
//! median is narrow or a cap is hit.

use std::time::{Duration, Instant};

use super::clock::{self, ClockSource};
use super::engine::{Engine, FrameTimes};
use super::results::Clock;
use crate::error::Result;
use crate::measure::statistics::{SplitMix64, median, median_ci95};
use crate::scene::Moment;

/// What plays frames: an engine, or a test's stand-in.
pub trait Player {
    /// Draws consecutive frames without reading back; one set of times a frame.
    fn burst(&mut self, moments: &[Moment]) -> Result<Vec<FrameTimes>>;
}

impl Player for Engine {
    fn burst(&mut self, moments: &[Moment]) -> Result<Vec<FrameTimes>> {
        Engine::burst(self, moments)
    }
}

/// When a measurement is enough.
#[derive(Clone, Copy, Debug)]
pub struct TimingPlan {
    /// Play the whole list of frames so often, instead of until the interval is narrow.
    pub repeat: Option<u32>,
    pub seed: u64,
    pub clock: ClockSource,
    /// Wall time for each case, warm-up included, unless `repeat` is given.
    pub cap: Duration,
}

impl TimingPlan {
    pub const CAP: Duration = Duration::from_secs(5);
}

/// The frames of one case, in the order played.
#[derive(Clone, Debug)]
pub struct Timing {
    /// Frame number and times, warm-up not included.
    pub frames: Vec<(u32, FrameTimes)>,
    /// Warm-up frames: their prepare counts, their times do not.
    pub warm_up: Vec<FrameTimes>,
    pub clock: Clock,
}

/// The interval is narrow when it lies within this share of the median on either side.
const NARROW: f64 = 0.03;
/// Bursts after which an interval is looked at, at the earliest.
const FEWEST_BURSTS: usize = 4;
/// Longest burst in frames and, roughly, in milliseconds: one submit must not look like a hang.
const BURST_FRAMES: usize = 8;
const BURST_MS: f64 = 400.0;
/// Two bursts in a row agree when their medians differ by less than this share.
const STEADY: f64 = 0.05;
const WARM_UP_BURSTS: usize = 6;
/// Bursts below this share of the highest clock seen are dropped.
const THROTTLED: f64 = 0.9;

struct Burst {
    frames: Vec<(u32, FrameTimes)>,
    mhz: Option<f64>,
}

struct Runner<'p, P> {
    player: &'p mut P,
    warm_up: Vec<FrameTimes>,
    bursts: Vec<Burst>,
    seconds: f64,
}

/// Times all players over the same list of frames. `tick` hears the share of the work done, 0 to 1.
///
/// # Errors
/// Whatever a player fails with.
pub fn measure<P: Player>(
    players: &mut [P],
    moments: &[Moment],
    plan: &TimingPlan,
    tick: &mut dyn FnMut(f64),
) -> Result<Vec<Timing>> {
    let load = clock::load();
    let before_mhz = plan.clock.mhz();
    let mut runners: Vec<Runner<P>> = players.iter_mut().map(Runner::new).collect();
    let mut length = BURST_FRAMES;
    for runner in &mut runners {
        length = length.min(runner.warm_up(moments, plan)?);
    }
    play(&mut runners, moments, length, plan, tick)?;
    let after_mhz = plan.clock.mhz();
    let clock = Clock { before_mhz, after_mhz, throttled: 0, load };
    Ok(runners.into_iter().map(|runner| runner.finish(clock)).collect())
}

/// Plays rounds: in each, every unfinished player plays the same chunk, in random order.
fn play<P: Player>(
    runners: &mut [Runner<P>],
    moments: &[Moment],
    length: usize,
    plan: &TimingPlan,
    tick: &mut dyn FnMut(f64),
) -> Result<()> {
    let chunks: Vec<&[Moment]> = moments.chunks(length).collect();
    let order = spread_order(chunks.len());
    let mut random = SplitMix64::new(plan.seed);
    for round in 0.. {
        let unfinished = |i: &usize| match plan.repeat {
            Some(repeat) => round < repeat as usize * chunks.len(),
            None => !runners[*i].is_done(plan),
        };
        let mut turn: Vec<usize> = (0..runners.len()).filter(unfinished).collect();
        if turn.is_empty() {
            return Ok(());
        }
        random.shuffle(&mut turn);
        for i in turn {
            runners[i].play(chunks[order[round % chunks.len()]], plan)?;
        }
        let shares = runners.iter().map(|runner| match plan.repeat {
            Some(repeat) => round as f64 / (repeat as usize * chunks.len()) as f64,
            None if runner.is_done(plan) => 1.0,
            None => runner.seconds / plan.cap.as_secs_f64(),
        });
        tick(shares.fold(0.0, |sum, share| sum + share.min(1.0)) / runners.len() as f64);
    }
    Ok(())
}

impl<'p, P: Player> Runner<'p, P> {
    fn new(player: &'p mut P) -> Self {
        Runner { player, warm_up: Vec::new(), bursts: Vec::new(), seconds: 0.0 }
    }

    /// Plays the beginning of the list until two bursts agree; returns the burst length that fits.
    fn warm_up(&mut self, moments: &[Moment], plan: &TimingPlan) -> Result<usize> {
        let begun = Instant::now();
        let mut length = 1;
        let mut last = f64::INFINITY;
        for _ in 0..WARM_UP_BURSTS {
            let times = self.player.burst(&moments[..length.min(moments.len())])?;
            let frame_ms: Vec<f64> = times.iter().map(|t| t.frame_gpu_ms).collect();
            self.warm_up.extend(times);
            let now = median(&frame_ms).unwrap_or(0.0);
            let steady = (now - last).abs() <= STEADY * now;
            last = now;
            length = (BURST_MS / now.max(1e-3)).clamp(1.0, BURST_FRAMES as f64) as usize;
            if steady || begun.elapsed() > plan.cap / 2 {
                break;
            }
        }
        self.seconds = begun.elapsed().as_secs_f64();
        Ok(length)
    }

    fn play(&mut self, chunk: &[Moment], plan: &TimingPlan) -> Result<()> {
        let begun = Instant::now();
        let times = self.player.burst(chunk)?;
        self.seconds += begun.elapsed().as_secs_f64();
        let frames = chunk.iter().map(|moment| moment.frame).zip(times).collect();
        self.bursts.push(Burst { frames, mhz: plan.clock.mhz() });
        Ok(())
    }

    fn is_done(&self, plan: &TimingPlan) -> bool {
        if self.bursts.is_empty() {
            return false;
        }
        if self.seconds >= plan.cap.as_secs_f64() {
            return true;
        }
        let frames = self.bursts.iter().flat_map(|burst| &burst.frames);
        let frame_ms: Vec<f64> = frames.map(|(_, times)| times.frame_gpu_ms).collect();
        self.bursts.len() >= FEWEST_BURSTS && is_narrow(&frame_ms, plan.seed)
    }

    /// Drops throttled bursts and counts them.
    fn finish(self, mut clock: Clock) -> Timing {
        let highest = self.bursts.iter().filter_map(|burst| burst.mhz).fold(0.0, f64::max);
        let is_kept = |burst: &Burst| burst.mhz.is_none_or(|mhz| mhz >= THROTTLED * highest);
        clock.throttled = self.bursts.iter().filter(|burst| !is_kept(burst)).count() as u64;
        let kept = self.bursts.into_iter().filter(is_kept);
        Timing { frames: kept.flat_map(|b| b.frames).collect(), warm_up: self.warm_up, clock }
    }
}

fn is_narrow(values: &[f64], seed: u64) -> bool {
    let (Some(median), Some([low, high])) = (median(values), median_ci95(values, seed)) else {
        return false;
    };
    high - low <= 2.0 * NARROW * median
}

/// An order of 0..n whose every beginning is spread evenly over the whole: ranks of the multiples
/// of the golden ratio modulo 1. A measurement that stops early has still seen all of the path.
fn spread_order(n: usize) -> Vec<usize> {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let mut by_place: Vec<usize> = (0..n).collect();
    by_place.sort_by(|a, b| (*a as f64 * GOLDEN).fract().total_cmp(&(*b as f64 * GOLDEN).fract()));
    let mut order = vec![0; n];
    for (rank, k) in by_place.into_iter().enumerate() {
        order[k] = rank;
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Camera, Projection};
    use glam::Vec3;

    /// Takes a steady time after a slow start, and notes what it was asked for.
    struct Fake {
        frame_ms: f64,
        noise: SplitMix64,
        played: Vec<u32>,
    }

    impl Player for Fake {
        fn burst(&mut self, moments: &[Moment]) -> Result<Vec<FrameTimes>> {
            let times = moments.iter().map(|moment| {
                let cold = if self.played.is_empty() { 5.0 } else { 1.0 };
                self.played.push(moment.frame);
                let noise = 1.0 + 0.02 * (self.noise.below(1000) as f64 / 1000.0 - 0.5);
                FrameTimes { frame_gpu_ms: cold * noise * self.frame_ms, ..Default::default() }
            });
            Ok(times.collect())
        }
    }

    fn fakes(times: &[f64]) -> Vec<Fake> {
        let noise = SplitMix64::new(3);
        let fake = |&frame_ms| Fake { frame_ms, noise: noise.clone(), played: Vec::new() };
        times.iter().map(fake).collect()
    }

    fn moments(n: u32) -> Vec<Moment> {
        let camera = Camera {
            eye: Vec3::Z,
            target: Vec3::ZERO,
            up: Vec3::Y,
            projection: Projection::Perspective { fov_y: 1.0 },
            near: 0.1,
            far: 10.0,
        };
        (0..n).map(|frame| Moment { frame, camera, poses: Vec::new() }).collect()
    }

    fn plan(repeat: Option<u32>) -> TimingPlan {
        TimingPlan { repeat, seed: 7, clock: ClockSource::Processor, cap: TimingPlan::CAP }
    }

    #[test]
    fn the_median_is_that_of_the_steady_state() {
        let timings =
            measure(&mut fakes(&[1.0, 2.0]), &moments(20), &plan(None), &mut |_| ()).unwrap();
        for (timing, expected) in timings.iter().zip([1.0, 2.0]) {
            let times: Vec<f64> = timing.frames.iter().map(|(_, t)| t.frame_gpu_ms).collect();
            assert!((median(&times).unwrap() / expected - 1.0).abs() < 0.02);
            assert!(times.len() >= FEWEST_BURSTS && times.iter().all(|t| *t < 2.0 * expected));
        }
    }

    #[test]
    fn repeat_plays_every_frame_so_often_for_every_case() {
        let mut players = fakes(&[1.0, 300.0]);
        let mut last = 0.0;
        let timings =
            measure(&mut players, &moments(21), &plan(Some(3)), &mut |share| last = share).unwrap();
        for timing in timings {
            for frame in 0..21 {
                let count = timing.frames.iter().filter(|(f, _)| *f == frame).count();
                assert_eq!(count, 3, "frame {frame}");
            }
        }
        assert!(last > 0.9 && last <= 1.0);
    }

    #[test]
    fn slow_frames_come_in_short_bursts() {
        for (frame_ms, expected) in [(0.01, 8), (100.0, 4), (1e6, 1)] {
            let mut player = fakes(&[frame_ms]).remove(0);
            let length = Runner::new(&mut player).warm_up(&moments(9), &plan(None)).unwrap();
            assert!(length.abs_diff(expected) <= 1, "{frame_ms} ms gave {length}");
        }
    }

    #[test]
    fn throttled_bursts_are_dropped_and_counted() {
        let mut player = fakes(&[1.0]).remove(0);
        let mut runner = Runner::new(&mut player);
        for mhz in [Some(3000.0), Some(2000.0), Some(2900.0)] {
            runner.bursts.push(Burst { frames: vec![(0, FrameTimes::default())], mhz });
        }
        let idle = Clock { before_mhz: None, after_mhz: None, throttled: 0, load: None };
        let timing = runner.finish(idle);
        assert_eq!((timing.frames.len(), timing.clock.throttled), (2, 1));
    }

    #[test]
    fn orders_are_permutations_whose_beginnings_are_spread() {
        for n in [1, 2, 7, 64] {
            let mut order = spread_order(n);
            order.sort_unstable();
            assert!(order.into_iter().eq(0..n));
        }
        let mut beginning = spread_order(64)[..8].to_vec();
        beginning.sort_unstable();
        assert!(beginning.windows(2).all(|w| w[1] - w[0] <= 16), "{beginning:?}");
    }
}
