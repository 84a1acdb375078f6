//! What a case costs beside the first of its table: times paired round by round.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::engine::FrameTimes;
use super::timing::{Burst, Timing};
use crate::measure::ratio::Comparison;
use crate::measure::statistics::median;
use crate::methods::Case;

/// The method every other is compared with, where it takes part (DESIGN 7).
pub const RIVAL: &str = "ray-traced";

/// A case's times over those of the first case of its table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ratio {
    /// That case's text.
    pub baseline: String,
    /// Rounds in which both played the same frames and neither was throttled.
    pub rounds: u64,
    /// Of the frames' GPU times, prepare not included.
    pub frame: Comparison,
    /// The same with the prepare passes of each frame included.
    pub with_prepare: Comparison,
}

/// The case the others are compared with: the first that is all ray traced, or else the first.
pub fn baseline(cases: &[Case]) -> usize {
    let is_rival = |case: &Case| case.parts.iter().all(|part| part.method == RIVAL);
    cases.iter().position(is_rival).unwrap_or(0)
}

/// A frame's GPU time with its prepare passes.
pub fn with_prepare(times: &FrameTimes) -> f64 {
    times.frame_gpu_ms + times.prepare.iter().map(|pass| pass.gpu_ms).sum::<f64>()
}

/// Compares one timing with another of the same measurement; `None` where too few rounds are left
/// to both.
pub fn ratio(case: &Timing, baseline: (&str, &Timing), seed: u64) -> Option<Ratio> {
    let (name, baseline) = baseline;
    let compared = |time: fn(&FrameTimes) -> f64| {
        let ratios = log_ratios(&case.bursts, &baseline.bursts, time);
        Some((ratios.len() as u64, Comparison::of_rounds(&ratios, seed)?))
    };
    let (rounds, frame) = compared(|times| times.frame_gpu_ms)?;
    let (_, with_prepare) = compared(with_prepare)?;
    Some(Ratio { baseline: name.to_owned(), rounds, frame, with_prepare })
}

/// The logarithm of the ratio of the bursts' medians in every round both have; bursts come in the
/// order of their rounds.
pub fn log_ratios<'b>(
    case: impl IntoIterator<Item = &'b Burst>,
    baseline: impl IntoIterator<Item = &'b Burst>,
    time: fn(&FrameTimes) -> f64,
) -> Vec<f64> {
    let middle = |burst: &Burst| {
        let times: Vec<f64> = burst.frames.iter().map(|(_, times)| time(times)).collect();
        // A coarse clock may show nothing at all.
        median(&times).filter(|ms| *ms > 0.0)
    };
    let mut baseline = baseline.into_iter().peekable();
    let mut ratios = Vec::new();
    for burst in case {
        while baseline.next_if(|other| other.round < burst.round).is_some() {}
        let Some(other) = baseline.next_if(|other| other.round == burst.round) else { continue };
        ratios.extend(middle(burst).zip(middle(other)).map(|(a, b)| (a / b).ln()));
    }
    ratios
}

#[cfg(test)]
mod tests {
    use super::super::clock::Clock;
    use super::super::rows::tests::pass;
    use super::*;
    use crate::methods::METHODS;

    fn timing(bursts: &[(usize, f64)]) -> Timing {
        let burst = |&(round, ms): &(usize, f64)| {
            let frame = |ms| FrameTimes {
                frame_gpu_ms: ms,
                prepare: vec![pass("capture", ms, 0.0)],
                ..Default::default()
            };
            let frames = vec![(0, frame(ms)), (1, frame(ms)), (2, frame(50.0 * ms))];
            Burst { round, frames, mhz: None }
        };
        let bursts = bursts.iter().map(burst).collect();
        Timing { bursts, warm_up: Vec::new(), clock: Clock::default() }
    }

    #[test]
    fn only_rounds_that_both_have_count() {
        let case = timing(&[(0, 2.0), (1, 99.0), (3, 4.0), (4, 0.0), (5, 8.0)]);
        let base = timing(&[(0, 1.0), (2, 99.0), (3, 2.0), (4, 1.0), (5, 4.0), (6, 99.0)]);
        let ratios = log_ratios(&case.bursts, &base.bursts, |times| times.frame_gpu_ms);
        assert_eq!(ratios, [2.0_f64.ln(); 3]);
        assert_eq!(ratio(&case, ("base", &base), 1), None, "three rounds are too few");
    }

    #[test]
    fn common_drift_cancels() {
        let drift = |factor: f64| -> Timing {
            let ms = |round: usize| factor * (1.0 + round as f64);
            timing(&(0..20).map(|round| (round, ms(round))).collect::<Vec<_>>())
        };
        let ratio = ratio(&drift(1.5), ("base", &drift(1.0)), 1).unwrap();
        assert_eq!((ratio.baseline.as_str(), ratio.rounds), ("base", 20));
        for value in [ratio.frame.median, ratio.frame.ci95[0], ratio.with_prepare.ci95[1]] {
            assert!((value - 1.5).abs() < 1e-9, "{ratio:?}");
        }
    }

    #[test]
    fn the_rival_leads_and_a_hybrid_is_not_it() {
        let methods: Vec<_> = METHODS.iter().collect();
        let mut cases = ["none", "environment-map"].map(|c| Case::parse(c, &methods).unwrap());
        assert_eq!(baseline(&cases), 0);
        cases[1].parts[0].method = RIVAL;
        assert_eq!(baseline(&cases), 1);
        let other = cases[0].parts[0].clone();
        cases[1].parts.push(other);
        assert_eq!(baseline(&cases), 0);
    }
}
