//! One player's part of a measurement: its warm-up, its bursts, when they are enough.

use std::time::Instant;

use super::clock::Clock;
use super::engine::FrameTimes;
use super::timing::{Burst, Player, Timing, TimingPlan, is_narrow};
use crate::error::Result;
use crate::measure::statistics::{blocks_median_ci95, has_trend, median, percentile, sorted};
use crate::scene::Moment;

/// Longest burst in frames.
const BURST_FRAMES: usize = 8;
/// Bursts of slow frames are shorter, down to a single frame: the sooner the players of a round take
/// turns, the more of what slows the machine hits all of them.
const BURST_MS: f64 = 20.0;
/// So many bursts in a row must show no trend, or none that matters: the median of their later half
/// within this share of their earlier half's.
const STEADY_BURSTS: usize = 8;
const STEADY: f64 = 0.02;
/// A warm-up that has not become steady by then is given up.
const WARM_UP_BURSTS: usize = 32;
/// Bursts below this share of the clock that a quarter of the bursts had are dropped. Not of the
/// highest: a processor's first second above its lasting clock would condemn all that follow.
const THROTTLED: f64 = 0.9;

pub(super) struct Runner<'p, P> {
    player: &'p mut P,
    warm_up: Vec<FrameTimes>,
    steady: bool,
    bursts: Vec<Burst>,
    /// The frame played last.
    played: Option<u32>,
    /// Wall time spent playing.
    pub seconds: f64,
}

impl<'p, P: Player> Runner<'p, P> {
    pub fn new(player: &'p mut P) -> Self {
        Runner {
            player,
            warm_up: Vec::new(),
            steady: false,
            bursts: Vec::new(),
            played: None,
            seconds: 0.0,
        }
    }

    /// Plays the beginning of the list until the times are steady, for half of the cap at most;
    /// returns the burst length that fits.
    pub fn warm_up(&mut self, moments: &[Moment], plan: &TimingPlan) -> Result<usize> {
        let begun = Instant::now();
        let mut length = 1;
        let mut middles = Vec::new();
        while !self.steady && middles.len() < WARM_UP_BURSTS && begun.elapsed() <= plan.cap / 2 {
            let times = self.player.burst(&moments[..length.min(moments.len())])?;
            let frame_ms: Vec<f64> = times.iter().map(|times| times.frame_gpu_ms).collect();
            self.warm_up.extend(times);
            let now = median(&frame_ms).unwrap_or(0.0);
            middles.push(now);
            length = (BURST_MS / now.max(1e-3)).clamp(1.0, BURST_FRAMES as f64) as usize;
            self.steady = is_steady(&middles);
        }
        self.seconds = begun.elapsed().as_secs_f64();
        Ok(length)
    }

    /// Plays a part of the path. Where its frame before, if it has one, is not what was played last, that
    /// is played first, untimed: a method that goes on from frame to frame is then timed doing so.
    pub fn play(
        &mut self,
        round: usize,
        before: Option<&Moment>,
        chunk: &[Moment],
        plan: &TimingPlan,
    ) -> Result<()> {
        let begun = Instant::now();
        if let Some(before) = before.filter(|before| self.played != Some(before.frame)) {
            self.player.burst(std::slice::from_ref(before))?;
        }
        self.played = chunk.last().map(|moment| moment.frame);
        let times = self.player.burst(chunk)?;
        self.seconds += begun.elapsed().as_secs_f64();
        let frames = chunk.iter().map(|moment| moment.frame).zip(times).collect();
        self.bursts.push(Burst { round, frames, mhz: plan.clock.mhz() });
        Ok(())
    }

    /// Whether its time is over; a burst at least is played.
    pub fn is_capped(&self, plan: &TimingPlan) -> bool {
        !self.bursts.is_empty() && self.seconds >= plan.cap.as_secs_f64()
    }

    /// Whether the interval of the median is narrow.
    pub fn is_narrow(&self, seed: u64) -> bool {
        let frame_ms = |burst: &Burst| burst.frames.iter().map(|(_, t)| t.frame_gpu_ms).collect();
        let blocks: Vec<Vec<f64>> = self.kept().map(frame_ms).collect();
        let both = median(&blocks.concat()).zip(blocks_median_ci95(&blocks, seed));
        both.is_some_and(|(median, interval)| is_narrow(median, interval))
    }

    /// The bursts that were not throttled.
    pub fn kept(&self) -> impl Iterator<Item = &Burst> {
        let least_mhz = self.least_mhz();
        self.bursts.iter().filter(move |burst| is_kept(burst, least_mhz))
    }

    fn least_mhz(&self) -> f64 {
        let clocks: Vec<f64> = self.bursts.iter().filter_map(|burst| burst.mhz).collect();
        percentile(&sorted(&clocks), 75.0).map_or(0.0, |mhz| THROTTLED * mhz)
    }

    /// Drops throttled bursts and counts them.
    pub fn finish(mut self, mut clock: Clock) -> Timing {
        let (least_mhz, played) = (self.least_mhz(), self.bursts.len());
        self.bursts.retain(|burst| is_kept(burst, least_mhz));
        clock.throttled = (played - self.bursts.len()) as u64;
        clock.steady = self.steady;
        Timing { bursts: self.bursts, warm_up: self.warm_up, clock }
    }
}

/// Where the system does not tell the clock, every burst is kept.
fn is_kept(burst: &Burst, least_mhz: f64) -> bool {
    burst.mhz.is_none_or(|mhz| mhz >= least_mhz)
}

/// Whether the last bursts' times have stopped drifting. Noise alone must not keep a busy machine
/// warming up, nor a drift too small to matter a quiet one: either test is enough. In noise a trend
/// shows only over twice as many bursts.
fn is_steady(middles: &[f64]) -> bool {
    let last = |count: usize| middles.len().checked_sub(count).map(|first| &middles[first..]);
    let drifts = |last: &[f64]| {
        let (earlier, later) = last.split_at(STEADY_BURSTS / 2);
        let both = median(earlier).zip(median(later));
        both.is_some_and(|(a, b)| (b - a).abs() > STEADY * b.max(1e-9))
    };
    last(STEADY_BURSTS).is_some_and(|last| !drifts(last))
        || last(2 * STEADY_BURSTS).is_some_and(|last| !has_trend(last))
}

#[cfg(test)]
mod tests {
    use super::super::timing::tests::{fakes, moments, plan};
    use super::*;

    #[test]
    fn slow_frames_come_in_short_bursts() {
        for (frame_ms, expected) in [(0.01, 8), (5.0, 4), (1e6, 1)] {
            let mut player = fakes(&[frame_ms]).remove(0);
            let length = Runner::new(&mut player).warm_up(&moments(9), &plan(None)).unwrap();
            assert!(length.abs_diff(expected) <= 1, "{frame_ms} ms gave {length}");
        }
    }

    #[test]
    fn times_are_steady_when_they_have_stopped_drifting() {
        let decay = |rate: f64| (0..WARM_UP_BURSTS as i32).map(move |i| 1.0 + 4.0 * rate.powi(i));
        let begun = |rate| {
            let times: Vec<f64> = decay(rate).collect();
            (1..=times.len()).find(|n| is_steady(&times[..*n]))
        };
        assert_eq!(begun(0.0), Some(STEADY_BURSTS), "only the first burst is cold");
        let (quick, slow) = (begun(0.3).unwrap(), begun(0.7).unwrap());
        assert!(quick < slow, "{quick} {slow}");
        assert!(decay(0.7).nth(slow - STEADY_BURSTS).unwrap() < 1.1, "cold after {slow}");
        assert_eq!(begun(0.99), None, "never steady");
        // Noise without a trend is steady, however strong, once there is enough of it.
        let noise = [1.0, 1.4, 0.8, 1.2, 0.9, 1.3, 1.0, 1.1];
        assert!(!is_steady(&noise) && is_steady(&[noise, noise].concat()));
    }

    #[test]
    fn throttled_bursts_are_dropped_and_counted() {
        let timing = |clocks: &[Option<f64>]| {
            let mut player = fakes(&[1.0]).remove(0);
            let mut runner = Runner::new(&mut player);
            runner.bursts.extend(clocks.iter().enumerate().map(|(round, mhz)| Burst {
                round,
                frames: vec![(0, FrameTimes::default())],
                mhz: *mhz,
            }));
            let timing = runner.finish(Clock::default());
            (timing.frames().count(), timing.clock.throttled)
        };
        assert_eq!(timing(&[Some(3000.0), Some(2000.0), Some(2900.0)]), (2, 1));
        let boost = [3500.0, 3000.0, 2990.0, 3010.0, 2000.0, 3000.0, 3000.0, 3000.0].map(Some);
        assert_eq!(timing(&boost), (7, 1), "a moment above the lasting clock condemns none");
        assert_eq!(timing(&[None; 5]), (5, 0), "a machine that does not tell");
        assert_eq!(timing(&[None, Some(3000.0), None]), (3, 0));
    }
}
