//! What each parameter of `virtual-objects@published` that the paper leaves open does (ALGORITHMS T13,
//! T16): the work counted, and the error against the truth.

mod gpu_support;

use std::collections::BTreeMap;

use gpu_support::{Session, engine, options, tracer};
use mirrorbench::measure;
use mirrorbench::scene::{self, Scene};

const SIZE: [u32; 2] = [128, 72];

/// What a case of virtual objects gives on one frame.
struct Outcome {
    /// `bad_share` at 1 px.
    bad: f64,
    counters: BTreeMap<String, u64>,
}

impl Outcome {
    fn count(&self, name: &str) -> u64 {
        self.counters[name]
    }
}

fn outcome(session: &Session, scene: &Scene, parameters: &str, at: u32) -> Outcome {
    let moment = scene.at(at);
    let case = format!("virtual-objects:{parameters}");
    let (frame, times) =
        engine(session, scene, &case, &options(SIZE)).frame(&moment, true).unwrap();
    let tracer = tracer(scene, &moment);
    let (accuracy, _) = measure::accuracy(&tracer.frame(SIZE), &frame, &tracer).unwrap();
    Outcome { bad: accuracy.bad_share.one, counters: times.counters.into_iter().collect() }
}

/// The outcomes of several values on the first frame of `columns`.
fn columns<const N: usize>(parameters: [&str; N]) -> [Outcome; N] {
    let (session, scene) = (Session::open(), scene::load("columns").unwrap());
    parameters.map(|parameters| outcome(&session, &scene, parameters, 0))
}

#[test]
fn half_precision_does_no_harm_in_coarse_textures_and_ruins_fine_ones() {
    // In fp16 neighbours of a fine texture share their points (T13: "fp16 breaks at n >= 512").
    let single = columns(["texture=128", "texture=512", "texture=2048"]).map(|o| o.bad);
    let half = columns([
        "texture=128,precision=fp16",
        "texture=512,precision=fp16",
        "texture=2048,precision=fp16",
    ])
    .map(|o| o.bad);
    assert!((half[0] - single[0]).abs() < 0.02, "{half:?} against {single:?} at 128");
    assert!(half[1] > 1.05 * single[1], "{half:?} against {single:?} at 512");
    assert!(half[2] > 4.0 * single[2], "{half:?} against {single:?} at 2048");
    // Finer textures help in fp32 all along; in fp16 they come to hurt.
    assert!(single[0] > 2.0 * single[1] && single[1] > 2.0 * single[2], "{single:?}");
    assert!(half[0] > half[1] && half[2] > half[1], "{half:?}");
}

#[test]
fn a_wider_frustum_mends_the_border_of_a_reflector_that_leaves_the_view() {
    // Texels as fine in both, or resolution would be compared, and long triangles, which stretch.
    let (session, scene) = (Session::open(), scene::load("columns-turn").unwrap());
    for frame in [60, 72, 84] {
        let [as_seen, wider] = ["widening=1,texture=640", "widening=1.2,texture=768"]
            .map(|p| outcome(&session, &scene, &format!("{p},subdivide=1"), frame).bad);
        assert!(wider < 0.95 * as_seen, "frame {frame}: {wider} against {as_seen}");
    }
}

#[test]
fn a_wider_frustum_costs_resolution_where_the_reflector_is_in_view() {
    let [as_seen, wider, twice] =
        columns(["texture=256,widening=1", "texture=256", "texture=256,widening=2"]).map(|o| o.bad);
    assert!(as_seen < wider && wider < twice, "{as_seen} {wider} {twice}");
}

#[test]
fn a_capped_search_stops_short() {
    let [four, sixteen, enough, free] = columns([
        "texture=256,cap=4",
        "texture=256,cap=16",
        "texture=256,cap=64",
        "texture=256,cap=65535",
    ]);
    assert_eq!((four.count("max-steps"), sixteen.count("max-steps")), (4, 16));
    assert!(free.count("max-steps") < 64, "the cap of 64 is none");
    assert_eq!(enough.counters, free.counters);
    assert_eq!(enough.bad, free.bad);
    assert!(four.count("steps") < sixteen.count("steps"));
    assert!(sixteen.count("steps") < free.count("steps"));
    assert!(four.bad > sixteen.bad && sixteen.bad > free.bad + 0.05, "{}", sixteen.bad);
}

#[test]
fn a_lower_threshold_saves_steps_and_costs_accuracy() {
    let found = columns([
        "texture=256,threshold=0.9",
        "texture=256,threshold=0.99",
        "texture=256,threshold=0.999",
        "texture=256,threshold=1",
    ]);
    for pair in found.windows(2) {
        let [low, high] = pair else { unreachable!() };
        assert!(low.count("steps") < high.count("steps"));
        assert!(low.bad > high.bad + 0.02, "{} against {}", low.bad, high.bad);
    }
    // Not a saving worth its price: N.B is flat at its maximum, where most steps are needed.
    let [cheap, full] = [&found[1], &found[3]];
    assert!(10 * cheap.count("steps") > 8 * full.count("steps") && cheap.bad > 1.5 * full.bad);
}

#[test]
fn on_a_sphere_patterns_differ_in_work_alone() {
    let [cross, diagonals, eight] = columns([
        "texture=256,pattern=crosshair",
        "texture=256,pattern=crosshair-diagonals",
        "texture=256,pattern=eight",
    ]);
    // A diagonal step is worth two, and costs eight looks.
    assert!(10 * eight.count("steps") < 8 * cross.count("steps"));
    assert!(10 * eight.count("evaluations") > 13 * cross.count("evaluations"));
    // Where no neighbour across is better, no diagonal one is but at the rim.
    assert!(100 * diagonals.count("steps").abs_diff(cross.count("steps")) < cross.count("steps"));
    let extra = diagonals.count("evaluations") - cross.count("evaluations");
    assert!(extra > 0 && extra < 5 * cross.count("searches"), "{extra}");
    for other in [diagonals, eight] {
        assert!((other.bad - cross.bad).abs() < 0.01, "{} against {}", other.bad, cross.bad);
    }
}
