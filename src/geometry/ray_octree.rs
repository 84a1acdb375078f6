//! An octree of ray segments, to find the one that passes nearest to a point without looking at all
//! (Martin & Popescu 2004, section 4.2).
//!
//! "The octree is subdivided if the new ray conflicts with an existing ray. Two rays conflict when they
//! have the same trace." That makes sense where a second ray of an equal trace is what a leaf has no room
//! for: rays of different traces each give another projection of a point, and stay side by side. At the
//! greatest depth leaves are not split, and their lists grow.

mod build;
mod near;

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

/// A ray between two surfaces. WGSL `RaySegment` of `shaders/reflection_morphing/octree.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct RaySegment {
    /// Where it leaves its last reflector, world.
    pub start: Vec3,
    /// The reflectors met up to there, packed as in [`crate::scene::Ids`].
    pub trace: u32,
    /// Where it ends, world.
    pub end: Vec3,
    /// Where it belongs in the map it comes from.
    pub texel: u32,
}

impl RaySegment {
    /// The square of a point's distance from the nearest point of the segment.
    pub fn distance_squared(&self, point: Vec3) -> f32 {
        let along = self.end - self.start;
        let from = point - self.start;
        // A segment without length has no direction; then its start is nearest.
        let t = from.dot(along) / along.length_squared().max(f32::MIN_POSITIVE);
        (from - t.clamp(0.0, 1.0) * along).length_squared()
    }
}

/// The box an octree covers; both sides of it are within.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Extent {
    pub low: Vec3,
    pub high: Vec3,
}

impl Extent {
    pub fn contains(&self, point: Vec3) -> bool {
        point.cmpge(self.low).all() && point.cmple(self.high).all()
    }

    fn middle(&self) -> Vec3 {
        0.5 * (self.low + self.high)
    }

    /// One of the eight parts it is split into: bits 0 to 2 choose the upper half along x, y and z.
    fn child(&self, which: u32) -> Extent {
        let middle = self.middle();
        let upper = glam::BVec3::new(which & 1 != 0, which & 2 != 0, which & 4 != 0);
        Extent {
            low: Vec3::select(upper, middle, self.low),
            high: Vec3::select(upper, self.high, middle),
        }
    }

    /// The part that a point is in.
    fn which(&self, point: Vec3) -> u32 {
        point.cmpge(self.middle()).bitmask()
    }

    /// What part of `start + t * way` is within, of `t` from 0 to `end`; `None` where nothing is. `start` is
    /// not in the plane of a side.
    pub fn clip(&self, start: Vec3, way: Vec3, end: f32) -> Option<[f32; 2]> {
        let inverse = way.recip();
        let (a, b) = ((self.low - start) * inverse, (self.high - start) * inverse);
        let enters = a.min(b).max_element().max(0.0);
        let leaves = a.max(b).min_element().min(end);
        (enters <= leaves).then_some([enters, leaves])
    }
}

/// Set in a cell that is a leaf; the other bits are its number.
pub const LEAF: u32 = 1 << 31;

/// The deepest an octree goes.
pub const MAX_DEPTH: u32 = 10;

/// An octree in four arrays, as it lies in files and on the device.
#[derive(Clone, Debug, PartialEq)]
pub struct RayOctree {
    pub extent: Extent,
    /// The root first: the place of the first of eight children, or [`LEAF`] and a leaf's number.
    pub cells: Vec<u32>,
    /// Where each leaf's rays begin in `lists`, and where the last one's end.
    pub starts: Vec<u32>,
    /// Places in `segments`, those of equal trace together, in rising order.
    pub lists: Vec<u32>,
    pub segments: Vec<RaySegment>,
}

/// How full leaves are.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LeafLoad {
    pub leaves: usize,
    /// Leaves that hold any ray.
    pub filled: usize,
    /// Mean over those.
    pub mean: f64,
    pub most: usize,
}

impl RayOctree {
    /// Insert every segment; `depth` is how often a cell may be split, at most [`MAX_DEPTH`].
    pub fn new(extent: Extent, segments: Vec<RaySegment>, depth: u32) -> RayOctree {
        build::linear(extent, segments, depth.min(MAX_DEPTH))
    }

    /// What it takes on disk and on the device.
    pub fn bytes(&self) -> u64 {
        let words = self.cells.len() + self.starts.len() + self.lists.len();
        (4 * words + size_of::<RaySegment>() * self.segments.len()) as u64
    }

    pub fn load(&self) -> LeafLoad {
        let lists = self.starts.windows(2).map(|ends| (ends[1] - ends[0]) as usize);
        let filled = lists.clone().filter(|&length| length > 0).count();
        LeafLoad {
            leaves: self.starts.len() - 1,
            filled,
            mean: self.lists.len() as f64 / filled.max(1) as f64,
            most: lists.max().unwrap_or(0),
        }
    }

    /// The segments of the leaf a point is in; none outside.
    pub fn leaf(&self, point: Vec3) -> &[u32] {
        if !self.extent.contains(point) {
            return &[];
        }
        let mut extent = self.extent;
        let mut cell = self.cells[0];
        while cell & LEAF == 0 {
            let which = extent.which(point);
            extent = extent.child(which);
            cell = self.cells[(cell + which) as usize];
        }
        self.list(cell & !LEAF)
    }

    /// The segments of a leaf by its number.
    fn list(&self, leaf: u32) -> &[u32] {
        let leaf = leaf as usize;
        &self.lists[self.starts[leaf] as usize..self.starts[leaf + 1] as usize]
    }

    /// The segment of a trace nearest to a point, of those in the point's own leaf.
    pub fn nearest(&self, point: Vec3, trace: u32) -> Option<u32> {
        self.nearest_of(self.leaf(point).iter().copied(), point, trace)
    }

    /// The segment of a trace nearest to a point, of all: section 1.2's "traverse the list of rays
    /// sequentially, compute the distance from every ray to the given point".
    pub fn nearest_of_all(&self, point: Vec3, trace: u32) -> Option<u32> {
        self.nearest_of(0..self.segments.len() as u32, point, trace)
    }

    fn nearest_of(
        &self,
        segments: impl Iterator<Item = u32>,
        point: Vec3,
        trace: u32,
    ) -> Option<u32> {
        let distance = |&place: &u32| self.segments[place as usize].distance_squared(point);
        segments
            .filter(|&place| self.segments[place as usize].trace == trace)
            .min_by(|a, b| distance(a).total_cmp(&distance(b)))
    }

    /// Whether the arrays are an octree: every walk ends, every list and segment exists.
    pub fn is_sound(&self) -> bool {
        let leaves = self.starts.len().saturating_sub(1);
        let cell = |(place, &cell): (usize, &u32)| match cell & LEAF {
            0 => cell as usize > place && (cell as usize).saturating_add(8) <= self.cells.len(),
            _ => ((cell & !LEAF) as usize) < leaves,
        };
        !self.cells.is_empty()
            && self.cells.iter().enumerate().all(cell)
            && self.starts.first() == Some(&0)
            && self.starts.is_sorted()
            && self.starts.last().is_some_and(|&end| end as usize == self.lists.len())
            && self.lists.iter().all(|&place| (place as usize) < self.segments.len())
    }
}
