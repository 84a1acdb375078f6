//! Statistics of timings: robust, seeded, without distributional assumptions.

pub use crate::geometry::random::SplitMix64;

use serde::{Deserialize, Serialize};

/// Middle, best and nearly worst of a set of measurements, in their unit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Spread {
    pub median: f64,
    pub min: f64,
    pub p95: f64,
}

impl Spread {
    /// `None` without values.
    pub fn of(values: &[f64]) -> Option<Spread> {
        let sorted = sorted(values);
        Some(Spread {
            median: percentile(&sorted, 50.0)?,
            min: *sorted.first()?,
            p95: percentile(&sorted, 95.0)?,
        })
    }
}

/// The values in rising order.
pub fn sorted(values: &[f64]) -> Vec<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    sorted
}

/// The `percent`-th percentile of values in rising order, linear between ranks (Hyndman & Fan
/// 1996, type 7); `None` without values.
pub fn percentile(sorted: &[f64], percent: f64) -> Option<f64> {
    let last = sorted.len().checked_sub(1)?;
    let rank = percent.clamp(0.0, 100.0) / 100.0 * last as f64;
    let below = sorted[rank as usize];
    let above = sorted[(rank as usize + 1).min(last)];
    Some(below + rank.fract() * (above - below))
}

pub fn median(values: &[f64]) -> Option<f64> {
    percentile(&sorted(values), 50.0)
}

/// How often the bootstrap draws a sample of its own.
const RESAMPLES: usize = 1000;

/// The 95 % percentile-bootstrap interval of the median of independent values (Efron 1979): the
/// medians of samples drawn from `values` with replacement, cut at 2.5 % on either side. The same
/// seed gives the same interval. `None` without values.
pub fn median_ci95(values: &[f64], seed: u64) -> Option<[f64; 2]> {
    let blocks: Vec<[f64; 1]> = values.iter().map(|value| [*value]).collect();
    bootstrap(&blocks, 1, seed)
}

/// The same for values that come in blocks, in order of time: those of a block go together, and
/// neighbouring blocks still resemble each other. Runs of blocks are drawn, as long as the square
/// root of their number, the last block followed by the first (Politis & Romano 1992).
pub fn blocks_median_ci95(blocks: &[Vec<f64>], seed: u64) -> Option<[f64; 2]> {
    bootstrap(blocks, blocks.len().isqrt(), seed)
}

/// Draws runs of `run` blocks until there are as many blocks as there were.
fn bootstrap(blocks: &[impl AsRef<[f64]>], run: usize, seed: u64) -> Option<[f64; 2]> {
    let of_block = |(i, block)| AsRef::<[f64]>::as_ref(block).iter().map(move |value| (*value, i));
    let mut ranked: Vec<(f64, usize)> = blocks.iter().enumerate().flat_map(of_block).collect();
    if ranked.is_empty() {
        return None;
    }
    ranked.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let mut random = SplitMix64::new(seed);
    let mut medians = Vec::with_capacity(RESAMPLES);
    for _ in 0..RESAMPLES {
        let mut drawn = vec![0; blocks.len()];
        for _ in 0..blocks.len().div_ceil(run) {
            let first = random.below(blocks.len());
            (first..first + run).for_each(|block| drawn[block % blocks.len()] += 1);
        }
        medians.extend(drawn_median(&ranked, &drawn));
    }
    let medians = sorted(&medians);
    Some([percentile(&medians, 2.5)?, percentile(&medians, 97.5)?])
}

/// The median of values in rising order, each taken as often as its block was drawn.
fn drawn_median(ranked: &[(f64, usize)], drawn: &[usize]) -> Option<f64> {
    let total: usize = ranked.iter().map(|(_, block)| drawn[*block]).sum();
    let mut seen = 0;
    let mut lower = None;
    for (value, block) in ranked {
        seen += drawn[*block];
        if 2 * seen >= total && lower.is_none() {
            lower = Some(value);
        }
        if 2 * seen > total {
            return lower.map(|lower| 0.5 * (lower + value));
        }
    }
    None
}

/// Whether values, in order of time, keep rising or falling: Mann's test of Kendall's rank
/// correlation with time (Mann 1945), two-sided at 5 %, with the normal approximation.
pub fn has_trend(values: &[f64]) -> bool {
    let n = values.len() as f64;
    let later = |(i, first): (usize, &f64)| -> i32 {
        values[i + 1..].iter().map(|second| second.total_cmp(first) as i32).sum()
    };
    let score: i32 = values.iter().enumerate().map(later).sum();
    let deviation = (n * (n - 1.0) * (2.0 * n + 5.0) / 18.0).sqrt();
    // The score moves in steps of two: a step's half is taken off.
    f64::from(score.abs()) - 1.0 > 1.96 * deviation
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Near enough to normal: the sum of four uniforms, variance 1/3, median 0.
    fn noise(random: &mut SplitMix64) -> f64 {
        (0..4).map(|_| random.next_u64() as f64 / u64::MAX as f64 - 0.5).sum()
    }

    #[test]
    fn percentiles_of_a_ramp_are_linear() {
        let ramp: Vec<f64> = (0..=10).map(f64::from).collect();
        for p in [0.0, 2.5, 50.0, 95.0, 100.0] {
            assert!((percentile(&ramp, p).unwrap() - p / 10.0).abs() < 1e-12);
        }
        assert_eq!(percentile(&[], 50.0), None);
        assert_eq!(percentile(&[3.0], 95.0), Some(3.0));
        assert_eq!(median(&[4.0, 1.0, 3.0, 2.0]), Some(2.5));
        let spread = Spread::of(&[3.0, 1.0, 2.0]).unwrap();
        assert_eq!((spread.median, spread.min), (2.0, 1.0));
        assert!((spread.p95 - 2.9).abs() < 1e-12);
    }

    #[test]
    fn the_interval_covers_the_median_about_95_times_in_100() {
        // 400 trials, standard error 1.1 %.
        let mut random = SplitMix64::new(9);
        let covered = (0..400).filter(|trial| {
            let values: Vec<f64> = (0..31).map(|_| noise(&mut random)).collect();
            let [low, high] = median_ci95(&values, *trial).unwrap();
            (low..=high).contains(&0.0)
        });
        let share = covered.count() as f64 / 400.0;
        assert!((0.91..=0.99).contains(&share), "covered {share}");
    }

    #[test]
    fn values_of_a_block_count_as_one() {
        // Eight values a block that are nearly the same, and a block remembers half of the last.
        let mut random = SplitMix64::new(5);
        let mut covered = [0; 2];
        for trial in 0..200 {
            let mut level = 0.0;
            let blocks: Vec<Vec<f64>> = (0..64)
                .map(|_| {
                    level = 0.5 * level + noise(&mut random);
                    (0..8).map(|_| level + 0.1 * noise(&mut random)).collect()
                })
                .collect();
            let intervals =
                [median_ci95(&blocks.concat(), trial), blocks_median_ci95(&blocks, trial)];
            for (count, interval) in covered.iter_mut().zip(intervals) {
                let [low, high] = interval.unwrap();
                *count += i32::from((low..=high).contains(&0.0));
            }
        }
        assert!(covered[0] < 120, "taken for independent, the interval covers {}", covered[0]);
        assert!(covered[1] > 170, "in blocks it covers {} of 200", covered[1]);
    }

    #[test]
    fn a_median_of_draws_is_that_of_the_values_drawn() {
        let ranked = [(1.0, 0), (2.0, 1), (3.0, 1), (8.0, 2)];
        for (drawn, expected) in [
            ([1, 1, 1], Some(2.5)),
            ([0, 0, 3], Some(8.0)),
            ([2, 1, 0], Some(1.5)),
            ([3, 0, 1], Some(1.0)),
            ([0, 0, 0], None),
        ] {
            assert_eq!(drawn_median(&ranked, &drawn), expected, "{drawn:?}");
        }
    }

    #[test]
    fn trends_are_told_from_noise() {
        let decay: Vec<f64> = (0..8).map(|i| 1.0 + 0.5_f64.powi(i)).collect();
        assert!(has_trend(&decay));
        assert!(!has_trend(&[2.0; 8]));
        assert!(!has_trend(&[5.0, 1.0, 1.1, 0.9, 1.05, 0.95, 1.0, 1.02]), "only the first is slow");
        assert!(!has_trend(&[]));
        let mut random = SplitMix64::new(2);
        let alarms = (0..1000).filter(|_| has_trend(&[(); 8].map(|()| noise(&mut random))));
        let share = alarms.count() as f64 / 1000.0;
        assert!((0.01..=0.06).contains(&share), "{share} false alarms");
    }

    #[test]
    fn the_interval_is_seeded_and_shrinks_with_the_sample() {
        let wave = |n: u32| (0..n).map(|i| f64::from(i).sin()).collect::<Vec<_>>();
        assert_eq!(median_ci95(&wave(30), 1), median_ci95(&wave(30), 1));
        let width = |n| median_ci95(&wave(n), 1).map(|[low, high]| high - low).unwrap();
        assert!(width(1600) < 0.5 * width(100));
        assert_eq!(median_ci95(&[2.0; 9], 1), Some([2.0, 2.0]));
        assert_eq!(median_ci95(&[], 1), None);
        assert_eq!(blocks_median_ci95(&[], 1), None);
    }
}
