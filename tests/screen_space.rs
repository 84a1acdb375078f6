//! Screen space: the pyramid meets the pixel that a walk over all pixels meets; rays that stay on the
//! screen agree with the truth; the others are few on flat mirrors and most on convex ones.

mod gpu_support;
mod truth_support;

use std::sync::Arc;

use glam::{Vec2, Vec4, Vec4Swizzles};
use gpu_support::{Session, engine, judged, options, tracer};
use mirrorbench::experiment::engine::Fallback;
use mirrorbench::geometry::random::SplitMix64;
use mirrorbench::gpu::{Buffer, ComputePipeline, Device, Format, Frame, Image, Shape};
use mirrorbench::measure;
use mirrorbench::scene::{self, Scene, Status};
use mirrorbench::stages::DepthPyramid;

const THICKNESS: f32 = 0.05;
const RAYS: u32 = 100_000;

/// A view's depth and objects: blocks of surfaces at all depths, nothing in between; object 0 is the
/// one that rays start on.
struct View {
    size: [u32; 2],
    texels: Vec<Vec2>,
}

impl View {
    fn random(size: [u32; 2], random: &mut SplitMix64) -> View {
        let mut texels = vec![Vec2::new(f32::INFINITY, 9.0); (size[0] * size[1]) as usize];
        for _ in 0..size[0] * size[1] / 20 {
            let depth = 0.4 + 8.0 * random.unit() * random.unit();
            let object = random.below(4) as f32;
            let low = size.map(|side| random.below(side as usize) as u32);
            let extent = size.map(|side| 1 + random.below(side as usize / 8 + 1) as u32);
            for y in low[1]..(low[1] + extent[1]).min(size[1]) {
                for x in low[0]..(low[0] + extent[0]).min(size[0]) {
                    texels[(y * size[0] + x) as usize] = Vec2::new(depth, object);
                }
            }
        }
        View { size, texels }
    }

    fn upload(&self, device: &Arc<Device>, frame: &mut Frame) -> (Image, Image) {
        let image =
            |name, format| Image::new(device, name, format, self.size, Shape::Flat).unwrap();
        let (depth, object) = (image("depth", Format::R32Float), image("object", Format::R32Uint));
        let fill = ComputePipeline::new(device, "tests/screen_image.wgsl", &[]).unwrap();
        let texels = Buffer::with_data(device, "texels", &self.texels).unwrap();
        let pass = frame.pass("test/image").compute(&fill).buffer("texels", &texels);
        pass.store("depth", &depth).store("object", &object).over_pixels(self.size).unwrap();
        (depth, object)
    }

    /// Whether a ray between two depths meets the surface of a pixel.
    fn stops(&self, pixel: [i64; 2], a: f64, b: f64) -> bool {
        let texel = self.texels[pixel[1] as usize * self.size[0] as usize + pixel[0] as usize];
        let surface = f64::from(texel.x);
        let thick = surface * (1.0 + f64::from(THICKNESS));
        surface.is_finite() && texel.y != 0.0 && a.max(b) >= surface && a.min(b) <= thick
    }

    /// The pixel a ray meets: all its crossings of pixel borders, in double precision and in order.
    fn walked(&self, start: Vec4, change: Vec4) -> Option<[i64; 2]> {
        let (from, by) = (start.as_dvec4(), change.as_dvec4());
        let depth = |time: f64| {
            let z = from.z + time * by.z;
            if from.w == 1.0 { 1.0 / z.max(1e-37) } else { z }
        };
        let mut crossings = Vec::new();
        for axis in 0..2 {
            for border in 0..=self.size[axis] {
                let time = (f64::from(border) - from[axis]) / by[axis];
                if time > 0.0 && time < 1.0 {
                    crossings.push(time);
                }
            }
        }
        crossings.push(1.0);
        crossings.sort_by(f64::total_cmp);
        // What lies before the first border is the pixel it starts in.
        crossings.windows(2).find_map(|pair| {
            let middle = 0.5 * (pair[0] + pair[1]);
            let pixel = [0, 1].map(|axis| (from[axis] + middle * by[axis]).floor() as i64);
            let inside = (0..2).all(|axis| (0..i64::from(self.size[axis])).contains(&pixel[axis]));
            (inside && self.stops(pixel, depth(pair[0]), depth(pair[1]))).then_some(pixel)
        })
    }
}

/// Rays across the view: start and change.
fn random_rays(size: [u32; 2], random: &mut SplitMix64) -> Vec<Vec4> {
    let side = Vec2::new(size[0] as f32, size[1] as f32);
    let mut rays = Vec::with_capacity(2 * RAYS as usize);
    for i in 0..RAYS {
        let mut place = || side * Vec2::new(random.unit(), random.unit());
        let (mut start, mut end) = (place(), place());
        match i % 8 {
            // On a corner of pixels, along an axis, through corners alone.
            0 => start = start.floor(),
            1 => end.x = start.x,
            2 => end.y = start.y,
            3 => {
                start = start.floor();
                end = start + (end.x - start.x).abs().floor() * (end - start).signum();
            }
            _ => {}
        }
        let inverted = i % 3 != 0;
        let mut depth = || 0.3 + 9.0 * random.unit();
        let (a, b) = (depth(), depth());
        let (a, b) = if inverted { (1.0 / a, 1.0 / b) } else { (a, b) };
        rays.push(start.extend(a).extend(f32::from(inverted)));
        rays.push((end - start).extend(b - a).extend(0.0));
    }
    rays
}

/// What each ray meets over the finest `levels` of the pyramid: pixel, 1 where found, visits.
fn seen(session: &Session, view: &View, rays: &[Vec4], levels: Option<u32>) -> Vec<Vec4> {
    let device = session.device();
    let pyramid = DepthPyramid::new(device, view.size).unwrap();
    let follow = ComputePipeline::new(device, "tests/screen_rays.wgsl", &[]).unwrap();
    let given = Buffer::with_data(device, "rays", rays).unwrap();
    let answer = Buffer::storage(device, "seen", 16 * u64::from(RAYS)).unwrap();
    let mut frame = Frame::new(device).unwrap();
    frame.begin().unwrap();
    let (depth, object) = view.upload(device, &mut frame);
    pyramid.build(&mut frame, "test", &depth).unwrap();
    let levels = levels.unwrap_or(pyramid.cells.levels);
    let pass = frame.pass("test/rays").compute(&follow).sample("direct_object", &object);
    let pass = pass.sample("pyramid", &pyramid.cells).buffer("inputs", &given);
    let limits = [THICKNESS.to_bits(), 65536, levels, 0];
    pass.uniform("limits", &limits).buffer("outputs", &answer).over(RAYS).unwrap();
    frame.submit().unwrap();
    answer.read().unwrap()
}

#[test]
fn the_pyramid_meets_the_pixel_that_a_walk_over_all_meets() {
    let (session, mut random) = (Session::open(), SplitMix64::new(3));
    for size in [[128, 64], [97, 61], [33, 100], [5, 3], [1, 7]] {
        let view = View::random(size, &mut random);
        let rays = random_rays(size, &mut random);
        let by_pyramid = seen(&session, &view, &rays, None);
        let by_pixel = seen(&session, &view, &rays, Some(1));
        let (mut found, mut visits, mut differ) = (0, [0.0; 2], 0);
        for (i, (a, b)) in by_pyramid.iter().zip(&by_pixel).enumerate() {
            assert_eq!(a.xyz(), b.xyz(), "{size:?}, ray {i}: {} {}", rays[2 * i], rays[2 * i + 1]);
            found += u32::from(a.z == 1.0);
            visits = [visits[0] + a.w, visits[1] + b.w];
            let here = (a.z == 1.0).then_some([a.x as i64, a.y as i64]);
            // Through corners of pixels rounding decides where a ray goes.
            if i % 8 != 0 && i % 8 != 3 {
                differ += u32::from(view.walked(rays[2 * i], rays[2 * i + 1]) != here);
            }
        }
        println!("{size:?}: {found} found, {visits:?} visits, {differ} unlike in double precision");
        assert!(size[0] < 10 || found > RAYS / 10, "{size:?}: only {found} met anything");
        assert!(size[0] < 100 || visits[0] < 0.8 * visits[1], "{size:?}: {visits:?} visits");
        assert!(differ < RAYS / 1000, "{size:?}: {differ} unlike a walk in double precision");
    }
}

/// A mirror on the floor before a wall and a box: nearly all it shows is on the screen.
const POOL: &str = r#"
[camera]
fov_deg = 60.0
eye = [0.0, 1.2, 4.0]
target = [0.0, 0.7, -2.0]
[[objects]]
name = "pool"
shape = { plane = { size = [3.0, 3.0] } }
material = "mirror"
[[objects]]
name = "wall"
shape = { plane = { size = [12.0, 8.0] } }
material = "floor"
position = [0.0, 2.0, -2.0]
rotation_deg = [90.0, 0.0, 0.0]
[[objects]]
name = "box"
shape = { box = { size = [0.8, 0.8, 0.4] } }
material = "red"
position = [0.4, 0.5, -1.7]
"#;

#[test]
fn rays_that_stay_on_the_screen_agree_with_the_truth() {
    let (session, scene) = (Session::open(), truth_support::scene(POOL));
    for size in [[128, 96], [127, 93]] {
        let (tested, accuracy, maps) =
            judged(&session, &scene, "screen-space:miss=missing", size, 0);
        println!("{size:?}: {accuracy:?}");
        assert!(accuracy.missing < 0.15, "{accuracy:?}");
        assert!(accuracy.wrong_object < 0.02 && accuracy.spurious == 0.0, "{accuracy:?}");
        let displacement = accuracy.displacement_px.unwrap();
        assert!(displacement.median < 0.5 && displacement.p95 < 1.5, "{displacement:?}");
        // Found or not looked for: nothing doubted, nothing of its own shown.
        for i in tested.reflector_pixels() {
            let ids = tested.record.ids[i];
            assert!(!ids.flag() && ids.status() != Status::Environment);
            assert!(maps.displacement_px[i].is_nan() || ids.status() == Status::Found);
        }
    }
}

#[test]
fn triangles_shown_are_the_truths() {
    let (session, scene) = (Session::open(), truth_support::scene(POOL));
    let (tested, ..) = judged(&session, &scene, "screen-space", [128, 96], 0);
    let truth = tracer(&scene, &scene.at(0)).frame([128, 96]);
    let found: Vec<usize> = truth_support::found(&tested).collect();
    let same = |i: &&usize| {
        let (a, b) = (tested.record.ids[**i], truth.record.ids[**i]);
        (a.object, a.triangle) == (b.object, b.triangle)
    };
    let share = found.iter().filter(same).count() as f64 / found.len() as f64;
    assert!(share > 0.95, "{share} of {}", found.len());
}

/// One frame with what it counted, and the share of its reflector pixels that met the screen.
fn hit_share(session: &Session, scene: &Scene, case: &str) -> f64 {
    let mut engine = engine(session, scene, case, &options([128, 96]));
    let (frame, times) = engine.frame(&scene.at(0), true).unwrap();
    let hits = times.counters.iter().find(|(name, _)| name == "hits").unwrap().1;
    hits as f64 / frame.reflector_pixels().len() as f64
}

#[test]
fn a_convex_mirror_gets_little_from_the_screen_and_the_fallback_the_rest() {
    // ALGORITHMS T12.
    let session = Session::open();
    let scene = scene::load("patow-room").unwrap();
    let share = hit_share(&session, &scene, "screen-space");
    assert!(share < 0.25, "{share}");
    assert!(hit_share(&session, &truth_support::scene(POOL), "screen-space") > 0.9);
    let mended = gpu_support::options([128, 96]);
    let mended = mirrorbench::experiment::engine::RunOptions { fallback: Fallback::Ray, ..mended };
    let mut engine = engine(&session, &scene, "screen-space", &mended);
    let (tested, _) = engine.frame(&scene.at(0), true).unwrap();
    let tracer = tracer(&scene, &scene.at(0));
    let (accuracy, _) = measure::accuracy(&tracer.frame([128, 96]), &tested, &tracer).unwrap();
    assert!(accuracy.bad_share.one < 0.1, "{accuracy:?}");
}

#[test]
fn a_mirror_met_on_the_screen_gives_no_answer() {
    let (session, scene) = (Session::open(), scene::load("hall-of-mirrors").unwrap());
    let mirrors = scene.reflectors();
    let (tested, ..) = judged(&session, &scene, "screen-space:miss=missing", [128, 96], 60);
    let found: Vec<usize> = truth_support::found(&tested).collect();
    assert!(found.len() > 20, "{}", found.len());
    assert!(found.iter().all(|&i| !mirrors.contains(&tested.record.ids[i].object)));
}
