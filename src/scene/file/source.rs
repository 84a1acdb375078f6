//! A scene file's text and the assets it names: reading, hashing, and errors with file and line.

use std::path::{Path, PathBuf};

use super::format::Span;
use crate::error::{Error, Result};

/// The file being read.
pub struct Source {
    /// As shown in messages.
    pub path: String,
    text: String,
    /// Where assets are looked for, in order.
    folders: Vec<PathBuf>,
    hasher: blake3::Hasher,
}

/// An asset's bytes and the name messages use.
pub struct Asset {
    pub path: PathBuf,
    pub bytes: Vec<u8>,
}

impl Source {
    /// Reads a scene file whose assets lie relative to it or, failing that, to `scenes_dir`.
    pub fn read(path: &Path, scenes_dir: Option<PathBuf>) -> Result<Self> {
        let text = std::fs::read_to_string(path)
            .map_err(|cause| Error::Scene(format!("cannot read {}: {cause}", path.display())))?;
        let mut hasher = blake3::Hasher::new();
        hasher.update(text.as_bytes());
        let beside = path.parent().map(Path::to_path_buf);
        let folders = beside.into_iter().chain(scenes_dir).collect();
        Ok(Source { path: path.display().to_string(), text, folders, hasher })
    }

    pub fn text(&self) -> &str {
        &self.text
    }

    /// An error at a place of the scene file.
    pub fn error(&self, span: &Span, message: impl std::fmt::Display) -> Error {
        let before = self.text.as_bytes().iter().take(span.start);
        let line = 1 + before.filter(|&&byte| byte == b'\n').count();
        Error::Scene(format!("{}:{line}: {message}", self.path))
    }

    /// The error of the TOML parser or of serde, in our words and on one line.
    pub fn toml_error(&self, error: &toml::de::Error) -> Error {
        let message = error
            .message()
            .replace("unknown field", "unknown key")
            .replace("unknown variant", "unknown value")
            .replace("missing field", "missing key")
            .replace(", expected one of ", "; valid: ")
            .replace(", expected ", "; valid: ")
            .replace('\n', " ");
        self.error(&error.span().unwrap_or(0..0), message)
    }

    /// Reads an asset and adds it to the hash. `span`: where the scene file names it.
    pub fn asset(&mut self, name: &str, span: &Span) -> Result<Asset> {
        let path = self.folders.iter().map(|folder| folder.join(name)).find(|path| path.is_file());
        let Some(path) = path else {
            let folders: Vec<String> =
                self.folders.iter().map(|folder| folder.display().to_string()).collect();
            let message = format!("no file `{name}`; valid: a path below {}", folders.join(" or "));
            return Err(self.error(span, message));
        };
        let bytes = std::fs::read(&path).map_err(|cause| {
            self.error(span, format!("cannot read {}: {cause}", path.display()))
        })?;
        self.hasher.update(&bytes);
        Ok(Asset { path, bytes })
    }

    /// Hash of the text and of every asset read, in order.
    pub fn hash(&self) -> String {
        self.hasher.finalize().to_hex().to_string()
    }
}

impl Asset {
    /// An error in the asset itself, at a line counted from 1 where one is known.
    pub fn error(&self, line: Option<usize>, message: impl std::fmt::Display) -> Error {
        let line = line.map(|line| format!("{line}:")).unwrap_or_default();
        Error::Scene(format!("{}:{line} {message}", self.path.display()))
    }

    /// The bytes as text.
    pub fn text(&self) -> Result<&str> {
        std::str::from_utf8(&self.bytes).map_err(|cause| self.error(None, cause))
    }
}
