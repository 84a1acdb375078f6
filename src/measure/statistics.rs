//! Statistics of timings: robust, seeded, without distributional assumptions.

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

/// The 95 % percentile-bootstrap interval of the median (Efron 1979): the medians of samples drawn
/// from `values` with replacement, cut at 2.5 % on either side. The same seed gives the same
/// interval. `None` without values.
pub fn median_ci95(values: &[f64], seed: u64) -> Option<[f64; 2]> {
    if values.is_empty() {
        return None;
    }
    let mut random = SplitMix64::new(seed);
    let mut sample = vec![0.0; values.len()];
    let mut medians = Vec::with_capacity(RESAMPLES);
    for _ in 0..RESAMPLES {
        sample.fill_with(|| values[random.below(values.len())]);
        medians.extend(median(&sample));
    }
    let medians = sorted(&medians);
    Some([percentile(&medians, 2.5)?, percentile(&medians, 97.5)?])
}

/// Steele, Lea & Flood 2014: a 64-bit generator of one word of state.
#[derive(Clone, Debug)]
pub struct SplitMix64(u64);

impl SplitMix64 {
    pub fn new(seed: u64) -> Self {
        SplitMix64(seed)
    }

    pub fn next_u64(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number in `0..end`; `end` is positive. Lemire's multiplication, bias below 2^-32 for the
    /// sample sizes of a benchmark.
    pub fn below(&mut self, end: usize) -> usize {
        ((u128::from(self.next_u64()) * end as u128) >> 64) as usize
    }

    /// Fisher and Yates's shuffle.
    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for end in (2..=items.len()).rev() {
            items.swap(end - 1, self.below(end));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
    fn the_generator_is_the_published_one() {
        // First outputs of the reference implementation for seed 1234567.
        let mut random = SplitMix64::new(1_234_567);
        let expected = [6457827717110365317, 3203168211198807973, 9817491932198370423];
        assert_eq!([(); 3].map(|()| random.next_u64()), expected);
    }

    #[test]
    fn a_shuffle_is_a_permutation_and_reaches_every_place() {
        let mut random = SplitMix64::new(5);
        let mut first = [0; 4];
        for _ in 0..400 {
            let mut items = [0, 1, 2, 3];
            random.shuffle(&mut items);
            first[items[0]] += 1;
            items.sort_unstable();
            assert_eq!(items, [0, 1, 2, 3]);
        }
        assert!(first.iter().all(|n| (60..140).contains(n)), "{first:?}");
    }

    #[test]
    fn the_interval_covers_the_median_about_95_times_in_100() {
        // Uniform on 0..1: the true median is 1/2. 400 trials, standard error 1.1 %.
        let mut random = SplitMix64::new(9);
        let mut uniform = || random.next_u64() as f64 / u64::MAX as f64;
        let covered = (0..400).filter(|trial| {
            let values: Vec<f64> = (0..31).map(|_| uniform()).collect();
            let [low, high] = median_ci95(&values, *trial).unwrap();
            (low..=high).contains(&0.5)
        });
        let share = covered.count() as f64 / 400.0;
        assert!((0.91..=0.99).contains(&share), "covered {share}");
    }

    #[test]
    fn the_interval_is_seeded_and_shrinks_with_the_sample() {
        let wave = |n: u32| (0..n).map(|i| f64::from(i).sin()).collect::<Vec<_>>();
        assert_eq!(median_ci95(&wave(30), 1), median_ci95(&wave(30), 1));
        let width = |n| median_ci95(&wave(n), 1).map(|[low, high]| high - low).unwrap();
        assert!(width(1600) < 0.5 * width(100));
        assert_eq!(median_ci95(&[2.0; 9], 1), Some([2.0, 2.0]));
        assert_eq!(median_ci95(&[], 1), None);
    }
}
