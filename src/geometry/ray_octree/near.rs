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

/// Of each level seven cells wait while one is open.
const WAITING: usize = 7 * MAX_DEPTH as usize + 1;

impl RayOctree {
    /// The segment of a trace nearest to a point, wherever it runs. WGSL twin: `nearest_of_near` of
    /// `shaders/reflection_morphing/octree.wgsl`.
    pub fn nearest_of_near(&self, point: Vec3, trace: u32) -> Option<u32> {
        let mut waiting = Vec::with_capacity(WAITING);
        waiting.push(Visit { cell: self.cells[0], corner: UVec3::ZERO, level: 0 });
        let mut nearest: Option<(f32, u32)> = None;
        while let Some(visit) = waiting.pop() {
            if nearest.is_some_and(|(least, _)| self.distance_to(&visit, point) > least) {
                continue;
            }
            if visit.cell & LEAF != 0 {
                let leaf = (visit.cell & !LEAF) as usize;
                for &place in
                    &self.lists[self.starts[leaf] as usize..self.starts[leaf + 1] as usize]
                {
                    let segment = &self.segments[place as usize];
                    if segment.trace == trace {
                        let found = (segment.distance_squared(point), place);
                        // Of two as near the first in the map, whichever leaf is visited first.
                        nearest = Some(
                            nearest
                                .map_or(found, |least| if found < least { found } else { least }),
                        );
                    }
                }
                continue;
            }
            let half = 1 << (MAX_DEPTH - visit.level - 1);
            let middle = self.corner(visit.corner + half);
            let near = point.cmpge(middle).bitmask();
            // The last pushed is visited first: the part nearest to the point.
            for part in (0..8).rev() {
                let which = near ^ part;
                let step = UVec3::new(which & 1, which >> 1 & 1, which >> 2);
                waiting.push(Visit {
                    cell: self.cells[(visit.cell + which) as usize],
                    corner: visit.corner + half * step,
                    level: visit.level + 1,
                });
            }
        }
        nearest.map(|(_, place)| place)
    }

    /// Where a corner of cells is, world.
    fn corner(&self, corner: UVec3) -> Vec3 {
        let share = corner.as_vec3() / (1 << MAX_DEPTH) as f32;
        self.extent.low + share * (self.extent.high - self.extent.low)
    }

    /// The square of a point's distance from a cell.
    fn distance_to(&self, visit: &Visit, point: Vec3) -> f32 {
        let (low, high) = (
            self.corner(visit.corner),
            self.corner(visit.corner + (1 << (MAX_DEPTH - visit.level))),
        );
        (point - point.clamp(low, high)).length_squared()
    }
}
