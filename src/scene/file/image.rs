//! Images of a scene: PNG (sRGB) and OpenEXR (linear), rounded to half precision.

use std::io::Cursor;

use exr::prelude::{ReadChannels, ReadLayers, read};
use glam::Vec3;
use half::f16;

use super::source::Asset;
use crate::error::Result;
use crate::scene::Image;

/// Decodes an image by its file's ending. Negative values become 0, values above `cap` become `cap`.
pub fn decode(asset: &Asset, cap: f32) -> Result<Image> {
    match asset.path.extension().and_then(|e| e.to_str()) {
        Some("png") => decode_png(asset, cap),
        Some("exr") => decode_exr(asset, cap),
        _ => Err(asset.error(None, "unknown image format; valid: .png, .exr")),
    }
}

fn decode_exr(asset: &Asset, cap: f32) -> Result<Image> {
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .rgba_channels(
            |size, _| (size.width(), vec![Vec3::ZERO; size.area()]),
            |(width, texels), position, (r, g, b, _): (f32, f32, f32, f32)| {
                texels[position.y() * *width + position.x()] = Vec3::new(r, g, b);
            },
        )
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(&asset.bytes))
        .map_err(|cause| asset.error(None, cause))?;
    let (width, texels) = image.layer_data.channel_data.pixels;
    let height = texels.len() / width.max(1);
    Ok(rounded(width as u32, height as u32, texels, cap))
}

fn decode_png(asset: &Asset, cap: f32) -> Result<Image> {
    let mut decoder = png::Decoder::new(Cursor::new(&asset.bytes));
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().map_err(|cause| asset.error(None, cause))?;
    let size = reader.output_buffer_size().unwrap_or(0);
    let mut bytes = vec![0; size];
    let info = reader.next_frame(&mut bytes).map_err(|cause| asset.error(None, cause))?;
    let channels = info.color_type.samples();
    let texels = bytes[..info.buffer_size()].chunks_exact(channels).map(|pixel| {
        let grey = channels < 3;
        let [r, g, b] = if grey { [pixel[0]; 3] } else { [pixel[0], pixel[1], pixel[2]] };
        Vec3::new(linear(r), linear(g), linear(b))
    });
    Ok(rounded(info.width, info.height, texels.collect(), cap))
}

/// The sRGB transfer function (IEC 61966-2-1), byte to linear.
fn linear(byte: u8) -> f32 {
    let encoded = f32::from(byte) / 255.0;
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

fn rounded(width: u32, height: u32, texels: Vec<Vec3>, cap: f32) -> Image {
    // max before min: a NaN becomes 0.
    let round = |value: f32| f16::from_f32(value.max(0.0).min(cap)).to_f32();
    let texels = texels.into_iter().map(|texel| Vec3::from(texel.to_array().map(round))).collect();
    Image { width, height, texels }
}
