//! Small blessed pictures, and what counts as the same.
#![allow(dead_code, reason = "each test file uses its own part")]

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use mirrorbench::experiment::frame_file::write_png;
use mirrorbench::scene::FrameRecord;

/// Largest difference of a channel, of 255, that is rounding: drivers may contract multiplications
/// and additions differently, and a half float has 11 bits.
const ROUNDING: u8 = 4;

/// Share of pixels that may differ by more on another driver than the one blessed on: at edges,
/// where the rasterisers' last bits decide.
pub const EDGE_SHARE: f64 = 0.002;

/// An 8-bit sRGB picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    pub size: [u32; 2],
    pub bytes: Vec<u8>,
}

impl Picture {
    /// A frame as its PNG shows it.
    pub fn of(frame: &FrameRecord) -> Picture {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("frame.png");
        write_png(&path, frame.size, &frame.colour).unwrap();
        Picture::read(&path).unwrap()
    }

    pub fn read(path: &Path) -> Option<Picture> {
        let mut reader =
            png::Decoder::new(BufReader::new(File::open(path).ok()?)).read_info().ok()?;
        let mut bytes = vec![0; reader.output_buffer_size()?];
        let info = reader.next_frame(&mut bytes).ok()?;
        Some(Picture { size: [info.width, info.height], bytes })
    }
}

/// What differs, in words, if it is more than rounding in over `edge_share` of the pixels.
pub fn difference(blessed: &Picture, actual: &Picture, edge_share: f64) -> Result<(), String> {
    if blessed.size != actual.size {
        return Err(format!("size {:?} instead of {:?}", actual.size, blessed.size));
    }
    let pixels = blessed.bytes.chunks(3).zip(actual.bytes.chunks(3));
    let changes = pixels.map(|(a, b)| a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max());
    let changes: Vec<u8> = changes.flatten().collect();
    let off = changes.iter().filter(|&&c| c > ROUNDING).count();
    let allowed = (edge_share * changes.len() as f64) as usize;
    if off > allowed {
        let worst = changes.iter().copied().max().unwrap_or(0);
        return Err(format!("{off} pixels differ, {allowed} may; the worst by {worst}"));
    }
    Ok(())
}
