//! Two frames or two runs, side by side.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;

use super::frame_file::{FrameFile, read_exr};
use super::results::Row;
use super::results_file::{self, RESULTS};
use crate::error::{Error, Result};
use crate::measure::ratio::Comparison;
use crate::measure::{Accuracy, accuracy};
use crate::scene;
use crate::truth::{Tracer, TruthOptions};

/// The error of frame file B, with frame file A taken as the truth.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FrameDiff {
    pub scene: String,
    pub frame: u32,
    pub cases: [String; 2],
    /// Share of bad pixels at the displacement asked for.
    pub bad_share_at_px: f64,
    pub accuracy: Accuracy,
}

/// Compares two frame files of the same scene and frame.
///
/// # Errors
/// [`Error::Usage`] where a file cannot be read or they do not show the same; the scene's own errors.
pub fn frames(a: &Path, b: &Path, at_px: f64) -> Result<FrameDiff> {
    let [first, second] = [read_exr(a)?, read_exr(b)?];
    let view = |file: &FrameFile| (file.from.scene.clone(), file.from.frame, file.frame.size);
    if view(&first) != view(&second) {
        let told = [(a, &first), (b, &second)].map(|(path, file)| {
            let [w, h] = file.frame.size;
            format!(
                "{} shows {} frame {} at {w}x{h}",
                path.display(),
                file.from.scene,
                file.from.frame
            )
        });
        return Err(Error::Usage(format!("the views differ: {}", told.join(", "))));
    }
    let scene = scene::load(&first.from.scene)?;
    let tracer = Tracer::new(&scene, &scene.at(first.from.frame), TruthOptions::default());
    let (accuracy, maps) = accuracy(&first.frame, &second.frame, &tracer)?;
    Ok(FrameDiff {
        scene: first.from.scene,
        frame: first.from.frame,
        cases: [first.from.case, second.from.case],
        bad_share_at_px: maps.bad_share(at_px),
        accuracy,
    })
}

/// One row of run B against its counterpart of run A.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RowDiff {
    pub scene: String,
    pub case: String,
    pub size: [u32; 2],
    /// Median frame times of A and B, milliseconds.
    pub frame_gpu_ms: Option<[f64; 2]>,
    /// B's over A's median, and the widest interval that theirs allow: nothing was interleaved.
    pub ratio: Option<Comparison>,
    /// Share of bad pixels of A and B at the displacement asked for.
    pub bad_share: [Option<f64>; 2],
}

/// Compares the rows two folders have in common: same scene, case, size and frames; of several
/// with the same, the last. `at_px` is one of 0.5, 1, 2 and 4.
///
/// # Errors
/// [`Error::Usage`] where a folder has no results, nothing is in common, or `at_px` is no row's.
pub fn runs(a: &Path, b: &Path, at_px: f64) -> Result<Vec<RowDiff>> {
    let [first, second] = [a, b].map(|folder| results_file::read(&folder.join(RESULTS)).map(keyed));
    let (first, second) = (first?, second?);
    let common = second.into_iter().filter_map(|(key, row)| Some((first.get(&key)?, row)));
    let diffs = common.map(|(a, b)| {
        let times = a.frame_gpu_ms.zip(b.frame_gpu_ms);
        Ok(RowDiff {
            frame_gpu_ms: times.map(|(a, b)| [a.median, b.median]),
            ratio: times.map(|(a, b)| {
                let interval = [b.ci95[0] / a.ci95[1], b.ci95[1] / a.ci95[0]];
                Comparison::new(b.median / a.median, interval)
            }),
            bad_share: [bad_share(a, at_px)?, bad_share(&b, at_px)?],
            scene: b.scene.name,
            case: b.case,
            size: b.size,
        })
    });
    let diffs = diffs.collect::<Result<Vec<_>>>()?;
    if diffs.is_empty() {
        return Err(Error::Usage(format!(
            "{} and {} have no scene, case, size and frames in common",
            a.display(),
            b.display()
        )));
    }
    Ok(diffs)
}

type Key = (String, String, [u32; 2], Vec<u32>);

fn keyed(rows: Vec<Row>) -> BTreeMap<Key, Row> {
    let key = |row: &Row| (row.scene.name.clone(), row.case.clone(), row.size, row.frames.clone());
    rows.into_iter().map(|row| (key(&row), row)).collect()
}

fn bad_share(row: &Row, at_px: f64) -> Result<Option<f64>> {
    let Some(accuracy) = &row.accuracy else { return Ok(None) };
    let shares = &accuracy.bad_share;
    let table = [(0.5, shares.half), (1.0, shares.one), (2.0, shares.two), (4.0, shares.four)];
    let found = table.into_iter().find(|(px, _)| *px == at_px);
    found.map(|(_, share)| Some(share)).ok_or_else(|| {
        Error::Usage(format!("rows have no share of bad pixels at {at_px} px; valid: 0.5, 1, 2, 4"))
    })
}

#[cfg(test)]
mod tests {
    use super::super::evidence::tests::accuracy_of;
    use super::super::results::tests::row;
    use super::*;
    use crate::measure::ratio::Verdict::{Faster, NoDifference, Slower};

    fn folder_with(rows: &[Row]) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        for row in rows {
            results_file::append(&folder.path().join(RESULTS), row).unwrap();
        }
        folder
    }

    fn timed(ms: f64) -> Row {
        let mut row = row("a");
        let time = row.frame_gpu_ms.as_mut().unwrap();
        (time.median, time.ci95) = (ms, [0.99 * ms, 1.01 * ms]);
        row.accuracy = Some(accuracy_of(0.25, None));
        row
    }

    #[test]
    fn runs_are_told_apart_beyond_their_intervals() {
        let a = folder_with(&[timed(9.0), timed(10.0)]);
        let cases = [(10.0, NoDifference), (10.4, NoDifference), (11.0, Slower), (9.0, Faster)];
        for (ms, verdict) in cases {
            let b = folder_with(&[timed(ms)]);
            let [diff] = <[RowDiff; 1]>::try_from(runs(a.path(), b.path(), 1.0).unwrap()).unwrap();
            assert_eq!(diff.ratio.unwrap().verdict, verdict, "{ms}");
            assert!((diff.ratio.unwrap().median - ms / 10.0).abs() < 1e-12, "the last row counts");
            assert_eq!(diff.bad_share, [Some(0.25); 2]);
        }
    }

    #[test]
    fn what_cannot_be_compared_is_refused() {
        let a = folder_with(&[timed(1.0)]);
        let other = Row { case: "none".into(), ..timed(1.0) };
        let b = folder_with(&[other]);
        let refusal = |b: &Path, px| runs(a.path(), b, px).unwrap_err().to_string();
        assert!(refusal(b.path(), 1.0).contains("in common"));
        assert!(refusal(a.path(), 3.0).contains("valid: 0.5, 1, 2, 4"));
        assert!(refusal(&a.path().join("none"), 1.0).contains("cannot read"));
    }
}
