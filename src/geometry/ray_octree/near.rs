//! The nearest ray of all, by the leaves it can run through.
//!
//! A point's own leaf does not always hold the ray nearest to it: that ray may run through the next leaf, and
//! where rays are farther apart than leaves are wide the point's own may be empty. What was found bounds how
//! far others need be looked for, so cells are visited near ones first, and those farther off than that ray
//! are left out.

use glam::{UVec3, Vec3};

use super::{LEAF, MAX_DEPTH, RayOctree};

/// A cell to be visited: its word, its corner in cells of [`MAX_DEPTH`], and how often its box was halved.
#[derive(Clone, Copy)]
struct Visit {
    cell: u32,
    corner: UVec3,
    level: u32,
}

impl RayOctree {
    /// The segment of a trace nearest to a point, wherever it runs. WGSL twin: `nearest` of
    /// `shaders/reflection_morphing/octree.wgsl`.
    pub fn nearest_of_near(&self, point: Vec3, trace: u32) -> Option<u32> {
        let mut nearest = self.nearer_of(None, self.leaf(point), point, trace);
        let mut waiting = vec![Visit { cell: self.cells[0], corner: UVec3::ZERO, level: 0 }];
        while let Some(Visit { cell, corner, level }) = waiting.pop() {
            if cell & LEAF != 0 {
                nearest = self.nearer_of(nearest, self.list(cell & !LEAF), point, trace);
                continue;
            }
            let half = 1 << (MAX_DEPTH - level - 1);
            let near = point.cmpge(self.corner(corner + half)).bitmask();
            // The last pushed is visited first: the part nearest to the point.
            for which in (0..8).rev().map(|part| near ^ part) {
                let corner = corner + half * UVec3::new(which & 1, which >> 1 & 1, which >> 2);
                let (low, high) = (self.corner(corner), self.corner(corner + half));
                let apart = (point - point.clamp(low, high)).length_squared();
                if nearest.is_none_or(|(least, _)| apart <= least) {
                    let cell = self.cells[(cell + which) as usize];
                    waiting.push(Visit { cell, corner, level: level + 1 });
                }
            }
        }
        nearest.map(|(_, place)| place)
    }

    /// The least of what was found and the segments of a leaf, by distance; of two as near the first in the map.
    fn nearer_of(
        &self,
        found: Option<(f32, u32)>,
        leaf: &[u32],
        point: Vec3,
        trace: u32,
    ) -> Option<(f32, u32)> {
        let of_trace = |place: &&u32| self.segments[**place as usize].trace == trace;
        let distance =
            |&place: &u32| (self.segments[place as usize].distance_squared(point), place);
        let least = |a: (f32, u32), b: (f32, u32)| if b < a { b } else { a };
        found.into_iter().chain(leaf.iter().filter(of_trace).map(distance)).reduce(least)
    }

    /// Where a corner of cells is, world.
    fn corner(&self, corner: UVec3) -> Vec3 {
        let share = corner.as_vec3() / (1 << MAX_DEPTH) as f32;
        self.extent.low + share * (self.extent.high - self.extent.low)
    }
}
