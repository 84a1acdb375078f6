//! `displacement_px`: how far from where it belongs a point is drawn.
//!
//! The distance from a pixel's centre to the nearest position of the image, on the same reflector
//! and chain of mirrors, whose mirrored path ends at the point. All such positions are roots of one
//! equation on the truth's dense image of mirrored rays; the search visits the trees over it in order
//! of distance, so the first root that nothing nearer can beat is the one.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::{UVec2, Vec2, Vec3};

use super::field::{Field, Segment, Target, Trees};
use super::mirrors::Mirrors;
use super::root::{CONFIRMED_PX, Guess, at_rim, centre, on_triangle, polish, traced_guess};
use super::tree::{Place, Tree};
use crate::truth::{Bounce, Tracer};

/// Beyond this a point counts as unreachable: drawn where it belongs nowhere near.
pub(super) const REACH_PX: f32 = 256.0;

/// Roots nearer than this to one already found are that one.
const SAME_ROOT_PX: f32 = 0.5;

/// Nearer than this, in diagonals of a cell, a target is not interpolated towards.
const CLOSE_DIAGONALS: f32 = 4.0;

/// Up to this far away, the surroundings of pixels at the rim of a chain are traced if need be.
const TRACED_RIM_PX: f32 = 4.0;

/// A target seen within this of a segment's direction is on it: single precision gives no better.
/// Where parallel rays meet a flat mirror every pixel shows the same point of the sky, and a search
/// for the one it belongs to would find none.
const ROUNDING_DEG: f32 = 1e-4;

/// The slope of a guess is taken from rays that far beside it.
const SLOPE_STEP_PX: f32 = 0.25;

/// The same around a pixel's own centre, wherever the chain is wide enough.
const OWN_STEPS_PX: [f32; 3] = [0.05, 0.01, 0.002];

/// What is asked of one pixel, or of one position.
pub(super) struct Query<'a> {
    pub tracer: &'a Tracer<'a>,
    pub size: [u32; 2],
    /// Of the order of `mirrors`.
    pub field: &'a Field,
    /// The position the root is to be near, pixels, within the image.
    pub near: Vec2,
    /// How far from there it may be.
    pub reach_px: f32,
    pub mirrors: Mirrors<'a>,
    pub target: Target,
}

/// Nodes to visit, nearest first; non-negative distances sort like their bits.
pub(super) type Queue = BinaryHeap<Reverse<(u32, Kind, Place)>>;

/// Which of a chain's trees a node is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Kind {
    Cells,
    Rims,
}

impl Query<'_> {
    /// The nearest root; `None` when none is within reach. `queue` is scratch space.
    pub fn root(&self, queue: &mut Queue) -> Option<Vec2> {
        let trees = self.field.trees(self.mirrors.key)?;
        let mut best = self.nothing_yet();
        queue.clear();
        for kind in [Kind::Cells, Kind::Rims] {
            self.enqueue(queue, &best, trees, kind, kind.of(trees).root());
        }
        while let Some(Reverse((bits, kind, place))) = queue.pop() {
            if f32::from_bits(bits) > best.squared {
                break;
            }
            let tree = kind.of(trees);
            if place.level > 0 {
                self.enqueue(queue, &best, trees, kind, tree.below(place));
            } else {
                match kind {
                    Kind::Cells => self.visit_cell(tree.pixel(place), &mut best),
                    Kind::Rims => self.visit_rim(tree.pixel(place), &mut best),
                }
            }
        }
        self.trace_rims(&mut best);
        best.root
    }

    fn nothing_yet(&self) -> Best {
        Best { of: self.near, root: None, squared: self.reach_px * self.reach_px }
    }

    /// The root next to the position asked of, if there is one: the search may miss it, as a chain
    /// seen through several mirrors or past an edge may be a hundredth of a pixel wide, and of two
    /// roots on either side of a fold it may find the other.
    pub fn root_beside(&self) -> Option<Vec2> {
        if self.trace(self.near)?.angle_deg(self.target) <= ROUNDING_DEG {
            return Some(self.near);
        }
        let step = |width_px: f32| {
            traced_guess(self.target, self.near, width_px, |position| self.trace(position))?.step()
        };
        let steps = OWN_STEPS_PX.map(step);
        let is_near = |step: &Vec2| step.length() < CONFIRMED_PX;
        // The widest slope is the most precise, but across an edge it makes anything seem near.
        steps.into_iter().flatten().last().filter(is_near)?;
        steps.into_iter().flatten().find(is_near).map(|step| self.near + step)
    }

    fn enqueue(
        &self,
        queue: &mut Queue,
        best: &Best,
        trees: &Trees,
        kind: Kind,
        places: impl IntoIterator<Item = Place>,
    ) {
        let tree = kind.of(trees);
        for place in places {
            let distance = tree.distance_squared(place, best.of);
            if distance <= best.squared && tree.may_reach(place, self.target) {
                queue.push(Reverse((distance.to_bits(), kind, place)));
            }
        }
    }

    /// Roots on the two triangles of a cell's corners. With the target so close that it is seen in
    /// all directions there is no sense in interpolating, and the cell's middle is traced.
    fn visit_cell(&self, cell: UVec2, best: &mut Best) {
        let corners = self.field.corners(cell);
        if self.is_close(corners.map(|(_, segment)| segment.origin)) {
            let middle = 0.5 * (corners[0].0 + corners[2].0);
            if best.may_improve(middle) {
                self.polish(self.traced_guess(middle), best);
            }
            return;
        }
        let [a, b, c, d] = corners;
        for triangle in [[a, b, c], [a, c, d]] {
            self.polish(on_triangle(self.target, triangle), best);
        }
    }

    fn visit_rim(&self, pixel: UVec2, best: &mut Best) {
        let corners = self.field.with_neighbours(pixel);
        self.polish(corners.and_then(|corners| at_rim(self.target, corners)), best);
    }

    /// Roots around the rim pixels where their neighbours do not help, as far as the pixels are
    /// near enough for a root there to matter.
    fn trace_rims(&self, best: &mut Best) {
        for rim in self.field.rims_around(self.near.as_uvec2(), self.mirrors.key, TRACED_RIM_PX) {
            let missed = || {
                let corners = self.field.with_neighbours(rim);
                corners.and_then(|corners| at_rim(self.target, corners)).is_none()
            };
            if centre(rim).distance_squared(best.of) <= best.squared
                && self.field.surroundings_may_reach(rim, self.target)
                && missed()
            {
                self.polish(self.traced_guess(centre(rim)), best);
            }
        }
    }

    fn polish(&self, guess: Option<Guess>, best: &mut Best) {
        let promising = |guess: &Guess| [guess.at, guess.expected].map(|at| best.may_improve(at));
        let Some(guess) = guess.filter(|guess| promising(guess).contains(&true)) else { return };
        if let Some(root) = polish(guess, |position| self.trace(position)) {
            best.offer(root);
        }
    }

    fn traced_guess(&self, at: Vec2) -> Option<Guess> {
        traced_guess(self.target, at, SLOPE_STEP_PX, |position| self.trace(position))
    }

    /// Whether the target is within a few diagonals of a cell's mirrors.
    fn is_close(&self, [a, b, c, d]: [Vec3; 4]) -> bool {
        let diagonal = a.distance(c).max(b.distance(d));
        let Target::Point(point) = self.target else { return false };
        point.distance(a) < CLOSE_DIAGONALS * diagonal
    }

    /// The last segment of the path through a position, as long as it meets the mirrors.
    /// What lies behind the last of them does not matter.
    fn trace(&self, position: Vec2) -> Option<Segment> {
        let ray = self.tracer.moment().camera.ray(self.size, position);
        let mut hit = self.tracer.look(&ray)?;
        let mut incident = ray.direction;
        let mut last = Segment::default();
        for (index, bounce) in self.mirrors.bounces.iter().enumerate() {
            if hit.object != bounce.hit.object {
                return None;
            }
            let lobe = bounce.lobe;
            let outgoing = self.tracer.depart(&hit, incident, lobe)?.direction;
            let left = Bounce { hit, lobe, outgoing };
            last = Segment::after(&left);
            if index + 1 < self.mirrors.bounces.len() {
                hit = self.tracer.leave(&left)?;
                incident = outgoing;
            }
        }
        Some(last)
    }
}

/// The nearest root so far.
struct Best {
    /// Nearest to this position.
    of: Vec2,
    root: Option<Vec2>,
    /// Squared distance in pixels beyond which nothing is of interest.
    squared: f32,
}

impl Best {
    /// Whether a guess may lead to a nearer root.
    fn may_improve(&self, guess: Vec2) -> bool {
        self.root.is_none_or(|root| {
            root.distance(guess) >= SAME_ROOT_PX && guess.distance_squared(self.of) <= self.squared
        })
    }

    fn offer(&mut self, root: Vec2) {
        let squared = root.distance_squared(self.of);
        if squared <= self.squared {
            (self.root, self.squared) = (Some(root), squared);
        }
    }
}

impl Kind {
    fn of(self, trees: &Trees) -> &Tree {
        match self {
            Kind::Cells => &trees.cells,
            Kind::Rims => &trees.rims,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::judge::chains;
    use crate::scene::{self, Lobe, Status};
    use crate::truth::{Chain, TruthOptions};

    impl Query<'_> {
        /// The same by looking at every cell and rim pixel, in no order.
        fn exhaustive(&self) -> Option<f32> {
            let trees = self.field.trees(self.mirrors.key)?;
            let cells = trees.cells.pixels().iter();
            let cells = cells.filter_map(|&cell| self.alone(|best| self.visit_cell(cell, best)));
            let rims = trees.rims.pixels().iter();
            let rims = rims.filter_map(|&pixel| self.alone(|best| self.visit_rim(pixel, best)));
            let traced = self.alone(|best| self.trace_rims(best));
            cells.chain(rims).chain(traced).reduce(f32::min)
        }

        /// The same by following the miss from every pixel of the chain, whatever it is there.
        fn tried_everywhere(&self) -> Option<f32> {
            let Trees { cells, rims } = self.field.trees(self.mirrors.key)?;
            let pixels = cells.pixels().iter().chain(rims.pixels());
            let from = |&pixel: &UVec2| {
                self.alone(|best| self.polish(self.traced_guess(centre(pixel)), best))
            };
            pixels.filter_map(from).reduce(f32::min)
        }

        /// The root that one visit finds.
        fn alone(&self, visit: impl Fn(&mut Best)) -> Option<f32> {
            let mut best = self.nothing_yet();
            visit(&mut best);
            best.root.map(|root| root.distance(self.near))
        }
    }

    /// Asks at every `stride`-th pixel of a scene's mirrors for what pixels nearby show, or for
    /// what lies beside it.
    fn ask(scene: &str, frame: u32, size: [u32; 2], stride: usize, mut answer: impl FnMut(Query)) {
        let scene = scene::load(scene).unwrap();
        let tracer = Tracer::new(&scene, &scene.at(frame), TruthOptions::default());
        let chains = chains(&tracer, size, Lobe::Reflected);
        let longest = chains.iter().flatten().map(Chain::order).max().unwrap();
        let fields: Vec<Field> = (1..=longest).map(|n| Field::new(size, &chains, n)).collect();
        let mirrors: Vec<usize> = (0..chains.len()).filter(|&i| chains[i].is_some()).collect();
        for (k, &pixel) in mirrors.iter().enumerate().step_by(stride) {
            let chain = chains[pixel].as_ref().unwrap();
            let shown = chains[mirrors[(k + 5) % mirrors.len()]].as_ref().unwrap();
            let beside = 0.02 * (k % 4) as f32 * Vec3::new(1.0, -0.5, 0.3);
            let point = match shown.ids().status() {
                Status::Found => (shown.point().truncate() + beside).extend(1.0),
                _ => shown.point(),
            };
            answer(Query {
                tracer: &tracer,
                size,
                field: &fields[chain.order() as usize - 1],
                near: centre(UVec2::new(pixel as u32 % size[0], pixel as u32 / size[0])),
                reach_px: REACH_PX,
                mirrors: Mirrors::of(chain),
                target: Target::new(point),
            });
        }
    }

    /// Of the search and another: roots both find, pixels where neither does, and those where they
    /// differ.
    fn compare(
        [scene, frame]: [&str; 2],
        size: [u32; 2],
        stride: usize,
        other: impl Fn(&Query) -> Option<f32>,
    ) -> [usize; 3] {
        let found =
            |query: &Query| query.root(&mut Queue::new()).map(|root| root.distance(query.near));
        let mut counts = [0; 3];
        ask(scene, frame.parse().unwrap(), size, stride, |query| {
            let kind = match (found(&query), other(&query)) {
                (Some(found), Some(expected)) if (found - expected).abs() < 0.05 => 0,
                (None, None) => 1,
                _ => 2,
            };
            counts[kind] += 1;
        });
        counts
    }

    /// Spheres, a mirror that hides parts of itself, and a bowl seen from near by.
    const SCENES: [[&str; 2]; 3] = [["two-spheres", "0"], ["teapot", "0"], ["kitchen", "191"]];

    #[test]
    fn culling_and_order_change_nothing() {
        for scene in SCENES {
            let [roots, none, unlike] = compare(scene, [96, 54], 3, |query| query.exhaustive());
            assert!(roots > 80 && none > 10, "{scene:?}: {roots} roots, {none} without");
            assert_eq!(unlike, 0, "{scene:?}");
        }
    }

    #[test]
    fn little_more_is_found_by_trying_everywhere() {
        // Where neighbouring pixels see unlike parts of a mirror, roots hide in between.
        for (scene, hidden) in SCENES.into_iter().zip([0.0, 0.1, 0.1]) {
            let [roots, none, unlike] =
                compare(scene, [192, 108], 31, |query| query.tried_everywhere());
            assert!(unlike as f32 <= hidden * (roots + none) as f32, "{scene:?}: {unlike} unlike");
        }
    }
}
