//! Where scene files are, and loading them by name.

use std::path::{Path, PathBuf};

use super::{Scene, file};
use crate::error::{Error, Result};

/// Names the folder of scenes and overrides the search for it.
pub const SCENES_VARIABLE: &str = "MIRRORBENCH_SCENES";

/// Loads a scene: a name under the scenes folder, or a path to a `.toml` file anywhere.
///
/// # Errors
/// [`Error::Usage`] for an unknown name, with the valid ones; [`Error::Scene`] for a file that cannot
/// be read, an unknown key, a value out of range or a bad asset, with file and line.
pub fn load(name_or_path: &str) -> Result<Scene> {
    let path = Path::new(name_or_path);
    if path.extension().is_some_and(|extension| extension == "toml") {
        return file::read(path, scenes_dir().ok());
    }
    let folder = scenes_dir()?;
    let names = names(&folder)?;
    if names.iter().any(|name| name == name_or_path) {
        return file::read(&folder.join(format!("{name_or_path}.toml")), Some(folder));
    }
    Err(Error::Usage(format!(
        "unknown scene `{name_or_path}`; valid: {}, or a path to a .toml file",
        names.join(", ")
    )))
}

/// Every scene of the scenes folder by name, with its `about` line.
pub fn list() -> Result<Vec<(String, String)>> {
    let folder = scenes_dir()?;
    let about = |name: String| {
        let about = file::about(&folder.join(format!("{name}.toml")))?;
        Ok((name, about))
    };
    names(&folder)?.into_iter().map(about).collect()
}

/// The folder of the shipped scenes: `$MIRRORBENCH_SCENES`, else the first `scenes` folder at or above
/// the current directory, at or above the executable, or in the source tree it was built from.
pub fn scenes_dir() -> Result<PathBuf> {
    if let Some(named) = std::env::var_os(SCENES_VARIABLE) {
        let named = PathBuf::from(named);
        if named.is_dir() {
            return Ok(named);
        }
        let message = format!("{SCENES_VARIABLE} = {} is not a folder", named.display());
        return Err(Error::Scene(message));
    }
    let starts = [std::env::current_dir().ok(), std::env::current_exe().ok()];
    let above = starts.iter().flatten().flat_map(|start| start.ancestors());
    above
        .chain([Path::new(env!("CARGO_MANIFEST_DIR"))])
        .map(|folder| folder.join("scenes"))
        .find(|folder| folder.is_dir() && names(folder).is_ok_and(|names| !names.is_empty()))
        .ok_or_else(|| {
            Error::Scene(format!("no folder of scenes found; set {SCENES_VARIABLE} to it"))
        })
}

/// The stems of the .toml files of a folder, sorted.
fn names(folder: &Path) -> Result<Vec<String>> {
    let cannot = |cause| Error::Scene(format!("cannot read {}: {cause}", folder.display()));
    let mut names = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(cannot)? {
        let path = entry.map_err(cannot)?.path();
        if path.extension().is_some_and(|extension| extension == "toml") {
            names.extend(path.file_stem().map(|stem| stem.to_string_lossy().into_owned()));
        }
    }
    names.sort();
    Ok(names)
}
