//! `profile`: where the time of a frame goes.

use std::path::PathBuf;

use super::args::{Common, Frames, frames_of};
use super::console::{Console, table};
use super::work;
use crate::error::{Error, Result};
use crate::experiment::bench::{self, BenchPlan};
use crate::experiment::lab::TRUTH;
use crate::experiment::results::{PassRow, Row};
use crate::experiment::trace::write_trace;
use crate::methods::{Case, MethodInfo};
use crate::scene;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// A scene of `list scenes`, or a path to a .toml file
    #[arg(long)]
    scene: String,
    /// METHOD[@VARIANT][:key=value,...]; `describe METHOD` has the keys
    #[arg(long)]
    case: String,
    /// Frames A to B of the scene's animation, B not included [default: all]
    #[arg(long, value_name = "A..B")]
    frames: Option<Frames>,
    /// Time all frames so often [default: until the median's 95 % interval is within 3 %, or 5 s]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    repeat: Option<u32>,
    /// Write a trace for ui.perfetto.dev or chrome://tracing
    #[arg(long, value_name = "FILE")]
    trace: Option<PathBuf>,
    #[command(flatten)]
    common: Common,
}

pub fn profile(args: &Args, methods: &[&'static MethodInfo]) -> Result<()> {
    let console = Console::new(args.common.json);
    let case = Case::parse(&args.case, methods)?;
    if case.uses(TRUTH) {
        return Err(Error::Usage(
            "the truth runs on no device: there is nothing to profile".into(),
        ));
    }
    let scene = scene::load(&args.scene)?;
    let frames = frames_of(&scene, args.frames.as_ref())?.collect();
    let folder = work::folder(args.common.out.as_ref(), &scene, &case)?;
    if let Some(path) = &args.trace {
        // Proves that the file can be written, before the work.
        write_trace(path, &[])?;
    }
    let lab = work::lab(&args.common, methods, &console, folder.path().to_owned());
    console.progress().set_length(1);
    let plan =
        BenchPlan { frames, truth_frames: 0, timed: true, repeat: args.repeat, path: Vec::new() };
    for outcome in bench::bench(&lab, &scene, std::slice::from_ref(&case), &plan)? {
        outcome.save(&folder)?;
        if let (Some(path), Some(timing)) = (&args.trace, &outcome.timing) {
            write_trace(path, &timing.frames().cloned().collect::<Vec<_>>())?;
        }
        console.object(&outcome.row)?;
        console.report(&report(&outcome.row))?;
    }
    lab.close()
}

/// Passes with their share of the frame, then the frame.
fn report(row: &Row) -> String {
    let Some(frame) = row.frame_gpu_ms else { return String::new() };
    let heading = ["PASS", "GPU MS", "MIN", "P95", "CPU MS", "SHARE", "INVOCATIONS"];
    let mut lines = vec![heading.map(str::to_owned).to_vec()];
    let share = |pass: &PassRow| {
        let share = 100.0 * pass.gpu_ms.median / frame.median;
        if pass.prepare { "prepare".to_owned() } else { format!("{share:.1} %") }
    };
    lines.extend(row.passes.iter().map(|pass| {
        vec![
            pass.name.clone(),
            format!("{:.3}", pass.gpu_ms.median),
            format!("{:.3}", pass.gpu_ms.min),
            format!("{:.3}", pass.gpu_ms.p95),
            format!("{:.3}", pass.cpu_ms),
            share(pass),
            pass.invocations.to_string(),
        ]
    }));
    let numbers = [frame.median, frame.min, frame.p95].map(|ms| format!("{ms:.3}"));
    lines.push([vec!["frame".to_owned()], numbers.to_vec()].concat());
    let mut text = format!(
        "{} on {}, {}x{}, {}{}\n{}",
        row.case,
        row.scene.name,
        row.size[0],
        row.size[1],
        row.device.name,
        work::time_mark(row.software_timing),
        table(&lines)
    );
    let [low, high] = frame.ci95;
    text += &format!("\nmedian of {} frames within {low:.3}..{high:.3} ms", frame.n);
    if let Some(prepare) = row.prepare.filter(|prepare| prepare.calls > 0) {
        text += &format!(
            "; prepare {:.3} ms GPU + {:.3} ms CPU a call, {} calls, {:.1} MiB",
            prepare.gpu_ms,
            prepare.cpu_ms,
            prepare.calls,
            prepare.bytes as f64 / f64::from(1 << 20)
        );
    }
    text
}
