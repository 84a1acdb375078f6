//! Surfaces that change their shape: the truth, the GPU and the measures see one and the same mesh, and
//! whoever depends on it hears of it.

mod gpu_support;
mod truth_support;

use std::collections::BTreeSet;
use std::f32::consts::TAU;

use glam::Vec3;
use gpu_support::{Session, engine, frame, judged, methods, options};
use mirrorbench::experiment::engine::{Engine, Fallback, FrameTimes, RunOptions};
use mirrorbench::geometry::Ray;
use mirrorbench::measure::PathMeasure;
use mirrorbench::methods::Case;
use mirrorbench::scene::{FrameRecord, NO_OBJECT, ObjectId, Scene};
use mirrorbench::truth::{Cache, Tracer, TruthOptions};

const SIZE: [u32; 2] = [128, 96];

/// A wobbling mirror ball over a checkered floor, beside a ball that may wobble too.
fn balls(mirror: &str, red: &str) -> Scene {
    truth_support::scene(&format!(
        r#"
[camera]
fov_deg = 40.0
eye = [0.3, 1.7, 5.0]
target = [0.3, 0.9, 0.0]
[[objects]]
name = "floor"
shape = {{ plane = {{ size = [40.0, 40.0] }} }}
material = "floor"
[[objects]]
name = "ball"
shape = {{ sphere = {{ radius = 1.0, edge = 0.05 }} }}
material = "mirror"
position = [0.0, 1.2, 0.0]
{mirror}
[[objects]]
name = "red"
shape = {{ sphere = {{ radius = 0.5, edge = 0.05 }} }}
material = "red"
position = [1.5, 0.9, 1.4]
{red}
"#
    ))
}

const WOBBLE: &str =
    "wobble = { amplitude = 0.05, wavelength = 0.8, period_s = 1.0, towards = [1, 1, 0] }";

fn wobbling() -> Scene {
    balls(WOBBLE, WOBBLE)
}

fn names(times: &[mirrorbench::experiment::engine::PassTime]) -> Vec<&str> {
    times.iter().map(|pass| pass.name.as_str()).collect()
}

#[test]
fn the_truth_meets_the_wave_in_closed_form_and_finds_its_points_again() {
    let scene = wobbling();
    let ball = scene.select("ball")[0];
    let moment = scene.at(5);
    let tracer = Tracer::new(&scene, &moment, TruthOptions::default());
    let later = Tracer::new(&scene, &scene.at(14), TruthOptions::default());
    let centre = Vec3::new(0.0, 1.2, 0.0);
    let mut met = 0;
    for i in 0..200 {
        // Towards the centre, so that what is met lies over its foot on the sphere at rest.
        let (turn, rise) = (i as f32 * 2.4, i as f32 / 100.0 - 0.995);
        let across = (1.0 - rise * rise).sqrt();
        let out = Vec3::new(across * turn.cos(), rise, across * turn.sin());
        let start = centre + 3.0 * out;
        let Some(hit) = tracer.look(&Ray { origin: start, direction: -out }) else { continue };
        if hit.object != ball {
            continue;
        }
        let radius = |frame: f32| {
            let phase = out.dot(Vec3::new(1.0, 1.0, 0.0).normalize()) / 0.8 - frame / 24.0;
            1.0 + 0.05 * (TAU * phase).sin()
        };
        // Triangles of 0.05 m cut corners by up to 0.05^2 / 8 times the curvature.
        assert!((hit.point.distance(centre) - radius(5.0)).abs() < 2e-3, "{out}");
        // The same spot of the surface at another moment, as a track follows it.
        let spot = later.point_on(ball, hit.triangle, tracer.barycentrics(&hit));
        assert!(spot.abs_diff_eq(centre + radius(14.0) * out, 4e-3), "{spot} for {out}");
        met += 1;
    }
    assert!(met > 50, "{met}");
}

#[test]
fn the_truth_and_the_direct_view_see_the_same_surface_at_any_frame() {
    let (session, scene) = (Session::open(), wobbling());
    let truths = [3, 11].map(|at| {
        let drawn = frame(&session, &scene, "none", SIZE, at);
        let truth = Tracer::new(&scene, &scene.at(at), TruthOptions::default()).frame(SIZE);
        let differ = (0..truth.object.len()).filter(|&i| truth.object[i] != drawn.object[i]);
        assert!(differ.count() <= 8, "outlines at frame {at}");
        let mirrors = truth.reflector_pixels();
        let near = |i: &usize| {
            drawn.reflector[*i] == NO_OBJECT
                || drawn.position[*i].abs_diff_eq(truth.position[*i], 1e-3)
                    && drawn.normal[*i].abs_diff_eq(truth.normal[*i], 1e-3)
        };
        let alike = mirrors.iter().filter(|i| near(i)).count();
        // On the silhouette a ray may fall to either of two triangles.
        assert!(alike + 8 >= mirrors.len(), "{alike} of {} at frame {at}", mirrors.len());
        truth
    });
    let moved = truths[0].reflector_pixels().into_iter();
    let moved = moved.filter(|&i| !truths[0].normal[i].abs_diff_eq(truths[1].normal[i], 0.02));
    assert!(moved.count() > 500, "the surface has moved between the frames");
}

#[test]
fn ray_traced_follows_the_surface_with_every_tree() {
    let (session, scene) = (Session::open(), wobbling());
    let mut cases = vec!["ray-traced", "ray-traced:update=rebuild", "ray-traced:tree=wide"];
    if session.device().has_ray_query() {
        cases.push("ray-traced:backend=query");
    }
    for case in cases {
        let mut engine = engine(&session, &scene, case, &options(SIZE));
        for at in [0, 7, 15] {
            let (tested, times) = engine.frame(&scene.at(at), at == 0).unwrap();
            let tracer = gpu_support::tracer(&scene, &scene.at(at));
            let truth = tracer.frame(SIZE);
            let (accuracy, _) = mirrorbench::measure::accuracy(&truth, &tested, &tracer).unwrap();
            assert!(accuracy.bad_share.half < 4e-3, "{case} at {at}: {}", accuracy.bad_share.half);
            assert!(!times.prepare.is_empty(), "{case} keeps up at {at}");
        }
    }
}

#[test]
fn the_fallback_follows_the_surface() {
    let (session, scene) = (Session::open(), wobbling());
    let traced = {
        let options = RunOptions { fallback: Fallback::Ray, ..options(SIZE) };
        let mut engine = engine(&session, &scene, "none", &options);
        engine.frame(&scene.at(0), true).unwrap();
        engine.frame(&scene.at(9), false).unwrap().0
    };
    let tracer = gpu_support::tracer(&scene, &scene.at(9));
    let truth = tracer.frame(SIZE);
    let (accuracy, _) = mirrorbench::measure::accuracy(&truth, &traced, &tracer).unwrap();
    assert!(accuracy.bad_share.half < 4e-3, "{}", accuracy.bad_share.half);
}

/// What drawing frame 0, then frame 1, then frame 1 again took.
fn three_frames(session: &Session, scene: &Scene, case: &str) -> [FrameTimes; 3] {
    let mut engine = engine(session, scene, case, &options(SIZE));
    [0, 1, 1].map(|at| engine.frame(&scene.at(at), at == 0).unwrap().1)
}

#[test]
fn a_method_that_depends_on_what_wobbles_is_prepared_again() {
    let session = Session::open();
    for (mirror, red, again) in [(WOBBLE, "", true), ("", WOBBLE, true), ("", "", false)] {
        let scene = balls(mirror, red);
        let [first, next, same] = three_frames(&session, &scene, "environment-map");
        assert!(!first.prepare.is_empty() && same.prepare.is_empty());
        assert_eq!(!next.prepare.is_empty(), again, "{mirror} {red}");
        // The surface itself is a cost of the frame, and a still scene has none.
        let waves = |times: &FrameTimes| {
            let names = names(&times.passes).into_iter();
            names.filter(|name| name.starts_with("scene/")).map(str::to_owned).collect::<Vec<_>>()
        };
        for times in [&first, &next, &same] {
            let expected: &[&str] = if again { &["scene/deform", "scene/vertices"] } else { &[] };
            assert_eq!(waves(times), expected);
            let sum: f64 = times.passes.iter().map(|pass| pass.gpu_ms).sum();
            assert!(sum <= times.frame_gpu_ms * 1.001, "{sum} of {} ms", times.frame_gpu_ms);
        }
    }
}

#[test]
fn points_on_a_wobbling_surface_are_followed() {
    let scene = wobbling();
    let mut measure = PathMeasure::new(1);
    for at in 0..6 {
        let moment = scene.at(at);
        let tracer = Tracer::new(&scene, &moment, TruthOptions::default());
        let truth = tracer.frame(SIZE);
        measure.frame(&tracer, &truth, std::slice::from_ref(&truth)).unwrap();
    }
    let (stability, frames) = measure.finish().remove(0);
    assert!(frames.iter().all(|frame| frame.points > 1000 && frame.covered > 0.9));
    let jitter = stability.jitter_px.unwrap();
    assert!(jitter.p95 < 0.02, "the truth stands where it belongs: {jitter:?}");
}

#[test]
fn a_mirrored_point_of_the_wave_is_where_the_record_says() {
    let (session, scene) = (Session::open(), wobbling());
    let (tested, accuracy, _) = judged(&session, &scene, "ray-traced", SIZE, 6);
    let red = scene.select("red")[0];
    let shows = |id: ObjectId| {
        tested.reflector_pixels().into_iter().filter(|&i| tested.record.ids[i].object == id).count()
    };
    assert!(shows(red) > 15, "{} pixels show the red ball", shows(red));
    assert!(accuracy.displacement_px.unwrap().p95 < 0.05);
}

#[test]
fn what_a_mirror_shows_of_the_wave_is_drawn_where_it_is() {
    let (session, scene) = (Session::open(), balls("", WOBBLE));
    let red = scene.select("red")[0];
    let case = "virtual-objects@revised";
    let mut engine = engine(&session, &scene, case, &options(SIZE));
    engine.frame(&scene.at(0), true).unwrap();
    let (tested, _) = engine.frame(&scene.at(6), false).unwrap();
    // Against the truth of another moment the red ball's outline differs; against its own it does not.
    let differing = |at: u32| {
        let truth = Tracer::new(&scene, &scene.at(at), TruthOptions::default()).frame(SIZE);
        let shows = |frame: &FrameRecord, i: usize| frame.record.ids[i].object == red;
        let mirrors = truth.reflector_pixels().into_iter();
        mirrors.filter(|&i| shows(&truth, i) != shows(&tested, i)).count()
    };
    let (own, other) = (differing(6), differing(18));
    assert!(
        own <= 3 && other > 2 * own + 3,
        "{own} at the moment drawn, {other} half a wave later"
    );
}

#[test]
fn a_kept_truth_belongs_to_its_moment() {
    let scene = wobbling();
    let cache = Cache::new("unused");
    let path = |frame: u32, time: f32| {
        let moment = scene.at_time(frame, time);
        cache.path(&Tracer::new(&scene, &moment, TruthOptions::default()), SIZE)
    };
    assert_eq!(path(3, 3.0), path(3, 3.0));
    assert_ne!(path(3, 3.0), path(3, 3.5), "between frames the surface is another");
    assert_ne!(path(3, 3.0), path(4, 4.0));
}

#[test]
fn what_wobbles_has_a_mesh_of_its_own_and_so_has_its_partner() {
    let open = "shape = { cylinder = { radius = 0.5, height = 1.0, capped = false, edge = 0.05 } }
closed = { cylinder = { radius = 0.5, height = 1.0, edge = 0.05 } }
material = \"mirror\"";
    let wave =
        "wobble = { amplitude = 0.02, wavelength = 2.0, period_s = 1.0, towards = [1, 0, 0] }";
    let other = wave.replace("0.02", "0.03");
    let object =
        |name: &str, wave: &str| format!("[[objects]]\nname = \"{name}\"\n{open}\n{wave}\n");
    let scene = truth_support::scene(&format!(
        "[camera]\nfov_deg = 40.0\neye = [0.0, 1.0, 4.0]\ntarget = [0.0, 0.0, 0.0]\n{}{}{}{}",
        object("still", ""),
        object("one", wave),
        object("same", wave),
        object("other", &other)
    ));
    let meshes = |i: usize| [scene.objects[i].mesh, scene.objects[i].closed.unwrap()];
    assert_eq!(meshes(1), meshes(2), "what is alike is stored once");
    let all: BTreeSet<usize> = [0, 1, 3].into_iter().flat_map(meshes).collect();
    assert_eq!(all.len(), 6);
    let wobbling: BTreeSet<usize> = scene.wobbles.keys().copied().collect();
    assert_eq!(wobbling, [1, 3].into_iter().flat_map(meshes).collect());
    assert!(!scene.wobbles(0) && scene.wobbles(1) && scene.is_moving(2));
}

#[test]
fn a_flat_mirror_that_wobbles_is_not_taken_for_flat() {
    let disc = |wave: &str| {
        truth_support::scene(&format!(
            r#"
[camera]
fov_deg = 40.0
eye = [0.0, 2.0, 3.0]
target = [0.0, 0.0, 0.0]
[[objects]]
name = "disc"
shape = {{ revolution = {{ profile = [[1, 0], [0.7, 0], [0.3, 0], [0, 0]], curve = "bezier", slices = 48 }} }}
material = "mirror"
{wave}
"#
        ))
    };
    let session = Session::open();
    let case = Case::parse("planar-mirror", &methods()).unwrap();
    let made = |scene: &Scene| {
        Engine::new(session.device(), scene, &case, &methods(), &options([64, 48])).map(drop)
    };
    made(&disc("")).unwrap();
    let wave =
        "wobble = { amplitude = 0.05, wavelength = 1.0, period_s = 1.0, towards = [1, 0, 0] }";
    let error = made(&disc(wave)).unwrap_err();
    assert_eq!(error.exit_code(), 2);
    assert!(error.to_string().contains("needs flat reflectors; `disc`"), "{error}");
}
