//! Projections on the device: what cells list against all bundles, and the bundles of a finely cut sphere against
//! Alhazen's root.

use std::sync::Arc;

use glam::{DVec3, Vec3};

use super::super::ray_map::{self, RayMapper};
use super::*;
use crate::geometry::Ray;
use crate::geometry::alhazen::reflected_point;
use crate::geometry::shapes::sphere;
use crate::gpu::Device;
use crate::methods::{Case, METHODS};
use crate::scene::{self, Lobe, Moment, ObjectId, Scene};
use crate::stages::RecordMode;

const VIEW: [u32; 2] = [160, 120];
/// WGSL `SHOWN` of `shaders/virtual_objects/corner.wgsl`.
const SHOWN: u32 = 0;

/// One node at the eye.
struct Bench {
    device: Arc<Device>,
    scene: GpuScene,
    node: EyeNode,
    record: ReflectionRecord,
}

impl Bench {
    fn new(scene: Scene, case: &str) -> Bench {
        let device = Device::open("auto", true).unwrap();
        let case = Case::parse(case, &METHODS.iter().collect::<Vec<_>>()).unwrap();
        let reflectors = scene.reflectors();
        let scene = GpuScene::new(&device, &Arc::new(scene)).unwrap();
        let setup = Setup {
            device: &device,
            scene: &scene,
            variant: case.parts[0].variant,
            values: &case.parts[0].values,
            mode: RecordMode::Full,
            size: VIEW,
            reflectors: &reflectors,
        };
        let extent = ray_map::extent(&scene.scene);
        let node = EyeNode::new(&setup, extent).unwrap();
        let record = ReflectionRecord::new(&device, VIEW, RecordMode::Full, 1).unwrap();
        Bench { node, record, scene, device }
    }

    /// Where a chain of reflectors shows each vertex.
    fn run(&mut self, moment: &Moment, chain: &[ObjectId]) -> Vec<Corner> {
        let mut frame = Frame::new(&self.device).unwrap();
        frame.begin().unwrap();
        self.scene.pose(&mut frame, moment).unwrap();
        self.record.clear(&mut frame).unwrap();
        let want =
            Want { changed: Default::default(), eyes: [Vec3::ZERO; 2], reflectors: &chain[..1] };
        self.node.prepare(&mut frame, &self.scene, &want).unwrap();
        let Bench { scene, node, record, .. } = self;
        let (source, corners) = node.state.as_ref().unwrap();
        source.pose(&mut frame, scene, "test").unwrap();
        let camera = CameraUniform::new(&moment.camera, VIEW);
        let (seen, found) = ((&camera, &*record), (source, corners));
        let mirror = |object| Mirror { object, lobe: Lobe::Reflected };
        node.find(&mut frame, scene, seen, &mirror(chain[0]), found).unwrap();
        let mut trace = Trace::of(&scene.scene, chain[0]);
        for &object in &chain[1..] {
            let further = node.further.as_ref().unwrap();
            further.follow(&mut frame, scene, &node.bins, record, trace).unwrap();
            trace = trace.on(&scene.scene, object);
            let cubes = node.bins.cubes(&scene.scene.points_of(moment, object), &mirror(object));
            let bins = (&node.bins, &cubes);
            further.find(&mut frame, scene, bins, seen, trace, found).unwrap();
        }
        frame.submit().unwrap();
        corners.read().unwrap()
    }
}

/// Two bundles with two rays in common give points between these by no more apart, metres.
const ROUNDING: f32 = 1e-4;

fn shown(corner: &Corner) -> bool {
    corner.found >> 28 == SHOWN
}

/// Vertices shown over so many mirrors by cells' bundles and by all bundles of the same rays: how many by any, by one
/// of both alone, and in different places.
fn compared(name: &str, case: &str, at: u32, order: usize) -> [usize; 3] {
    let scene = scene::load(name).unwrap();
    let (mirrors, moment) = (scene.reflectors(), scene.at(at));
    let [cells, all] = ["", ",lookup=brute-force"].map(|how| {
        Bench::new(scene.clone(), &format!("{case}{how}")).run(&moment, &mirrors[..order])
    });
    let mut counts = [0; 3];
    for (a, b) in cells.iter().zip(&all) {
        counts[0] += usize::from(shown(a) || shown(b));
        counts[1] += usize::from(shown(a) != shown(b));
        let apart = Vec3::from(a.image).distance(b.image.into()) > ROUNDING;
        counts[2] += usize::from(shown(a) && shown(b) && apart);
    }
    counts
}

#[test]
fn cells_lose_no_bundle() {
    let mut total = 0;
    for (name, at, edge, map) in [
        ("columns", 0, 0.5, 64),
        ("columns", 333, 1.0, 100),
        ("columns-moving", 30, 1.0, 37),
        ("two-spheres", 0, 1.0, 64),
    ] {
        let case = format!("reflection-morphing:nodes=eye,subdivide={edge},map={map}");
        let [shown, lost, apart] = compared(name, &case, at, 1);
        assert!(shown > 1000, "{name}: {shown} vertices");
        assert_eq!([lost, apart], [0, 0], "{name}: of {shown} vertices");
        total += shown;
    }
    assert!(total >= 10_000, "{total} vertices");
}

#[test]
fn cells_lose_no_bundle_of_rays_that_went_on() {
    let case = "reflection-morphing:nodes=eye,bounces=2,subdivide=1,map=64";
    let [shown, lost, apart] = compared("two-spheres", case, 0, 2);
    assert!(shown > 1000, "{shown} vertices");
    assert_eq!([lost, apart], [0, 0], "of {shown} vertices");
}

/// Of the vertices that a chain of mirrors shows: how many, and the median and the 95th percentile of how far a ray
/// traced from the eye to the image passes by the vertex in the end, as a share of the metres it has come.
fn passed_by(chain: &[usize], map: u32) -> (usize, [f32; 2]) {
    let scene = scene::load("two-spheres").unwrap();
    let (mirrors, moment) = (scene.reflectors(), scene.at(0));
    let chain: Vec<ObjectId> = chain.iter().map(|&rank| mirrors[rank]).collect();
    let case = format!("reflection-morphing:nodes=eye,bounces=3,subdivide=1,map={map}");
    let corners = Bench::new(scene.clone(), &case).run(&moment, &chain);
    let packed = chain[1..].iter().fold(Trace::of(&scene, chain[0]), |t, &m| t.on(&scene, m));
    let (mapper, eye) = (RayMapper::new(&scene, &moment, false), moment.camera.eye);
    let traced = corners.iter().filter(|corner| shown(corner)).filter_map(|corner| {
        let image = Vec3::from(corner.image);
        let ray = Ray { origin: eye, direction: (image - eye).normalize() };
        let segment = mapper.chain(&ray, chain.len() as u32).pop()?;
        // Rays at the eye do not end at other mirrors.
        let towards = Vec3::from(corner.position) - segment.start;
        let missed = towards.reject_from((segment.end - segment.start).normalize()).length();
        // At its rim a mirror's facets and those of its image are not the same.
        (segment.trace == packed.packed).then(|| missed / eye.distance(image))
    });
    let mut missed: Vec<f32> = traced.collect();
    missed.sort_by(f32::total_cmp);
    let at = |share: usize| missed[missed.len() * share / 100];
    (missed.len(), [at(50), at(95)])
}

#[test]
fn rays_traced_to_images_pass_by_the_vertices() {
    for (chain, most) in [(&[0][..], 3e-5), (&[0, 1], 5e-4), (&[0, 1, 0], 5e-3)] {
        let (count, missed) = passed_by(chain, 256);
        assert!(count > 1000, "{chain:?}: {count} vertices");
        assert!(missed[0] < most, "{chain:?}: {missed:?} of {count} vertices");
    }
}

#[test]
fn hollow_mirrors_lose_none_either() {
    // Where several bundles hold a vertex, a walk may end in another one than the shortest path's.
    let case = "reflection-morphing:nodes=eye,subdivide=0.5,map=64";
    let [shown, lost, apart] = compared("columns-wobble", case, 7, 1);
    assert!(shown > 1000, "{shown} vertices");
    assert_eq!(lost, 0, "of {shown} vertices");
    assert!(apart * 100 < shown, "{apart} of {shown} vertices");
}

#[test]
fn bundles_are_as_exact_as_the_square_of_their_width() {
    let mut scene = scene::load("columns").unwrap();
    let mirror = scene.reflectors()[0];
    let mesh = scene.objects[mirror as usize].mesh;
    scene.meshes[mesh] = sphere(1.0, 1024, 512);
    let moment = scene.at(0);
    let (eye, centre) = (moment.camera.eye, Vec3::from(moment.poses[mirror as usize].translation));
    let camera = CameraUniform::new(&moment.camera, VIEW);
    let middle = [64, 128, 256].map(|map| {
        let case = format!("reflection-morphing:nodes=eye,subdivide=0.5,map={map}");
        let corners = Bench::new(scene.clone(), &case).run(&moment, &[mirror]);
        let mut errors: Vec<f32> = corners
            .iter()
            .filter(|corner| shown(corner))
            .filter_map(|corner| {
                let [eye, v] = [eye, corner.position.into()].map(|p: Vec3| (p - centre).as_dvec3());
                let root: DVec3 = reflected_point(DVec3::ZERO, 1.0, eye, v)?;
                let pixel = |p: Vec3| {
                    Some(
                        0.5 * camera.project(p)?
                            * Vec3::new(VIEW[0] as f32, VIEW[1] as f32, 0.0).truncate(),
                    )
                };
                Some((pixel(corner.image.into())? - pixel(root.as_vec3() + centre)?).length())
            })
            .collect();
        errors.sort_by(f32::total_cmp);
        assert!(errors.len() > 5000, "{} vertices", errors.len());
        errors[errors.len() / 2]
    });
    assert!(middle[2] < 0.01, "{middle:?} px");
    assert!(middle[0] > 2.5 * middle[1] && middle[1] > 2.5 * middle[2], "{middle:?} px");
}
