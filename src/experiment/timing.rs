//! Timing frames so that the numbers mean something.
//!
//! Bursts without readback, after a warm-up until steady; the cases of a scene interleaved in random
//! order, so that a slow minute of the machine hits all of them; until the bootstrap intervals of each
//! median, and of its ratio to the baseline's, are narrow or a cap is hit.

use std::time::Duration;

use super::clock::{self, Clock, ClockSource};
use super::comparison::log_ratios;
use super::engine::{Engine, FrameTimes};
use super::runner::Runner;
use crate::error::Result;
use crate::measure::ratio::Comparison;
use crate::measure::statistics::SplitMix64;
use crate::scene::Moment;

/// What plays frames: an engine, or a test's stand-in.
pub trait Player {
    /// Draws consecutive frames without reading back; one set of times a frame. The first may follow the
    /// last of the call before.
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
    /// Play the whole list of frames so often, instead of until the intervals are narrow.
    pub repeat: Option<u32>,
    pub seed: u64,
    pub clock: ClockSource,
    /// Wall time for each case, warm-up included, unless `repeat` is given.
    pub cap: Duration,
    /// The player whose times the others' are compared with.
    pub baseline: usize,
}

impl TimingPlan {
    pub const CAP: Duration = Duration::from_secs(5);
}

/// Frames drawn in one submit.
#[derive(Clone, Debug)]
pub struct Burst {
    /// Bursts of one round show the same frames, one player after the other.
    pub round: usize,
    /// Frame number and times.
    pub frames: Vec<(u32, FrameTimes)>,
    /// The clock right after it, where the system tells.
    pub mhz: Option<f64>,
}

/// The frames of one case.
#[derive(Clone, Debug)]
pub struct Timing {
    /// In the order played; neither warm-up nor throttled bursts are among them.
    pub bursts: Vec<Burst>,
    /// Warm-up frames: their prepare counts, their times do not.
    pub warm_up: Vec<FrameTimes>,
    pub clock: Clock,
}

impl Timing {
    /// Frame number and times of all bursts.
    pub fn frames(&self) -> impl Iterator<Item = &(u32, FrameTimes)> {
        self.bursts.iter().flat_map(|burst| &burst.frames)
    }
}

/// An interval is narrow when it lies within this share of the median on either side.
pub(super) const NARROW: f64 = 0.03;
/// Rounds after which intervals are looked at first; then each time there are half as many more.
/// Few looks, so that no interval is stopped at for being narrow by chance.
const FIRST_LOOK: usize = 8;
/// So many frames at least are played in the order of the path before another part of it is.
const STRETCH_FRAMES: usize = 8;

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
    let mut clock = Clock { before_mhz: plan.clock.mhz(), load: clock::load(), ..Clock::default() };
    let mut runners: Vec<Runner<P>> = players.iter_mut().map(Runner::new).collect();
    let mut length = usize::MAX;
    for runner in &mut runners {
        length = length.min(runner.warm_up(moments, plan)?);
    }
    play(&mut runners, moments, length, plan, tick)?;
    clock.after_mhz = plan.clock.mhz();
    clock.load_after = clock::load();
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
    let chunks = moments.len().div_ceil(length);
    let order = stretch_order(chunks, STRETCH_FRAMES.div_ceil(length));
    let rounds = plan.repeat.map(|repeat| repeat as usize * chunks);
    let mut random = SplitMix64::new(plan.seed);
    let mut enough = vec![false; runners.len()];
    let mut next_look = FIRST_LOOK;
    for round in 0.. {
        let unfinished = |i: &usize| match rounds {
            Some(rounds) => round < rounds,
            None => !enough[*i] && !runners[*i].is_capped(plan),
        };
        let mut turn: Vec<usize> = (0..runners.len()).filter(unfinished).collect();
        if turn.is_empty() {
            return Ok(());
        }
        random.shuffle(&mut turn);
        for i in turn {
            let first = order[round % chunks] * length;
            let last = (first + length).min(moments.len());
            let before = first.checked_sub(1).map(|before| &moments[before]);
            runners[i].play(round, before, &moments[first..last], plan)?;
        }
        if round + 1 == next_look && rounds.is_none() {
            enough = look(runners, plan);
            next_look += next_look / 2;
        }
        let shares = runners.iter().zip(&enough).map(|(runner, enough)| match rounds {
            Some(rounds) => (round + 1) as f64 / rounds as f64,
            None if *enough => 1.0,
            None => runner.seconds / plan.cap.as_secs_f64(),
        });
        tick(shares.fold(0.0, |sum, share| sum + share.min(1.0)) / runners.len() as f64);
    }
    Ok(())
}

/// Which players need no further rounds. The baseline plays as long as another needs it.
fn look<P: Player>(runners: &[Runner<P>], plan: &TimingPlan) -> Vec<bool> {
    let baseline = &runners[plan.baseline];
    let is_enough = |runner: &Runner<P>| {
        let ratios = log_ratios(runner.kept(), baseline.kept(), |times| times.frame_gpu_ms);
        let ratio = Comparison::of_rounds(&ratios, plan.seed);
        let is_narrow = ratio.is_some_and(|ratio| is_narrow(ratio.median, ratio.ci95));
        runner.is_narrow(plan.seed) && (is_narrow || baseline.is_capped(plan))
    };
    let mut enough: Vec<bool> = runners.iter().map(is_enough).collect();
    let is_over = |(runner, enough): (&Runner<P>, &bool)| *enough || runner.is_capped(plan);
    enough[plan.baseline] = runners.iter().zip(&enough).all(is_over);
    enough
}

pub(super) fn is_narrow(median: f64, [low, high]: [f64; 2]) -> bool {
    high - low <= 2.0 * NARROW * median
}

/// An order of 0..n by stretches of `length` in a row: what must be played before a stretch, so that
/// none of it begins cold, is then little.
fn stretch_order(n: usize, length: usize) -> Vec<usize> {
    let stretches = spread_order(n.div_ceil(length)).into_iter();
    stretches.flat_map(|stretch| (stretch * length..n).take(length)).collect()
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
pub(super) mod tests {
    use super::*;
    use crate::geometry::{Camera, Projection};
    use crate::measure::statistics::median;
    use glam::Vec3;

    /// Takes a steady time after a slow start, and notes what it was asked for.
    pub struct Fake {
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

    pub fn fakes(times: &[f64]) -> Vec<Fake> {
        let noise = SplitMix64::new(3);
        let fake = |&frame_ms| Fake { frame_ms, noise: noise.clone(), played: Vec::new() };
        times.iter().map(fake).collect()
    }

    pub fn moments(n: u32) -> Vec<Moment> {
        let camera = Camera {
            eye: Vec3::Z,
            target: Vec3::ZERO,
            up: Vec3::Y,
            projection: Projection::Perspective { fov_y: 1.0 },
            near: 0.1,
            far: 10.0,
        };
        (0..n)
            .map(|frame| Moment { frame, time: frame as f32, camera, poses: Vec::new() })
            .collect()
    }

    pub fn plan(repeat: Option<u32>) -> TimingPlan {
        let cap = TimingPlan::CAP;
        TimingPlan { repeat, seed: 7, clock: ClockSource::Processor, cap, baseline: 0 }
    }

    #[test]
    fn the_median_is_that_of_the_steady_state() {
        let timings =
            measure(&mut fakes(&[1.0, 2.0]), &moments(20), &plan(None), &mut |_| ()).unwrap();
        for (timing, expected) in timings.iter().zip([1.0, 2.0]) {
            let times: Vec<f64> = timing.frames().map(|(_, t)| t.frame_gpu_ms).collect();
            assert!((median(&times).unwrap() / expected - 1.0).abs() < 0.02);
            assert!(times.len() >= FIRST_LOOK && times.iter().all(|t| *t < 2.0 * expected));
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
                let count = timing.frames().filter(|(f, _)| *f == frame).count();
                assert_eq!(count, 3, "frame {frame}");
            }
        }
        assert!(last > 0.9 && last <= 1.0);
    }

    #[test]
    fn every_timed_frame_follows_the_one_before_it() {
        for (frame_ms, repeat) in [(0.01, None), (3.0, Some(2)), (300.0, Some(2))] {
            let mut players = fakes(&[frame_ms, frame_ms]);
            let mut plan = plan(repeat);
            plan.cap = Duration::from_millis(200);
            let timings = measure(&mut players, &moments(45), &plan, &mut |_| ()).unwrap();
            for (player, timing) in players.iter().zip(&timings) {
                let played = &player.played[timing.warm_up.len()..];
                let led = played.len() - timing.frames().count();
                assert!(led <= timing.frames().count() / 4, "{led} untimed of {}", played.len());
                let timed: Vec<u32> = timing.frames().map(|(frame, _)| *frame).collect();
                let mut next = 0;
                for (i, frame) in played.iter().enumerate() {
                    if timed.get(next) == Some(frame) {
                        let before = i.checked_sub(1).map(|before| played[before]);
                        // The path's own beginning follows nothing.
                        assert!(*frame == 0 || before == Some(frame - 1), "{before:?} {frame}");
                        next += 1;
                    }
                }
                assert_eq!(next, timed.len());
            }
        }
    }

    #[test]
    fn orders_are_permutations_whose_beginnings_are_spread() {
        for (n, length) in [(1, 1), (2, 1), (7, 3), (64, 8), (64, 1)] {
            let mut order = stretch_order(n, length);
            let steps = order.windows(2).filter(|pair| pair[1] != pair[0] + 1).count();
            assert!(steps < n.div_ceil(length), "{n} by {length}: {order:?}");
            order.sort_unstable();
            assert!(order.into_iter().eq(0..n));
        }
        let mut beginning = spread_order(64)[..8].to_vec();
        beginning.sort_unstable();
        assert!(beginning.windows(2).all(|w| w[1] - w[0] <= 16), "{beginning:?}");
    }
}
