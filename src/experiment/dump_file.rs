//! Dumps on disk. Images are `FOLDER/<pass>/<variable>.exr`, a cube's faces as layers `face0` to `face5`,
//! those of a layered map counted on; buffers are `FOLDER/<pass>/<variable>.npy`, NumPy's arrays of `<u4`.

use std::io::{self, Write};
use std::path::Path;

use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, WritableImage,
    f16,
};

use super::output::write_file;
use crate::error::{Error, Result};
use crate::gpu::{Dump, DumpKind, Format};
use crate::scene::matches_pattern;

const RGBA: [&str; 4] = ["R", "G", "B", "A"];

/// What to dump for patterns as [`matches_pattern`] reads them: images of the passes that one fits, or with
/// `PASS:VARIABLE` such images and buffers.
pub fn filter(patterns: &[String]) -> impl Fn(&str, &str, bool) -> bool + Send + use<> {
    let patterns = patterns.to_vec();
    move |pass, variable, is_image| {
        patterns.iter().any(|pattern| match pattern.split_once(':') {
            Some((of, name)) => matches_pattern(of, pass) && matches_pattern(name, variable),
            None => is_image && matches_pattern(pattern, pass),
        })
    }
}

/// Writes one dump; an image's channels are two or four of R, G, B, A or the one channel Y.
///
/// # Errors
/// [`Error::Output`].
pub fn write(folder: &Path, dump: &Dump) -> Result<()> {
    let folder = folder.join(&dump.pass);
    std::fs::create_dir_all(&folder).map_err(|cause| Error::output(&folder, cause))?;
    match dump.kind {
        DumpKind::Buffer => {
            let path = folder.join(format!("{}.npy", dump.variable));
            write_file(&path, |file| {
                file.write_all(&npy_header(dump.bytes.len() / 4))?;
                file.write_all(&dump.bytes)
            })
        }
        DumpKind::Image { format, size, layers } => {
            let path = folder.join(format!("{}.exr", dump.variable));
            let image = image(&dump.bytes, format, size, layers);
            write_file(&path, |file| image.write().to_buffered(file).map_err(io::Error::other))
        }
    }
}

/// Version 1.0 of NumPy's format for one row of little-endian words; the data begin at a multiple of 64.
fn npy_header(words: usize) -> Vec<u8> {
    let about = format!("{{'descr': '<u4', 'fortran_order': False, 'shape': ({words},), }}");
    let length = (10 + about.len() + 1).next_multiple_of(64) - 10;
    let mut header = b"\x93NUMPY\x01\x00".to_vec();
    header.extend((length as u16).to_le_bytes());
    header.extend(format!("{about:<0$}\n", length - 1).into_bytes());
    header
}

fn image(
    texels: &[u8],
    format: Format,
    size: [u32; 2],
    layers: u32,
) -> Image<Layer<AnyChannels<FlatSamples>>> {
    let names: &[&str] = match channels_of(format) {
        1 => &["Y"],
        channels => &RGBA[..channels],
    };
    let [width, height] = size.map(|n| n as usize);
    let mut channels = Vec::new();
    for layer in 0..layers as usize {
        let prefix = if layers > 1 { format!("face{layer}.") } else { String::new() };
        for (i, name) in names.iter().enumerate() {
            let place = layer * width * height * names.len() + i;
            let samples = samples((texels, format), place, names.len(), width * height);
            channels.push(AnyChannel::new(format!("{prefix}{name}").as_str(), samples));
        }
    }
    let channels = AnyChannels::sort(channels.into_iter().collect());
    let attributes = LayerAttributes::default();
    Image::from_layer(Layer::new((width, height), attributes, Encoding::SMALL_LOSSLESS, channels))
}

fn channels_of(format: Format) -> usize {
    match format {
        Format::Rgba16Float | Format::Rgba32Float | Format::Rgba32Uint => 4,
        Format::Rg32Uint => 2,
        Format::R32Float | Format::R32Uint | Format::DepthStencil => 1,
    }
}

/// Every `stride`th value from `first` on.
fn samples(
    (texels, format): (&[u8], Format),
    first: usize,
    stride: usize,
    count: usize,
) -> FlatSamples {
    fn every<T: bytemuck::Pod>(bytes: &[u8], first: usize, stride: usize, count: usize) -> Vec<T> {
        let values: Vec<T> = bytemuck::pod_collect_to_vec(bytes);
        values[first..].iter().step_by(stride).take(count).copied().collect()
    }
    match format {
        Format::Rgba16Float => FlatSamples::F16(
            every::<u16>(texels, first, stride, count).into_iter().map(f16::from_bits).collect(),
        ),
        Format::Rgba32Float | Format::R32Float | Format::DepthStencil => {
            FlatSamples::F32(every(texels, first, stride, count))
        }
        Format::Rgba32Uint | Format::Rg32Uint | Format::R32Uint => {
            FlatSamples::U32(every(texels, first, stride, count))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pass_gives_its_images_and_a_variable_also_buffers() {
        let passes = filter(&["method/*".to_owned()]);
        assert!(passes("method/search", "found", true) && !passes("method/search", "found", false));
        assert!(!passes("other/search", "found", true));
        let one = filter(&["method/*:found".to_owned()]);
        assert!(one("method/search", "found", false) && one("method/draw", "found", true));
        assert!(!one("method/search", "vertices", false));
    }

    #[test]
    fn headers_of_arrays_are_aligned_and_say_their_length() {
        for words in [0, 7, 123_456_789] {
            let header = npy_header(words);
            assert_eq!(header.len() % 64, 0);
            assert_eq!(usize::from(u16::from_le_bytes([header[8], header[9]])), header.len() - 10);
            let text = String::from_utf8_lossy(&header[10..]);
            assert!(text.contains(&format!("({words},)")) && text.ends_with('\n'), "{text}");
        }
    }
}
