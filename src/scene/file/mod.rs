//! Scene files: TOML text and assets -> [`Scene`]. `scenes/README.md` documents the format.

mod build;
mod camera;
mod format;
mod image;
mod obj;
mod obj_check;
mod parts;
mod patches;
mod scatter;
mod smooth;
mod source;
mod values;
mod wobble;

use std::path::{Path, PathBuf};

use super::Scene;
use crate::error::Result;
use source::Source;

/// Reads and checks a scene file; `scenes_dir` is the second place assets are looked for.
pub fn read(path: &Path, scenes_dir: Option<PathBuf>) -> Result<Scene> {
    let source = Source::read(path, scenes_dir)?;
    let file: format::SceneFile =
        toml::from_str(source.text()).map_err(|error| source.toml_error(&error))?;
    let name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
    build::build(name.unwrap_or_default(), source, file)
}

/// The `about` line of a scene file, without reading its assets.
pub fn about(path: &Path) -> Result<String> {
    let source = Source::read(path, None)?;
    let file: format::AboutFile =
        toml::from_str(source.text()).map_err(|error| source.toml_error(&error))?;
    Ok(file.about)
}
