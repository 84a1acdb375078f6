//! POV-Ray, run on a file written by [`super::pov_file`].

use std::fs::{self, File};
use std::io::BufReader;
use std::path::Path;
use std::process::{Command, Stdio};

use glam::DVec3;
use mirrorbench::scene::{Moment, Scene};

use super::pov_file::{self, Look};

/// Renders a square picture of `side` pixels, one ray through each pixel's centre: linear colours,
/// row 0 on top.
pub fn render(scene: &Scene, moment: &Moment, look: Look, side: u32) -> Vec<DVec3> {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.pov"), pov_file::write(scene, moment, look)).unwrap();
    run(folder.path(), side);
    read(&folder.path().join("scene.png"))
}

/// `scene.pov` of a folder to `scene.png`: 16 bits a channel, linear, without anti-aliasing.
pub fn run(folder: &Path, side: u32) {
    let size = [format!("+W{side}"), format!("+H{side}")];
    let result = Command::new("povray")
        .args(["+Iscene.pov", "+Oscene.png", "+FN16", "File_Gamma=1.0", "-A", "-D", "-GA"])
        .args(size)
        .current_dir(folder)
        .stdin(Stdio::null())
        .output()
        .unwrap_or_else(|cause| {
            panic!(
                "cannot run povray: {cause}; install the Debian package `povray` or run tools/setup"
            )
        });
    let said = String::from_utf8_lossy(&result.stderr);
    assert!(result.status.success(), "povray failed:\n{said}");
}

fn read(path: &Path) -> Vec<DVec3> {
    let mut reader =
        png::Decoder::new(BufReader::new(File::open(path).unwrap())).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let frame = reader.next_frame(&mut bytes).unwrap();
    assert_eq!(frame.bit_depth, png::BitDepth::Sixteen);
    let level = |bytes: &[u8]| f64::from(u16::from_be_bytes([bytes[0], bytes[1]])) / 65535.0;
    let pixels = bytes.chunks_exact(2 * frame.color_type.samples());
    pixels.map(|pixel| DVec3::new(level(pixel), level(&pixel[2..]), level(&pixel[4..]))).collect()
}
