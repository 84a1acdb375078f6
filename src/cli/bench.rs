//! `bench` and `sweep`: many cases on many scenes, timed and compared with the truth.

use std::path::PathBuf;
use std::str::FromStr;

use super::args::{Common, Frames, Shard, Size, Vary, frames_of};
use super::console::{Console, table};
use super::work;
use crate::error::{Error, Result};
use crate::experiment::bench::{self, BenchPlan};
use crate::experiment::comparison::{self, Ratio};
use crate::experiment::path::DEFAULT_FRAMES;
use crate::experiment::results::Row;
use crate::experiment::sweep::{Sweep, batches};
use crate::measure::Stability;
use crate::measure::stability::LEAST_FRAMES;
use crate::methods::{Case, MethodInfo};
use crate::scene::Scene;

#[derive(Debug, clap::Args)]
pub struct BenchArgs {
    /// A scene of `list scenes`, or a path to a .toml file; repeat for several
    #[arg(long, required = true)]
    scene: Vec<String>,
    /// METHOD[@VARIANT][:key=value,...]; repeat for several
    #[arg(long, required = true)]
    case: Vec<String>,
    /// Values of a parameter to try; repeat for all combinations
    #[arg(long, value_name = "METHOD.key=a,b,c")]
    vary: Vec<Vary>,
    /// Frames A to B of the scene's animation, B not included [default: all]
    #[arg(long, value_name = "A..B")]
    frames: Option<Frames>,
    /// Time all frames so often [default: until the median's 95 % interval is within 3 %, or 5 s]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    repeat: Option<u32>,
    /// How many of the frames, evenly spaced, are compared with the truth
    #[arg(long, default_value_t = 3, value_name = "N")]
    truth_frames: usize,
    /// Follow scene points from frame to frame, for jitter and pops: along all of --frames, or
    /// along the animation's first 48
    #[arg(long)]
    path: bool,
    #[command(flatten)]
    common: Common,
}

#[derive(Debug, clap::Args)]
pub struct SweepArgs {
    /// TOML file: scenes, cases, and optionally vary, sizes, frames, repeat, truth_frames, path
    file: PathBuf,
    /// Do part I of N only
    #[arg(long, value_name = "I/N")]
    shard: Option<Shard>,
    #[command(flatten)]
    common: Common,
}

/// Everything a benchmark runs over, read and checked.
struct Request {
    scenes: Vec<Scene>,
    cases: Vec<Case>,
    sizes: Vec<Size>,
    frames: Option<Frames>,
    repeat: Option<u32>,
    truth_frames: usize,
    path: bool,
    shard: Option<Shard>,
}

pub fn bench(args: &BenchArgs, methods: &[&'static MethodInfo]) -> Result<()> {
    let request = Request {
        cases: work::parse_cases(&args.case, &args.vary, methods)?,
        scenes: work::load_scenes(&args.scene)?,
        sizes: vec![args.common.size],
        frames: args.frames.clone(),
        repeat: args.repeat,
        truth_frames: args.truth_frames,
        path: args.path,
        shard: None,
    };
    run(&request, &args.common, methods)
}

pub fn sweep(args: &SweepArgs, methods: &[&'static MethodInfo]) -> Result<()> {
    let sweep = Sweep::read(&args.file)?;
    let vary: Vec<Vary> = parsed(args, "vary", &sweep.vary)?;
    let mut sizes = parsed(args, "sizes", &sweep.sizes)?;
    if sizes.is_empty() {
        sizes.push(args.common.size);
    }
    let request = Request {
        cases: work::parse_cases(&sweep.cases, &vary, methods)?,
        scenes: work::load_scenes(&sweep.scenes)?,
        sizes,
        frames: parsed(args, "frames", sweep.frames.as_slice())?.pop(),
        repeat: sweep.repeat,
        truth_frames: sweep.truth_frames,
        path: sweep.path,
        shard: args.shard,
    };
    run(&request, &args.common, methods)
}

/// The values of one key of a sweep file, written as the flag of that name is.
fn parsed<T: FromStr<Err = String>>(
    args: &SweepArgs,
    key: &str,
    texts: &[String],
) -> Result<Vec<T>> {
    let file = args.file.display();
    let refused = |text, cause| Error::Usage(format!("{file}: {key} `{text}`: {cause}"));
    texts.iter().map(|text| text.parse().map_err(|cause| refused(text, cause))).collect()
}

fn run(request: &Request, common: &Common, methods: &[&'static MethodInfo]) -> Result<()> {
    let console = Console::new(common.json);
    let Request { scenes, sizes, .. } = request;
    let mut cases = request.cases.clone();
    let baseline = comparison::baseline(&cases);
    cases[..=baseline].rotate_right(1);
    let counts = [sizes.len(), scenes.len(), cases.len()];
    let shard = request.shard.map_or((1, 1), |shard| (shard.index, shard.count));
    let batches = batches(counts, shard);
    let mut plans = Vec::new();
    for scene in scenes {
        let frames: Vec<u32> = frames_of(scene, request.frames.as_ref())?.collect();
        let path = if request.path { path_of(scene, &frames, request)? } else { Vec::new() };
        let Request { truth_frames, repeat, .. } = *request;
        plans.push(BenchPlan { frames, truth_frames, timed: true, repeat, path });
    }
    // All folders are tried before any work is done.
    for batch in &batches {
        for case in &batch.cases {
            work::folder(common.out.as_ref(), &scenes[batch.scene], &cases[*case])?;
        }
    }
    let base = common.out.clone().unwrap_or_else(|| "out".into());
    let mut lab = work::lab(common, methods, &console, base);
    let total: usize = batches.iter().map(|batch| batch.cases.len()).sum();
    console.progress().set_length(total as u64);
    let mut rows = Vec::new();
    for batch in &batches {
        let (scene, plan) = (&scenes[batch.scene], &plans[batch.scene]);
        let cases: Vec<Case> = batch.cases.iter().map(|case| cases[*case].clone()).collect();
        lab.settings.size = sizes[batch.size].0;
        for (outcome, case) in bench::bench(&lab, scene, &cases, plan)?.into_iter().zip(&cases) {
            outcome.save(&work::folder(common.out.as_ref(), scene, case)?)?;
            console.object(&outcome.row)?;
            console.progress().inc(1);
            rows.push(outcome.row);
        }
    }
    console.report(&summary(&rows))?;
    if request.path {
        console.report(&steadiness(&rows))?;
    }
    lab.close()
}

/// The frames to follow: those the user named, or the animation's first.
fn path_of(scene: &Scene, frames: &[u32], request: &Request) -> Result<Vec<u32>> {
    let count = request.frames.as_ref().map_or(DEFAULT_FRAMES, |_| frames.len()).min(frames.len());
    if count < LEAST_FRAMES {
        return Err(Error::Usage(format!(
            "--path on scene {}: {count} frames; valid: at least {LEAST_FRAMES}",
            scene.name
        )));
    }
    Ok(frames[..count].to_vec())
}

/// One line a case: how steady it is.
fn steadiness(rows: &[Row]) -> String {
    let heading = ["SCENE", "CASE", "JITTER PX", "P95 PX", "POPS", "COLOUR", "COVERED", "SPEED PX"];
    let mut lines = vec![heading.map(str::to_owned).to_vec()];
    for row in rows {
        let Some(stability) = &row.stability else { continue };
        let Stability { jitter_px, pops, temporal_error, covered, speed_px, .. } = stability;
        let or_dash =
            |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{value:.3}"));
        lines.push(vec![
            row.scene.name.clone(),
            row.case.clone(),
            or_dash(jitter_px.map(|jitter| jitter.median)),
            or_dash(jitter_px.map(|jitter| jitter.p95)),
            pops.to_string(),
            or_dash(*temporal_error),
            format!("{:.1} %", 100.0 * covered),
            format!("{speed_px:.2}"),
        ]);
    }
    table(&lines)
}

/// One line a row: cost and error.
fn summary(rows: &[Row]) -> String {
    let heading = [
        "SCENE",
        "CASE",
        "SIZE",
        "FRAME MS",
        "95 %",
        "RATIO",
        "PREPARE MS",
        "BAD 1PX",
        "MEDIAN PX",
    ];
    let mut lines = vec![heading.map(str::to_owned).to_vec()];
    let or_dash = |text: Option<String>| text.unwrap_or_else(|| "-".into());
    for row in rows {
        let time = row.frame_gpu_ms;
        let mark = work::time_mark(row.software_timing);
        let accuracy = row.accuracy.as_ref();
        let shift = accuracy.and_then(|a| a.displacement_px);
        lines.push(vec![
            row.scene.name.clone(),
            row.case.clone(),
            format!("{}x{}", row.size[0], row.size[1]),
            or_dash(time.map(|t| format!("{:.3}{mark}", t.median))),
            or_dash(time.map(|t| format!("{:.3}..{:.3}", t.ci95[0], t.ci95[1]))),
            or_dash(row.ratio.as_ref().map(ratio)),
            or_dash(row.prepare.map(|p| format!("{:.3}", p.gpu_ms + p.cpu_ms))),
            or_dash(accuracy.map(|a| format!("{:.2} %", 100.0 * a.bad_share.one))),
            or_dash(shift.map(|d| format!("{:.2}", d.median))),
        ]);
    }
    table(&lines)
}

/// To the first row of the scene and size; with prepare, too, where frames were prepared anew.
fn ratio(ratio: &Ratio) -> String {
    let frame = work::ratio(ratio.frame);
    if ratio.with_prepare == ratio.frame {
        return frame;
    }
    format!("{frame}; with prepare {}", work::ratio(ratio.with_prepare))
}
