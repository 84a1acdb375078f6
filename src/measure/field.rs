//! The truth's own dense image of mirrored rays.
//!
//! At every pixel centre a chain of mirrors ends in a last segment: an origin and a direction.
//! Pixels of one chain that are neighbours on its mirrors too are interpolated between, in cells of
//! four pixel centres. Where a chain's pixels end, at another mirror's, at a silhouette within the
//! same mirror or at the picture's border, a rim pixel speaks for its surroundings.

use std::collections::HashMap;

use glam::{UVec2, Vec2, Vec3, Vec4};
use rayon::prelude::*;

use super::mirrors::{Key, Mirrors};
use super::root::{MARGIN, RIM_PX, centre};
use super::tree::{Bundle, Leaf, Tree, angle};
use crate::truth::{Bounce, Chain};

/// Where a record says the light came from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Target {
    Point(Vec3),
    Direction(Vec3),
}

impl Target {
    /// From the record's form: a point with w = 1, a direction with w = 0.
    pub fn new(point: Vec4) -> Self {
        if point.w == 0.0 {
            Target::Direction(point.truncate().normalize_or_zero())
        } else {
            Target::Point(point.truncate())
        }
    }

    /// Unit direction from `origin` to the target.
    pub fn seen_from(self, origin: Vec3) -> Vec3 {
        match self {
            Target::Point(point) => (point - origin).normalize_or_zero(),
            Target::Direction(direction) => direction,
        }
    }
}

/// The last segment of a chain: a mirrored ray.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Segment {
    pub origin: Vec3,
    pub direction: Vec3,
}

impl Segment {
    /// What leaves a mirror.
    pub fn after(bounce: &Bounce) -> Self {
        Segment { origin: bounce.hit.point, direction: bounce.outgoing }
    }

    /// Angle between the segment and the direction to a target from where it begins; by the chord,
    /// which keeps small angles.
    pub fn angle_deg(&self, target: Target) -> f32 {
        let chord = target.seen_from(self.origin).distance(self.direction);
        2.0 * (0.5 * chord).min(1.0).asin().to_degrees()
    }
}

/// No chain here. No trace and refractions look like this: a chain has at most 16 bounces.
const NONE: Key = u64::MAX;

/// A position of the image and the segment there.
pub(super) type Corner = (Vec2, Segment);

/// Where to search for roots on the chains of one key.
#[derive(Default)]
pub(super) struct Trees {
    /// Of cells, by their first pixel.
    pub cells: Tree,
    /// Of rim pixels.
    pub rims: Tree,
}

/// Segments after `order` bounces, over a whole image.
pub(super) struct Field {
    size: UVec2,
    keys: Vec<Key>,
    segments: Vec<Segment>,
    /// By pixel, whether the field goes on to the next one in x and in y.
    links: Vec<[bool; 2]>,
    /// By pixel, whether it is one of a chain and lacks a cell on some side.
    rims: Vec<bool>,
    trees: HashMap<Key, Trees>,
}

/// How far beyond its corners a cell's bounds reach: what lies between pixel centres may bend
/// outwards, and roots are accepted a little outside their cell.
const INFLATION: f32 = 1.6;

/// The last digits of directions are noise.
const DIRECTION_NOISE: f32 = 1e-5;

/// Between neighbours on a mirror nothing changes that much more than on to the next neighbours:
/// not even at a silhouette, where the change is as of a root, by at most a factor of 1 + sqrt 2.
const JUMP: f32 = 4.0;

/// The least that is known of what surrounds a rim pixel, radians.
const RIM_ANGLE: f32 = 1e-3;

/// How far beyond the differences to its neighbours the surroundings of a rim pixel reach where it
/// is traced: up to a pixel lies outside, where directions change ever faster.
const TRACED_INFLATION: f32 = 3.0;

const AXES: [UVec2; 2] = [UVec2::X, UVec2::Y];

impl Field {
    /// From the chain at every pixel of an image.
    pub fn new(size: [u32; 2], chains: &[Option<Chain>], order: u32) -> Self {
        let last = |chain: &Option<Chain>| last_of(chain.as_ref()?, order);
        let (keys, segments) =
            chains.iter().map(|chain| last(chain).unwrap_or((NONE, Segment::default()))).unzip();
        Field::of_segments(size.into(), keys, segments)
    }

    fn of_segments(size: UVec2, keys: Vec<Key>, segments: Vec<Segment>) -> Self {
        let (links, rims, trees) = Default::default();
        let mut field = Field { size, keys, segments, links, rims, trees };
        let pixels = || (0..size.y).flat_map(|y| (0..size.x).map(move |x| UVec2::new(x, y)));
        let links = pixels().map(|pixel| AXES.map(|axis| field.goes_on(pixel, axis)));
        field.links = links.collect();
        let rims = pixels().map(|pixel| field.key(pixel).is_some() && !field.is_inside(pixel));
        field.rims = rims.collect();
        let mut leaves: HashMap<Key, [Vec<Leaf>; 2]> = HashMap::default();
        for pixel in pixels() {
            let Some(key) = field.key(pixel) else { continue };
            let [cells, rims] = leaves.entry(key).or_default();
            cells.extend(field.cell_leaf(pixel));
            rims.extend(field.rim_leaf(pixel));
        }
        let trees = leaves.into_par_iter().map(|(key, leaves)| {
            let [cells, rims] = leaves.map(Tree::new);
            (key, Trees { cells, rims })
        });
        field.trees = trees.collect();
        field
    }

    /// Where the chains of that key are; `None` when there are none.
    pub fn trees(&self, key: Key) -> Option<&Trees> {
        self.trees.get(&key)
    }

    /// Whether from a pixel to the next along an axis the chain stays and its last mirror goes on:
    /// what is more of a step than to the pixels before and after is a jump.
    fn goes_on(&self, pixel: UVec2, axis: UVec2) -> bool {
        let next = pixel + axis;
        let Some(key) = self.key(pixel).filter(|&key| self.key(next) == Some(key)) else {
            return false;
        };
        let on_chain = |pixel: &UVec2| self.key(*pixel) == Some(key);
        let before = pixel.cmpge(axis).all().then(|| pixel - axis).filter(on_chain);
        let after = Some(next + axis).filter(on_chain);
        let beside = [before.map(|before| [before, pixel]), after.map(|after| [next, after])];
        let change = |[a, b]: [UVec2; 2]| {
            let [a, b] = [self.segment(a), self.segment(b)];
            [a.origin.distance(b.origin), a.direction.distance(b.direction)]
        };
        let largest = |a: [f32; 2], b: [f32; 2]| [a[0].max(b[0]), a[1].max(b[1])];
        let [metres, chord] = change([pixel, next]);
        // Without a third pixel there is nothing to go by.
        beside
            .into_iter()
            .flatten()
            .map(change)
            .reduce(largest)
            .is_none_or(|[m, c]| metres <= JUMP * m && chord <= JUMP * c + DIRECTION_NOISE)
    }

    /// A pixel's key, `None` where no chain is, also outside the image.
    fn key(&self, pixel: UVec2) -> Option<Key> {
        pixel
            .cmplt(self.size)
            .all()
            .then(|| self.keys[self.index(pixel)])
            .filter(|&key| key != NONE)
    }

    fn segment(&self, pixel: UVec2) -> Segment {
        self.segments[self.index(pixel)]
    }

    fn index(&self, pixel: UVec2) -> usize {
        (pixel.y * self.size.x + pixel.x) as usize
    }

    /// Whether the field is one between a pixel and its next ones in x, in y and in both.
    fn is_cell(&self, pixel: UVec2) -> bool {
        let linked = |pixel: UVec2, axis: usize| {
            pixel.cmplt(self.size).all() && self.links[self.index(pixel)][axis]
        };
        linked(pixel, 0)
            && linked(pixel, 1)
            && linked(pixel + UVec2::Y, 0)
            && linked(pixel + UVec2::X, 1)
    }

    /// The corners of a cell around its rim.
    pub fn corners(&self, cell: UVec2) -> [Corner; 4] {
        cell_pixels(cell).map(|pixel| (centre(pixel), self.segment(pixel)))
    }

    fn cell_leaf(&self, pixel: UVec2) -> Option<Leaf> {
        if !self.is_cell(pixel) {
            return None;
        }
        let corners = self.corners(pixel).into_iter().map(|(_, Segment { origin, direction })| {
            Bundle { centre: origin, radius: 0.0, axis: direction, angle: 0.0 }
        });
        let bounds = Bundle::around(corners);
        let bundle = Bundle {
            radius: INFLATION * bounds.radius,
            angle: INFLATION * bounds.angle + DIRECTION_NOISE,
            ..bounds
        };
        Some(Leaf { pixel, low: centre(pixel) - MARGIN, high: centre(pixel + 1) + MARGIN, bundle })
    }

    /// Whether there are cells on all sides of a pixel.
    fn is_inside(&self, pixel: UVec2) -> bool {
        let before = pixel.cmpgt(UVec2::ZERO).all().then(|| pixel - 1);
        before.is_some_and(|UVec2 { x, y }| {
            let cells = [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[dx, dy]| UVec2::new(x + dx, y + dy));
            cells.into_iter().all(|cell| self.is_cell(cell))
        })
    }

    fn is_rim(&self, pixel: UVec2) -> bool {
        self.rims[self.index(pixel)]
    }

    /// Bounds of where [`super::root::at_rim`] finds something.
    fn rim_leaf(&self, pixel: UVec2) -> Option<Leaf> {
        let corners = self.is_rim(pixel).then(|| self.with_neighbours(pixel))??;
        let [here, beside, above] = corners.map(|(_, segment)| segment);
        let reach = |of: fn(&Segment, &Segment) -> f32| {
            RIM_PX * of(&here, &beside).hypot(of(&here, &above))
        };
        let bundle = Bundle {
            centre: here.origin,
            radius: reach(|a, b| a.origin.distance(b.origin)),
            axis: here.direction,
            angle: reach(|a, b| angle(a.direction, b.direction)) + RIM_ANGLE,
        };
        Some(Leaf { pixel, low: centre(pixel) - RIM_PX, high: centre(pixel) + RIM_PX, bundle })
    }

    /// A rim pixel with a neighbour beside and one above or below it.
    pub fn with_neighbours(&self, pixel: UVec2) -> Option<[Corner; 3]> {
        let neighbour = |axis: usize| {
            if self.links[self.index(pixel)][axis] {
                return Some(pixel + AXES[axis]);
            }
            let before = pixel.checked_sub(AXES[axis])?;
            self.links[self.index(before)][axis].then_some(before)
        };
        let pixels = [pixel, neighbour(0)?, neighbour(1)?];
        Some(pixels.map(|pixel| (centre(pixel), self.segment(pixel))))
    }

    /// Whether around a rim pixel a path may end at the target, going by its neighbours, by those
    /// across a jump only where there are no others.
    pub fn surroundings_may_reach(&self, pixel: UVec2, target: Target) -> bool {
        let here = self.segment(pixel);
        let neighbours = match self.with_neighbours(pixel) {
            Some([_, (_, beside), (_, above)]) => vec![beside, above],
            None => self.all_neighbours(pixel).collect(),
        };
        let (mut radius, mut spread) = (0.0, RIM_ANGLE);
        for neighbour in neighbours {
            radius += neighbour.origin.distance(here.origin);
            spread += angle(neighbour.direction, here.direction);
        }
        let bundle = Bundle {
            centre: here.origin,
            radius: TRACED_INFLATION * radius,
            axis: here.direction,
            angle: TRACED_INFLATION * spread,
        };
        bundle.may_reach(target)
    }

    /// The segments around a pixel of the same key.
    fn all_neighbours(&self, pixel: UVec2) -> impl Iterator<Item = Segment> {
        let low = pixel.saturating_sub(UVec2::ONE);
        let rows = low.y..=pixel.y + 1;
        let around = rows.flat_map(move |y| (low.x..=pixel.x + 1).map(move |x| UVec2::new(x, y)));
        around
            .filter(move |&neighbour| self.key(neighbour) == self.key(pixel))
            .map(|neighbour| self.segment(neighbour))
    }

    /// The rim pixels of a key within `reach` pixels of another pixel's centre.
    pub fn rims_around(&self, pixel: UVec2, key: Key, reach: f32) -> impl Iterator<Item = UVec2> {
        let low = pixel.saturating_sub(UVec2::splat(reach as u32));
        let high = (pixel + reach as u32 + 1).min(self.size);
        let pixels =
            (low.y..high.y).flat_map(move |y| (low.x..high.x).map(move |x| UVec2::new(x, y)));
        pixels.filter(move |&near| {
            let distance = near.as_vec2().distance(pixel.as_vec2());
            self.key(near) == Some(key) && distance <= reach && self.is_rim(near)
        })
    }
}

/// The pixels at the corners of a cell, around its rim.
fn cell_pixels(UVec2 { x, y }: UVec2) -> [UVec2; 4] {
    [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[dx, dy]| UVec2::new(x + dx, y + dy))
}

fn last_of(chain: &Chain, order: u32) -> Option<(Key, Segment)> {
    let bounce = chain.bounces.get(order as usize - 1)?;
    Some((Mirrors::first(chain, order).key, Segment::after(bounce)))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: UVec2 = UVec2::new(24, 16);

    fn pixels() -> impl Iterator<Item = UVec2> {
        (0..SIZE.y).flat_map(|y| (0..SIZE.x).map(move |x| UVec2::new(x, y)))
    }

    /// A slightly curved mirror of key 1 seen over the whole image, changed by `change`.
    fn field(change: impl Fn(UVec2, &mut Key, &mut Segment)) -> Field {
        let one = |pixel: UVec2| {
            let Vec2 { x, y } = 0.01 * pixel.as_vec2();
            let origin = Vec3::new(x, y, x * x + y * y);
            let direction = Vec3::new(x, y, 1.0).normalize();
            let (mut key, mut segment) = (1, Segment { origin, direction });
            change(pixel, &mut key, &mut segment);
            (key, segment)
        };
        let (keys, segments) = pixels().map(one).unzip();
        Field::of_segments(SIZE, keys, segments)
    }

    fn rims(field: &Field) -> Vec<UVec2> {
        pixels().filter(|&pixel| field.is_rim(pixel)).collect()
    }

    fn at_border(pixel: UVec2) -> bool {
        pixel.cmpeq(UVec2::ZERO).any() || (pixel + 1).cmpeq(SIZE).any()
    }

    #[test]
    fn a_smooth_mirror_has_its_rim_at_the_pictures_border() {
        let field = field(|_, _, _| {});
        assert!(rims(&field).into_iter().eq(pixels().filter(|&pixel| at_border(pixel))));
        let trees = field.trees(1).unwrap();
        assert_eq!(trees.cells.pixels().len() as u32, (SIZE.x - 1) * (SIZE.y - 1));
        assert!(field.trees(2).is_none());
    }

    #[test]
    fn other_chains_and_jumps_of_origin_or_direction_end_a_field() {
        let right = |pixel: UVec2| pixel.x >= 10;
        let split = [
            field(|pixel, key, _| *key += Key::from(right(pixel))),
            field(|pixel, key, _| *key = if right(pixel) { NONE } else { *key }),
            field(|pixel, _, segment| segment.origin.z += f32::from(u8::from(right(pixel)))),
            field(|pixel, _, segment| {
                if right(pixel) {
                    segment.direction = (segment.direction + Vec3::Y).normalize();
                }
            }),
        ];
        for (case, field) in split.iter().enumerate() {
            let cells = field.trees(1).unwrap().cells.pixels();
            assert!(cells.iter().all(|cell| cell.x != 9), "case {case}");
            assert!(cells.contains(&UVec2::new(8, 5)), "case {case}");
            assert_eq!(cells.contains(&UVec2::new(10, 5)), case >= 2);
            assert!(field.is_rim(UVec2::new(9, 5)) && !field.is_rim(UVec2::new(8, 5)));
            for pixel in rims(field) {
                let Some(corners) = field.with_neighbours(pixel) else { continue };
                let side = corners.map(|(position, _)| position.x > 10.0);
                assert!(side == [right(pixel); 3], "case {case}: {pixel} looks across");
            }
        }
    }

    #[test]
    fn every_rays_own_target_is_reached_in_its_surroundings() {
        let field = field(|pixel, key, segment| {
            *key += Key::from(pixel.y > 7);
            segment.origin.z += f32::from(u8::from(pixel.x > 15));
        });
        for pixel in pixels().filter(|&pixel| field.is_rim(pixel)) {
            let Segment { origin, direction } = field.segment(pixel);
            for target in [Target::Point(origin + 3.0 * direction), Target::Direction(direction)] {
                assert!(field.surroundings_may_reach(pixel, target));
                assert!(!field.surroundings_may_reach(pixel, Target::Direction(-direction)));
            }
        }
        let near: Vec<UVec2> = field.rims_around(UVec2::new(15, 7), 1, 2.0).collect();
        assert!(near.contains(&UVec2::new(15, 7)) && near.contains(&UVec2::new(13, 7)));
        assert!(near.iter().all(|pixel| pixel.y <= 7 && field.is_rim(*pixel)));
    }
}
