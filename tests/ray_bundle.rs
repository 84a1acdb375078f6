//! What `reflection-morphing@revised` looks up: the nearest ray wherever it runs, and the place between four
//! rays; beside what Martin & Popescu 2004 look up. Rays of an exact sphere, without a mesh's facets.

use glam::{DVec3, Vec3};
use mirrorbench::geometry::alhazen::reflected_point;
use mirrorbench::geometry::random::SplitMix64;
use mirrorbench::geometry::ray_bundle::{RayTable, Seen};
use mirrorbench::geometry::ray_octree::{Extent, RayOctree, RaySegment};
use mirrorbench::geometry::{cube, optics};
use mirrorbench::methods::reflection_morphing::grid::{Corner, Grid};
use rayon::prelude::*;

const CENTRE: Vec3 = Vec3::Y;
const EXTENT: Extent = Extent { low: Vec3::new(-6.0, -0.1, -6.0), high: Vec3::new(6.0, 3.1, 6.0) };
/// Pixels a radian, of a view 720 high that is open by 60 degrees.
const PIXELS: f32 = 623.5;

/// A sampling location, and what is looked up there.
struct Node {
    octree: RayOctree,
    table: RayTable,
}

impl Node {
    /// Rays mirrored by a sphere of 1 m.
    fn new(location: Vec3, map: u32) -> Node {
        let mut segments = Vec::new();
        for texel in 0..6 * map * map {
            let (row, column) = (texel / map, texel % map);
            let uv = (glam::UVec2::new(column, row % map).as_vec2() + 0.5) / map as f32;
            let way = cube::direction(row / map, uv).as_dvec3().normalize();
            let from = (location - CENTRE).as_dvec3();
            let (b, c) = (from.dot(way), from.length_squared() - 1.0);
            if b >= 0.0 || b * b <= c {
                continue;
            }
            let normal = from + way * (-b - (b * b - c).sqrt());
            let start = (normal + CENTRE.as_dvec3()).as_vec3();
            let outgoing = optics::reflect(way.as_vec3(), normal.as_vec3()).normalize();
            let [_, to] = EXTENT.clip(start, outgoing, f32::INFINITY).unwrap_or([0.0; 2]);
            segments.push(RaySegment { start, trace: 1, end: start + to * outgoing, texel });
        }
        let table = RayTable::new(&segments, map, 1);
        Node { octree: RayOctree::new(EXTENT, segments, 5), table }
    }

    /// As published: the nearest ray of the point's leaf.
    fn published(&self, point: Vec3) -> Option<Seen> {
        let ray = self.octree.nearest(point, 1)?;
        Some(self.table.seen_by_ray(&self.octree.segments, point, ray))
    }

    fn revised(&self, point: Vec3) -> Option<Seen> {
        let ray = self.octree.nearest_of_near(point, 1)?;
        self.table.seen(&self.octree.segments, point, ray).filter(|seen| seen.within)
    }
}

type LookUp = fn(&Node, Vec3) -> Option<Seen>;
const RULES: [LookUp; 2] = [Node::published, Node::revised];

/// Metres aside of the eye's line of sight to one point, as pixels.
fn pixels(eye: Vec3, a: Vec3, b: Vec3) -> f32 {
    PIXELS * (a - eye).normalize().cross((b - eye).normalize()).length()
}

#[test]
fn revised_finds_the_nearest_ray_of_all() {
    let node = Node::new(Vec3::new(0.0, 1.5, 4.0), 128);
    let mut random = SplitMix64::new(7);
    let mut same = [0, 0];
    for _ in 0..10_000 {
        let point = random.within(Vec3::new(-6.0, 0.0, 1.0), Vec3::new(6.0, 3.0, 6.0));
        let all = node.octree.nearest_of_all(point, 1);
        same[0] += usize::from(node.octree.nearest(point, 1) == all);
        same[1] += usize::from(node.octree.nearest_of_near(point, 1) == all);
    }
    assert!((4_000..6_500).contains(&same[0]), "published: {} of 10000", same[0]);
    assert!(same[1] >= 9_990, "revised: {} of 10000", same[1]);
}

#[test]
fn between_four_rays_a_point_is_seen_where_it_is() {
    let eye = Vec3::new(0.3, 1.4, 3.9);
    let node = Node::new(eye, 256);
    let mut random = SplitMix64::new(23);
    let mut errors = [Vec::new(), Vec::new()];
    for _ in 0..2000 {
        let point = random.within(Vec3::new(-3.0, 0.0, 1.1), Vec3::new(3.0, 3.0, 3.0));
        let Some(exact) = reflected_point(DVec3::Y, 1.0, eye.as_dvec3(), point.as_dvec3()) else {
            continue;
        };
        for (rule, errors) in RULES.iter().zip(&mut errors) {
            errors.extend(rule(&node, point).map(|seen| pixels(eye, seen.point, exact.as_vec3())));
        }
    }
    let [published, revised] = errors.map(|mut errors| {
        errors.sort_by(f32::total_cmp);
        assert!(errors.len() > 1000, "{} are seen", errors.len());
        [errors[errors.len() / 2], errors[errors.len() * 99 / 100]]
    });
    // Rays are 0.35 degrees apart, 3.8 pixels.
    assert!(published[0] > 0.5, "{published:?} px");
    assert!(revised[0] < 0.02 && revised[1] < 0.2, "{revised:?} px");
}

/// Where an eye sees a point by a rule, all eight nodes seeing it.
fn morphed(nodes: &[(f32, Node)], point: Vec3, rule: LookUp) -> Option<Vec3> {
    nodes
        .iter()
        .try_fold(Vec3::ZERO, |sum, (weight, node)| Some(sum + *weight * rule(node, point)?.point))
}

fn nodes(grid: Grid, eye: Vec3, map: u32) -> Vec<(f32, Node)> {
    let corners = grid.cell_of(eye).corners();
    let node = |corner: &Corner| (corner.weight, Node::new(grid.location(corner.node), map));
    corners.par_iter().map(node).collect()
}

#[test]
fn errors_fall_with_the_square_of_the_cell_where_rays_add_none() {
    let cells = [0.25, 0.5, 1.0, 2.0];
    let errors = cells.map(|cell| {
        let (mut random, mut errors) = (SplitMix64::new(29), [Vec::new(), Vec::new()]);
        for _ in 0..3 {
            let eye = random.within(Vec3::new(-1.0, 0.6, 3.0), Vec3::new(1.0, 2.6, 5.0));
            let nodes = nodes(Grid { cell }, eye, 384);
            for _ in 0..300 {
                let point = random.within(Vec3::new(-2.0, 0.0, 1.2), Vec3::new(2.0, 2.5, 2.5));
                let exact = reflected_point(DVec3::Y, 1.0, eye.as_dvec3(), point.as_dvec3());
                let Some(exact) = exact.map(|exact| exact.as_vec3()) else { continue };
                for (errors, rule) in errors.iter_mut().zip(RULES) {
                    let found = morphed(&nodes, point, rule);
                    errors.extend(found.map(|found| pixels(eye, found, exact)));
                }
            }
        }
        errors.map(|errors| {
            assert!(errors.len() > 250, "{} points at {cell} m", errors.len());
            errors.iter().sum::<f32>() / errors.len() as f32
        })
    });
    let [published, revised] = [0, 1].map(|rule| errors.map(|errors| errors[rule]));
    let slope = |errors: &[f32; 4]| {
        // Least squares over equal steps of 1 in the logarithm.
        let logs = errors.map(f32::log2);
        0.1 * (3.0 * (logs[3] - logs[0]) + logs[2] - logs[1])
    };
    assert!((1.7..2.3).contains(&slope(&revised)), "{revised:?} px");
    // The nearest ray is up to half a ray off, whatever the cell.
    assert!(slope(&published) < 1.0, "{published:?} px");
}

#[test]
fn what_drifts_slowly_is_drawn_smoothly() {
    // In front of the mirror, by 1 mm a step: a ray is passed every few steps.
    let eye = Vec3::new(0.1, 1.6, 3.9);
    let nodes = nodes(Grid { cell: 0.5 }, eye, 256);
    let [published, revised] = RULES.map(|rule| {
        let place = |step: i32| {
            let point = Vec3::new(-0.3, 1.0, 1.5) + 1e-3 * step as f32 * Vec3::new(1.0, 0.4, 0.2);
            let seen = morphed(&nodes, point, rule).unwrap();
            PIXELS * (seen - eye) / (seen - eye).length()
        };
        let places: Vec<Vec3> = (0..400).map(place).collect();
        let bends = places.windows(3).map(|p| (p[0] - 2.0 * p[1] + p[2]).length_squared());
        (bends.sum::<f32>() / (places.len() - 2) as f32).sqrt()
    });
    assert!(revised < 0.2 * published, "{revised} px a step squared, {published} as published");
}

#[test]
fn over_an_edge_of_the_cube_and_at_the_rim_points_are_seen_too() {
    // Seen in the direction (1, 0, 1), the mirror lies on two faces.
    let eye = Vec3::new(-2.5, 1.2, -2.4);
    let node = Node::new(eye, 128);
    let mut random = SplitMix64::new(31);
    let (mut asked, mut within) = (0, 0);
    for _ in 0..2000 {
        let point = random.within(Vec3::new(-3.0, 0.0, -3.0), Vec3::new(0.0, 3.0, 0.0));
        let Some(exact) = reflected_point(DVec3::Y, 1.0, eye.as_dvec3(), point.as_dvec3()) else {
            continue;
        };
        asked += 1;
        let seen = node.revised(point);
        within +=
            usize::from(seen.is_some_and(|seen| pixels(eye, seen.point, exact.as_vec3()) < 0.5));
    }
    assert!(asked > 800 && within * 100 > asked * 97, "{within} of {asked}");
}
