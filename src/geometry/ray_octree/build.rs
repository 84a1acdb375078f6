//! Building: the tree that inserting one ray after the other gives, all rays at once.
//!
//! No ray is ever taken out again. So a cell ends up split exactly if it may be and two of all the rays that
//! cross it have the same trace, whatever order they came in; and cells can be split from the root down, in
//! parallel.

use glam::Vec3;
use rayon::prelude::*;

use super::{Extent, LEAF, RayOctree, RaySegment};

/// A cell with fewer rays is not worth another thread.
const PARALLEL: usize = 2048;

/// What a ray's part in a cell is: its segment, and from where to where, as shares of its length.
#[derive(Clone, Copy)]
struct Part {
    segment: u32,
    from: f32,
    to: f32,
}

/// A cell before it has a place.
enum Cell {
    Leaf(Vec<u32>),
    Inner(Vec<Cell>),
}

/// Build and linearise.
pub(super) fn linear(extent: Extent, segments: Vec<RaySegment>, depth: u32) -> RayOctree {
    let inside = |(segment, ray): (u32, &RaySegment)| {
        let [from, to] = extent.clip(ray.start, ray.end - ray.start, 1.0)?;
        Some(Part { segment, from, to })
    };
    let parts: Vec<Part> = (0..).zip(&segments).filter_map(inside).collect();
    let root = Builder { segments: &segments }.cell(extent, parts, depth);
    let mut octree = RayOctree {
        extent,
        cells: vec![0],
        starts: vec![0],
        lists: Vec::new(),
        segments: Vec::new(),
    };
    octree.place(0, root);
    octree.segments = segments;
    octree
}

impl RayOctree {
    /// Write a cell, and all below it, into the arrays.
    fn place(&mut self, at: usize, cell: Cell) {
        match cell {
            Cell::Leaf(list) => {
                self.cells[at] = LEAF | (self.starts.len() - 1) as u32;
                self.lists.extend(list);
                self.starts.push(self.lists.len() as u32);
            }
            Cell::Inner(children) => {
                let first = self.cells.len();
                self.cells[at] = first as u32;
                self.cells.resize(first + children.len(), 0);
                for (which, child) in children.into_iter().enumerate() {
                    self.place(first + which, child);
                }
            }
        }
    }
}

struct Builder<'a> {
    segments: &'a [RaySegment],
}

impl Builder<'_> {
    fn cell(&self, extent: Extent, parts: Vec<Part>, depth: u32) -> Cell {
        if depth == 0 || !self.conflict(&parts) {
            return Cell::Leaf(self.list(parts));
        }
        let mut children: [Vec<Part>; 8] = Default::default();
        for part in &parts {
            self.share_out(&extent, part, &mut children);
        }
        let many = parts.len() >= PARALLEL;
        drop(parts);
        let child = |(which, parts): (usize, Vec<Part>)| {
            self.cell(extent.child(which as u32), parts, depth - 1)
        };
        let children: Vec<(usize, Vec<Part>)> = children.into_iter().enumerate().collect();
        Cell::Inner(if many {
            children.into_par_iter().map(child).collect()
        } else {
            children.into_iter().map(child).collect()
        })
    }

    fn trace(&self, part: &Part) -> u32 {
        self.segments[part.segment as usize].trace
    }

    /// "Two rays conflict when they have the same trace."
    fn conflict(&self, parts: &[Part]) -> bool {
        parts.iter().enumerate().any(|(place, part)| {
            parts[..place].iter().any(|before| self.trace(before) == self.trace(part))
        })
    }

    fn list(&self, mut parts: Vec<Part>) -> Vec<u32> {
        parts.sort_unstable_by_key(|part| (self.trace(part), part.segment));
        parts.into_iter().map(|part| part.segment).collect()
    }

    /// Give a ray to the children it crosses: the planes in the middle cut it into up to four pieces, each
    /// within one child.
    fn share_out(&self, extent: &Extent, part: &Part, children: &mut [Vec<Part>; 8]) {
        let RaySegment { start, end, .. } = self.segments[part.segment as usize];
        let way = end - start;
        let mut cuts = ((extent.middle() - start) / way).to_array();
        cuts.sort_unstable_by(f32::total_cmp);
        let mut push = |from: f32, to: f32| {
            let within: Vec3 = start + 0.5 * (from + to) * way;
            children[extent.which(within) as usize].push(Part { from, to, ..*part });
        };
        let mut from = part.from;
        // What is not between, not a number included, cuts nothing.
        for cut in cuts.into_iter().filter(|&cut| cut > part.from && cut < part.to) {
            push(from, cut);
            from = cut;
        }
        push(from, part.to);
    }
}
