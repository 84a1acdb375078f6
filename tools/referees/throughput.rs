//! Rays a second of the truth beside Embree's: `cargo bench --bench referees`.
//!
//! One thread each, the same triangles and the same rays, batch by batch in random order, one after
//! the other on each batch, the first chosen by lot; so what else the machine does meets both alike.
//! Only Embree's own call is timed, not the pipe to it. A ratio is the median over the batches
//! with its 95 % bootstrap interval.
//!
//! Then the whole process against POV-Ray's, from its start to the picture on disk, all threads.

#[path = "../../tests/referee_support/mod.rs"]
mod support;

use std::fs;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use mirrorbench::geometry::Ray;
use mirrorbench::geometry::bvh::Bvh;
use mirrorbench::measure::statistics::{SplitMix64, median, median_ci95};
use mirrorbench::scene::{Scene, load};
use mirrorbench::truth::{Bounce, Tracer, TruthOptions};
use support::embree::Embree;
use support::pov_file::{self, Look};
use support::povray;

const SIZE: [u32; 2] = [512, 512];
const BATCH: usize = 5000;
const ROUNDS: usize = 15;

fn main() {
    // Embree's quicker mode, that of its default scene flags.
    let mut embree = Embree::start(false);
    println!("million rays a second on one thread");
    println!("scene    triangles  rays               ours  Embree  ratio");
    compare("fine", &support::fine(), 0, &mut embree);
    // Late on its path the camera is close to a mirror.
    compare("kitchen", &load("kitchen").expect("a shipped scene"), 150, &mut embree);
    drop(embree);
    whole_process();
}

fn compare(name: &str, scene: &Scene, frame: u32, embree: &mut Embree) {
    let moment = scene.at(frame);
    let triangles = support::triangles(scene, &moment);
    let tracer = Tracer::new(scene, &moment, TruthOptions::default());
    let bvh = Bvh::new(&triangles);
    embree.load(&triangles);
    let tree = |ray: &Ray| bvh.nearest(ray, [0.0, f32::INFINITY], |_, _| true).map(|hit| hit.t);
    let leave = |bounce: &Bounce| tracer.leave(bounce).map(|hit| hit.distance);

    let primary = support::primary(&moment, SIZE);
    let mirrored = support::mirrored(&tracer, SIZE);
    let raised: Vec<Ray> = mirrored.iter().map(support::raised).collect();
    for (rays, rates) in [
        ("primary, tree", race(&primary, tree, Ray::clone, embree)),
        ("mirrored, tree", race(&raised, tree, Ray::clone, embree)),
        ("mirrored, tracer", race(&mirrored, leave, support::raised, embree)),
    ] {
        let Rates { ours, theirs, ratio, interval: [low, high] } = rates;
        let count = triangles.len();
        println!(
            "{name:8} {count:9}  {rays:16} {ours:6.2}  {theirs:6.2}  {ratio:.3} [{low:.3}, {high:.3}]"
        );
    }
}

struct Rates {
    ours: f64,
    theirs: f64,
    ratio: f64,
    interval: [f64; 2],
}

/// Times `trace` on all of `items` and Embree on the `ray` of each.
fn race<T>(
    items: &[T],
    trace: impl Fn(&T) -> Option<f32>,
    ray: impl Fn(&T) -> Ray,
    embree: &mut Embree,
) -> Rates {
    let mut random = SplitMix64::new(1);
    let mut batches: Vec<&[T]> = (0..ROUNDS).flat_map(|_| items.chunks_exact(BATCH)).collect();
    random.shuffle(&mut batches);
    let own = |batch: &[T]| -> Duration {
        let start = Instant::now();
        let distances: Vec<Option<f32>> = batch.iter().map(&trace).collect();
        let time = start.elapsed();
        std::hint::black_box(distances);
        time
    };
    let times = batches.iter().map(|batch| {
        let rays: Vec<Ray> = batch.iter().map(&ray).collect();
        if random.below(2) == 0 {
            (own(batch), embree.trace(&rays).0)
        } else {
            let theirs = embree.trace(&rays).0;
            (own(batch), theirs)
        }
    });
    let times: Vec<[f64; 2]> = times.map(|(a, b)| [a.as_secs_f64(), b.as_secs_f64()]).collect();
    let each = |value: fn(&[f64; 2]) -> f64| times.iter().map(value).collect::<Vec<f64>>();
    let rate = |seconds: Vec<f64>| median(&seconds).map(|time| 1e-6 * BATCH as f64 / time);
    let ratios = each(|[ours, theirs]| theirs / ours);
    Rates {
        ours: rate(each(|times| times[0])).expect("rays"),
        theirs: rate(each(|times| times[1])).expect("rays"),
        ratio: median(&ratios).expect("rays"),
        interval: median_ci95(&ratios, 1).expect("rays"),
    }
}

/// `columns` at 512x512 with spheres in closed form, nothing cached, in turns with POV-Ray.
fn whole_process() {
    const SIDE: u32 = 512;
    let folder = tempfile::tempdir().expect("a temporary folder");
    let scene = load("columns").expect("a shipped scene");
    let file = pov_file::write(&scene, &scene.at(0), Look::Flat);
    fs::write(folder.path().join("scene.pov"), file).expect("a temporary file");
    let render = || {
        let cache = folder.path().join("cache");
        let status = Command::new(env!("CARGO_BIN_EXE_mirrorbench"))
            .args(["render", "--scene", "columns", "--case", "truth:shapes=analytic"])
            .args(["--size", &format!("{SIDE}x{SIDE}"), "--out"])
            .arg(folder.path().join("out"))
            .env("MIRRORBENCH_CACHE", &cache)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .status();
        assert!(status.is_ok_and(|status| status.success()), "mirrorbench render failed");
        fs::remove_dir_all(cache).expect("the frame just cached");
    };
    let timed = |run: &dyn Fn()| {
        let start = Instant::now();
        run();
        start.elapsed().as_secs_f64()
    };
    let times: Vec<[f64; 2]> = (0..ROUNDS)
        .map(|_| [timed(&render), timed(&|| povray::run(folder.path(), SIDE))])
        .collect();
    let each = |value: fn(&[f64; 2]) -> f64| times.iter().map(value).collect::<Vec<f64>>();
    let [ours, theirs] =
        [each(|times| times[0]), each(|times| times[1])].map(|times| median(&times));
    let ratios = each(|[ours, theirs]| theirs / ours);
    println!(
        "whole process, columns at {SIDE}x{SIDE}: {:.2} s, POV-Ray {:.2} s, ratio {:.2} {:.2?}",
        ours.expect("times"),
        theirs.expect("times"),
        median(&ratios).expect("times"),
        median_ci95(&ratios, 1).expect("times")
    );
}
