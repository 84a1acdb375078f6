//! What one case draws of the points followed along a path.

use glam::{Vec2, Vec3};
use rayon::prelude::*;

use super::drawn::Drawn;
use super::judge::Court;
use super::stability::{Jitter, PathFrame, SLOW_PX};
use super::track::{Track, Tracks};
use crate::scene::FrameRecord;

/// A point that moves by more against its place from one frame to the next has jumped, pixels.
const JUMP_PX: f32 = 1.0;

/// How a case draws a point in one frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Sight {
    /// So many pixels from where it belongs.
    At(Vec2),
    /// Not, though it did and the truth does.
    Gone,
    /// Too near to an edge to tell, or not yet.
    #[default]
    Unclear,
}

/// A point's last three frames, the latest first.
#[derive(Clone, Copy, Debug, Default)]
struct Trail {
    sights: [Sight; 3],
    /// The latest displacement known.
    last: Option<Vec2>,
}

impl Trail {
    fn follow(&self, track: &Track, drawn: &Drawn) -> Trail {
        let displacement = drawn.displacement(track, self.last.unwrap_or(Vec2::ZERO));
        let sight = match (displacement, self.last) {
            (Some(displacement), _) => Sight::At(displacement),
            (None, Some(last)) if drawn.lacks(track, last) => Sight::Gone,
            _ => Sight::Unclear,
        };
        let [latest, before, _] = self.sights;
        Trail { sights: [sight, latest, before], last: displacement.or(self.last) }
    }

    /// Amplitude of the vibration around the middle frame, pixels.
    fn jitter(&self) -> Option<f64> {
        let [Sight::At(after), Sight::At(at), Sight::At(before)] = self.sights else { return None };
        Some(f64::from((before - 2.0 * at + after).length()) / 4.0)
    }

    /// Whether the point jumped into the latest frame; `None` where that cannot be told.
    fn jumped(&self) -> Option<bool> {
        match [self.sights[0], self.sights[1]] {
            [Sight::Unclear, _] | [_, Sight::Unclear] => None,
            [Sight::At(now), Sight::At(before)] => Some(now.distance(before) > JUMP_PX),
            [now, before] => Some(now != before),
        }
    }
}

/// One case along a path, frame by frame.
#[derive(Default)]
pub(super) struct Trails {
    /// By live track.
    trails: Vec<Trail>,
    /// By pixel, the colour's error in the last frame; empty after a fast frame.
    errors: Vec<Option<Vec3>>,
    pub frames: Vec<PathFrame>,
    /// Of all points and frames.
    pub jitter: Vec<f64>,
}

impl Trails {
    /// Takes the next frame, whose points have moved at `speed_px` since the last.
    pub fn follow(
        &mut self,
        tracks: &Tracks,
        tested: &FrameRecord,
        court: &Court,
        speed_px: Option<f64>,
    ) {
        let drawn = Drawn::new(tested, court);
        let known = tracks.live.par_iter().zip(&tracks.parents);
        self.trails = known
            .map(|(track, parent)| {
                let before = parent.map_or(Trail::default(), |parent| self.trails[parent]);
                before.follow(track, &drawn)
            })
            .collect();
        let jitter: Vec<f64> = self.trails.iter().filter_map(Trail::jitter).collect();
        if let Some(middle) = self.frames.last_mut() {
            middle.jitter_px = Jitter::of(&jitter);
        }
        self.jitter.extend(jitter);
        let shown = |trail: &&Trail| matches!(trail.sights[0], Sight::At(_));
        let jumps: Vec<bool> = self.trails.iter().filter_map(Trail::jumped).collect();
        let temporal_error = self.temporal_error(&drawn, speed_px);
        self.frames.push(PathFrame {
            frame: court.tracer.moment().frame,
            points: tracks.live.len(),
            covered: share(self.trails.iter().filter(shown).count(), self.trails.len()),
            speed_px,
            jitter_px: None,
            popping: share(jumps.iter().filter(|jumped| **jumped).count(), jumps.len()),
            temporal_error,
        });
    }

    /// Root of the mean square change of the pixels' colour errors since the last frame.
    fn temporal_error(&mut self, drawn: &Drawn, speed_px: Option<f64>) -> Option<f64> {
        let slow = speed_px.is_none_or(|px| px <= SLOW_PX);
        let now = if slow { drawn.colour_errors() } else { Vec::new() };
        let before = std::mem::replace(&mut self.errors, now);
        let pairs = self.errors.iter().zip(&before);
        let changes = pairs.filter_map(|(now, before)| Some((*now)? - (*before)?));
        let squares: Vec<f64> =
            changes.map(|change| f64::from(change.length_squared()) / 3.0).collect();
        let mean = squares.iter().sum::<f64>() / squares.len() as f64;
        (!squares.is_empty()).then(|| mean.sqrt())
    }
}

fn share(count: usize, of: usize) -> f64 {
    count as f64 / of.max(1) as f64
}
