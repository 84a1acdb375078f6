//! Comparing cases with the truth, frame by frame, in full-record mode.

use std::collections::BTreeMap;

use super::lab::Lab;
use crate::error::Result;
use crate::measure::{
    Accuracy, BadShare, Flip, Quantiles, accuracy, mean_by_order, mean_by_reflector, mean_by_second,
};
use crate::methods::Case;
use crate::scene::Scene;
use crate::truth::{Cache, Tracer, TruthOptions};

/// What the compared frames of one case said.
#[derive(Clone, Debug, Default)]
pub struct Evidence {
    /// Frame number and accuracy.
    pub frames: Vec<(u32, Accuracy)>,
    /// Reflector pixels a frame, mean.
    pub reflector_pixels: f64,
    /// Work a frame, mean.
    pub counters: BTreeMap<String, f64>,
}

/// `count` frames of a list, evenly spaced, both ends included; the middle for one.
pub fn evenly_spaced(frames: &[u32], count: usize) -> Vec<u32> {
    match (frames, count) {
        ([], _) | (_, 0) => Vec::new(),
        (_, 1) => vec![frames[frames.len() / 2]],
        _ if count >= frames.len() => frames.to_vec(),
        _ => (0..count).map(|i| frames[i * (frames.len() - 1) / (count - 1)]).collect(),
    }
}

/// Draws every case at every frame and compares it with the truth of that frame.
///
/// # Errors
/// Those of the engine and of the truth's cache.
pub fn gather(lab: &Lab, scene: &Scene, cases: &[Case], frames: &[u32]) -> Result<Vec<Evidence>> {
    let size = lab.settings.size;
    let mut gathered = vec![Evidence::default(); cases.len()];
    if frames.is_empty() {
        return Ok(gathered);
    }
    let cache = Cache::of_user()?;
    let artists = cases.iter().map(|case| lab.artist(scene, case, size));
    let mut artists = artists.collect::<Result<Vec<_>>>()?;
    let part = 1.0 / frames.len() as f64;
    for &number in frames {
        let moment = scene.at(number);
        let tracer = Tracer::new(scene, &moment, TruthOptions::default());
        let truth = cache.frame(&tracer, size)?;
        for ((artist, case), evidence) in artists.iter_mut().zip(cases).zip(&mut gathered) {
            lab.progress.set_message(format!("{} frame {number}: {}", scene.name, case.text));
            let (frame, times) = artist.frame(&moment, size, true)?;
            evidence.frames.push((number, accuracy(&truth, &frame, &tracer)?.0));
            evidence.reflector_pixels += part * frame.reflector_pixels().len() as f64;
            for (name, count) in times.counters {
                *evidence.counters.entry(name).or_default() += part * count as f64;
            }
        }
    }
    Ok(gathered)
}

impl Evidence {
    /// One accuracy for all frames: means over the frames (those that have a value, where one may be
    /// absent), maxima of the maxima. `None` without frames.
    pub fn accuracy(&self) -> Option<Accuracy> {
        let all: Vec<&Accuracy> = self.frames.iter().map(|(_, accuracy)| accuracy).collect();
        let first = all.first()?;
        let orders: Vec<_> = all.iter().map(|a| a.by_order.as_slice()).collect();
        let reflectors: Vec<_> = all.iter().map(|a| a.by_reflector.as_slice()).collect();
        let seconds: Vec<_> = all.iter().map(|a| a.by_second.as_slice()).collect();
        let mean = |field: fn(&Accuracy) -> f64| mean(all.iter().map(|a| field(a))).unwrap_or(0.0);
        Some(Accuracy {
            bad_share: BadShare {
                half: mean(|a| a.bad_share.half),
                one: mean(|a| a.bad_share.one),
                two: mean(|a| a.bad_share.two),
                four: mean(|a| a.bad_share.four),
            },
            covered: mean(|a| a.covered),
            missing: mean(|a| a.missing),
            spurious: mean(|a| a.spurious),
            wrong_object: mean(|a| a.wrong_object),
            wrong_depth: mean(|a| a.wrong_depth),
            unreachable: mean(|a| a.unreachable),
            footprint_mismatch: mean(|a| a.footprint_mismatch),
            displacement_px: quantiles(all.iter().filter_map(|a| a.displacement_px)),
            angle_deg: quantiles(all.iter().filter_map(|a| a.angle_deg)),
            relmse: mean(|a| a.relmse),
            relmse_shading: mean(|a| a.relmse_shading),
            psnr: self::mean(all.iter().filter_map(|a| a.psnr)),
            flip: Flip {
                mean: mean(|a| a.flip.mean),
                p95: mean(|a| a.flip.p95),
                ppd: mean(|a| a.flip.ppd),
                exposure: first.flip.exposure,
            },
            by_order: mean_by_order(&orders),
            by_reflector: mean_by_reflector(&reflectors),
            by_second: mean_by_second(&seconds),
        })
    }
}

fn quantiles(all: impl Iterator<Item = Quantiles> + Clone) -> Option<Quantiles> {
    Some(Quantiles {
        median: mean(all.clone().map(|q| q.median))?,
        p95: mean(all.clone().map(|q| q.p95))?,
        max: all.map(|q| q.max).fold(0.0, f64::max),
    })
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0), |(sum, count), value| (sum + value, count + 1));
    (count > 0).then(|| sum / f64::from(count))
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// An accuracy in which most fields are `x`.
    pub fn accuracy_of(x: f64, displacement: Option<f64>) -> Accuracy {
        let quantiles = |median| Quantiles { median, p95: 2.0 * median, max: 3.0 * median };
        Accuracy {
            bad_share: BadShare { half: x, one: x, two: x, four: x },
            covered: x,
            missing: x,
            spurious: x,
            wrong_object: x,
            wrong_depth: x,
            unreachable: x,
            footprint_mismatch: x,
            displacement_px: displacement.map(quantiles),
            angle_deg: displacement.map(quantiles),
            relmse: x,
            relmse_shading: x,
            psnr: None,
            flip: Flip { mean: x, p95: x, ppd: 67.0, exposure: 1.0 },
            by_order: Vec::new(),
            by_reflector: Vec::new(),
            by_second: Vec::new(),
        }
    }

    #[test]
    fn frames_are_spread_over_the_list() {
        let list: Vec<u32> = (10..30).collect();
        assert_eq!(evenly_spaced(&list, 3), [10, 19, 29]);
        assert_eq!(evenly_spaced(&list, 1), [20]);
        assert_eq!(evenly_spaced(&list[..2], 3), [10, 11]);
        assert_eq!(evenly_spaced(&list, 0), [0; 0]);
        assert_eq!(evenly_spaced(&[], 3), [0; 0]);
    }

    #[test]
    fn accuracies_average_over_the_frames_that_have_a_value() {
        let frames = [(0, accuracy_of(0.1, Some(1.0))), (1, accuracy_of(0.3, Some(3.0)))];
        let mut evidence = Evidence { frames: frames.to_vec(), ..Default::default() };
        evidence.frames.push((2, accuracy_of(0.2, None)));
        let all = evidence.accuracy().unwrap();
        assert!((all.bad_share.one - 0.2).abs() < 1e-12);
        assert_eq!(all.displacement_px, Some(Quantiles { median: 2.0, p95: 4.0, max: 9.0 }));
        assert_eq!((all.psnr, all.flip.ppd), (None, 67.0));
        assert_eq!(Evidence::default().accuracy(), None);
    }
}
