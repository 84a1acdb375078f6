//! Simplified rotated depth maps (Popescu et al. 2006, slides 37 and 38): "Pre-rotate depth map. All rays
//! ever needed project to rows. Pre-simplify rows."
//!
//! A depth image is `size` texels a side; what it shows lies in the disc inscribed in it, so that each
//! rotated map has as many rows, of as many samples. A texel holds a height above the farthest thing the
//! image can show, 0 (also: nothing) to 1, in which straight lines stay straight: 1/z under perspective, z
//! under parallel rays. A row is kept as at most so many segments in (x, height). Shader twins:
//! `shaders/depth_impostors/`.

mod march;
mod search;
mod simplify;
mod sweep;

use std::f32::consts::PI;

use glam::Vec2;
use rayon::prelude::*;

pub use march::{Marched, march};
pub use search::{Found, ImageLine, RowHit, RowLine, Rule, degenerate, finish, search};
pub use simplify::simplify;
pub use sweep::sweep;

/// Most segments a row can have.
pub const MOST_SEGMENTS: u32 = 64;

/// Of the jump that is a silhouette: no farther behind one than this is its rim, which a surface goes on to
/// bend round.
const RIM: f32 = 0.5;

/// How many maps of what size, of how many segments a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RowShape {
    /// Texels along a side of the depth image; rows of a map, and samples of a row.
    pub size: u32,
    /// Rotated maps, a half turn over so many apart.
    pub angles: u32,
    /// Most a row is simplified to.
    pub segments: u32,
}

impl RowShape {
    /// Radians that a map is rotated by.
    pub fn angle(&self, map: u32) -> f32 {
        map as f32 * PI / self.angles as f32
    }

    /// Rows of all maps.
    pub fn rows(&self) -> u32 {
        self.angles * self.size
    }

    /// Bytes of all rows' segments and counts.
    pub fn bytes(&self) -> u64 {
        u64::from(self.rows()) * (8 * u64::from(self.segments) + 4)
    }

    /// A place of the image, in texels, in a map rotated by `angle`; and back with the angle's negative.
    pub fn rotated(&self, place: Vec2, angle: f32) -> Vec2 {
        let middle = Vec2::splat(0.5 * self.size as f32);
        middle + Vec2::from_angle(-angle).rotate(place - middle)
    }
}

/// What counts as one surface, in heights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// A row is simplified no further than to this error.
    pub tolerance: f32,
    /// Neighbouring texels farther apart than this are two surfaces: a silhouette is between them.
    pub jump: f32,
}

/// A depth image.
#[derive(Clone, Copy, Debug)]
pub struct Heights<'a> {
    /// Row by row; 0 where there is nothing.
    pub texels: &'a [f32],
    pub size: u32,
}

impl Heights<'_> {
    /// That of the texel at a place; 0 outside.
    pub fn nearest(&self, place: Vec2) -> f32 {
        let texel = place.floor().as_ivec2();
        if texel.min_element() < 0 || texel.max_element() >= self.size as i32 {
            return 0.0;
        }
        self.texels[(texel.y as u32 * self.size + texel.x as u32) as usize]
    }

    /// Between four texels of one surface; that of the nearest at a silhouette.
    pub fn at(&self, place: Vec2, jump: f32) -> f32 {
        match self.between(place, jump) {
            0.0 => self.nearest(place),
            height => height,
        }
    }

    /// Between four texels of one surface, 0 where they are not.
    pub fn between(&self, place: Vec2, jump: f32) -> f32 {
        let low = (place - 0.5).floor();
        if low.min_element() < 0.0 || low.max_element() >= self.size as f32 - 1.0 {
            return 0.0;
        }
        let part = place - 0.5 - low;
        let corner = (low.y as u32 * self.size + low.x as u32) as usize;
        let below = corner + self.size as usize;
        let [a, b] = [self.texels[corner], self.texels[corner + 1]];
        let [c, d] = [self.texels[below], self.texels[below + 1]];
        let (least, most) = (a.min(b).min(c.min(d)), a.max(b).max(c.max(d)));
        if least == 0.0 || most - least > jump {
            return 0.0;
        }
        let (top, bottom) = (a + part.x * (b - a), c + part.x * (d - c));
        top + part.y * (bottom - top)
    }

    /// Four neighbours a texel, as shaders read them: each texel's own height and its right neighbour's, then
    /// those below; 16 bits each.
    pub fn quads(&self) -> Vec<[u32; 2]> {
        let word = |x: u32, y: u32| {
            let inside = x < self.size && y < self.size;
            let height = if inside { self.texels[(y * self.size + x) as usize] } else { 0.0 };
            (height.clamp(0.0, 1.0) * 65535.0 + 0.5) as u32
        };
        let quad = |i: u32| {
            let (x, y) = (i % self.size, i / self.size);
            [y, y + 1].map(|y| word(x, y) | word(x + 1, y) << 16)
        };
        (0..self.size * self.size).map(quad).collect()
    }
}

/// Part of a row; x in texels from the row's left end on.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Segment {
    pub x: [f32; 2],
    pub height: [f32; 2],
}

/// A segment in two words: both x, over the size of the image, and both heights, as 16 bits each.
pub type Packed = [u32; 2];

impl Segment {
    /// From the centre of one sample of a row to that of another; on to the sample's border where no
    /// neighbour begins or ends with the same sample.
    fn over([first, last]: [u32; 2], joined: [bool; 2], samples: &[f32]) -> Segment {
        let low = if joined[0] { 0.5 } else { 0.0 };
        let high = if joined[1] { 0.5 } else { 1.0 };
        Segment {
            x: [first as f32 + low, last as f32 + high],
            height: [first, last].map(|i| samples[i as usize]),
        }
    }

    pub fn packed(&self, size: u32) -> Packed {
        let pair = |[a, b]: [f32; 2]| {
            let word = |v: f32| (v.clamp(0.0, 1.0) * 65535.0 + 0.5).floor() as u32;
            word(a) | word(b) << 16
        };
        [pair(self.x.map(|x| x / size as f32)), pair(self.height)]
    }

    pub fn unpacked([x, height]: Packed, size: u32) -> Segment {
        let pair = |word: u32| [word & 0xffff, word >> 16].map(|v| v as f32 / 65535.0);
        Segment { x: pair(x).map(|x| x * size as f32), height: pair(height) }
    }
}

/// A rule that simplifies a row of samples into at most so many segments, and says how many they are:
/// [`simplify`] or [`sweep`].
pub type Simplify = fn(&[f32], Limits, &mut [Packed]) -> u32;

/// All rows of a depth image.
#[derive(Clone, Debug, PartialEq)]
pub struct DepthRows {
    pub shape: RowShape,
    /// Segments in use of each row, map after map.
    pub counts: Vec<u32>,
    /// `shape.segments` a row, from left to right.
    pub segments: Vec<Packed>,
}

impl DepthRows {
    /// "Pre-rotate depth map ... Pre-simplify rows", on all cores.
    pub fn build(
        heights: Heights,
        shape: RowShape,
        limits: Limits,
        simplify: Simplify,
    ) -> DepthRows {
        let mut rows = DepthRows {
            shape,
            counts: vec![0; shape.rows() as usize],
            segments: vec![[0; 2]; (shape.rows() * shape.segments) as usize],
        };
        let of_row = rows.segments.par_chunks_mut(shape.segments as usize);
        of_row.zip(&mut rows.counts).enumerate().for_each_init(
            || vec![0.0; shape.size as usize],
            |samples, (row, (segments, count))| {
                let (map, row) = (row as u32 / shape.size, row as u32 % shape.size);
                sample_row(heights, shape, limits.jump, (map, row), samples);
                *count = simplify(samples, limits, segments);
            },
        );
        rows
    }

    /// The segments of a row.
    pub fn row(&self, map: u32, row: u32) -> &[Packed] {
        let index = (map * self.shape.size + row) as usize;
        let first = index * self.shape.segments as usize;
        &self.segments[first..first + self.counts[index] as usize]
    }
}

/// A row of a rotated map before it is simplified, at the samples' centres; of 16 bits, as on the device.
pub fn sample_row(
    heights: Heights,
    shape: RowShape,
    jump: f32,
    (map, row): (u32, u32),
    samples: &mut [f32],
) {
    let along = Vec2::from_angle(shape.angle(map));
    let middle = 0.5 * shape.size as f32;
    let across = row as f32 + 0.5 - middle;
    let origin = Vec2::splat(middle) + across * along.perp();
    for (i, sample) in samples.iter_mut().enumerate() {
        let x = i as f32 + 0.5 - middle;
        // Beyond the disc there is nothing.
        let inside = x * x + across * across <= middle * middle;
        let height = if inside { heights.at(origin + x * along, jump) } else { 0.0 };
        *sample = (65535.0 * height + 0.5).floor() / 65535.0;
    }
}

#[cfg(test)]
mod tests;
