//! The search of interval maps: the pyramid finds what a scan of every texel finds, in few steps, and
//! its maths agrees with the Rust twin's.

mod gpu_support;

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use glam::{Vec3, Vec4, Vec4Swizzles};
use gpu_support::Session;
use mirrorbench::geometry::face_ray;
use mirrorbench::geometry::random::SplitMix64;
use mirrorbench::gpu::{Buffer, ComputePipeline, Frame};
use mirrorbench::scene::{self, Scene};
use mirrorbench::stages::{Certificate, GpuScene, IntervalMap, IntervalStage, RecordMode};

/// WGSL `Rays` of `shaders/tests/search.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Rays {
    reach: [f32; 3],
    seed: u32,
}

/// What random rays through a scene's map count.
#[derive(Debug)]
struct Counts {
    rays: u32,
    found: u32,
    different: u32,
    visits_mean: f64,
    visits_p99: usize,
}

/// Rays from all over the first reflector's box, searched for in the map taken from its middle.
fn searched(session: &Session, scene: &Scene, size: u32, layers: u32, rays: u32) -> Counts {
    let device = session.device();
    let mut gpu_scene = GpuScene::new(device, &Arc::new(scene.clone())).unwrap();
    let mode = RecordMode::Radiance;
    let mut map = IntervalMap::new(device, "test", size, layers, mode).unwrap();
    let stage = IntervalStage::new(device, mode, Certificate::Edges).unwrap();
    let search = ComputePipeline::new(device, "tests/search.wgsl", &[]).unwrap();
    let counts = Buffer::storage(device, "counts", 4 * (6 + 256)).unwrap();
    let (moment, reflectors) = (scene.at(0), scene.reflectors());
    let (_, objects) = &scene.groups(&reflectors)[0];
    let (low, high) = scene.bounds_of(&moment, objects);
    let reach = Rays { reach: (0.5 * (high - low)).to_array(), seed: 7 };
    let mut frame = Frame::new(device).unwrap();
    frame.begin().unwrap();
    gpu_scene.pose(&mut frame, &moment).unwrap();
    let centre = 0.5 * (low + high);
    stage.capture(&mut frame, &gpu_scene, "test", &mut map, centre, objects).unwrap();
    frame.pass("test/clear").fill(&[&counts], 0).unwrap();
    let pass = map.bind(frame.pass("test/search").compute(&search));
    pass.uniform("rays", &reach).buffer("counts", &counts).over(rays).unwrap();
    frame.submit().unwrap();
    let words = counts.read::<u32>().unwrap();
    let (rays, visited) = (words[0], &words[6..]);
    let mut left = rays - rays / 100;
    let within = |&n: &u32| {
        left = left.saturating_sub(n);
        left == 0
    };
    Counts {
        rays,
        found: words[1],
        different: words[3],
        visits_mean: f64::from(words[4]) / f64::from(rays),
        visits_p99: visited.iter().position(within).unwrap(),
    }
}

#[test]
fn the_pyramid_finds_what_a_scan_finds_on_a_million_rays() {
    let session = Session::open();
    let names: Vec<String> = scene::list().unwrap().into_iter().map(|(name, _)| name).collect();
    let each = 1_000_000u32.div_ceil(names.len() as u32).next_multiple_of(64) + 1024;
    let (mut rays, mut found) = (0, 0);
    for name in names {
        let counts = searched(&session, &scene::load(&name).unwrap(), 32, 2, each);
        assert_eq!(counts.different, 0, "{name}: {counts:?}");
        rays += counts.rays;
        found += counts.found;
    }
    assert!(rays >= 1_000_000, "only {rays} rays");
    assert!(found > rays / 4, "only {found} of {rays} rays meet anything");
}

#[test]
fn visits_grow_with_the_logarithm_of_the_map() {
    let (session, scene) = (Session::open(), scene::load("clutter-60").unwrap());
    let means: Vec<f64> = [64, 128, 256]
        .map(|size| {
            let counts = searched(&session, &scene, size, 1, 4096);
            assert!(counts.visits_p99 < 80, "{size}: {counts:?}");
            counts.visits_mean
        })
        .into();
    // At most 40 at 1024 and 6 more each time the side doubles.
    assert!(means[2] <= 40.0 - 2.0 * 6.0, "{means:?}");
    assert!(means.windows(2).all(|pair| pair[1] - pair[0] <= 6.0), "{means:?}");
}

/// Takes minutes: `cargo test --release --test interval_map -- --ignored --nocapture`.
#[test]
#[ignore = "measures, at sizes beyond a quick suite"]
fn measure_visits() {
    let session = Session::open();
    let names = [
        "patow-room",
        "columns",
        "window-teapot",
        "square-mirror",
        "clutter-60",
        "clutter-150",
        "clutter-400",
        "sticks",
    ];
    for name in names {
        for (size, layers) in [(512, 1), (1024, 1), (512, 2), (1024, 2)] {
            let counts = searched(&session, &scene::load(name).unwrap(), size, layers, 1 << 15);
            println!("{name} size={size} layers={layers}: {counts:?}");
        }
    }
}

#[test]
fn rays_are_cut_at_the_same_seams_as_in_rust() {
    let session = Session::open();
    let device = session.device();
    let mut random = SplitMix64::new(11);
    let rays: Vec<(Vec3, Vec3)> = (0..4096)
        .map(|_| (random.within(Vec3::NEG_ONE, Vec3::ONE), random.rotation() * Vec3::X))
        .collect();
    let inputs: Vec<Vec4> =
        rays.iter().flat_map(|(start, way)| [start.extend(0.0), way.extend(0.0)]).collect();
    let pipeline = ComputePipeline::new(device, "tests/face_ray.wgsl", &[]).unwrap();
    let given = Buffer::with_data(device, "rays", &inputs).unwrap();
    let answer = Buffer::storage(device, "pieces", 16 * 12 * rays.len() as u64).unwrap();
    let mut frame = Frame::new(device).unwrap();
    frame.begin().unwrap();
    let pass = frame.pass("test/face-ray").compute(&pipeline);
    pass.buffer("rays", &given).buffer("pieces", &answer).over(rays.len() as u32).unwrap();
    frame.submit().unwrap();
    let answers = answer.read::<Vec4>().unwrap();
    let mut elsewhere = 0;
    for ((start, way), pieces) in rays.iter().zip(answers.chunks(12)) {
        let expected = face_ray::segments(*start, *way, 64);
        let same = expected.iter().zip(pieces.chunks(2)).all(|(piece, out)| {
            let close = |a: Vec3, b: Vec3| {
                a.truncate().abs_diff_eq(b.truncate(), 0.01) && (a.z - b.z).abs() <= 1e-3 * b.z
            };
            out[0].w as u32 == piece.face
                && close(out[0].xyz(), piece.begin)
                && close(out[1].xyz(), piece.end)
        });
        let count = pieces.chunks(2).filter(|out| out[1].w == 1.0).count();
        elsewhere += u32::from(!same || count != expected.len());
    }
    // At a corner of the cube, where three faces meet, roundings decide which comes first.
    assert!(elsewhere <= 4, "{elsewhere} of {} rays are cut elsewhere", rays.len());
}
