//! Writing files so that a failure or an interruption leaves what was there before.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::error::{Error, Result};

/// A folder that results can be written to: checked before the long work, not after it.
#[derive(Clone, Debug)]
pub struct OutputFolder(PathBuf);

impl OutputFolder {
    /// Creates the folder and proves with a small file that it can be written to.
    ///
    /// # Errors
    /// [`Error::Output`] where it cannot, or where the disk is full.
    pub fn create(path: impl Into<PathBuf>) -> Result<Self> {
        let path = path.into();
        fs::create_dir_all(&path).map_err(|cause| Error::output(&path, cause))?;
        let probe = path.join(format!(".probe-{}", std::process::id()));
        let written = File::create(&probe).and_then(|mut file| {
            file.write_all(&[0; 4096])?;
            file.sync_all()
        });
        let removed = fs::remove_file(&probe);
        written.and(removed).map_err(|cause| Error::output(&path, cause))?;
        Ok(OutputFolder(path))
    }

    pub fn path(&self) -> &Path {
        &self.0
    }

    pub fn file(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }
}

/// Writes a whole file or leaves the one that is there. A path that is no regular file (a pipe, a
/// device) is written directly.
///
/// # Errors
/// [`Error::Output`].
pub fn write_file(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<()> {
    let direct = fs::metadata(path).is_ok_and(|found| !found.is_file());
    let target = if direct { path.to_owned() } else { temporary(path) };
    let written = OpenOptions::new()
        .write(true)
        .create(!direct)
        .truncate(!direct)
        .open(&target)
        .and_then(|file| {
            let mut file = BufWriter::new(file);
            write(&mut file)?;
            file.flush()?;
            if direct { Ok(()) } else { file.get_ref().sync_all() }
        })
        .and_then(|()| if direct { Ok(()) } else { fs::rename(&target, path) });
    if written.is_err() && !direct {
        // The error that matters is the one above; the temporary file may not even exist.
        let _ = fs::remove_file(&target);
    }
    written.map_err(|cause| Error::output(path, cause))
}

/// Where a file is written until it is whole.
pub(super) fn temporary(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".partial-{}", std::process::id()));
    path.with_file_name(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_write_leaves_the_old_file_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        write_file(&path, |file| file.write_all(b"old")).unwrap();
        let error = write_file(&path, |file| {
            file.write_all(b"half of the new")?;
            Err(io::Error::from(io::ErrorKind::StorageFull))
        });
        assert_eq!(error.unwrap_err().exit_code(), 6);
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn a_full_device_is_an_output_error() {
        let error = write_file(Path::new("/dev/full"), |file| file.write_all(b"x")).unwrap_err();
        assert!(error.to_string().contains("/dev/full"), "{error}");
        assert!(matches!(error, Error::Output(_)));
    }

    #[test]
    fn a_file_in_the_way_is_an_output_error() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        fs::write(&file, "").unwrap();
        let error = OutputFolder::create(file.join("below")).unwrap_err();
        assert!(matches!(error, Error::Output(_)), "{error}");
        let made = OutputFolder::create(folder.path().join("a/b")).unwrap();
        assert_eq!(fs::read_dir(made.path()).unwrap().count(), 0, "the probe is removed");
    }
}
