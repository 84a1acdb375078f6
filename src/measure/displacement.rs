//! `displacement_px`: how far from where it belongs a point is drawn.
//!
//! The distance from a pixel's centre to the nearest position of the image, on the same reflector
//! and chain of mirrors, whose mirrored path ends at the point. All such positions are roots of one
//! equation on the truth's dense image of mirrored rays; the search visits its pyramid in order of
//! distance, so the first root that nothing nearer can beat is the one.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::{UVec2, Vec2};

use super::field::{Cell, Field, Key, Segment, Target};
use super::root::{Guess, on_triangle, polish, traced_guess};
use crate::geometry::optics::reflect;
use crate::truth::{Chain, Tracer};

/// Beyond this a point counts as unreachable: drawn where it belongs nowhere near.
pub(super) const REACH_PX: f32 = 256.0;

/// Roots nearer than this to one already found are that one.
const SAME_ROOT_PX: f32 = 0.5;

/// A pixel's own neighbourhood, where the dense image has gaps, pixels.
const NEIGHBOURHOOD_PX: f32 = 2.0;

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
        let centre = self.centre();
        let mut best = self.root_nearby();
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
            for guess in self.guesses(cell) {
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

    fn centre(&self) -> Vec2 {
        self.pixel.as_vec2() + 0.5
    }

    fn enqueue(&self, queue: &mut Queue, cell: Cell) {
        let distance = self.field.distance(cell, self.centre());
        if distance <= REACH_PX && self.field.may_reach(cell, self.key, self.target) {
            queue.push(Reverse((distance.to_bits(), cell)));
        }
    }

    /// At the rim of a reflector the pixel's neighbours are not all there to interpolate; its
    /// surroundings are traced instead.
    fn root_nearby(&self) -> Option<Vec2> {
        if self.field.is_interior(self.pixel, self.key) {
            return None;
        }
        let trace = |position| self.trace(position);
        let guess = traced_guess(self.target, self.centre(), trace)?;
        polish(guess, trace).filter(|root| root.distance(self.centre()) < NEIGHBOURHOOD_PX)
    }

    /// Roots on the two triangles of a cell, or on the one that three corners make.
    fn guesses(&self, cell: Cell) -> impl Iterator<Item = Guess> {
        let [a, b, c, d] = self.field.corners(cell.x, cell.y, self.key);
        let triangles = match (a, b, c, d) {
            (Some(a), Some(b), Some(c), Some(d)) => [Some([a, b, c]), Some([a, c, d])],
            (Some(a), Some(b), Some(c), None) => [Some([a, b, c]), None],
            (Some(a), Some(b), None, Some(d)) => [Some([a, b, d]), None],
            (Some(a), None, Some(c), Some(d)) => [Some([a, c, d]), None],
            (None, Some(b), Some(c), Some(d)) => [Some([b, c, d]), None],
            _ => [None, None],
        };
        let target = self.target;
        triangles.into_iter().flatten().filter_map(move |corners| on_triangle(target, corners))
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
