//! `displacement_px`: how far from where it belongs a point is drawn.
//!
//! The distance from a pixel's centre to the nearest position of the image, on the same reflector
//! and chain of mirrors, whose mirrored path ends at the point. All such positions are roots of one
//! equation on the truth's dense image of mirrored rays; the search visits its pyramid in order of
//! distance, so the first root that nothing nearer can beat is the one.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::{UVec2, Vec2};

use super::field::{Cell, Corner, Field, Key, Segment, Target};
use super::root::{Guess, at_rim, centre, on_triangle, polish, traced_guess};
use crate::geometry::optics::reflect;
use crate::truth::{Chain, Tracer};

/// Beyond this a point counts as unreachable: drawn where it belongs nowhere near.
pub(super) const REACH_PX: f32 = 256.0;

/// Roots nearer than this to one already found are that one.
const SAME_ROOT_PX: f32 = 0.5;

/// Nearer than this, in diagonals of a cell, a target is not interpolated towards.
const CLOSE_DIAGONALS: f32 = 4.0;

/// Up to this far away, the surroundings of pixels at the rim of a chain are traced if need be.
const TRACED_RIM_PX: f32 = 4.0;

/// What is asked of one pixel.
pub(super) struct Query<'a> {
    pub tracer: &'a Tracer<'a>,
    pub size: [u32; 2],
    /// Of the order of `chain`.
    pub field: &'a Field,
    pub pixel: UVec2,
    /// The truth's chain at the pixel, and its key.
    pub chain: &'a Chain,
    pub key: Key,
    pub target: Target,
}

/// Cells to visit, nearest first; non-negative distances sort like their bits.
pub(super) type Queue = BinaryHeap<Reverse<(u32, Cell)>>;

impl Query<'_> {
    /// Pixels from the pixel's centre to the nearest root; `None` when none is within
    /// [`REACH_PX`]. `queue` is scratch space.
    pub fn displacement(&self, queue: &mut Queue) -> Option<f32> {
        let centre = centre(self.pixel);
        let mut best = None;
        queue.clear();
        self.enqueue(queue, self.field.root());
        while let Some(Reverse((bits, cell))) = queue.pop() {
            let nearest = best.map_or(REACH_PX, |root: Vec2| root.distance(centre));
            if f32::from_bits(bits) > nearest {
                break;
            }
            if cell.level > 0 {
                for below in self.field.below(cell) {
                    self.enqueue(queue, below);
                }
                continue;
            }
            for guess in self.guesses(cell).into_iter().flatten() {
                let known = best.is_some_and(|root| {
                    let distance = guess.at.distance(centre);
                    root.distance(guess.at) < SAME_ROOT_PX || distance > root.distance(centre)
                });
                if known {
                    continue;
                }
                let root = polish(guess, |position| self.trace(position));
                best = [best, root].into_iter().flatten().min_by(|a, b| {
                    a.distance_squared(centre).total_cmp(&b.distance_squared(centre))
                });
            }
        }
        best.map(|root| root.distance(centre)).filter(|&distance| distance <= REACH_PX)
    }

    fn enqueue(&self, queue: &mut Queue, cell: Cell) {
        let distance = self.field.distance(cell, centre(self.pixel));
        if distance <= REACH_PX && self.field.may_reach(cell, self.key, self.target) {
            queue.push(Reverse((distance.to_bits(), cell)));
        }
    }

    /// Where roots may be in a cell: on the two triangles of its corners, or around each of them
    /// where the chain's pixels end. With the target so close that it is seen in all directions
    /// there is no sense in interpolating, and the surroundings are traced.
    fn guesses(&self, cell: Cell) -> [Option<Guess>; 4] {
        let corners = self.field.corners(cell, self.key);
        match corners {
            [Some(a), Some(b), Some(c), Some(d)] if self.is_close([a, b, c, d]) => {
                let middle = 0.5 * (centre(a.0) + centre(c.0));
                [self.traced_guess(middle), None, None, None]
            }
            [Some(a), Some(b), Some(c), Some(d)] => {
                let linear = |corners| on_triangle(self.target, corners);
                [linear([a, b, c]), linear([a, c, d]), None, None]
            }
            rim => rim.map(|corner| self.rim_guess(corner?.0)),
        }
    }

    /// A guess at a pixel where its chain ends: from its neighbours, or by tracing where they do
    /// not help and the pixel is near enough for a root there to matter.
    fn rim_guess(&self, pixel: UVec2) -> Option<Guess> {
        if !self.field.rim_may_reach(pixel, self.target) {
            return None;
        }
        let near = centre(pixel).distance(centre(self.pixel)) <= TRACED_RIM_PX;
        let neighbours = self.field.with_neighbours(pixel);
        neighbours
            .and_then(|corners| at_rim(self.target, corners))
            .or_else(|| near.then(|| self.traced_guess(centre(pixel)))?)
    }

    fn traced_guess(&self, at: Vec2) -> Option<Guess> {
        traced_guess(self.target, at, |position| self.trace(position))
    }

    /// Whether the target is within a few diagonals of a cell's mirrors.
    fn is_close(&self, [a, b, c, d]: [Corner; 4]) -> bool {
        let diagonal = a.1.origin.distance(c.1.origin).max(b.1.origin.distance(d.1.origin));
        let Target::Point(point) = self.target else { return false };
        point.distance(a.1.origin) < CLOSE_DIAGONALS * diagonal
    }

    /// The last segment of the path through a position, as long as it meets the chain's mirrors.
    /// What lies behind the last of them does not matter.
    fn trace(&self, position: Vec2) -> Option<Segment> {
        let ray = self.tracer.moment().camera.ray(self.size, position);
        let mut hit = self.tracer.look(&ray)?;
        let mut mirrored = ray.direction;
        for (index, bounce) in self.chain.bounces.iter().enumerate() {
            if index > 0 {
                hit = self.tracer.leave(&hit, mirrored)?;
            }
            if hit.object != bounce.hit.object {
                return None;
            }
            mirrored = reflect(mirrored, hit.normal);
        }
        Some(Segment { origin: hit.point, direction: mirrored })
    }
}
