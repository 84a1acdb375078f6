//! Billboard impostors: what they cost, where they are exact, what refreshes them, and that ray morphing
//! hides a billboard's border.

mod gpu_support;
mod truth_support;

use std::collections::BTreeSet;

use glam::Vec3;
use gpu_support::{Session, engine, frame, judged, options, tracer};
use mirrorbench::experiment::frame_file::write_png;
use mirrorbench::measure::colour;
use mirrorbench::scene::{self, FrameRecord, Scene, Status};

const SIZE: [u32; 2] = [96, 64];

/// A frame of a case and its counters: intersections, the most of a pixel, pixels of order 2 and up.
fn counted(session: &Session, scene: &Scene, case: &str, at: u32) -> (FrameRecord, [u64; 3]) {
    let mut engine = engine(session, scene, case, &options(SIZE));
    let (frame, times) = engine.frame(&scene.at(at), true).unwrap();
    let of = |name: &str| times.counters.iter().find(|(n, _)| n == name).unwrap().1;
    (frame, ["intersections", "most_intersections", "second_order"].map(of))
}

#[test]
fn the_slides_cost_is_counted() {
    // Slides 17 to 22: D + (R - 1) + D for K = 2; slide 15 itself: D + R - 1 at every order.
    let session = Session::open();
    for (name, d, r) in [("four-teapots", 1, 4), ("table", 2, 2), ("pushing-it", 2, 9)] {
        let scene = scene::load(name).unwrap();
        for (case, most) in [
            ("billboard-impostors:size=64,map=32", d + r - 1 + d),
            ("billboard-impostors:size=64,map=32,last=all", 2 * (d + r - 1)),
            ("billboard-impostors:size=64,map=32,bounces=1", d),
        ] {
            let (drawn, [all, counted, second]) = counted(&session, &scene, case, 0);
            assert_eq!(counted, most, "{case} on {name}");
            let pixels = drawn.reflector_pixels();
            assert!(all <= most * pixels.len() as u64 && all >= pixels.len() as u64);
            let orders = |&&i: &&usize| drawn.record.ids[i].order() > 1;
            assert_eq!(second, pixels.iter().filter(orders).count() as u64, "{case} on {name}");
        }
    }
}

#[test]
fn second_order_reflections_are_of_every_pair_of_mirrors() {
    // Slide 18: two of them on the table. The teapot counts as one: it skips its own billboard.
    let (session, scene) = (Session::open(), scene::load("table").unwrap());
    let ranks = scene.reflectors();
    let group = |rank: u32| &scene.objects[ranks[rank as usize] as usize].group;
    let (drawn, _) = counted(&session, &scene, "billboard-impostors:size=128,map=32", 0);
    let twice = drawn.reflector_pixels().into_iter().map(|i| drawn.record.ids[i]);
    let pairs: BTreeSet<_> = twice
        .filter(|ids| ids.order() == 2)
        .map(|ids| [ids.trace & 0xff, ids.trace >> 8 & 0xff].map(|rank| group(rank - 1)))
        .collect();
    assert_eq!(pairs.len(), 2, "{pairs:?}");
    assert!(pairs.iter().all(|[first, second]| first != second), "{pairs:?}");
}

#[test]
fn a_flat_thing_is_its_own_billboard() {
    let (session, scene) = (Session::open(), truth_support::scene(truth_support::FLAT));
    let (_, accuracy, _) = judged(&session, &scene, "billboard-impostors:size=1024", SIZE, 0);
    assert!(accuracy.bad_share.one < 0.005, "{accuracy:?}");
    assert!(accuracy.wrong_object < 1e-9 && accuracy.missing < 1e-9, "{accuracy:?}");
}

/// A ball that orbits a turning mirror, and one that wobbles.
const MOVING: &str = r#"
[camera]
fov_deg = 40.0
eye = [0.3, 1.7, 5.0]
target = [0.0, 0.9, 0.0]
[[objects]]
name = "floor"
shape = { plane = { size = [8.0, 8.0] } }
material = "floor"
[[objects]]
name = "mirror"
shape = { sphere = { radius = 0.8, slices = 48, stacks = 24 } }
material = "mirror"
position = [0.0, 1.0, 0.0]
[[objects]]
name = "box"
shape = { box = { size = [0.4, 0.8, 0.3] } }
material = "red"
position = [1.6, 0.5, 0.6]
orbit = { centre = [0.0, 0.0, 0.0], period_s = 4.0 }
[[objects]]
name = "ball"
shape = { sphere = { radius = 0.4, slices = 32, stacks = 16 } }
material = "floor"
position = [-1.5, 0.6, 0.8]
wobble = { amplitude = 0.05, wavelength = 0.5, period_s = 1.0 }
"#;

#[test]
fn what_came_before_leaves_no_trace_in_a_frame() {
    let session = Session::open();
    let scene = truth_support::scene(MOVING);
    for case in ["billboard-impostors:size=64", "billboard-impostors@revised:size=64,view_deg=5"] {
        let mut engine = engine(&session, &scene, case, &options(SIZE));
        let mut taken = Vec::new();
        let mut last = None;
        for at in 0..4 {
            let (drawn, times) = engine.frame(&scene.at(at), at == 0).unwrap();
            let name = "billboard-impostors/portrait";
            taken.push(times.prepare.iter().filter(|pass| pass.name == name).count());
            last = Some(drawn);
        }
        let (warm, cold) = (last.unwrap(), frame(&session, &scene, case, SIZE, 3));
        assert!(warm.record == cold.record, "{case}");
        // The box goes 3.75 degrees a frame about the mirror and turns with it, so that it shows the same
        // side; the ball changes its shape; the floor does neither.
        assert_eq!((taken[0], &taken[1..]), (3, &[1, 1, 1][..]), "{case}");
    }
}

#[test]
fn a_view_that_changes_is_taken_anew_beyond_its_tolerance() {
    let session = Session::open();
    // Not carried about the mirror, but past it.
    let text = MOVING.replace(
        "position = [1.6, 0.5, 0.6]\norbit = { centre = [0.0, 0.0, 0.0], period_s = 4.0 }",
        "keys = [{ time_s = 0.0, position = [1.6, 0.5, 1.5] }, { time_s = 1.0, position = [1.6, 0.5, -1.5] }]",
    );
    let scene = truth_support::scene(&text);
    let taken = |degrees: &str| {
        let case = format!("billboard-impostors@revised:size=32,view_deg={degrees}");
        let mut engine = engine(&session, &scene, &case, &options(SIZE));
        (0..24)
            .map(|at| {
                let (_, times) = engine.frame(&scene.at(at), at == 0).unwrap();
                let name = "billboard-impostors/portrait";
                times.prepare.iter().filter(|pass| pass.name == name).count()
            })
            .sum::<usize>()
    };
    // The floor once, the ball at every frame, and the box.
    let [always, seldom] = ["0", "20"].map(taken);
    assert_eq!(always, 1 + 24 + 24);
    assert!((1 + 24 + 3..1 + 24 + 12).contains(&seldom), "{seldom}");
}

#[test]
fn a_moving_eye_refreshes_nothing_and_a_moving_mirror_what_it_sees_anew() {
    // The camera of the first orbits; in the second the mirror goes 2 m past three things that stand still.
    let session = Session::open();
    let still = MOVING
        .replace("orbit = { centre = [0.0, 0.0, 0.0], period_s = 4.0 }", "")
        .replace("wobble = { amplitude = 0.05, wavelength = 0.5, period_s = 1.0 }", "");
    let eye = still.replace("target =", "orbit = { period_s = 8.0 }\ntarget =");
    let mirror = still.replace(
        "material = \"mirror\"\nposition = [0.0, 1.0, 0.0]",
        "material = \"mirror\"\nkeys = [{ time_s = 0.0, position = [0.0, 1.0, -1.0] }, { time_s = 1.0, position = [0.0, 1.0, 1.0] }]",
    );
    let taken = |text: &str, degrees: &str| {
        let scene = truth_support::scene(text);
        let case = format!("billboard-impostors@revised:size=32,view_deg={degrees}");
        let mut engine = engine(&session, &scene, &case, &options(SIZE));
        let count = |at| {
            let (_, times) = engine.frame(&scene.at(at), at == 0).unwrap();
            let name = "billboard-impostors/portrait";
            times.prepare.iter().filter(|pass| pass.name == name).count()
        };
        (0..24).map(count).collect::<Vec<_>>()
    };
    let of_eye = taken(&eye, "2");
    assert_eq!((of_eye[0], of_eye[1..].iter().sum()), (3, 0), "{of_eye:?}");
    // The floor is its own picture from everywhere above it; box and ball are not.
    assert_eq!(taken(&mirror, "0")[1..], [2; 23]);
    let seldom: usize = taken(&mirror, "20")[1..].iter().sum();
    assert!((4..20).contains(&seldom), "{seldom}");
}

#[test]
fn a_billboard_faces_where_the_scene_says() {
    // Looked at from its edge a billboard is not there.
    let session = Session::open();
    let seen = |impostor: &str| {
        let text = MOVING
            .replace("orbit = { centre = [0.0, 0.0, 0.0], period_s = 4.0 }", impostor)
            .replace("position = [1.6, 0.5, 0.6]", "position = [1.2, 0.9, 1.0]");
        let scene = truth_support::scene(&text);
        let thing = scene.select("box")[0];
        let drawn = frame(&session, &scene, "billboard-impostors:size=64,map=64", [192, 128], 0);
        drawn.record.ids.iter().filter(|ids| ids.object == thing).count()
    };
    let fitted = seen("");
    let [towards, edge] = ["[-1.0, 0.0, -0.8]", "[0.8, 0.0, -1.0]"]
        .map(|facing| seen(&format!("impostor = {{ facing = {facing} }}")));
    assert!(fitted > 20 && towards > fitted / 2, "{fitted} {towards}");
    assert!(edge < fitted / 2, "{edge} of {fitted}");
    assert!(seen("impostor = \"backdrop\"") > 0, "the environment map shows it");
}

#[test]
fn rays_that_leave_from_stored_points_are_nearer_the_truth() {
    // Of what both variants and the truth see by two mirrors, with the same pictures.
    let (session, scene) = (Session::open(), scene::load("two-spheres").unwrap());
    let size = [192, 128];
    // From behind, where one sphere is in the other.
    let truth = tracer(&scene, &scene.at(240)).frame(size);
    let error = |origin: &str| {
        let case = format!("billboard-impostors@revised:bounces=2,relief=off,origin={origin}");
        let drawn = frame(&session, &scene, &case, size, 240);
        let mut errors: Vec<f32> = (0..truth.reflector.len())
            .filter(|&i| {
                let [a, b] = [&truth, &drawn].map(|frame| frame.record.ids[i]);
                a.order() == 2 && b.order() == 2 && a.trace == b.trace
            })
            .map(|i| truth.record.last[i].truncate().distance(drawn.record.last[i].truncate()))
            .collect();
        errors.sort_by(f32::total_cmp);
        assert!(errors.len() > 50, "only {}", errors.len());
        errors[errors.len() / 2]
    };
    let [quad, stored] = ["quad", "stored"].map(error);
    assert!(stored < 0.5 * quad, "{stored} m instead of {quad} m");
}

/// A mirror ball on the near part of a floor whose colour changes smoothly, a wave in 48 m; the rest of the floor
/// is backdrop.
fn smooth_floor() -> Scene {
    let folder = tempfile::tempdir().unwrap();
    let ramp = |x: u32, y: u32| {
        let wave = |t: u32| 0.5 + 0.45 * (t as f32 / 64.0 * std::f32::consts::TAU).sin();
        Vec3::new(wave(x), wave(y), wave(x + y))
    };
    let texels: Vec<Vec3> = (0..64 * 64).map(|i| ramp(i % 64, i / 64)).collect();
    write_png(&folder.path().join("ramp.png"), [64, 64], &texels).unwrap();
    let text = r#"
        about = "test"
        [environment]
        colour = [0.5, 0.6, 0.7]
        [materials]
        mirror = { mirror = { reflectance = 1.0 } }
        floor = { image = { file = "ramp.png", size = [48.0, 48.0] } }
        [camera]
        fov_deg = 24.0
        eye = [0.0, 1.2, 4.5]
        target = [0.0, 0.6, 0.0]
        [[objects]]
        name = "ball"
        shape = { sphere = { radius = 0.8, slices = 192, stacks = 96 } }
        material = "mirror"
        position = [0.0, 0.9, 0.0]
        [[objects]]
        name = "near"
        shape = { plane = { size = [6.0, 6.0] } }
        material = "floor"
        [[objects]]
        name = "far"
        shape = { plane = { size = [60.0, 60.0] } }
        material = "floor"
        position = [0.0, -0.001, 0.0]
        impostor = "backdrop"
        "#;
    let path = folder.path().join("smooth.toml");
    std::fs::write(&path, text).unwrap();
    scene::load(path.to_str().unwrap()).unwrap()
}

/// How far beyond the near floor's border pairs of pixels still count as across it, metres: a quarter of the
/// margin. At the ball's outline one pixel spans more, and the truth itself leaps.
const ACROSS: f32 = 0.375;

/// Of pairs of neighbouring pixels that show floor, one inside the billboard's border and one just outside: by how
/// much the step between them exceeds the truth's, in 1/255 of what is displayed; in rising order.
fn excesses(truth: &FrameRecord, drawn: &FrameRecord) -> Vec<f32> {
    let [width, height] = truth.size.map(|side| side as usize);
    let beyond = |i: usize| {
        let point = truth.record.point[i];
        point.x.abs().max(point.z.abs()) - 3.0
    };
    let floor = |i: usize| truth.record.ids[i].status() == Status::Found;
    let shown = |frame: &FrameRecord, i: usize| 255.0 * colour::displayed(frame.record.radiance[i]);
    let mut found = Vec::new();
    for i in 0..width * height {
        let right = (i % width + 1 < width).then_some(i + 1);
        let below = (i / width + 1 < height).then_some(i + width);
        for j in right.into_iter().chain(below).filter(|&j| floor(i) && floor(j)) {
            let (inner, outer) = (beyond(i).min(beyond(j)), beyond(i).max(beyond(j)));
            if inner < 0.0 && (0.0..ACROSS).contains(&outer) {
                let step = |frame: &FrameRecord| (shown(frame, i) - shown(frame, j)).abs();
                found.push((step(drawn) - step(truth)).max_element());
            }
        }
    }
    found.sort_by(f32::total_cmp);
    found
}

#[test]
fn ray_morphing_hides_a_billboards_border() {
    let (session, scene) = (Session::open(), smooth_floor());
    let size = [256, 192];
    let truth = tracer(&scene, &scene.at(0)).frame(size);
    let of = |case: &str| excesses(&truth, &frame(&session, &scene, case, size, 0));
    let most = |all: &[f32]| all[all.len() - 1];
    let without = of("billboard-impostors:morph=0,filter=bilinear");
    let median = without[without.len() / 2];
    assert!(without.len() > 150 && median > 2.5 && most(&without) > 20.0, "{median}");
    let bilinear = most(&of("billboard-impostors:filter=bilinear"));
    assert!(bilinear <= 2.0, "{bilinear}");
    // Mip maps blur the environment map just outside the border, but not the billboard just inside.
    let blurred = most(&of("billboard-impostors"));
    assert!((2.0..4.0).contains(&blurred), "{blurred}");
    let sharp = most(&of("billboard-impostors:border=sharp"));
    assert!(sharp <= 2.0, "{sharp}");
    // That the map is looked up where the ray meets it leaves nothing for morphing to err by.
    let revised = most(&of("billboard-impostors@revised"));
    assert!(revised <= 0.5, "{revised}");
}

#[test]
fn the_revised_border_is_hidden_at_every_size() {
    let (session, scene) = (Session::open(), smooth_floor());
    for size in [[128, 96], [512, 384]] {
        let truth = tracer(&scene, &scene.at(0)).frame(size);
        let all =
            excesses(&truth, &frame(&session, &scene, "billboard-impostors@revised", size, 0));
        let most = all[all.len() - 1];
        assert!(all.len() > 50 && most <= 0.5, "{most} at {size:?}");
    }
}
