//! A frame on disk: one multi-layer EXR with the picture and its evidence, and a PNG to look at.
//!
//! Channels: `R,G,B` picture and `reflection.R/G/B` radiance along the chain, half; `Z` depth,
//! `shown.X/Y/Z/W` point, `last.X/Y/Z/W` last bounce and path length, `position.X/Y/Z` and
//! `normal.X/Y/Z` of the reflector, float; `shown.object`, `.triangle`, `.trace`, `.order`,
//! `.lobe`, `.status`, `.source`, `.flag`, `object.id` seen directly and `reflector.id`, uint. What
//! glass lets through is in `refraction.*`, `refracted.*` and `refracted-last.*` in place of
//! `reflection.*`, `shown.*` and `last.*`, in scenes that have glass. ZIP, linear Rec.709.

use std::collections::HashMap;
use std::io;
use std::path::Path;

use exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Encoding, FlatSamples, Image, Layer, LayerAttributes,
    ReadChannels, ReadLayers, Text, WritableImage, f16, read,
};
use glam::{Vec3, Vec4};

use super::output::write_file;
use crate::error::{Error, Result};
use crate::scene::{FrameRecord, Ids, Lobe, ReflectionRecord};

/// Where a frame comes from: the text attributes of its file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Provenance {
    pub scene: String,
    pub frame: u32,
    pub case: String,
    pub commit: String,
    pub device: String,
}

/// One frame file, read.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameFile {
    pub frame: FrameRecord,
    pub from: Provenance,
}

const RGB: [&str; 3] = ["R", "G", "B"];
const XYZ: [&str; 3] = ["X", "Y", "Z"];
const XYZW: [&str; 4] = ["X", "Y", "Z", "W"];

/// Layers of a lobe's record: radiance, point and ids, last bounce.
const LAYERS: [(Lobe, [&str; 3]); 2] = [
    (Lobe::Reflected, ["reflection", "shown", "last"]),
    (Lobe::Refracted, ["refraction", "refracted", "refracted-last"]),
];

/// A channel of identities: its name in its layer, the word of [`Ids`] it is part of, its lowest bit, its mask.
const ID_CHANNELS: [(&str, usize, u32, u32); 8] = [
    ("object", 0, 0, u32::MAX),
    ("triangle", 1, 0, u32::MAX),
    ("trace", 2, 0, u32::MAX),
    ("order", 3, 0, 0xff),
    ("lobe", 3, 8, 0xf),
    ("status", 3, 12, 0xf),
    ("source", 3, 16, 0xf),
    ("flag", 3, 20, 0x1),
];

/// Writes the EXR. Colours are rounded to half precision; everything else is exact.
///
/// # Errors
/// [`Error::Output`].
pub fn write_exr(path: &Path, frame: &FrameRecord, from: &Provenance) -> Result<()> {
    let [width, height] = frame.size.map(|n| n as usize);
    let mut attributes = LayerAttributes::default();
    let number = from.frame.to_string();
    for (name, value) in [
        ("scene", &from.scene),
        ("frame", &number),
        ("case", &from.case),
        ("commit", &from.commit),
        ("device", &from.device),
    ] {
        attributes.other.insert(name.into(), AttributeValue::Text(value.as_str().into()));
    }
    let channels = AnyChannels::sort(channels(frame).into_iter().collect());
    let layer = Layer::new((width, height), attributes, Encoding::SMALL_LOSSLESS, channels);
    let image = Image::from_layer(layer);
    write_file(path, |file| image.write().to_buffered(file).map_err(io::Error::other))
}

fn channels(frame: &FrameRecord) -> Vec<AnyChannel<FlatSamples>> {
    let mut list = Vec::new();
    let halves = |values: &[Vec3], i: usize| {
        FlatSamples::F16(values.iter().map(|v| f16::from_f32(v[i])).collect())
    };
    let floats =
        |values: &[Vec3], i: usize| FlatSamples::F32(values.iter().map(|v| v[i]).collect());
    let wide = |values: &[Vec4], i: usize| FlatSamples::F32(values.iter().map(|v| v[i]).collect());
    let mut add = |name: String, samples| list.push(AnyChannel::new(name.as_str(), samples));
    for (i, name) in RGB.iter().enumerate() {
        add((*name).to_owned(), halves(&frame.colour, i));
    }
    for (i, name) in XYZ.iter().enumerate() {
        add(format!("position.{name}"), floats(&frame.position, i));
        add(format!("normal.{name}"), floats(&frame.normal, i));
    }
    for (lobe, [light, shown, last]) in LAYERS {
        let Some(record) = frame.lobe(lobe) else { continue };
        for (i, name) in RGB.iter().enumerate() {
            add(format!("{light}.{name}"), halves(&record.radiance, i));
        }
        for (i, name) in XYZW.iter().enumerate() {
            add(format!("{shown}.{name}"), wide(&record.point, i));
            add(format!("{last}.{name}"), wide(&record.last, i));
        }
        for (name, word, shift, mask) in ID_CHANNELS {
            let bits = |ids: &Ids| words(ids)[word] >> shift & mask;
            let values = record.ids.iter().map(bits).collect();
            add(format!("{shown}.{name}"), FlatSamples::U32(values));
        }
    }
    add("Z".to_owned(), FlatSamples::F32(frame.depth.clone()));
    add("object.id".to_owned(), FlatSamples::U32(frame.object.clone()));
    add("reflector.id".to_owned(), FlatSamples::U32(frame.reflector.clone()));
    list
}

fn words(ids: &Ids) -> [u32; 4] {
    [ids.object, ids.triangle, ids.trace, ids.bits]
}

/// Reads a file that [`write_exr`] wrote.
///
/// # Errors
/// [`Error::Usage`] where the file cannot be read, is no EXR, or lacks a channel.
pub fn read_exr(path: &Path) -> Result<FrameFile> {
    let failed = |cause: String| Error::Usage(format!("cannot read {}: {cause}", path.display()));
    let reader = read().no_deep_data().largest_resolution_level().all_channels();
    let image = reader.first_valid_layer().all_attributes().from_file(path);
    let image = image.map_err(|cause| failed(cause.to_string()))?;
    let layer = image.layer_data;
    let text = |name: &str| match layer.attributes.other.get(&Text::from(name)) {
        Some(AttributeValue::Text(text)) => text.to_string(),
        _ => String::new(),
    };
    let from = Provenance {
        scene: text("scene"),
        frame: text("frame").parse().unwrap_or_default(),
        case: text("case"),
        commit: text("commit"),
        device: text("device"),
    };
    let size = layer.size;
    let list = layer.channel_data.list;
    let named = list.into_iter().map(|channel| (channel.name.to_string(), channel.sample_data));
    let mut channels = Channels(named.collect());
    let size = [size.width(), size.height()].map(|n| n as u32);
    let frame = channels.frame(size).map_err(|name| {
        failed(format!("it has no channel {name} of the kind mirrorbench writes"))
    })?;
    Ok(FrameFile { frame, from })
}

/// The channels of a file by name; taking one that is missing gives its name as the error.
struct Channels(HashMap<String, FlatSamples>);

impl Channels {
    fn frame(&mut self, size: [u32; 2]) -> Result<FrameRecord, String> {
        let pixels = size[0] as usize * size[1] as usize;
        let vec3 = |v: Vec<[f32; 3]>| v.into_iter().map(Vec3::from_array).collect();
        let [(_, reflected), (_, refracted)] = LAYERS;
        let has_glass = self.0.contains_key(&format!("{}.{}", refracted[1], ID_CHANNELS[0].0));
        Ok(FrameRecord {
            size,
            colour: vec3(self.vectors("", RGB, pixels)?),
            depth: self.floats("Z")?,
            object: self.uints("object.id")?,
            reflector: self.uints("reflector.id")?,
            position: vec3(self.vectors("position.", XYZ, pixels)?),
            normal: vec3(self.vectors("normal.", XYZ, pixels)?),
            record: self.record(reflected, pixels)?,
            refracted: has_glass.then(|| self.record(refracted, pixels)).transpose()?,
        })
    }

    fn record(
        &mut self,
        [light, shown, last]: [&str; 3],
        pixels: usize,
    ) -> Result<ReflectionRecord, String> {
        let vec4 = |v: Vec<[f32; 4]>| v.into_iter().map(Vec4::from_array).collect();
        let mut ids = vec![[0; 4]; pixels];
        for (name, word, shift, _) in ID_CHANNELS {
            for (id, bits) in ids.iter_mut().zip(self.uints(&format!("{shown}.{name}"))?) {
                id[word] |= bits << shift;
            }
        }
        let unpack =
            |[object, triangle, trace, bits]: [u32; 4]| Ids { object, triangle, trace, bits };
        let light = self.vectors(&format!("{light}."), RGB, pixels)?;
        Ok(ReflectionRecord {
            radiance: light.into_iter().map(Vec3::from_array).collect(),
            point: vec4(self.vectors(&format!("{shown}."), XYZW, pixels)?),
            last: vec4(self.vectors(&format!("{last}."), XYZW, pixels)?),
            ids: ids.into_iter().map(unpack).collect(),
        })
    }

    fn vectors<const N: usize>(
        &mut self,
        layer: &str,
        names: [&str; N],
        pixels: usize,
    ) -> Result<Vec<[f32; N]>, String> {
        let mut vectors = vec![[0.0; N]; pixels];
        for (i, name) in names.iter().enumerate() {
            for (vector, value) in vectors.iter_mut().zip(self.floats(&format!("{layer}{name}"))?) {
                vector[i] = value;
            }
        }
        Ok(vectors)
    }

    fn floats(&mut self, name: &str) -> Result<Vec<f32>, String> {
        match self.0.remove(name) {
            Some(FlatSamples::F32(values)) => Ok(values),
            Some(FlatSamples::F16(values)) => Ok(values.into_iter().map(f16::to_f32).collect()),
            _ => Err(name.to_owned()),
        }
    }

    fn uints(&mut self, name: &str) -> Result<Vec<u32>, String> {
        match self.0.remove(name) {
            Some(FlatSamples::U32(values)) => Ok(values),
            _ => Err(name.to_owned()),
        }
    }
}

/// Writes the picture as 8-bit sRGB at exposure 1, clamped.
///
/// # Errors
/// [`Error::Output`].
pub fn write_png(path: &Path, size: [u32; 2], colour: &[Vec3]) -> Result<()> {
    let bytes: Vec<u8> = colour.iter().flat_map(|c| c.to_array().map(srgb_byte)).collect();
    write_file(path, |file| {
        let mut encoder = png::Encoder::new(file, size[0], size[1]);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
        let mut writer = encoder.write_header().map_err(io::Error::other)?;
        writer.write_image_data(&bytes).map_err(io::Error::other)?;
        writer.finish().map_err(io::Error::other)
    })
}

/// IEC 61966-2-1; not a number becomes 0.
fn srgb_byte(linear: f32) -> u8 {
    let l = linear.clamp(0.0, 1.0);
    let encoded = if l <= 0.003_130_8 { 12.92 * l } else { 1.055 * l.powf(1.0 / 2.4) - 0.055 };
    (255.0 * encoded).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Status;

    /// A frame in which every value of every pixel differs, half-exact where stored as half.
    fn varied(size: [u32; 2]) -> FrameRecord {
        let mut frame = FrameRecord::new(size);
        for i in 0..frame.depth.len() {
            let x = i as f32;
            frame.colour[i] = Vec3::new(x, x + 0.25, x + 0.5);
            frame.depth[i] = 1.1 * x;
            frame.reflector[i] = i as u32 * 3;
            frame.object[i] = i as u32 + 7;
            frame.position[i] = Vec3::new(0.1 * x, -x, 7.7);
            frame.normal[i] = Vec3::new(x, 1.0, 0.3).normalize();
            frame.record.radiance[i] = Vec3::splat(x / 8.0);
            frame.record.point[i] = Vec4::new(x, 0.1, 0.2, (i % 2) as f32);
            frame.record.last[i] = Vec4::new(0.3, x, 0.2, f32::INFINITY);
            let mut ids = Ids::new(i as u32, 9, 0x0201, 1 + i as u32 % 3, Status::Found);
            ids.bits |= (i as u32 & 1) << 8 | (i as u32 % 3) << 16 | (i as u32 & 1) << 20;
            frame.record.ids[i] = ids;
        }
        frame.depth[0] = f32::INFINITY;
        frame
    }

    #[test]
    fn frames_come_back_as_written() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("frame.exr");
        let from = Provenance {
            scene: "columns".into(),
            frame: 12,
            case: "environment-map".into(),
            commit: "abc".into(),
            device: "llvmpipe".into(),
        };
        let mut frame = varied([7, 5]);
        for refracted in [None, Some(frame.record.clone())] {
            frame.refracted = refracted;
            write_exr(&path, &frame, &from).unwrap();
            let back = read_exr(&path).unwrap();
            assert_eq!(back.from, from);
            assert!(back.frame == frame, "the frame came back changed");
        }
    }

    #[test]
    fn what_is_not_ours_is_refused_in_one_line() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("bad.exr");
        let refusal = || {
            let message = read_exr(&path).unwrap_err().to_string();
            assert!(message.contains("bad.exr") && !message.contains('\n'), "{message}");
            message
        };
        refusal();
        std::fs::write(&path, "not an EXR").unwrap();
        refusal();
        exr::prelude::write_rgb_file(&path, 4, 4, |_, _| (0.0f32, 0.0f32, 0.0f32)).unwrap();
        assert!(refusal().contains("no channel Z"));
    }

    #[test]
    fn png_holds_srgb() {
        assert_eq!([0.0, 1.0, 0.5, 2.0, f32::NAN].map(srgb_byte), [0, 255, 188, 255, 0]);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        write_png(&path, [2, 1], &[Vec3::ZERO, Vec3::new(1.0, 0.5, 0.0)]).unwrap();
        let file = std::io::BufReader::new(std::fs::File::open(&path).unwrap());
        let mut reader = png::Decoder::new(file).read_info().unwrap();
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut bytes).unwrap();
        assert_eq!(bytes, [0, 0, 0, 255, 188, 0]);
    }
}
