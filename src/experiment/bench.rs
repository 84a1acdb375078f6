//! A benchmark: cases of one scene, timed against each other and compared with the truth.

use std::collections::BTreeMap;
use std::path::PathBuf;

use serde_json::json;

use super::comparison::{self, Ratio};
use super::engine::FrameTimes;
use super::evidence::{self, Evidence};
use super::lab::{Lab, TRUTH};
use super::output::{OutputFolder, write_file};
use super::path::{self, PathRun};
use super::results::{COMMIT, Row, SCHEMA_VERSION, SceneCard, case_columns};
use super::results_file::{self, RESULTS};
use super::rows;
use super::timing::{self, Timing, TimingPlan};
use crate::error::Result;
use crate::methods::Case;
use crate::scene::{Moment, Scene};

/// What is measured on every scene and case.
#[derive(Clone, Debug)]
pub struct BenchPlan {
    /// The scene's frames, in order.
    pub frames: Vec<u32>,
    /// How many of them, evenly spaced, are compared with the truth.
    pub truth_frames: usize,
    /// Whether frames are timed at all.
    pub timed: bool,
    /// Play the frames so often, instead of until the interval is narrow.
    pub repeat: Option<u32>,
    /// Consecutive frames along which scene points are followed; none where empty.
    pub path: Vec<u32>,
}

/// One row and the arrays behind it.
#[derive(Clone, Debug)]
pub struct Outcome {
    pub row: Row,
    pub timing: Option<Timing>,
    pub evidence: Evidence,
    pub path: Option<PathRun>,
}

/// Measures cases of one scene. The cases are timed in turns within each other.
///
/// # Errors
/// Those of the engine and of the truth.
pub fn bench(lab: &Lab, scene: &Scene, cases: &[Case], plan: &BenchPlan) -> Result<Vec<Outcome>> {
    let truth_frames = evidence::evenly_spaced(&plan.frames, plan.truth_frames);
    let mut timings = if plan.timed { time(lab, scene, cases, plan)? } else { BTreeMap::new() };
    let gathered = evidence::gather(lab, scene, cases, &truth_frames)?;
    let mut paths = match plan.path.as_slice() {
        [] => vec![None; cases.len()],
        frames => path::follow(lab, scene, cases, frames)?.into_iter().map(Some).collect(),
    };
    let outcomes = cases.iter().zip(gathered).enumerate().map(|(i, (case, evidence))| {
        let timed = timings.remove(&i);
        let mut row = row(lab, scene, case, plan, &truth_frames)?;
        if let Some(Timed { timing, still, ratio }) = &timed {
            row.prepare = Some(rows::prepare(timing));
            row.frame_gpu_ms = rows::frame_time(timing, lab.settings.seed);
            row.ratio.clone_from(ratio);
            row.passes = rows::passes(timing);
            rows::add_invocations(&mut row.passes, &still.times);
            row.clock = Some(timing.clock);
            row.software_timing = row.device.is_software;
            row.reflector_pixels = Some(still.reflector_pixels as f64);
        }
        if !evidence.frames.is_empty() {
            row.reflector_pixels = Some(evidence.reflector_pixels);
            row.accuracy = evidence.accuracy();
            row.counters.clone_from(&evidence.counters);
        }
        let path = paths[i].take();
        row.stability = path.as_ref().map(|path| path.stability.clone());
        Ok(Outcome { row, timing: timed.map(|timed| timed.timing), evidence, path })
    });
    outcomes.collect()
}

/// One frame drawn on its own after the timing: bursts count neither invocations nor pixels.
struct Still {
    times: FrameTimes,
    reflector_pixels: usize,
}

struct Timed {
    timing: Timing,
    still: Still,
    ratio: Option<Ratio>,
}

/// Times every case but the truth, by its place in the list.
fn time(
    lab: &Lab,
    scene: &Scene,
    cases: &[Case],
    plan: &BenchPlan,
) -> Result<BTreeMap<usize, Timed>> {
    let places: Vec<usize> = (0..cases.len()).filter(|&i| !cases[i].uses(TRUTH)).collect();
    if places.is_empty() {
        return Ok(BTreeMap::new());
    }
    let timed_cases: Vec<Case> = places.iter().map(|&i| cases[i].clone()).collect();
    let baseline = comparison::baseline(&timed_cases);
    let settings = &lab.settings;
    let engines =
        places.iter().map(|&i| lab.engine(scene, &cases[i], settings.size, settings.record));
    let mut engines = engines.collect::<Result<Vec<_>>>()?;
    let moments: Vec<Moment> = plan.frames.iter().map(|frame| scene.at(*frame)).collect();
    let timing_plan = TimingPlan {
        repeat: plan.repeat,
        seed: settings.seed,
        clock: lab.clock_source()?,
        cap: TimingPlan::CAP,
        baseline,
    };
    lab.progress.set_message(format!("{}: timing {} cases", scene.name, places.len()));
    let begun = lab.progress.position();
    let timings = timing::measure(&mut engines, &moments, &timing_plan, &mut |share| {
        lab.progress.set_position(begun + (share * cases.len() as f64) as u64);
    })?;
    lab.progress.set_position(begun);
    let middle = &moments[moments.len() / 2];
    let stills = engines.iter_mut().map(|engine| {
        let (frame, times) = engine.frame(middle, true)?;
        Ok(Still { times, reflector_pixels: frame.reflector_pixels().len() })
    });
    let stills = stills.collect::<Result<Vec<_>>>()?;
    let base = (timed_cases[baseline].text.as_str(), &timings[baseline]);
    let ratio = |(i, timing)| {
        let other = Some(timing).filter(|_| i != baseline);
        other.and_then(|timing| comparison::ratio(timing, base, settings.seed))
    };
    let ratios: Vec<Option<Ratio>> = timings.iter().enumerate().map(ratio).collect();
    let parts = timings.into_iter().zip(stills).zip(ratios);
    let timed = parts.map(|((timing, still), ratio)| Timed { timing, still, ratio });
    Ok(places.into_iter().zip(timed).collect())
}

/// A row without measurements.
pub fn row(
    lab: &Lab,
    scene: &Scene,
    case: &Case,
    plan: &BenchPlan,
    truth_frames: &[u32],
) -> Result<Row> {
    let settings = &lab.settings;
    let (method, variant, params) = case_columns(case, lab.methods);
    let mut row = Row {
        schema_version: SCHEMA_VERSION,
        run: String::new(),
        commit: COMMIT.into(),
        scene: SceneCard::of(scene),
        case: case.text.clone(),
        method,
        variant,
        params,
        fallback: settings.fallback.name().into(),
        record: settings.record.enough_for(scene).name().into(),
        size: settings.size,
        frames: plan.frames.clone(),
        truth_frames: truth_frames.to_vec(),
        device: lab.device_card(case)?,
        software_timing: false,
        reflector_pixels: None,
        prepare: None,
        frame_gpu_ms: None,
        ratio: None,
        passes: Vec::new(),
        counters: BTreeMap::new(),
        accuracy: None,
        stability: None,
        clock: None,
    };
    // Everything known before measuring is an input.
    let inputs = json!([row, settings.seed, plan.timed, plan.repeat, plan.path]);
    row.run = blake3::hash(inputs.to_string().as_bytes()).to_hex()[..16].to_owned();
    Ok(row)
}

impl Outcome {
    /// Appends the row to the folder's results and puts the per-frame arrays beside them, as
    /// `RUN.frames.json`. Returns that file.
    ///
    /// # Errors
    /// [`crate::error::Error::Output`].
    pub fn save(&self, folder: &OutputFolder) -> Result<PathBuf> {
        let timed = self.timing.iter().flat_map(Timing::frames).map(|(frame, times)| {
            let prepare: f64 = times.prepare.iter().map(|pass| pass.gpu_ms).sum();
            // Passes of one name in a frame count with their sum.
            let mut passes = serde_json::Map::new();
            for pass in &times.passes {
                let so_far = passes.get(&pass.name).and_then(serde_json::Value::as_f64);
                passes.insert(pass.name.clone(), json!(so_far.unwrap_or(0.0) + pass.gpu_ms));
            }
            json!({
                "frame": frame, "gpu_ms": times.frame_gpu_ms, "prepare_gpu_ms": prepare,
                "passes_gpu_ms": passes,
            })
        });
        let compared = self.evidence.frames.iter();
        let compared =
            compared.map(|(frame, accuracy)| json!({"frame": frame, "accuracy": accuracy}));
        let arrays = json!({
            "run": self.row.run, "scene": self.row.scene.name, "case": self.row.case,
            "timed": timed.collect::<Vec<_>>(), "compared": compared.collect::<Vec<_>>(),
            "path": self.path.as_ref().map_or(&[][..], |path| &path.frames),
            "path_counters": self.path.as_ref().map_or(&[][..], |path| &path.counters),
        });
        let path = folder.file(&format!("{}.frames.json", self.row.run));
        write_file(&path, |file| Ok(serde_json::to_writer(file, &arrays)?))?;
        results_file::append(&folder.file(RESULTS), &self.row)?;
        Ok(path)
    }
}
