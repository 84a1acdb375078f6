//! The nearest triangle a ray meets, on the CPU: obvhs's tree, walked our own way.
//!
//! obvhs builds the binary tree. It is folded into nodes of eight boxes and leaves of up to four
//! triangles that lie side by side, so that SSE2, which every x86-64 has, tests four at once.
//!
//! Beside Embree 4.4 on one thread (`cargo bench --bench referees`, mirrored rays, 600,000 triangles
//! and `kitchen`) the binary tree itself reached 0.37 and 0.32 of its speed, nodes of four boxes 0.60
//! and 0.58, nodes of eight 0.65 and 0.72; built for the native CPU (Zen 4) 0.72 and 0.79. Tried
//! without gain: Woop, Benthin & Wald's sheared triangle test (JCGT 2013), though it has half the
//! operations: a ray meets ten nodes but two packs, and waits for memory and mispredicted branches
//! rather than for arithmetic, so wider registers matter little too; huge pages; touching children
//! ahead. obvhs's slower builds gain up to a tenth in `kitchen` for three times the build.

mod build;
mod node;
mod pack;
mod splat;

use std::cell::Cell;
use std::time::Duration;

use glam::{Vec2, Vec3};
use obvhs::BvhBuildParams;
use obvhs::bvh2::builder::build_bvh2_from_tris;
use obvhs::triangle::Triangle;

use super::Ray;
use node::{Child, Node, Visit};
use pack::{LANES, Pack};
use splat::SplatRay;

thread_local! {
    /// Room for the visits that wait, kept from ray to ray: clearing an array for each would cost
    /// more than a node.
    static WAITING: Cell<Vec<Visit>> = const { Cell::new(Vec::new()) };
}

/// A tree over world-space triangles.
pub struct Bvh {
    /// The root first; empty without triangles.
    nodes: Vec<Node>,
    packs: Vec<Pack>,
}

/// Where a ray meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BvhHit {
    /// Index into the list the tree was built from.
    pub triangle: u32,
    /// Distance along the ray, in lengths of its direction.
    pub t: f32,
    /// Weights of the second and third corner.
    pub barycentrics: Vec2,
    /// Whether the ray meets the side the corners run counter-clockwise on.
    pub front: bool,
}

impl Bvh {
    /// Build over `triangles`; corners must be finite.
    pub fn new(triangles: &[[Vec3; 3]]) -> Self {
        if triangles.is_empty() {
            return Bvh { nodes: Vec::new(), packs: Vec::new() };
        }
        let list: Vec<Triangle> = triangles
            .iter()
            .map(|&[v0, v1, v2]| Triangle { v0: v0.into(), v1: v1.into(), v2: v2.into() })
            .collect();
        let params = BvhBuildParams {
            max_prims_per_leaf: LANES as u32,
            // A pack costs as much as a node.
            collapse_traversal_cost: 1.0,
            ..BvhBuildParams::medium_build()
        };
        let mut build_time = Duration::ZERO;
        build::fold(&build_bvh2_from_tris(&list, params, &mut build_time), triangles)
    }

    /// The nearest triangle met at `t` from `t_min` (0 or more) to before `t_max` for which
    /// `accept(triangle, front)`.
    #[inline]
    pub fn nearest(
        &self,
        ray: &Ray,
        range: [f32; 2],
        accept: impl Fn(u32, bool) -> bool,
    ) -> Option<BvhHit> {
        if self.nodes.is_empty() {
            return None;
        }
        WAITING.with(|place| {
            let mut waiting = place.take();
            let nearest = self.walk(&mut waiting, ray, range, accept);
            place.set(waiting);
            nearest
        })
    }

    /// [`Bvh::nearest`] of a tree with nodes; `waiting` starts and ends empty.
    #[inline]
    fn walk(
        &self,
        waiting: &mut Vec<Visit>,
        ray: &Ray,
        [t_min, mut t_max]: [f32; 2],
        accept: impl Fn(u32, bool) -> bool,
    ) -> Option<BvhHit> {
        let ray = SplatRay::new(ray);
        let mut nearest = None;
        let mut child = Child::node(0);
        loop {
            match child.index() {
                Err(node) => {
                    let met = self.nodes[node].meet(&ray, t_min, t_max);
                    if let Some(visit) = push_all_but_nearest(met, waiting) {
                        child = visit.child();
                        continue;
                    }
                }
                Ok(pack) => {
                    for hit in self.packs[pack].meet(&ray, t_min, t_max) {
                        if hit.t < t_max && accept(hit.triangle, hit.front) {
                            t_max = hit.t;
                            nearest = Some(hit);
                        }
                    }
                }
            }
            loop {
                let Some(visit) = waiting.pop() else { return nearest };
                if visit.enters() <= t_max {
                    child = visit.child();
                    break;
                }
            }
        }
    }
}

/// Returns the nearest of the children met; the others go on the stack, the nearer on top.
#[inline]
fn push_all_but_nearest(mut met: node::Met, waiting: &mut Vec<Visit>) -> Option<Visit> {
    let mut nearest = met.next()?;
    let base = waiting.len();
    for visit in met {
        let farther = visit.max(nearest);
        nearest = visit.min(nearest);
        let mut place = waiting.len();
        waiting.push(farther);
        while place > base && waiting[place - 1] < farther {
            waiting[place] = waiting[place - 1];
            place -= 1;
        }
        waiting[place] = farther;
    }
    Some(nearest)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ray(origin: Vec3, direction: Vec3) -> Ray {
        Ray { origin, direction: direction.normalize() }
    }

    /// A height field of `n` x `n` quads over the unit square.
    fn field(n: u32) -> Vec<[Vec3; 3]> {
        let corner = |i: u32, j: u32| {
            let (x, z) = (i as f32 / n as f32, j as f32 / n as f32);
            Vec3::new(x, 0.1 * (9.0 * x).sin() * (7.0 * z).cos(), z)
        };
        let quads = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
        quads
            .flat_map(|(i, j)| {
                let [a, b, c, d] =
                    [corner(i, j), corner(i, j + 1), corner(i + 1, j + 1), corner(i + 1, j)];
                [[a, b, c], [a, c, d]]
            })
            .collect()
    }

    #[test]
    fn nearest_agrees_with_trying_every_triangle() {
        let triangles = field(12);
        let bvh = Bvh::new(&triangles);
        let alone = |triangle| Pack::new(&triangles, &[triangle]);
        let packs: Vec<Pack> = (0..triangles.len() as u32).map(alone).collect();
        let mut hits = 0;
        for k in 0..2000u32 {
            let s = k as f32;
            let from =
                Vec3::new((s * 0.37).fract(), 0.05 + 0.5 * (s * 0.71).fract(), (s * 0.13).fract());
            let towards = Vec3::new(
                (s * 0.53).fract() - 0.5,
                -0.3 * (s * 0.29).fract(),
                (s * 0.91).fract() - 0.5,
            );
            let ray = ray(from, towards);
            let splat = SplatRay::new(&ray);
            let every = packs.iter().flat_map(|pack| pack.meet(&splat, 0.0, f32::INFINITY));
            let expected = every.map(|hit| hit.t).reduce(f32::min);
            let found = bvh.nearest(&ray, [0.0, f32::INFINITY], |_, _| true).map(|hit| hit.t);
            // On a shared edge either triangle may answer; they differ in the last digit.
            let off = found.unwrap_or(-1.0) - expected.unwrap_or(-1.0);
            assert!(off.abs() < 1e-6, "{found:?} instead of {expected:?}");
            hits += found.is_some() as u32;
        }
        assert!(hits > 500);
    }

    #[test]
    fn rays_through_shared_edges_and_corners_never_slip_through() {
        let bvh = Bvh::new(&field(8));
        for i in 4..=60 {
            for j in 4..=60 {
                // Every grid line and corner of the field is among these.
                let target = Vec3::new(i as f32 / 64.0, 0.0, j as f32 / 64.0);
                let ray = ray(target + Vec3::Y, Vec3::NEG_Y);
                assert!(bvh.nearest(&ray, [0.0, 10.0], |_, _| true).is_some(), "{target}");
            }
        }
    }

    #[test]
    fn barycentrics_rebuild_the_point_and_the_side_is_that_of_the_winding() {
        let [a, b, c] = [Vec3::ZERO, Vec3::X, Vec3::Y];
        let bvh = Bvh::new(&[[a, b, c]]);
        for (z, front) in [(2.0, true), (-2.0, false)] {
            let ray = ray(Vec3::new(0.2, 0.3, z), Vec3::new(0.0, 0.0, -z));
            let hit = bvh.nearest(&ray, [0.0, 10.0], |_, _| true).unwrap();
            assert_eq!(hit.front, front);
            assert!(hit.barycentrics.abs_diff_eq(Vec2::new(0.2, 0.3), 1e-6));
            assert!((hit.t - 2.0).abs() < 1e-6);
        }
    }

    #[test]
    fn range_and_filter_are_respected() {
        let layer =
            |y: f32| [Vec3::new(-1.0, y, -1.0), Vec3::new(-1.0, y, 3.0), Vec3::new(3.0, y, -1.0)];
        let bvh = Bvh::new(&[layer(0.0), layer(-1.0), layer(-2.0)]);
        let ray = ray(Vec3::Y, Vec3::NEG_Y);
        let nearest = |range, skip| {
            bvh.nearest(&ray, range, |triangle, _| triangle != skip).map(|hit| hit.triangle)
        };
        assert_eq!(nearest([0.0, 9.0], 9), Some(0));
        assert_eq!(nearest([0.0, 9.0], 0), Some(1));
        assert_eq!(nearest([2.5, 9.0], 9), Some(2));
        assert_eq!(nearest([0.0, 0.5], 9), None);
        assert_eq!(Bvh::new(&[]).nearest(&ray, [0.0, 9.0], |_, _| true), None);
    }
}
