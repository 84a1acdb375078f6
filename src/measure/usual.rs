//! What displacement is usual around a pixel.
//!
//! Linear in the position, by medians throughout: of the steps from each pixel to the next for the
//! slope, then of what the slope leaves. So a minority of strays counts for nothing, nor does a tear
//! between two parts of a picture.

use std::collections::HashMap;

use glam::{Mat2, UVec2, Vec2};
use rayon::prelude::*;

use super::mirrors::Key;

/// Taken over three by three blocks of so many pixels a side.
const BLOCK: u32 = 4;

/// Of fewer steps than this no slope is taken.
const LEAST_STEPS: usize = 12;

/// By block and mirrors.
pub(super) struct Usual(HashMap<(Key, UVec2), Trend>);

/// A displacement that changes linearly.
#[derive(Clone, Copy)]
struct Trend {
    at: Vec2,
    displacement: Vec2,
    slope: Mat2,
}

impl Usual {
    /// From the mirrors and the displacement of every pixel of an image, pixels, `None` where neither
    /// is. Slopes of up to `steepest` pixels a pixel are believed.
    pub fn new(size: UVec2, displacements: &[Option<(Key, Vec2)>], steepest: f32) -> Self {
        let mut blocks: HashMap<(Key, UVec2), Vec<UVec2>> = HashMap::new();
        for (index, displacement) in displacements.iter().enumerate() {
            if let Some((key, _)) = displacement {
                let pixel = UVec2::new(index as u32 % size.x, index as u32 / size.x);
                blocks.entry((*key, pixel / BLOCK)).or_default().push(pixel);
            }
        }
        let known = |key: Key, pixel: UVec2| {
            let inside = pixel.cmplt(size).all();
            let here = inside.then(|| displacements[(pixel.y * size.x + pixel.x) as usize])??;
            (here.0 == key).then_some(here.1)
        };
        let around = |(key, block): (Key, UVec2)| {
            let beside = |i: u32| (block + UVec2::new(i % 3, i / 3)).checked_sub(UVec2::ONE);
            let near = (0..9).filter_map(beside).filter_map(|block| blocks.get(&(key, block)));
            let pixels: Vec<UVec2> = near.flatten().copied().collect();
            Trend::of(block * BLOCK, &pixels, steepest, |pixel| known(key, pixel))
        };
        let trend = |place| Some((place, around(place)?));
        Usual(blocks.par_iter().filter_map(|(&place, _)| trend(place)).collect())
    }

    /// At a pixel, if anything is known around it of those mirrors.
    pub fn at(&self, key: Key, pixel: UVec2) -> Option<Vec2> {
        self.0.get(&(key, pixel / BLOCK)).map(|trend| trend.at(pixel))
    }
}

impl Trend {
    /// Around a pixel, from what is `known` of others: the same everywhere unless a slope, up to
    /// `steepest`, leaves less.
    fn of(
        at: UVec2,
        pixels: &[UVec2],
        steepest: f32,
        known: impl Fn(UVec2) -> Option<Vec2>,
    ) -> Option<Trend> {
        let slope = |axis: UVec2| {
            let step = |&pixel: &UVec2| Some(known(pixel + axis)? - known(pixel)?);
            let steps: Vec<Vec2> = pixels.iter().filter_map(step).collect();
            let enough = steps.len() >= LEAST_STEPS;
            median(&steps).filter(|step| enough && step.length() <= steepest)
        };
        let here = |&pixel: &UVec2| Some((pixel, known(pixel)?));
        let known: Vec<(UVec2, Vec2)> = pixels.iter().filter_map(here).collect();
        let flat = Trend::with(Mat2::ZERO, at, &known)?;
        let Some((x, y)) = slope(UVec2::X).zip(slope(UVec2::Y)) else { return Some(flat) };
        let sloping = Trend::with(Mat2::from_cols(x, y), at, &known)?;
        Some(if sloping.leaves(&known) < flat.leaves(&known) { sloping } else { flat })
    }

    fn with(slope: Mat2, at: UVec2, known: &[(UVec2, Vec2)]) -> Option<Trend> {
        let rising = Trend { at: at.as_vec2(), displacement: Vec2::ZERO, slope };
        let left: Vec<Vec2> =
            known.iter().map(|&(pixel, there)| there - rising.at(pixel)).collect();
        Some(Trend { displacement: median(&left)?, ..rising })
    }

    /// The median distance from what is known.
    fn leaves(&self, known: &[(UVec2, Vec2)]) -> Option<f32> {
        middle(known.iter().map(|&(pixel, there)| there.distance(self.at(pixel))))
    }

    fn at(&self, pixel: UVec2) -> Vec2 {
        self.displacement + self.slope * (pixel.as_vec2() - self.at)
    }
}

/// By component.
fn median(values: &[Vec2]) -> Option<Vec2> {
    let [x, y] = [0, 1].map(|axis| middle(values.iter().map(|value| value[axis])));
    Some(Vec2::new(x?, y?))
}

/// The median; of an even number the higher of the middle two. `None` of none.
fn middle(values: impl Iterator<Item = f32>) -> Option<f32> {
    let mut values: Vec<f32> = values.collect();
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f32::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: UVec2 = UVec2::new(24, 16);

    /// An image of displacements through mirrors of key 1 as `of` a pixel.
    fn image(of: impl Fn(UVec2) -> Vec2) -> Vec<Option<(Key, Vec2)>> {
        let pixels = (0..SIZE.y).flat_map(|y| (0..SIZE.x).map(move |x| UVec2::new(x, y)));
        pixels.map(|pixel| Some((1, of(pixel)))).collect()
    }

    fn linear(pixel: UVec2) -> Vec2 {
        Vec2::new(1.5, -2.0) + Mat2::from_cols_array(&[0.1, 0.02, -0.03, 0.2]) * pixel.as_vec2()
    }

    /// Every fifth pixel's step is another; all on the right are torn away.
    fn with_strays(pixel: UVec2) -> Vec2 {
        let stray = (pixel.x + 2 * pixel.y).is_multiple_of(5);
        let torn = pixel.x >= 16;
        linear(pixel) + Vec2::new(3.0, 1.0) * f32::from(stray) + 20.0 * f32::from(torn)
    }

    #[test]
    fn strays_and_tears_leave_a_linear_displacement() {
        let usual = Usual::new(SIZE, &image(with_strays), 0.5);
        for pixel in [UVec2::new(6, 6), UVec2::new(1, 13), UVec2::new(10, 3)] {
            let off = usual.at(1, pixel).unwrap().distance(linear(pixel));
            assert!(off < 1e-4, "{off} px at {pixel}");
        }
        assert!(usual.at(2, UVec2::ZERO).is_none());
    }

    #[test]
    fn what_seems_mirrored_has_no_slope() {
        // Most points are displaced as if mirrored in the line y = 8.
        let mirrored = |pixel: UVec2| Vec2::new(0.5, 2.0 * (pixel.y as f32 - 8.0));
        let image =
            image(|pixel| if pixel.x.is_multiple_of(3) { Vec2::X } else { mirrored(pixel) });
        let flat = Usual::new(SIZE, &image, 0.5).at(1, UVec2::new(9, 4)).unwrap();
        let same = Usual::new(SIZE, &image, 0.5).at(1, UVec2::new(9, 7)).unwrap();
        assert_eq!(flat, same);
        assert!(Usual::new(SIZE, &image, 3.0).at(1, UVec2::new(9, 4)).unwrap() != flat);
    }

    #[test]
    fn other_mirrors_do_not_count() {
        let mut image = image(|_| Vec2::X);
        for (index, displacement) in image.iter_mut().enumerate() {
            if index % 3 > 0 {
                *displacement = Some((2, Vec2::Y));
            }
        }
        let usual = Usual::new(SIZE, &image, 0.0);
        assert_eq!(usual.at(1, UVec2::new(9, 9)), Some(Vec2::X));
        assert_eq!(usual.at(2, UVec2::new(9, 9)), Some(Vec2::Y));
    }
}
