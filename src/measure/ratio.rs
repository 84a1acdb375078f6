//! How much slower one thing is than another, how sure that is, and what may be said about it.

use serde::{Deserialize, Serialize};

use super::statistics::{median, median_ci95};

/// Ratios nearer to one than this are no difference.
pub const BAND: f64 = 0.03;

/// "No difference" must rule out a difference as large as this.
const RULED_OUT: f64 = 0.1;

/// Rounds from which on a 95 % interval of a median exists: of five, all lie on the same side of it
/// once in 16 times.
const FEWEST_ROUNDS: usize = 6;

/// What an interval allows to be said.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// The whole interval lies below 0.97.
    Faster,
    /// The whole interval lies above 1.03.
    Slower,
    /// The interval meets 0.97 to 1.03 and lies within 0.9 to 1.1: a tenth would have been seen.
    NoDifference,
    /// The interval meets 0.97 to 1.03 and is too wide to say more.
    Undecided,
}

impl Verdict {
    pub fn of([low, high]: [f64; 2]) -> Verdict {
        if low > 1.0 + BAND {
            Verdict::Slower
        } else if high < 1.0 - BAND {
            Verdict::Faster
        } else if low >= 1.0 - RULED_OUT && high <= 1.0 + RULED_OUT {
            Verdict::NoDifference
        } else {
            Verdict::Undecided
        }
    }

    /// In words.
    pub fn text(self) -> &'static str {
        match self {
            Verdict::Faster => "faster",
            Verdict::Slower => "slower",
            Verdict::NoDifference => "no difference",
            Verdict::Undecided => "undecided",
        }
    }
}

/// A ratio of two times: over one is slower.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Comparison {
    pub median: f64,
    /// 95 % interval of the median.
    pub ci95: [f64; 2],
    pub verdict: Verdict,
}

impl Comparison {
    pub fn new(median: f64, ci95: [f64; 2]) -> Comparison {
        Comparison { median, ci95, verdict: Verdict::of(ci95) }
    }

    /// The median ratio of rounds in which both sides did the same work one soon after the other,
    /// from its logarithm in each; `None` for fewer than six rounds.
    ///
    /// What slows both sides of a round cancels in it: measured on a busy machine, the times of
    /// neighbouring rounds correlate by a half, their ratios by less than 0.1. So rounds are what is
    /// drawn, one by one. The median, because a neighbour's spike hits one side of some rounds.
    pub fn of_rounds(log_ratios: &[f64], seed: u64) -> Option<Comparison> {
        if log_ratios.len() < FEWEST_ROUNDS {
            return None;
        }
        let interval = median_ci95(log_ratios, seed)?;
        Some(Comparison::new(median(log_ratios)?.exp(), interval.map(f64::exp)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_verdict_follows_from_the_interval() {
        for (interval, verdict) in [
            ([1.04, 1.20], Verdict::Slower),
            ([1.02, 1.06], Verdict::NoDifference),
            ([0.99, 1.01], Verdict::NoDifference),
            ([0.92, 1.09], Verdict::NoDifference),
            ([0.85, 1.01], Verdict::Undecided),
            ([1.02, 1.30], Verdict::Undecided),
            ([0.50, 2.00], Verdict::Undecided),
            ([0.80, 0.96], Verdict::Faster),
        ] {
            assert_eq!(Verdict::of(interval), verdict, "{interval:?}");
        }
    }

    #[test]
    fn swapping_the_sides_inverts_the_ratio() {
        let logs: Vec<f64> = (0..21).map(|i| 0.2 + 0.1 * f64::from(i * 7 % 5)).collect();
        let swapped: Vec<f64> = logs.iter().map(|log| -log).collect();
        let [a, b] = [logs, swapped].map(|logs| Comparison::of_rounds(&logs, 3).unwrap());
        assert!((a.median * b.median - 1.0).abs() < 1e-12);
        assert_eq!((a.verdict, b.verdict), (Verdict::Slower, Verdict::Faster));
        assert!(a.ci95[0] <= a.median && a.median <= a.ci95[1]);
    }

    #[test]
    fn a_handful_of_rounds_says_nothing() {
        assert_eq!(Comparison::of_rounds(&[0.3; 5], 1), None);
        assert_eq!(Comparison::of_rounds(&[0.3; 6], 1).unwrap().verdict, Verdict::Slower);
    }
}
