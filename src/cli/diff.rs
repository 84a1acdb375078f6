//! `diff`: two frame files or two run folders; a threshold makes it a test.

use std::path::PathBuf;

use super::args::share;
use super::console::{Console, table};
use super::work;
use crate::error::{Error, Result};
use crate::experiment::diff::{self, FrameDiff, RowDiff};

#[derive(Debug, clap::Args)]
pub struct Args {
    /// What to compare with: a frame's EXR, taken as the truth, or a run's folder
    a: PathBuf,
    /// What is compared: a frame's EXR of the same view, or a run's folder
    b: PathBuf,
    /// Fail with exit code 1 where B has a larger share of bad pixels, for instance 1%
    #[arg(long, value_name = "SHARE", value_parser = share)]
    max_bad_share: Option<f64>,
    /// Displacement in pixels from which a pixel is bad
    #[arg(long, default_value_t = 1.0, value_name = "PX", value_parser = positive)]
    at_px: f64,
    /// One JSON object a line on stdout; text for people goes to stderr
    #[arg(long)]
    json: bool,
}

fn positive(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|px| px.is_finite() && *px > 0.0);
    number.ok_or_else(|| "valid: a positive number of pixels".into())
}

pub fn run(args: &Args) -> Result<()> {
    let console = Console::new(args.json);
    if args.a.is_dir() != args.b.is_dir() {
        return Err(Error::Usage(format!(
            "{} and {} are not alike; valid: two EXR files or two run folders",
            args.a.display(),
            args.b.display()
        )));
    }
    let shares = if args.a.is_dir() {
        let rows = diff::runs(&args.a, &args.b, args.at_px)?;
        rows.iter().try_for_each(|row| console.object(row))?;
        console.report(&runs_report(&rows, args.at_px))?;
        rows.iter().map(|row| (row.case.clone(), row.bad_share[1])).collect()
    } else {
        let frame = diff::frames(&args.a, &args.b, args.at_px)?;
        console.object(&frame)?;
        console.report(&frame_report(&frame, args.at_px))?;
        vec![(frame.cases[1].clone(), Some(frame.bad_share_at_px))]
    };
    shares.into_iter().try_for_each(|(case, share)| check(args, &case, share))
}

/// Holds one share against the threshold.
fn check(args: &Args, case: &str, share: Option<f64>) -> Result<()> {
    let Some(limit) = args.max_bad_share else { return Ok(()) };
    let share = share.ok_or_else(|| {
        Error::Usage(format!("{case} was not compared with the truth: no share of bad pixels"))
    })?;
    if share <= limit {
        return Ok(());
    }
    let [share, limit] = [share, limit].map(|s| 100.0 * s);
    let at = args.at_px;
    Err(Error::Threshold(format!("{case}: {share:.3} % bad at {at} px, more than {limit} %")))
}

fn frame_report(diff: &FrameDiff, at_px: f64) -> String {
    let accuracy = &diff.accuracy;
    let percent = |share: f64| format!("{:.3} %", 100.0 * share);
    let quantiles = |q: Option<crate::measure::Quantiles>| {
        let text = q.map(|q| format!("median {:.3}, p95 {:.3}, max {:.3}", q.median, q.p95, q.max));
        text.unwrap_or_else(|| "-".into())
    };
    let [a, b] = &diff.cases;
    let rows = [
        (format!("bad at {at_px} px"), percent(diff.bad_share_at_px)),
        ("covered".into(), percent(accuracy.covered)),
        ("missing".into(), percent(accuracy.missing)),
        ("spurious".into(), percent(accuracy.spurious)),
        ("wrong object".into(), percent(accuracy.wrong_object)),
        ("wrong depth".into(), percent(accuracy.wrong_depth)),
        ("unreachable".into(), percent(accuracy.unreachable)),
        ("footprint mismatch".into(), percent(accuracy.footprint_mismatch)),
        ("displacement, px".into(), quantiles(accuracy.displacement_px)),
        ("angle, degrees".into(), quantiles(accuracy.angle_deg)),
        ("relative MSE".into(), format!("{:.6}", accuracy.relmse)),
        ("FLIP, mean".into(), format!("{:.5}", accuracy.flip.mean)),
    ];
    let rows = rows.map(|(name, value)| vec![format!("  {name}"), value]);
    format!("{} frame {}: {b} against {a}\n{}", diff.scene, diff.frame, table(&rows))
}

fn runs_report(rows: &[RowDiff], at_px: f64) -> String {
    let bad = format!("BAD {at_px}PX");
    let heading = ["SCENE", "CASE", "SIZE", "A MS", "B MS", "B/A", "A", "B"];
    let mut lines = vec![heading.map(str::to_owned).to_vec()];
    for column in [6, 7] {
        lines[0][column] = format!("{} {bad}", heading[column]);
    }
    let or_dash = |text: Option<String>| text.unwrap_or_else(|| "-".into());
    for row in rows {
        let percent = |share: f64| format!("{:.3} %", 100.0 * share);
        lines.push(vec![
            row.scene.clone(),
            row.case.clone(),
            format!("{}x{}", row.size[0], row.size[1]),
            or_dash(row.frame_gpu_ms.map(|ms| format!("{:.3}", ms[0]))),
            or_dash(row.frame_gpu_ms.map(|ms| format!("{:.3}", ms[1]))),
            or_dash(row.ratio.map(work::ratio)),
            or_dash(row.bad_share[0].map(percent)),
            or_dash(row.bad_share[1].map(percent)),
        ]);
    }
    table(&lines)
}
