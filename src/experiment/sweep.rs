//! A sweep: a file that names what to run, cut into shards for several machines.

use std::fs;
use std::path::Path;

use serde::Deserialize;

use crate::error::{Error, Result};

/// A sweep file. Everything is written as the flag of `bench` of the same name is.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sweep {
    pub scenes: Vec<String>,
    pub cases: Vec<String>,
    #[serde(default)]
    pub vary: Vec<String>,
    #[serde(default)]
    pub sizes: Vec<String>,
    pub frames: Option<String>,
    pub repeat: Option<u32>,
    #[serde(default = "three")]
    pub truth_frames: usize,
    #[serde(default)]
    pub path: bool,
}

fn three() -> usize {
    3
}

impl Sweep {
    /// # Errors
    /// [`Error::Usage`] with file and line.
    pub fn read(path: &Path) -> Result<Sweep> {
        let text = fs::read_to_string(path)
            .map_err(|cause| Error::Usage(format!("cannot read {}: {cause}", path.display())))?;
        let sweep: Sweep = toml::from_str(&text).map_err(|cause| {
            let begin = cause.span().map_or(0, |span| span.start.min(text.len()));
            let line = 1 + text.as_bytes()[..begin].iter().filter(|b| **b == b'\n').count();
            Error::Usage(format!("{}:{line}: {}", path.display(), cause.message()))
        })?;
        let empty = [("scenes", sweep.scenes.is_empty()), ("cases", sweep.cases.is_empty())];
        if let Some((key, _)) = empty.into_iter().find(|(_, empty)| *empty) {
            return Err(Error::Usage(format!("{}: {key} is empty", path.display())));
        }
        match sweep.repeat {
            Some(0) => Err(Error::Usage(format!("{}: repeat must be at least 1", path.display()))),
            _ => Ok(sweep),
        }
    }
}

/// Cases to run together, so that they are timed in turns: places in the lists.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Batch {
    pub size: usize,
    pub scene: usize,
    pub cases: Vec<usize>,
}

/// Part `shard.0` (from 1) of `shard.1` of all sizes, scenes and cases, `counts` of each.
///
/// Single jobs are dealt out in turn; those of one size and scene that fall together stay together.
pub fn batches(counts: [usize; 3], shard: (usize, usize)) -> Vec<Batch> {
    let [sizes, scenes, cases] = counts;
    let mut batches = Vec::new();
    for (size, scene) in (0..sizes).flat_map(|size| (0..scenes).map(move |scene| (size, scene))) {
        let first = (size * scenes + scene) * cases;
        let mine = |case: &usize| (first + case) % shard.1 == shard.0 - 1;
        let cases: Vec<usize> = (0..cases).filter(mine).collect();
        if !cases.is_empty() {
            batches.push(Batch { size, scene, cases });
        }
    }
    batches
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_part_the_work() {
        let jobs = |shard| -> Vec<[usize; 3]> {
            let all = batches([2, 3, 5], shard).into_iter();
            all.flat_map(|b| b.cases.into_iter().map(move |c| [b.size, b.scene, c])).collect()
        };
        let all = jobs((1, 1));
        assert_eq!(all.len(), 30);
        let mut parts: Vec<_> = (1..=4).flat_map(|i| jobs((i, 4))).collect();
        assert!((1..=4).all(|i| (7..=8).contains(&jobs((i, 4)).len())));
        parts.sort_unstable();
        assert_eq!(parts, all);
    }

    #[test]
    fn files_are_read_or_refused_with_their_line() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.toml");
        let read = |text: &str| {
            fs::write(&path, text).unwrap();
            Sweep::read(&path).map_err(|error| error.to_string())
        };
        let sweep = read("scenes = [\"sky\"]\ncases = [\"none\"]\nsizes = [\"64x64\"]").unwrap();
        assert_eq!((sweep.truth_frames, sweep.sizes.len(), sweep.repeat), (3, 1, None));
        assert!(!sweep.path);
        for (text, expected) in [
            ("scenes = [\"sky\"]\ncases = [\"none\"]\nscene = 1", "a.toml:3: unknown field"),
            ("scenes = [\"sky\"]\ncases = 3", "a.toml:2: invalid type"),
            ("scenes = []\ncases = [\"none\"]", "scenes is empty"),
            ("scenes = [\"a\"]\ncases = [\"none\"]\nrepeat = 0", "repeat must be at least 1"),
            ("scenes = [", "a.toml:1: "),
        ] {
            let message = read(text).unwrap_err();
            assert!(message.contains(expected) && !message.contains('\n'), "{message}");
        }
    }
}
