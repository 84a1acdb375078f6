//! The error of one record against the truth.
//!
//! Pixels are compared where both see the same reflector. R, N, B and the chain of mirrors are the
//! truth's; a record is judged by the point S it shows, its colours apart. Of two equal answers
//! nothing differs, so the truth against itself scores zero in everything.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::colour::{self, EXPOSURE};
use super::groups::{
    OrderAccuracy, ReflectorAccuracy, SecondAccuracy, by_order, by_reflector, by_second,
};
use super::judge::{Judged, judge_all};
use crate::error::{Error, Result};
use crate::scene::{FrameRecord, NO_OBJECT};
use crate::truth::Tracer;

/// How far a frame is from the truth. Shares are of all compared pixels unless said otherwise.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Accuracy {
    /// Pixels that are missing, spurious, of the wrong object, of the wrong depth, unreachable, or
    /// displaced by more than so many pixels. One where nothing could be compared though a
    /// reflector is there.
    pub bad_share: BadShare,
    /// Pixels that `displacement_px` and `angle_deg` speak of: truth and record both show a
    /// surface, or both the environment, and the place where the answer belongs was found.
    pub covered: f64,
    /// No answer, or the environment where the truth shows a surface.
    pub missing: f64,
    /// A surface where the truth shows the environment.
    pub spurious: f64,
    /// Another object than the truth's.
    pub wrong_object: f64,
    /// The distance from the last mirror to S differs from the truth's by over 5 %.
    pub wrong_depth: f64,
    /// S belongs nowhere within 256 pixels.
    pub unreachable: f64,
    /// Share of the pixels where truth or record see a reflector that see different ones. These
    /// are not compared.
    pub footprint_mismatch: f64,
    /// Distance in pixels from the pixel to where its S belongs; null where nothing is covered.
    pub displacement_px: Option<Quantiles>,
    /// Degrees at the last mirror between the mirrored direction and the direction to S; null
    /// where nothing is covered.
    pub angle_deg: Option<Quantiles>,
    /// Relative mean squared error of the picture.
    pub relmse: f64,
    /// The same with S shaded as the truth shades it: what is left is not resampling.
    pub relmse_shading: f64,
    /// Decibels, after tone mapping; null where the tone-mapped pictures are equal.
    pub psnr: Option<f64>,
    pub flip: Flip,
    /// By the number of reflectors the truth met, rising.
    #[serde(default)]
    pub by_order: Vec<OrderAccuracy>,
    /// By the reflector seen, in the order of their names.
    #[serde(default)]
    pub by_reflector: Vec<ReflectorAccuracy>,
    /// Of order 2, by whether the second mirror is the first one's own.
    #[serde(default)]
    pub by_second: Vec<SecondAccuracy>,
}

/// Share of bad pixels by the displacement still tolerated, in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BadShare {
    #[serde(rename = "0.5")]
    pub half: f64,
    #[serde(rename = "1")]
    pub one: f64,
    #[serde(rename = "2")]
    pub two: f64,
    #[serde(rename = "4")]
    pub four: f64,
}

/// Nearest-rank quantiles.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Quantiles {
    pub median: f64,
    pub p95: f64,
    pub max: f64,
}

/// FLIP over the compared pixels; other pixels are taken from the truth.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Flip {
    pub mean: f64,
    pub p95: f64,
    /// Pixels per degree FLIP was told.
    pub ppd: f64,
    /// Factor of the tone mapping.
    pub exposure: f64,
}

/// What is wrong with a pixel, the gravest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// No reflector here, in neither record.
    Outside,
    /// Truth and record see different reflectors.
    Footprint,
    Missing,
    Spurious,
    WrongObject,
    WrongDepth,
    Unreachable,
    /// Nothing but its displacement.
    Placed,
}

/// The errors pixel by pixel, row-major, for heat maps.
#[derive(Clone, Debug, PartialEq)]
pub struct Maps {
    pub size: [u32; 2],
    pub class: Vec<Class>,
    /// Pixels; NaN where none is defined.
    pub displacement_px: Vec<f32>,
    /// 0 to 1; 0 where nothing is compared.
    pub flip: Vec<f32>,
}

impl Maps {
    /// Share of the compared pixels that are bad when `tolerated_px` of displacement are not;
    /// one where nothing could be compared though a reflector is there.
    pub fn bad_share(&self, tolerated_px: f64) -> f64 {
        let (mut bad, mut compared, mut mismatched) = (0, 0, 0);
        for (class, &displacement) in self.class.iter().zip(&self.displacement_px) {
            match class {
                Class::Outside => {}
                Class::Footprint => mismatched += 1,
                Class::Placed => {
                    compared += 1;
                    bad += u64::from(f64::from(displacement) > tolerated_px);
                }
                _ => {
                    compared += 1;
                    bad += 1;
                }
            }
        }
        if compared == 0 { f64::from(mismatched.min(1)) } else { share(bad, compared) }
    }
}

/// Compare `tested` with `truth`, a frame of `tracer`'s.
///
/// # Errors
/// When the frames differ in size.
pub fn accuracy(
    truth: &FrameRecord,
    tested: &FrameRecord,
    tracer: &Tracer,
) -> Result<(Accuracy, Maps)> {
    if truth.size != tested.size {
        let [[a, b], [c, d]] = [truth.size, tested.size];
        return Err(Error::Usage(format!("the truth is {a}x{b} pixels, the other frame {c}x{d}")));
    }
    let (compared, mismatched) = footprint(truth, tested);
    let judged = judge_all(truth, tested, tracer, &compared);
    let flip = flip_map(truth, tested, tracer, &compared);
    let maps = Maps {
        size: truth.size,
        class: classes(truth.size, &compared, &mismatched, &judged),
        displacement_px: scatter(
            truth.size,
            f32::NAN,
            &compared,
            judged.iter().map(|j| j.displacement_px.unwrap_or(f32::NAN)),
        ),
        flip: flip.1,
    };
    let among = |test: fn(&Judged) -> bool| {
        share(judged.iter().filter(|judged| test(judged)).count() as u64, compared.len() as u64)
    };
    let covered = || judged.iter().filter(|judged| judged.displacement_px.is_some());
    let union = (compared.len() + mismatched.len()) as u64;
    let pictures = || compared.iter().map(|&p| [truth.colour[p], finite(tested.colour[p])]);
    let accuracy = Accuracy {
        bad_share: BadShare {
            half: maps.bad_share(0.5),
            one: maps.bad_share(1.0),
            two: maps.bad_share(2.0),
            four: maps.bad_share(4.0),
        },
        covered: among(|judged| judged.displacement_px.is_some()),
        missing: among(|judged| judged.missing),
        spurious: among(|judged| judged.spurious),
        wrong_object: among(|judged| judged.wrong_object),
        wrong_depth: among(|judged| judged.wrong_depth),
        unreachable: among(|judged| judged.unreachable),
        footprint_mismatch: share(mismatched.len() as u64, union),
        displacement_px: quantiles(covered().filter_map(|judged| judged.displacement_px)),
        angle_deg: quantiles(covered().map(|judged| judged.angle_deg)),
        relmse: colour::relative_mse(pictures()),
        relmse_shading: colour::relative_mse(judged.iter().map(|judged| judged.shaded)),
        psnr: colour::psnr(pictures()),
        flip: flip.0,
        by_order: by_order(truth, &compared, &judged),
        by_reflector: by_reflector(tracer.scene(), truth, &compared, &judged),
        by_second: by_second(tracer.scene(), truth, &compared, &judged),
    };
    Ok((accuracy, maps))
}

/// The pixels where both see the same reflector, and those where they see different ones.
fn footprint(truth: &FrameRecord, tested: &FrameRecord) -> (Vec<usize>, Vec<usize>) {
    let seen = |pixel: &usize| {
        truth.reflector[*pixel] != NO_OBJECT || tested.reflector[*pixel] != NO_OBJECT
    };
    (0..truth.reflector.len())
        .filter(seen)
        .partition(|&pixel| truth.reflector[pixel] == tested.reflector[pixel])
}

fn classes(
    size: [u32; 2],
    compared: &[usize],
    mismatched: &[usize],
    judged: &[Judged],
) -> Vec<Class> {
    let mut classes = scatter(size, Class::Outside, compared, judged.iter().map(Judged::class));
    for &pixel in mismatched {
        classes[pixel] = Class::Footprint;
    }
    classes
}

fn flip_map(
    truth: &FrameRecord,
    tested: &FrameRecord,
    tracer: &Tracer,
    compared: &[usize],
) -> (Flip, Vec<f32>) {
    let mut picture = truth.colour.clone();
    for &pixel in compared {
        picture[pixel] = finite(tested.colour[pixel]);
    }
    let ppd = colour::pixels_per_degree(&tracer.moment().camera, truth.size);
    let errors = colour::flip_map(truth.size, &truth.colour, &picture, ppd);
    let masked = || compared.iter().map(|&pixel| errors[pixel]);
    let sum: f64 = masked().map(f64::from).sum();
    let flip = Flip {
        mean: sum / compared.len().max(1) as f64,
        p95: quantiles(masked()).map_or(0.0, |errors| errors.p95),
        ppd: ppd.into(),
        exposure: EXPOSURE.into(),
    };
    (flip, scatter(truth.size, 0.0, compared, masked()))
}

/// An image of `rest` with `values` at `pixels`.
fn scatter<T: Clone>(
    size: [u32; 2],
    rest: T,
    pixels: &[usize],
    values: impl Iterator<Item = T>,
) -> Vec<T> {
    let mut image = vec![rest; (size[0] * size[1]) as usize];
    for (&pixel, value) in pixels.iter().zip(values) {
        image[pixel] = value;
    }
    image
}

/// A colour that is not a number is none.
pub(super) fn finite(colour: glam::Vec3) -> glam::Vec3 {
    if colour.is_finite() { colour } else { glam::Vec3::ZERO }
}

fn share(count: u64, of: u64) -> f64 {
    if of == 0 { 0.0 } else { count as f64 / of as f64 }
}

fn quantiles(values: impl Iterator<Item = f32>) -> Option<Quantiles> {
    let mut sorted: Vec<f32> = values.collect();
    sorted.sort_by(f32::total_cmp);
    let rank = |q: f64| (q * sorted.len() as f64).ceil() as usize;
    let at = |q: f64| sorted.get(rank(q).max(1) - 1).copied().map(f64::from);
    Some(Quantiles { median: at(0.5)?, p95: at(0.95)?, max: at(1.0)? })
}
