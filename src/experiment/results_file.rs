//! `results.jsonl`: one row a line, appended so that an interruption costs at most the row in hand.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;

use super::results::{Row, SCHEMA_VERSION};
use crate::error::{Error, Result};

/// The file's name in a run's folder.
pub const RESULTS: &str = "results.jsonl";

/// Appends a row. A torn last line, left by an interrupted run, is cut off first; if this row
/// cannot be written in full, the file is cut back to what it was.
///
/// # Errors
/// [`Error::Output`].
pub fn append(path: &Path, row: &Row) -> Result<()> {
    append_line(path, row).map_err(|cause| Error::output(path, cause))
}

fn append_line(path: &Path, row: &Row) -> io::Result<()> {
    let mut line = serde_json::to_vec(row)?;
    line.push(b'\n');
    let mut file = OpenOptions::new().read(true).append(true).create(true).open(path)?;
    let whole = whole_lines(&mut file)?;
    if whole < file.metadata()?.len() {
        file.set_len(whole)?;
    }
    let written = file.write_all(&line).and_then(|()| file.sync_all());
    if written.is_err() {
        file.set_len(whole)?;
    }
    written
}

/// The length of the file up to and with its last line end.
fn whole_lines(file: &mut File) -> io::Result<u64> {
    const BLOCK: u64 = 4096;
    let mut end = file.metadata()?.len();
    while end > 0 {
        let begin = end.saturating_sub(BLOCK);
        let mut block = vec![0; (end - begin) as usize];
        file.seek(SeekFrom::Start(begin))?;
        file.read_exact(&mut block)?;
        if let Some(at) = block.iter().rposition(|byte| *byte == b'\n') {
            return Ok(begin + at as u64 + 1);
        }
        end = begin;
    }
    Ok(0)
}

/// The rows of a file in order; a torn last line is passed over.
///
/// # Errors
/// [`Error::Usage`] where the file cannot be read, or a line is not a row of this version.
pub fn read(path: &Path) -> Result<Vec<Row>> {
    let text = fs::read_to_string(path)
        .map_err(|cause| Error::Usage(format!("cannot read {}: {cause}", path.display())))?;
    let whole = text.rfind('\n').map_or("", |end| &text[..end]);
    whole.lines().enumerate().map(|(i, line)| parse(path, i + 1, line)).collect()
}

fn parse(path: &Path, line: usize, text: &str) -> Result<Row> {
    let failed = |cause: &dyn std::fmt::Display| {
        Error::Usage(format!("{}:{line}: not a results row: {cause}", path.display()))
    };
    let value: serde_json::Value = serde_json::from_str(text).map_err(|cause| failed(&cause))?;
    let version = value.get("schema_version").and_then(serde_json::Value::as_u64);
    if version != Some(u64::from(SCHEMA_VERSION)) {
        return Err(failed(&format!("schema_version is not {SCHEMA_VERSION}")));
    }
    serde_json::from_value(value).map_err(|cause| failed(&cause))
}

#[cfg(test)]
mod tests {
    use super::super::results::tests::row;
    use super::*;

    #[test]
    fn rows_come_back_in_order() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(RESULTS);
        let rows = ["a", "b", "c"].map(row);
        for row in &rows {
            append(&path, row).unwrap();
        }
        assert_eq!(read(&path).unwrap(), rows);
    }

    #[test]
    fn a_torn_line_is_passed_over_and_then_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(RESULTS);
        append(&path, &row("kept")).unwrap();
        // Longer than a block, so that the search for the last line end takes several.
        let torn = format!("{{\"run\":\"{}", "x".repeat(10_000));
        OpenOptions::new().append(true).open(&path).unwrap().write_all(torn.as_bytes()).unwrap();
        assert_eq!(read(&path).unwrap(), [row("kept")]);
        append(&path, &row("new")).unwrap();
        assert_eq!(read(&path).unwrap(), [row("kept"), row("new")]);
    }

    #[test]
    fn a_first_line_that_is_torn_leaves_an_empty_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(RESULTS);
        fs::write(&path, "{\"run\"").unwrap();
        assert_eq!(read(&path).unwrap(), []);
        append(&path, &row("a")).unwrap();
        assert_eq!(read(&path).unwrap(), [row("a")]);
    }

    #[test]
    fn a_bad_line_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(RESULTS);
        append(&path, &row("a")).unwrap();
        for bad in ["nonsense\n", "{\"schema_version\": 0}\n", "{\"schema_version\": 1}\n"] {
            let good = fs::read(&path).unwrap();
            OpenOptions::new().append(true).open(&path).unwrap().write_all(bad.as_bytes()).unwrap();
            let error = read(&path).unwrap_err().to_string();
            assert!(error.contains("results.jsonl:2: not a results row"), "{error}");
            fs::write(&path, good).unwrap();
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_full_disk_is_an_output_error() {
        let error = append(Path::new("/dev/full"), &row("a")).unwrap_err();
        assert!(matches!(error, Error::Output(_)), "{error}");
    }
}
