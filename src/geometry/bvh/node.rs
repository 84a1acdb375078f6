//! Eight boxes at once.

use std::ops::Range;

use glam::Vec4;

use super::splat::SplatRay;

/// Children a node has at most.
pub(super) const WIDTH: usize = 8;

/// Packs a leaf has at most.
pub(super) const LEAF_PACKS: usize = 2;

/// Vectors of four that make up the width.
const HALVES: usize = WIDTH / 4;

/// The boxes of up to eight children side by side, in whole cache lines.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(super) struct Node {
    /// By axis, then low and high side, then half of the children.
    bounds: [[[Vec4; HALVES]; 2]; 3],
    children: [Child; WIDTH],
}

/// Index of a node, or of a leaf's packs of triangles.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct Child(u32);

impl Child {
    const LEAF: u32 = 1 << 31;
    /// Where a leaf has its number of packs, less one.
    const COUNT: u32 = 30;

    pub fn node(index: usize) -> Self {
        Child(index as u32)
    }

    /// One to [`LEAF_PACKS`] packs side by side.
    pub fn leaf(packs: Range<usize>) -> Self {
        Child(packs.start as u32 | (packs.len() as u32 - 1) << Self::COUNT | Self::LEAF)
    }

    #[inline]
    pub fn below(self) -> Below {
        if self.0 & Self::LEAF == 0 {
            return Below::Node(self.0 as usize);
        }
        let first = (self.0 & ((1 << Self::COUNT) - 1)) as usize;
        let more = ((self.0 & !Self::LEAF) >> Self::COUNT) as usize;
        Below::Packs(first..first + 1 + more)
    }
}

/// What a child is, by index.
pub(super) enum Below {
    Node(usize),
    Packs(Range<usize>),
}

/// A child still to be visited and where the ray enters its box. As one number, of which the
/// nearer child has the smaller: distances are not negative, so their bits rise with them.
#[derive(Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Visit(u64);

impl Visit {
    fn new(enters: f32, child: Child) -> Self {
        Visit(u64::from(enters.to_bits()) << 32 | u64::from(child.0))
    }

    pub fn enters(self) -> f32 {
        f32::from_bits((self.0 >> 32) as u32)
    }

    pub fn child(self) -> Child {
        Child(self.0 as u32)
    }
}

impl Node {
    /// A node without children: no ray meets its boxes.
    pub const EMPTY: Node = Node {
        bounds: [[[Vec4::INFINITY; HALVES], [Vec4::NEG_INFINITY; HALVES]]; 3],
        children: [Child(0); WIDTH],
    };

    pub fn set(&mut self, slot: usize, low: [f32; 3], high: [f32; 3], child: Child) {
        for axis in 0..3 {
            self.bounds[axis][0][slot / 4][slot % 4] = low[axis];
            self.bounds[axis][1][slot / 4][slot % 4] = high[axis];
        }
        self.children[slot] = child;
    }

    /// The children that are set, by their slots.
    #[cfg(test)]
    pub fn children(&self) -> impl Iterator<Item = Child> {
        let set = |&slot: &usize| self.bounds[0][0][slot / 4][slot % 4] < f32::INFINITY;
        (0..WIDTH).filter(set).map(|slot| self.children[slot])
    }

    /// The children whose box the ray meets between `t_min` and `t_max`.
    #[inline]
    pub fn meet(&self, ray: &SplatRay, t_min: f32, t_max: f32) -> Met<'_> {
        // The exit is raised by the rounding of both, so that no box is missed (T. Ize, "Robust BVH
        // ray traversal", JCGT 2013).
        const ROUNDED_UP: f32 = 1.0 + 4.0 * f32::EPSILON;
        let mut met = Met { node: self, mask: 0, enters: [0.0; WIDTH] };
        for half in 0..HALVES {
            let plane = |axis: usize, side: usize| {
                (self.bounds[axis][side][half] - ray.origin[axis]) * ray.inverse[axis]
            };
            let [x, y, z] = ray.entry_side;
            let enters = plane(0, x).max(plane(1, y)).max(plane(2, z)).max(Vec4::splat(t_min));
            let exits = plane(0, 1 - x).min(plane(1, 1 - y)).min(plane(2, 1 - z)) * ROUNDED_UP;
            met.mask |= enters.cmple(exits.min(Vec4::splat(t_max))).bitmask() << (4 * half);
            met.enters[4 * half..4 * half + 4].copy_from_slice(&enters.to_array());
        }
        met
    }
}

/// The children of a node that a ray meets, in no order.
pub(super) struct Met<'a> {
    node: &'a Node,
    mask: u32,
    enters: [f32; WIDTH],
}

impl Iterator for Met<'_> {
    type Item = Visit;

    #[inline]
    fn next(&mut self) -> Option<Visit> {
        if self.mask == 0 {
            return None;
        }
        // The remainder only tells the compiler what is true anyway.
        let slot = self.mask.trailing_zeros() as usize % WIDTH;
        self.mask &= self.mask - 1;
        Some(Visit::new(self.enters[slot], self.node.children[slot]))
    }
}
