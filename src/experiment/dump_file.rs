//! Dumped images on disk: `FOLDER/<pass>/<variable>.exr`, a cube's faces as layers `face0` to
//! `face5`, those of a layered map counted on.

use std::io;
use std::path::Path;

use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, WritableImage,
    f16,
};

use super::output::write_file;
use crate::error::{Error, Result};
use crate::gpu::{Dump, Format};

const RGBA: [&str; 4] = ["R", "G", "B", "A"];

/// Writes one dumped image; two or four channels of R, G, B, A or the one channel Y.
///
/// # Errors
/// [`Error::Output`].
pub fn write(folder: &Path, dump: &Dump) -> Result<()> {
    let folder = folder.join(&dump.pass);
    std::fs::create_dir_all(&folder).map_err(|cause| Error::output(&folder, cause))?;
    let names: &[&str] = match channels_of(dump.format) {
        1 => &["Y"],
        channels => &RGBA[..channels],
    };
    let [width, height] = dump.size.map(|n| n as usize);
    let mut channels = Vec::new();
    for layer in 0..dump.layers as usize {
        let prefix = if dump.layers > 1 { format!("face{layer}.") } else { String::new() };
        for (i, name) in names.iter().enumerate() {
            let place = layer * width * height * names.len() + i;
            let samples = samples(dump, place, names.len(), width * height);
            channels.push(AnyChannel::new(format!("{prefix}{name}").as_str(), samples));
        }
    }
    let channels = AnyChannels::sort(channels.into_iter().collect());
    let attributes = LayerAttributes::default();
    let layer = Layer::new((width, height), attributes, Encoding::SMALL_LOSSLESS, channels);
    let image = Image::from_layer(layer);
    let path = folder.join(format!("{}.exr", dump.variable));
    write_file(&path, |file| image.write().to_buffered(file).map_err(io::Error::other))
}

fn channels_of(format: Format) -> usize {
    match format {
        Format::Rgba16Float | Format::Rgba32Float | Format::Rgba32Uint => 4,
        Format::Rg32Uint => 2,
        Format::R32Float | Format::R32Uint | Format::DepthStencil => 1,
    }
}

/// Every `stride`th value from `first` on.
fn samples(dump: &Dump, first: usize, stride: usize, count: usize) -> FlatSamples {
    fn every<T: bytemuck::Pod>(bytes: &[u8], first: usize, stride: usize, count: usize) -> Vec<T> {
        let values: Vec<T> = bytemuck::pod_collect_to_vec(bytes);
        values[first..].iter().step_by(stride).take(count).copied().collect()
    }
    let texels = dump.texels.as_slice();
    match dump.format {
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
