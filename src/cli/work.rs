//! From flags to work: the lab, the scenes, the cases, the folders.

use std::path::PathBuf;

use super::args::{Common, Vary};
use super::console::Console;
use crate::error::{Error, Result};
use crate::experiment::lab::{Lab, Settings, default_folder};
use crate::experiment::output::OutputFolder;
use crate::measure::ratio::Comparison;
use crate::methods::nearest::valid_names;
use crate::methods::{Case, MethodInfo};
use crate::scene::{self, Scene};

/// A lab with the user's settings. `base` is where `--dump` puts its images.
pub fn lab<'m>(
    common: &Common,
    methods: &'m [&'static MethodInfo],
    console: &Console,
    base: PathBuf,
) -> Lab<'m> {
    let settings = Settings {
        device: common.device.clone(),
        validation: common.vulkan_validation,
        size: common.size.0,
        fallback: common.fallback,
        record: common.record,
        seed: common.seed,
        shader_dir: common.shader_dir.clone(),
        dump: (!common.dump.is_empty()).then(|| (common.dump.clone(), base.join("dump"))),
    };
    Lab::new(methods, settings, console.progress().clone())
}

pub fn load_scenes(names: &[String]) -> Result<Vec<Scene>> {
    names.iter().map(|name| scene::load(name)).collect()
}

/// The cases with every combination of the varied parameters, in order, without repetition.
///
/// # Errors
/// [`Error::Usage`] for a method no case uses, and for what [`Case::parse`] refuses.
pub fn parse_cases(
    texts: &[String],
    vary: &[Vary],
    methods: &[&'static MethodInfo],
) -> Result<Vec<Case>> {
    let parsed = texts.iter().map(|text| Case::parse(text, methods));
    let mut cases = parsed.collect::<Result<Vec<_>>>()?;
    for Vary { method, key, values } in vary {
        if !cases.iter().any(|case| case.uses(method)) {
            let used = cases.iter().flat_map(|case| case.parts.iter().map(|part| part.method));
            let valid = valid_names(method, used);
            return Err(Error::Usage(format!("no case uses the method `{method}`; {valid}")));
        }
        let mut varied = Vec::new();
        for case in cases {
            if !case.uses(method) {
                varied.push(case);
                continue;
            }
            for value in values {
                varied.push(case.with(method, key, value, methods)?);
            }
        }
        cases = varied;
    }
    let mut unique: Vec<Case> = Vec::new();
    for case in cases {
        if !unique.contains(&case) {
            unique.push(case);
        }
    }
    Ok(unique)
}

/// The folder of a scene and case: the user's, or its own.
pub fn folder(out: Option<&PathBuf>, scene: &Scene, case: &Case) -> Result<OutputFolder> {
    OutputFolder::create(out.cloned().unwrap_or_else(|| default_folder(scene, case)))
}

/// What to say beside a time: a software rasteriser's is marked wherever it is shown.
pub fn time_mark(software: bool) -> &'static str {
    if software { " (software)" } else { "" }
}

/// `1.250 (1.240..1.260, slower)`: a ratio, its interval, and what they say.
pub fn ratio(ratio: Comparison) -> String {
    let [low, high] = ratio.ci95;
    format!("{:.3} ({low:.3}..{high:.3}, {})", ratio.median, ratio.verdict.text())
}
