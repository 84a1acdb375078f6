//! A film: pictures as one moving picture.
//!
//! An animated PNG is written here; other containers are left to an `ffmpeg` on the PATH, which is fed
//! raw pictures. Either way the file appears when it is whole.

use std::fs::{self, File};
use std::io::{self, BufWriter, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use super::output::temporary;
use crate::error::{Error, Result};

/// The options of `ffmpeg` by a file's extension: codec, quality, container.
const CODECS: [(&str, &[&str]); 2] = [
    ("mp4", &["-c:v", "libx264", "-crf", "18", "-f", "mp4"]),
    ("webm", &["-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-f", "webm"]),
];

/// How a film is encoded, told by its file's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    AnimatedPng,
    /// With these options.
    Ffmpeg(&'static [&'static str]),
}

impl Format {
    fn of(path: &Path) -> Result<Format> {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        if ["png", "apng"].contains(&extension.as_str()) {
            return Ok(Format::AnimatedPng);
        }
        let codec = CODECS.iter().find(|(name, _)| *name == extension);
        codec.map(|(_, options)| Format::Ffmpeg(options)).ok_or_else(|| {
            let file = path.display();
            Error::Usage(format!(
                "--film {file}: valid: .png or .apng, and .mp4 or .webm by ffmpeg"
            ))
        })
    }
}

/// Checks that a film of that name can be made.
///
/// # Errors
/// [`Error::Usage`] for an extension that names no format; [`Error::Output`] where `ffmpeg` is
/// needed and not there.
pub fn check(path: &Path) -> Result<()> {
    match Format::of(path)? {
        Format::AnimatedPng => Ok(()),
        Format::Ffmpeg(_) => {
            let mut command = Command::new("ffmpeg");
            command.arg("-version").stdin(Stdio::null()).stdout(Stdio::null());
            let found = command.stderr(Stdio::null()).status();
            found.map(drop).map_err(|cause| no_ffmpeg(path, &cause))
        }
    }
}

fn no_ffmpeg(path: &Path, cause: &io::Error) -> Error {
    let hint = "install the package ffmpeg (apt-get install ffmpeg), or name a .png";
    Error::output(path, format!("ffmpeg does not run ({cause}); {hint}"))
}

/// Where pictures go.
enum Sink {
    Png(png::Writer<BufWriter<File>>),
    Ffmpeg(Child),
}

/// A film being written.
pub struct Film {
    path: PathBuf,
    /// The file until it is whole.
    partial: PathBuf,
    /// `None` once finished.
    sink: Option<Sink>,
}

impl Film {
    /// A film of `count` pictures of `size` pixels, `rate_hz` a second.
    ///
    /// # Errors
    /// Those of [`check`]; [`Error::Output`].
    pub fn create(path: &Path, size: [u32; 2], count: u32, rate_hz: f32) -> Result<Film> {
        let partial = temporary(path);
        let sink = match Format::of(path)? {
            Format::AnimatedPng => {
                let writer = animated_png(&partial, size, count, rate_hz);
                Sink::Png(writer.map_err(|cause| Error::output(path, cause))?)
            }
            Format::Ffmpeg(options) => {
                let child = ffmpeg(&partial, size, rate_hz, options).spawn();
                Sink::Ffmpeg(child.map_err(|cause| no_ffmpeg(path, &cause))?)
            }
        };
        Ok(Film { path: path.to_owned(), partial, sink: Some(sink) })
    }

    /// Adds a picture: 8-bit sRGB, row-major.
    ///
    /// # Errors
    /// [`Error::Output`].
    pub fn add(&mut self, picture: &[u8]) -> Result<()> {
        let written = match &mut self.sink {
            Some(Sink::Png(writer)) => writer.write_image_data(picture).map_err(io::Error::other),
            Some(Sink::Ffmpeg(child)) => match &mut child.stdin {
                Some(pipe) => pipe.write_all(picture),
                None => Ok(()),
            },
            None => Ok(()),
        };
        written.map_err(|cause| self.failed(cause))
    }

    /// Ends the film: from now on it is there.
    ///
    /// # Errors
    /// [`Error::Output`].
    pub fn finish(mut self) -> Result<()> {
        let ended = match self.sink.take() {
            Some(Sink::Png(writer)) => writer.finish().map_err(io::Error::other),
            Some(Sink::Ffmpeg(child)) => said(child),
            None => Ok(()),
        };
        ended
            .and_then(|()| fs::rename(&self.partial, &self.path))
            .map_err(|cause| Error::output(&self.path, cause))
    }

    /// The error of a picture that was not taken: what ffmpeg says, where it is the one.
    fn failed(&mut self, cause: io::Error) -> Error {
        let told = match self.sink.take() {
            Some(Sink::Ffmpeg(child)) => said(child).err(),
            _ => None,
        };
        Error::output(&self.path, told.unwrap_or(cause))
    }
}

impl Drop for Film {
    fn drop(&mut self) {
        if let Some(Sink::Ffmpeg(child)) = &mut self.sink {
            // A film given up on: nobody waits for its encoder's words.
            let _ = child.kill();
            let _ = child.wait();
        }
        // Gone already where the film was finished.
        let _ = fs::remove_file(&self.partial);
    }
}

fn animated_png(
    path: &Path,
    size: [u32; 2],
    count: u32,
    rate_hz: f32,
) -> io::Result<png::Writer<BufWriter<File>>> {
    let mut encoder = png::Encoder::new(BufWriter::new(File::create(path)?), size[0], size[1]);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
    encoder.set_animated(count, 0).map_err(io::Error::other)?;
    let delay_ms = (1000.0 / rate_hz).round() as u16;
    encoder.set_frame_delay(delay_ms, 1000).map_err(io::Error::other)?;
    encoder.write_header().map_err(io::Error::other)
}

/// Raw pictures from standard input; sides are padded to even numbers, which these codecs want.
fn ffmpeg(path: &Path, [width, height]: [u32; 2], rate_hz: f32, options: &[&str]) -> Command {
    let mut command = Command::new("ffmpeg");
    command.args(["-loglevel", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24"]);
    command.args(["-s", &format!("{width}x{height}"), "-r", &rate_hz.to_string(), "-i", "-"]);
    command.args(["-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p"]);
    command.args(options).arg(path);
    command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
    command
}

/// Waits for ffmpeg to end; what it said last is the error.
fn said(mut child: Child) -> io::Result<()> {
    drop(child.stdin.take());
    let mut text = String::new();
    if let Some(pipe) = &mut child.stderr {
        pipe.read_to_string(&mut text)?;
    }
    let status = child.wait()?;
    let last = text.lines().last().unwrap_or("it said nothing");
    if status.success() { Ok(()) } else { Err(io::Error::other(format!("ffmpeg: {last}"))) }
}
