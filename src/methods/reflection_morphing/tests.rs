//! What the device looks up and interpolates, vertex by vertex, against the Rust twins of the same rules
//! (`geometry::ray_octree`, `geometry::ray_bundle`).

use std::sync::Arc;

use glam::{Vec3, Vec4, Vec4Swizzles};
use rayon::prelude::*;

use super::*;
use crate::geometry::ray_bundle::{RayTable, Seen};
use crate::geometry::ray_octree::RayOctree;
use crate::gpu::Device;
use crate::methods::reflected::Corner;
use crate::methods::{Case, METHODS};
use crate::scene::{self, Moment, ObjectId, Scene};
use crate::stages::{CameraUniform, RecordMode};
use grid::Corner as CellCorner;
use ray_map::RayMapper;

const CELL: f32 = 0.7;
const MAP: u32 = 32;
const LAYERS: u32 = 2;
const DEPTH: u32 = 5;
/// WGSL `SHOWN`, `HIDDEN` and `LOST` of `shaders/virtual_objects/corner.wgsl`.
const SHOWN: u32 = 0;
const HIDDEN: u32 = 1;
const LOST: u32 = 3;

/// A location as the processor looks it up.
struct Location {
    octree: RayOctree,
    table: RayTable,
}

type Nearest = fn(&RayOctree, Vec3, u32) -> Option<u32>;

/// A case, and the twins of its look-up.
struct Rule {
    case: &'static str,
    nearest: Nearest,
    between: bool,
}

const RULES: [Rule; 4] = [
    Rule { case: "reflection-morphing", nearest: RayOctree::nearest, between: false },
    Rule {
        case: "reflection-morphing:lookup=brute-force",
        nearest: RayOctree::nearest_of_all,
        between: false,
    },
    Rule {
        case: "reflection-morphing@revised:point=ray",
        nearest: RayOctree::nearest_of_near,
        between: false,
    },
    Rule { case: "reflection-morphing@revised", nearest: RayOctree::nearest_of_all, between: true },
];

impl Rule {
    /// In the words of `points` of `shaders/reflection_morphing/look_up.wgsl`.
    fn look_up(&self, location: &Location, point: Vec3, trace: u32) -> Vec4 {
        let Location { octree, table } = location;
        let seen = (self.nearest)(octree, point, trace).and_then(|ray| match self.between {
            true => table.seen(&octree.segments, point, ray),
            false => Some(table.seen_by_ray(&octree.segments, point, ray)),
        });
        seen.map_or(Vec4::ZERO, |Seen { point, way, within }| {
            point.extend(if within { 1.0 } else { -1.0 } * (1.0 + way))
        })
    }
}

/// What the device found by a rule and a trace.
struct Found {
    /// Of each location in turn, all vertices.
    points: Vec<Vec4>,
    corners: Vec<Corner>,
    owners: Vec<ObjectId>,
}

fn found(
    device: &Arc<Device>,
    (scene, moment): (&Arc<Scene>, &Moment),
    corners: &[CellCorner; 8],
    case: &str,
    trace: Trace,
) -> Found {
    let case = Case::parse(case, &METHODS.iter().collect::<Vec<_>>()).unwrap();
    let full = RecordMode::Full.defines();
    let defines = [&full[..], &look_up_defines(&case.parts[0].values), &[("RAY_MAP", 1)]].concat();
    let morph = Morph::new(device, &defines).unwrap();
    let recipe = Recipe { map: MAP, depth: DEPTH, layers: LAYERS, still: false };
    let mut nodes = Nodes::new(recipe, Grid { cell: CELL }, None, true);
    nodes.fetch(device, (scene, moment), corners).unwrap();
    let lists = Lists::new(scene, 1.0).unwrap();
    let mut vertices = Vertices::new(device, scene, &lists).unwrap();
    let source = lists.upload(device).unwrap();
    let mut on_device = GpuScene::new(device, scene).unwrap();
    let record = ReflectionRecord::new(device, [16; 2], RecordMode::Full, 1).unwrap();
    let camera = CameraUniform::new(&moment.camera, [16; 2]);
    let mut frame = Frame::new(device).unwrap();
    frame.begin().unwrap();
    on_device.pose(&mut frame, moment).unwrap();
    let asked = (&source, &mut vertices);
    morph.look_up(&mut frame, &on_device, asked, &mut nodes, trace, &record).unwrap();
    let seen = (&source, &vertices);
    morph.run(&mut frame, &on_device, seen, corners, trace, (&camera, &record)).unwrap();
    frame.submit().unwrap();
    let points = vertices.points[&trace.packed].read::<[f32; 4]>().unwrap();
    let points = points.into_iter().map(Vec4::from_array).collect();
    Found { points, corners: vertices.corners.read().unwrap(), owners: lists.owners }
}

/// One point from eight, as `shaders/reflection_morphing/morph.wgsl` has it: where, metres on, and its status.
fn morphed(seen: [Vec4; 8], corners: &[CellCorner; 8], by_valid: bool) -> Option<(Vec4, u32)> {
    let [mut within, mut beside] = [(Vec4::ZERO, 0.0); 2];
    for (seen, corner) in seen.into_iter().zip(corners) {
        let sum = if seen.w > 0.0 { &mut within } else { &mut beside };
        if seen.w != 0.0 {
            sum.0 += corner.weight * seen.xyz().extend(seen.w.abs() - 1.0);
            sum.1 += corner.weight;
        }
    }
    let all = (within.0 + beside.0, within.1 + beside.1);
    match by_valid {
        true if within.1 >= 0.5 => Some((within.0 / within.1, SHOWN)),
        true => (all.1 >= 0.5).then(|| (all.0 / all.1, HIDDEN)),
        false if seen.iter().any(|seen| seen.w == 0.0) => None,
        false => Some((all.0, if beside.1 > 0.0 { HIDDEN } else { SHOWN })),
    }
}

/// Metres that rounding may part two points by, and the share of look-ups in which two rays are as near to a
/// vertex but for rounding, or a walk from bundle to bundle ends beside one.
const ROUNDING: f32 = 1e-3;
const TIES: f64 = 2e-3;

#[test]
fn the_device_looks_up_and_interpolates_as_the_processor_does() {
    let device = Device::open("auto", true).unwrap();
    let scene = Arc::new(scene::load("two-spheres").unwrap());
    let moment = scene.at(0);
    let cell = Grid { cell: CELL }.cell_of(moment.camera.eye);
    let corners = cell.corners();
    let mapper = RayMapper::new(&scene, &moment, false);
    let locations = corners.map(|corner| {
        let rays = mapper.trace(Grid { cell: CELL }.location(corner.node), MAP, LAYERS);
        let table = RayTable::new(&rays, MAP, LAYERS);
        Location { octree: RayOctree::new(mapper.extent, rays, DEPTH), table }
    });
    let mirrors = scene.reflectors();
    let once = Trace::of(&scene, mirrors[0]);
    let mut drawn = [0; LAYERS as usize];
    for rule in &RULES {
        for trace in [once, once.on(&scene, mirrors[1])] {
            let what = format!("{}, {} reflectors", rule.case, trace.order);
            let found = found(&device, (&scene, &moment), &corners, rule.case, trace);
            check_look_ups(&what, rule, &locations, &found, trace);
            let seen_from = (&corners, moment.camera.eye);
            drawn[trace.order as usize - 1] += check_morph(&what, rule, seen_from, &found, trace);
        }
    }
    assert!(drawn.iter().all(|&drawn| drawn > 1000), "{drawn:?} vertices");
}

/// Every point that the device looked up.
fn check_look_ups(what: &str, rule: &Rule, places: &[Location; 8], found: &Found, trace: Trace) {
    let count = found.owners.len();
    let asked = (0..8 * count).into_par_iter();
    let asked = asked.filter(|i| found.owners[i % count] != trace.last);
    let apart = asked.map(|i| {
        let vertex = Vec3::from(found.corners[i % count].position);
        let expected = rule.look_up(&places[i / count], vertex, trace.packed);
        let same = expected.abs_diff_eq(found.points[i], ROUNDING);
        [1, usize::from(expected != Vec4::ZERO), usize::from(!same)]
    });
    let [asked, seen, apart] = apart.reduce(|| [0; 3], |a, b| std::array::from_fn(|i| a[i] + b[i]));
    assert!(seen > 1000, "{what}: {seen} of {asked} vertices are seen");
    assert!((apart as f64) < TIES * asked as f64, "{what}: {apart} of {asked} vertices");
}

/// What the device made of the points it looked up; how many vertices have images.
fn check_morph(
    what: &str,
    rule: &Rule,
    (corners, eye): (&[CellCorner; 8], Vec3),
    found: &Found,
    trace: Trace,
) -> usize {
    let count = found.owners.len();
    let mut drawn = 0;
    for (vertex, corner) in found.corners.iter().enumerate() {
        if found.owners[vertex] == trace.last {
            continue;
        }
        let seen = std::array::from_fn(|slot| found.points[slot * count + vertex]);
        let by_valid = rule.case.contains("@revised");
        let Some((point, status)) = morphed(seen, corners, by_valid) else {
            assert_eq!(corner.found >> 28, LOST, "{what}: vertex {vertex}");
            continue;
        };
        assert_eq!(corner.found >> 28, status, "{what}: vertex {vertex}");
        let way = match trace.order {
            1 => point.xyz().distance(corner.position.into()),
            _ => point.w,
        };
        let image = point.xyz() + way * (point.xyz() - eye).normalize();
        let apart = image.distance(corner.image.into());
        assert!(apart < ROUNDING, "{what}: vertex {vertex} is {apart} m from there");
        drawn += 1;
    }
    drawn
}
