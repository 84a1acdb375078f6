//! Where words go: reports on stdout, or JSON there and the reports on stderr with `--json`;
//! remarks and progress always on stderr.

use std::cell::Cell;
use std::fmt::Write as _;
use std::io::{self, ErrorKind, Write};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;

use crate::error::{Error, Result};

/// The user's side of a command.
pub struct Console {
    json: bool,
    /// The reader of stdout has gone away: nothing more is written, and that is no error.
    closed: Cell<bool>,
    progress: ProgressBar,
}

impl Console {
    pub fn new(json: bool) -> Self {
        let progress = ProgressBar::no_length();
        let style = ProgressStyle::with_template("{elapsed:>4} {bar:24} {pos}/{len} {wide_msg}");
        progress.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        progress.enable_steady_tick(Duration::from_millis(500));
        Console { json, closed: Cell::new(false), progress }
    }

    /// The bar; it draws only on a terminal.
    pub fn progress(&self) -> &ProgressBar {
        &self.progress
    }

    /// What the user asked to be told.
    pub fn report(&self, text: &str) -> Result<()> {
        if self.json {
            self.remark(text);
            return Ok(());
        }
        self.stdout(text)
    }

    /// One object on a line of its own, with `--json` only.
    pub fn object(&self, value: &impl Serialize) -> Result<()> {
        if !self.json {
            return Ok(());
        }
        let text = serde_json::to_string(value)
            .map_err(|cause| Error::Output(format!("cannot write JSON: {cause}")))?;
        self.stdout(&text)
    }

    /// A remark beside the report.
    pub fn remark(&self, text: &str) {
        // A user who closed stderr does not want to know.
        self.progress.suspend(|| drop(writeln!(io::stderr(), "{text}")));
    }

    fn stdout(&self, text: &str) -> Result<()> {
        if self.closed.get() {
            return Ok(());
        }
        let written = self.progress.suspend(|| {
            let mut out = io::stdout().lock();
            writeln!(out, "{text}").and_then(|()| out.flush())
        });
        match written {
            Err(cause) if cause.kind() == ErrorKind::BrokenPipe => {
                self.closed.set(true);
                Ok(())
            }
            other => other
                .map_err(|cause| Error::Output(format!("cannot write standard output: {cause}"))),
        }
    }
}

/// Left-aligned columns, two spaces apart; the first row is the heading.
pub fn table(rows: &[Vec<String>]) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let mut text = String::new();
    for row in rows {
        let mut line = String::new();
        for (cell, width) in row.iter().zip(&widths) {
            // Writing to a String cannot fail.
            let _ = write!(line, "{cell:width$}  ");
        }
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text.truncate(text.trim_end().len());
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_line_up_and_lines_have_no_tail() {
        let rows = [["a", "bb", ""], ["ccc", "d", "e"]].map(|r| r.map(str::to_owned).to_vec());
        assert_eq!(table(&rows), "a    bb\nccc  d   e");
    }
}
