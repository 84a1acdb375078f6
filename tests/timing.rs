//! Honest timing, on a simulated machine: a case against itself is no difference, a case slowed by a
//! tenth is slower, whatever the machine does to both.

use std::cell::RefCell;
use std::f64::consts::TAU;
use std::rc::Rc;
use std::time::Duration;

use mirrorbench::error::Result;
use mirrorbench::experiment::clock::ClockSource;
use mirrorbench::experiment::comparison::{Ratio, ratio};
use mirrorbench::experiment::engine::FrameTimes;
use mirrorbench::experiment::timing::{Player, Timing, TimingPlan, measure};
use mirrorbench::measure::ratio::Verdict;
use mirrorbench::measure::statistics::SplitMix64;
use mirrorbench::scene::{self, Moment};

/// Two busy cores: what slows them comes and goes with time, whoever plays.
struct Machine {
    now_ms: f64,
    random: SplitMix64,
    /// When a neighbour next comes or goes, and whether it is there.
    turn_ms: f64,
    contended: bool,
}

impl Machine {
    fn new(seed: u64) -> Rc<RefCell<Machine>> {
        let random = SplitMix64::new(seed);
        Rc::new(RefCell::new(Machine { now_ms: 0.0, random, turn_ms: 0.0, contended: true }))
    }

    /// Uniform in 0..1.
    fn uniform(&mut self) -> f64 {
        (self.random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (TAU * self.uniform()).cos()
    }

    /// What slows a frame that begins now: a clock that drifts by a fifth within half a minute, and
    /// neighbours that take a core for 0.2 s, every second.
    fn slowness(&mut self) -> f64 {
        while self.now_ms >= self.turn_ms {
            self.contended = !self.contended;
            let mean_ms = if self.contended { 200.0 } else { 1000.0 };
            self.turn_ms += -mean_ms * (1.0 - self.uniform()).ln();
        }
        let drift = 1.0 + 0.1 * (TAU * self.now_ms / 30_000.0).sin();
        if self.contended { 1.8 * drift } else { drift }
    }
}

/// How much longer the first frame takes, and what is left of that with each frame.
const COLD: f64 = 4.0;
const COOLING: f64 = 0.8;

/// A case on the machine: a cold start, bursts with a level of their own, frames that resemble the
/// frame before, and one in fifty that takes three times as long.
struct Simulated {
    machine: Rc<RefCell<Machine>>,
    frame_ms: f64,
    cold: f64,
}

impl Player for Simulated {
    fn burst(&mut self, moments: &[Moment]) -> Result<Vec<FrameTimes>> {
        let mut machine = self.machine.borrow_mut();
        let level = 0.05 * machine.normal();
        let mut noise = 0.0;
        let times = moments.iter().map(|_| {
            noise = 0.7 * noise + 0.03 * machine.normal();
            let outlier = if machine.uniform() < 0.02 { 3.0 } else { 1.0 };
            let steady_ms = self.frame_ms * machine.slowness() * (level + noise).exp() * outlier;
            let frame_gpu_ms = steady_ms * (1.0 + self.cold);
            self.cold *= COOLING;
            machine.now_ms += frame_gpu_ms;
            FrameTimes { frame_gpu_ms, ..FrameTimes::default() }
        });
        Ok(times.collect())
    }
}

/// A case, the same again, and the same slowed by a tenth, each beside the first.
fn measured(seed: u64, repeat: Option<u32>) -> (Vec<Timing>, [Ratio; 2]) {
    let machine = Machine::new(seed);
    let player = |frame_ms| Simulated { machine: machine.clone(), frame_ms, cold: COLD };
    let mut players = [4.0, 4.0, 4.4].map(player);
    let moment = scene::load("sky").unwrap().at(0);
    let moments = vec![moment; 64];
    let clock = ClockSource::Graphics;
    let cap = Duration::from_secs(60);
    let plan = TimingPlan { repeat, seed, clock, cap, baseline: 0 };
    let timings = measure(&mut players, &moments, &plan, &mut |_| ()).unwrap();
    let ratios = [1, 2].map(|i| ratio(&timings[i], ("first", &timings[0]), seed).unwrap());
    (timings, ratios)
}

/// Of 100 measurements: those that find no difference to itself, those that find the slowed case
/// slower, and the mean of its ratio.
fn shares(repeat: Option<u32>) -> (usize, usize, f64) {
    let ratios: Vec<[Ratio; 2]> = (0..100).map(|seed| measured(seed, repeat).1).collect();
    let count = |i: usize, verdict| ratios.iter().filter(|r| r[i].frame.verdict == verdict).count();
    let mean = ratios.iter().map(|r| r[1].frame.median).sum::<f64>() / 100.0;
    let rounds = ratios.iter().map(|r| r[0].rounds).sum::<u64>() / 100;
    let (same, slower) = (count(0, Verdict::NoDifference), count(1, Verdict::Slower));
    println!("{rounds} rounds: itself {same}, slowed {slower} of 100, ratio {mean:.4}");
    (same, slower, mean)
}

#[test]
fn a_case_is_no_different_from_itself_and_a_tenth_is_told_apart() {
    let (same, slower, mean) = shares(None);
    assert!(same >= 95, "no difference in {same} of 100");
    assert!(slower >= 95, "slower in {slower} of 100");
    assert!((mean - 1.1).abs() < 0.005, "{mean}");
}

#[test]
fn forty_eight_rounds_tell_a_tenth() {
    let (same, slower, _) = shares(Some(6));
    assert!(same >= 95 && slower >= 95, "{same} and {slower} of 100");
}

#[test]
fn a_cold_start_is_waited_for() {
    for seed in 0..20 {
        let (timings, _) = measured(seed, Some(1));
        for timing in timings {
            assert!(timing.clock.steady, "seed {seed}");
            // What is left of it drowns in the noise of a frame.
            let left = COLD * COOLING.powi(timing.warm_up.len() as i32);
            assert!(left < 0.15, "seed {seed}: {left} left");
        }
    }
}
