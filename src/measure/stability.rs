//! Steadiness along a path: how scene points tremble in the mirrors of consecutive frames.
//!
//! Points are followed through the truth's mirrors (`track`), not through glass; what a case
//! draws of each is its displacement vector d(t) in pixels (`drawn`). However far off, a
//! steady picture has a d that changes slowly, so what is measured is the second difference:
//!
//! jitter(t) = |d(t - 1) - 2 d(t) + d(t + 1)| / 4
//!
//! The quarter makes it the amplitude a of a point that is drawn a to either side of its place in
//! turn, the fastest vibration a film can show: a film's picture shifted by +a, -a, +a scores a at
//! every point. A slower vibration, of T frames a period, counts a sin^2(pi / T), so motion over
//! seconds hardly does; offsets of length a in random directions count a sqrt(6) / 4 in quadratic
//! mean. Any constant shift and any steady drift count nothing.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::judge::Court;
use super::statistics::{Spread, median};
use super::track::{Track, Tracks};
use super::trail::Trails;
use crate::error::{Error, Result};
use crate::scene::{FrameRecord, Lobe};
use crate::truth::Tracer;

/// A frame in which more than this share of the points jump is a pop.
const POP_SHARE: f64 = 0.005;

/// Faster paths have no temporal error, pixels a frame: pixels would show something else each time.
pub const SLOW_PX: f64 = 0.125;

/// The fewest frames with a second difference.
pub const LEAST_FRAMES: usize = 3;

/// Steadiness of one case along a path.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stability {
    /// First and last of the consecutive frames that were followed.
    pub frames: [u32; 2],
    /// A quarter of the second difference of the displacement vector, over all points and frames:
    /// the amplitude of a picture that goes to and fro from frame to frame. Null where no point
    /// was shown over three frames.
    pub jitter_px: Option<Jitter>,
    /// Frames in which more than 0.5 % of the points that are compared with the frame before jump by
    /// over a pixel, or vanish or appear though the truth goes on showing them.
    pub pops: u64,
    /// How the pixels' colour errors change from frame to frame: root of the mean square, in displayed
    /// values from 0 to 1. A pixel's error is its colour less the truth's where what it shows belongs.
    /// Null on paths faster than 1/8 px a frame.
    pub temporal_error: Option<f64>,
    /// Points followed a frame, mean.
    pub points: f64,
    /// Share of them whose place in the case's picture was found.
    pub covered: f64,
    /// How fast the points move in the truth, pixels a frame: the median of the fastest frame.
    pub speed_px: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Jitter {
    pub median: f64,
    pub p95: f64,
}

/// One frame of a path.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PathFrame {
    pub frame: u32,
    /// Points followed.
    pub points: usize,
    /// Share of them whose place in the case's picture was found.
    pub covered: f64,
    /// Median motion of the points since the frame before, pixels; null in the first.
    pub speed_px: Option<f64>,
    /// Over the points shown in the frames before, at and after this one.
    pub jitter_px: Option<Jitter>,
    /// Share of the points that jumped since the frame before.
    pub popping: f64,
    /// As [`Stability::temporal_error`], of this frame's change; null where it was too fast.
    pub temporal_error: Option<f64>,
}

/// Follows one path for several cases at once: the truth's side is the same for all.
#[derive(Default)]
pub struct PathMeasure {
    tracks: Tracks,
    cases: Vec<Trails>,
    size: Option<[u32; 2]>,
}

impl PathMeasure {
    pub fn new(cases: usize) -> Self {
        PathMeasure { cases: (0..cases).map(|_| Trails::default()).collect(), ..Self::default() }
    }

    /// Takes the next frame: its truth, a frame of `tracer`'s, and what every case draws, in the order
    /// of the cases.
    ///
    /// # Errors
    /// When the frames differ in size, from each other or from the ones before.
    pub fn frame(
        &mut self,
        tracer: &Tracer,
        truth: &FrameRecord,
        tested: &[FrameRecord],
    ) -> Result<()> {
        let mut sizes = tested.iter().map(|frame| frame.size).chain(self.size);
        if let Some([a, b]) = sizes.find(|size| *size != truth.size) {
            let [c, d] = truth.size;
            return Err(Error::Usage(format!(
                "the truth is {c}x{d} pixels, another frame {a}x{b}"
            )));
        }
        self.size = Some(truth.size);
        let court = Court::new(truth, tracer, Lobe::Reflected);
        self.tracks.advance(&court);
        let speed_px = speed(&self.tracks.live);
        for (case, tested) in self.cases.iter_mut().zip(tested) {
            case.follow(&self.tracks, tested, &court, speed_px);
        }
        Ok(())
    }

    /// The verdict on every case, with the frames behind it.
    pub fn finish(self) -> Vec<(Stability, Vec<PathFrame>)> {
        self.cases.into_iter().map(|case| verdict(case.frames, &case.jitter)).collect()
    }
}

/// Median motion of the tracks since the frame before, pixels.
fn speed(tracks: &[Track]) -> Option<f64> {
    let moved = |track: &Track| Some(f64::from(track.at.distance(track.before?)));
    median(&tracks.iter().filter_map(moved).collect::<Vec<_>>())
}

fn verdict(frames: Vec<PathFrame>, jitter: &[f64]) -> (Stability, Vec<PathFrame>) {
    let number = |frame: Option<&PathFrame>| frame.map_or(0, |frame| frame.frame);
    let points: usize = frames.iter().map(|frame| frame.points).sum();
    let found: f64 = frames.iter().map(|frame| frame.covered * frame.points as f64).sum();
    let speed_px = frames.iter().filter_map(|frame| frame.speed_px).fold(0.0, f64::max);
    let squares: Vec<f64> =
        frames.iter().filter_map(|frame| frame.temporal_error).map(|error| error * error).collect();
    let mean_square = squares.iter().sum::<f64>() / squares.len() as f64;
    let stability = Stability {
        frames: [number(frames.first()), number(frames.last())],
        jitter_px: Jitter::of(jitter),
        pops: frames.iter().filter(|frame| frame.popping > POP_SHARE).count() as u64,
        temporal_error: (speed_px <= SLOW_PX && !squares.is_empty()).then(|| mean_square.sqrt()),
        points: points as f64 / frames.len().max(1) as f64,
        covered: found / points.max(1) as f64,
        speed_px,
    };
    (stability, frames)
}

impl Jitter {
    /// `None` without values.
    pub(super) fn of(values: &[f64]) -> Option<Jitter> {
        let Spread { median, p95, .. } = Spread::of(values)?;
        Some(Jitter { median, p95 })
    }
}
