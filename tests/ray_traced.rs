//! The ray-traced rival: it is the truth on every scene, however its tree lies in buffers and
//! whatever moves, and it mends what others leave.

mod gpu_support;

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use glam::{Vec4, Vec4Swizzles};
use gpu_support::{Session, engine, frame, methods, options, tracer};
use mirrorbench::experiment::engine::{Engine, Fallback, FrameTimes, RunOptions};
use mirrorbench::gpu::{Buffer, ComputePipeline, Frame};
use mirrorbench::measure;
use mirrorbench::methods::Case;
use mirrorbench::scene::{self, FrameRecord, Lobe, ReflectionRecord, Scene, Source};
use mirrorbench::stages::{GpuScene, SceneTree, TreeKind, TreeLayout, TreeUpdate};
use mirrorbench::truth::Hit;

/// Share of the pixels of two frames of a scene that are half a pixel off.
fn bad_share(session: &Session, name: &str, case: &str, size: [u32; 2]) -> f64 {
    let scene = scene::load(name).unwrap();
    let mut engine = engine(session, &scene, case, &options(size));
    let (mut bad, mut pixels) = (0.0, 0.0);
    for at in [0, scene.frames / 2] {
        let moment = scene.at(at);
        let (tested, times) = engine.frame(&moment, true).unwrap();
        let tracer = tracer(&scene, &moment);
        let (accuracy, _) = measure::accuracy(&tracer.frame(size), &tested, &tracer).unwrap();
        let count = tested.reflector_pixels().len() as f64;
        bad += accuracy.bad_share.half * count;
        pixels += count;
        let rays = times.counters.iter().find(|(name, _)| name == "rays").unwrap().1;
        assert!(rays as f64 >= count, "{name}: {rays} rays for {count} pixels");
    }
    println!("{name}: {bad} of {pixels} pixels");
    bad / pixels
}

/// Nothing but what rounding makes of edges.
const MOST: f64 = 5e-4;

#[test]
fn it_is_the_truth_on_every_shipped_scene() {
    let session = Session::open();
    for (name, _) in scene::list().unwrap() {
        let bad = bad_share(&session, &name, "ray-traced", [640, 400]);
        assert!(bad < MOST, "{name}: {bad}");
    }
}

/// Small pictures of scenes of every sort: still and moving, flat and curved, mirrors and glass.
fn hold_to_the_truth(session: &Session, case: &str) {
    for name in ["columns", "two-spheres", "hall-of-mirrors", "glass-sphere", "teapot"] {
        let bad = bad_share(session, name, case, [320, 200]);
        assert!(bad < 4.0 * MOST, "{name}: {bad}");
    }
}

#[test]
fn the_wide_tree_leads_to_the_truth_too() {
    hold_to_the_truth(&Session::open(), "ray-traced:tree=wide");
}

#[test]
fn the_devices_own_rays_are_the_truth_too_or_are_refused() {
    let session = Session::open();
    let case = "ray-traced:backend=query";
    if session.device().has_ray_query() {
        hold_to_the_truth(&session, case);
        return;
    }
    let scene = scene::load("columns").unwrap();
    let parsed = Case::parse(case, &methods()).unwrap();
    let made = Engine::new(session.device(), &scene, &parsed, &methods(), &options([64, 64]));
    let error = made.err().expect("a device without ray queries refuses them");
    assert_eq!(error.exit_code(), 3);
    assert!(error.to_string().contains("backend=software"), "{error}");
}

#[test]
fn fitting_the_tree_to_what_moved_is_as_good_as_building_it() {
    let (session, scene) = (Session::open(), scene::load("two-spheres").unwrap());
    let [refit, rebuilt] = ["refit", "rebuild"].map(|update| {
        let case = format!("ray-traced:update={update}");
        let mut engine = engine(&session, &scene, &case, &options([128, 96]));
        engine.frame(&scene.at(0), true).unwrap();
        engine.frame(&scene.at(40), false).unwrap()
    });
    let names =
        |times: &FrameTimes| times.prepare.iter().map(|pass| pass.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&rebuilt.1), ["ray-traced/build"]);
    assert!(names(&refit.1).contains(&"ray-traced/refit".to_owned()), "{:?}", names(&refit.1));
    // The moved corners are placed by the processor in one and by the GPU in the other.
    let same = |i: &usize| {
        let [a, b] = [&refit.0, &rebuilt.0].map(|frame| &frame.record);
        a.ids[*i] == b.ids[*i] && a.point[*i].abs_diff_eq(b.point[*i], 1e-4)
    };
    let pixels = refit.0.reflector_pixels();
    let equal = pixels.iter().filter(|i| same(i)).count();
    assert!(equal + 2 >= pixels.len(), "{equal} of {} pixels are the same", pixels.len());
}

#[test]
fn the_fallback_traces_what_a_method_leaves() {
    let session = Session::open();
    for name in ["two-spheres", "glass-sphere"] {
        let scene = scene::load(name).unwrap();
        let size = [96, 64];
        let traced = frame(&session, &scene, "ray-traced:tree=binary", size, 5);
        let mended = |case: &str| {
            let options = RunOptions { fallback: Fallback::Ray, ..options(size) };
            engine(&session, &scene, case, &options).frame(&scene.at(5), true).unwrap()
        };
        let (all, times) = mended("none");
        let filled = times.counters.iter().find(|(name, _)| name == "fallback-pixels").unwrap().1;
        let pixels = all.reflector_pixels();
        for (record, expected) in records(&all).zip(records(&traced)) {
            for &i in &pixels {
                assert_eq!(record.ids[i].source(), Source::FallbackRay);
                assert_eq!(
                    (record.point[i], record.radiance[i]),
                    (expected.point[i], expected.radiance[i])
                );
            }
        }
        assert_eq!(filled as usize, pixels.len() * records(&all).count());
        assert_eq!(all.colour, traced.colour);
        // Nothing is left by a method that answers everywhere.
        let (untouched, times) = mended("ray-traced:tree=binary");
        assert_eq!(untouched, traced);
        assert!(times.counters.contains(&("fallback-pixels".to_owned(), 0)));
    }
}

/// Of every lobe.
fn records(frame: &FrameRecord) -> impl Iterator<Item = &ReflectionRecord> {
    [Lobe::Reflected, Lobe::Refracted].into_iter().filter_map(|lobe| frame.lobe(lobe))
}

#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct GivenRay {
    origin: Vec4,
    direction: Vec4,
    start: [u32; 4],
}

#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
struct Met {
    ids: [u32; 4],
    position: Vec4,
}

/// What rays meet on the GPU, with the tree laid out as given.
fn met(session: &Session, scene: &Scene, layout: TreeLayout, rays: &[GivenRay]) -> Vec<Met> {
    let device = session.device();
    let mut gpu_scene = GpuScene::new(device, &Arc::new(scene.clone())).unwrap();
    let mut tree = SceneTree::new(device, layout).unwrap();
    let pipeline = ComputePipeline::new(device, "tests/trace.wgsl", &layout.defines()).unwrap();
    let given = Buffer::with_data(device, "rays", rays).unwrap();
    let zero = vec![Met::zeroed(); rays.len()];
    let answer = Buffer::with_data(device, "met", &zero).unwrap();
    let mut frame = Frame::new(device).unwrap();
    frame.begin().unwrap();
    gpu_scene.pose(&mut frame, &scene.at(0)).unwrap();
    tree.prepare(&mut frame, &gpu_scene, "test").unwrap();
    // A second time: everything that may move is placed and fitted where it already is.
    tree.prepare(&mut frame, &gpu_scene, "test").unwrap();
    let pass = tree.bind(gpu_scene.bind(frame.pass("test/trace").compute(&pipeline)));
    pass.buffer("rays", &given).buffer("met", &answer).over(rays.len() as u32).unwrap();
    frame.submit().unwrap();
    answer.read().unwrap()
}

#[test]
fn rays_meet_on_the_gpu_what_they_meet_on_the_processor() {
    let (session, scene) = (Session::open(), scene::load("two-spheres").unwrap());
    let moment = scene.at(0);
    let tracer = tracer(&scene, &moment);
    let size = [96, 64];
    let mut rays = Vec::new();
    let mut expected: Vec<Option<Hit>> = Vec::new();
    for y in 0..size[1] {
        for x in 0..size[0] {
            let at = glam::Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
            let eye = moment.camera.ray(size, at);
            let Some(hit) = tracer.look(&eye) else { continue };
            let Some(chain) = tracer.chain(hit, eye.direction, Lobe::Reflected) else { continue };
            for bounce in &chain.bounces {
                let Hit { object, triangle, point, .. } = bounce.hit;
                rays.push(GivenRay {
                    origin: point.extend(0.0),
                    direction: bounce.outgoing.extend(0.0),
                    start: [object, triangle, u32::from(bounce.outside()), 0],
                });
                expected.push(tracer.leave(bounce));
            }
        }
    }
    assert!(rays.len() > 1000);
    let bytes = 48 * scene.triangles() as u64;
    for kind in [TreeKind::Binary(TreeUpdate::Refit), TreeKind::Wide] {
        let whole = TreeLayout::new(&scene, kind, 1 << 27).unwrap();
        let cut = TreeLayout::new(&scene, kind, bytes * 3 / 5).unwrap();
        assert_ne!(whole.defines(), cut.defines());
        let on_gpu = met(&session, &scene, whole, &rays);
        assert_eq!(met(&session, &scene, cut, &rays), on_gpu, "{kind:?} cut into parts");
        let mut differ = 0;
        for (met, expected) in on_gpu.iter().zip(&expected) {
            differ += u32::from(match expected {
                None => met.ids[0] != 0,
                Some(hit) => {
                    met.ids != [1, hit.object, hit.triangle, u32::from(hit.front)]
                        || !met.position.xyz().abs_diff_eq(hit.point, 1e-4)
                }
            });
        }
        // Rays between two triangles may fall to either.
        assert!(differ <= 3, "{kind:?}: {differ} of {} rays", rays.len());
    }
}
