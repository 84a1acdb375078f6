//! Following a path: consecutive frames of every case, in full-record mode, for their stability.

use std::collections::BTreeMap;

use super::lab::Lab;
use crate::error::Result;
use crate::measure::{PathFrame, PathMeasure, Stability};
use crate::methods::Case;
use crate::scene::Scene;
use crate::truth::{Tracer, TruthOptions};

/// So many frames of an animation are followed where the user names none: two seconds at 24 Hz.
pub const DEFAULT_FRAMES: usize = 48;

/// What one case's path said.
#[derive(Clone, Debug)]
pub struct PathRun {
    pub stability: Stability,
    pub frames: Vec<PathFrame>,
    /// Work of each frame, by counter.
    pub counters: Vec<BTreeMap<String, u64>>,
}

/// Draws every case at every one of `frames`, which are consecutive, and follows the scene's points
/// from one to the next. The truths are not kept: a path has many, and each is needed once.
///
/// # Errors
/// Those of the engine.
pub fn follow(lab: &Lab, scene: &Scene, cases: &[Case], frames: &[u32]) -> Result<Vec<PathRun>> {
    let size = lab.settings.size;
    let artists = cases.iter().map(|case| lab.artist(scene, case, size));
    let mut artists = artists.collect::<Result<Vec<_>>>()?;
    let mut measure = PathMeasure::new(cases.len());
    let mut counters = vec![Vec::with_capacity(frames.len()); cases.len()];
    for (i, &number) in frames.iter().enumerate() {
        let moment = scene.at(number);
        let tracer = Tracer::new(scene, &moment, TruthOptions::default());
        let of = frames.len();
        lab.progress.set_message(format!("{}: frame {} of {of} of the path", scene.name, i + 1));
        let drawn = artists.iter_mut().zip(&mut counters).map(|(artist, counters)| {
            let (frame, times) = artist.frame(&moment, size, i == 0)?;
            counters.push(times.counters.into_iter().collect());
            Ok(frame)
        });
        measure.frame(&tracer, &tracer.frame(size), &drawn.collect::<Result<Vec<_>>>()?)?;
    }
    let runs = measure.finish().into_iter().zip(counters);
    let run = |((stability, frames), counters)| PathRun { stability, frames, counters };
    Ok(runs.map(run).collect())
}
