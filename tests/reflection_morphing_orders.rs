//! Reflection morphing over several mirrors: a vertex has one projection by each chain of them (Martin &
//! Popescu 2004, sections 4.1 and 9).

mod gpu_support;

use glam::{Vec3, Vec4Swizzles};
use gpu_support::{Session, engine, frame, judged, methods, options, tracer};
use mirrorbench::experiment::engine::Engine;
use mirrorbench::geometry::Camera;
use mirrorbench::measure::{self, Accuracy};
use mirrorbench::methods::Case;
use mirrorbench::scene::{self, CameraPath, FrameRecord, Motion, Scene, Status};

const SIZE: [u32; 2] = [160, 96];
const EYE: &str = "reflection-morphing:nodes=eye,subdivide=0.5";

/// Both spheres of `two-spheres` and the gap between them, from near.
fn between_spheres() -> Scene {
    let mut scene = scene::load("two-spheres").unwrap();
    let camera = scene.camera.at(0.0);
    let (eye, target) = (Vec3::new(1.2, 1.3, -2.3), Vec3::new(1.2, 1.0, 0.0));
    scene.camera = CameraPath::Keys(vec![(0.0, Camera { eye, target, ..camera })]);
    scene
}

/// Of the pixels whose light met so many mirrors: their share, and of those what is over a pixel off.
fn of_order(accuracy: &Accuracy, order: u32) -> (f64, f64) {
    let row = accuracy.by_order.iter().find(|row| row.order == order).unwrap();
    (row.group.share, row.group.bad_share.one)
}

#[test]
fn every_bounce_adds_an_order() {
    let (session, scene) = (Session::open(), between_spheres());
    let bad = [1, 2, 3].map(|bounces| {
        let case = format!("reflection-morphing:files=none,cell=0.25,bounces={bounces}");
        let accuracy = judged(&session, &scene, &case, SIZE, 0).1;
        [1, 2, 3].map(|order| of_order(&accuracy, order))
    });
    let [once, twice, thrice] = bad;
    assert!(once[1].0 > 0.04 && once[1].1 > 0.99 && once[2].1 > 0.99, "{once:?}");
    assert!(twice[1].1 < 0.4 && twice[2].1 > 0.9, "{twice:?}");
    assert!(thrice[1].1 < 0.4 && thrice[2].1 < 0.75, "{thrice:?}");
    // First reflections do not suffer.
    assert!(twice[0].1 <= once[0].1 + 0.01, "{once:?}, then {twice:?}");
}

/// Pixels that a frame and the truth show the same object in, by the same reflector and one more: how many, how
/// many with the same bounce and way, and how many with the same light.
fn told_alike(truth: &FrameRecord, tested: &FrameRecord) -> [usize; 3] {
    let [mut alike, mut near, mut lit] = [0, 0, 0];
    for i in tested.reflector_pixels() {
        let [a, b] = [truth, tested].map(|frame| frame.record.ids[i]);
        let is_second = |ids: scene::Ids| ids.order() == 2 && ids.status() == Status::Found;
        let seen_in = [truth, tested].map(|frame| frame.reflector[i]);
        if !is_second(a) || !is_second(b) || a.object != b.object || seen_in[0] != seen_in[1] {
            continue;
        }
        assert_eq!(a.trace, b.trace, "pixel {i}");
        let [p, q] = [truth, tested].map(|frame| frame.record.last[i]);
        alike += 1;
        near += usize::from(p.xyz().distance(q.xyz()) < 0.05 && (p.w - q.w).abs() < 0.05 * p.w);
        let [p, q] = [truth, tested].map(|frame| frame.record.radiance[i]);
        lit += usize::from(p.abs_diff_eq(q, 0.1));
    }
    [alike, near, lit]
}

#[test]
fn the_record_tells_the_chain() {
    let (session, scene) = (Session::open(), between_spheres());
    let truth = tracer(&scene, &scene.at(0)).frame(SIZE);
    let case = "reflection-morphing:files=none,cell=0.25,bounces=2";
    let [alike, near, lit] = told_alike(&truth, &frame(&session, &scene, case, SIZE, 0));
    assert!(alike > 120, "{alike} pixels show the same object by two mirrors");
    assert!(near > alike * 8 / 10, "{near} of {alike}");
    assert!(lit > alike * 6 / 10, "{lit} of {alike}");
    let case = format!("{EYE},bounces=2");
    let [alike, near, lit] = told_alike(&truth, &frame(&session, &scene, &case, SIZE, 0));
    assert!(alike > 200 && near > alike * 95 / 100, "{near} of {alike}");
    assert!(lit > alike * 9 / 10, "{lit} of {alike}");
}

#[test]
fn rays_at_the_eye_go_on_from_mirror_to_mirror() {
    let (session, scene) = (Session::open(), between_spheres());
    let [once, twice, thrice] = [1, 2, 3].map(|bounces| {
        let case = format!("{EYE},bounces={bounces}");
        let (frame, accuracy, _) = judged(&session, &scene, &case, SIZE, 0);
        (frame, [1, 2, 3].map(|order| of_order(&accuracy, order).1))
    });
    assert!(once.1[1] > 0.99 && once.1[2] > 0.99, "{:?}", once.1);
    assert!(twice.1[1] < 0.1 && twice.1[2] > 0.99, "{:?}", twice.1);
    assert!(thrice.1[1] < 0.1 && thrice.1[2] < 0.3, "{:?}", thrice.1);
    // What is seen by one mirror is the same bit for bit, whatever is seen by more.
    let (once, thrice) = (once.0, thrice.0);
    let first = |&i: &usize| thrice.record.ids[i].order() == 1;
    let pixels: Vec<usize> = thrice.reflector_pixels().into_iter().filter(first).collect();
    assert!(pixels.len() > 5000, "{} pixels", pixels.len());
    for i in pixels {
        assert_eq!(once.record.point[i], thrice.record.point[i], "pixel {i}");
        assert_eq!(once.record.radiance[i], thrice.record.radiance[i], "pixel {i}");
    }
}

#[test]
fn mirrors_seen_in_mirrors_may_move() {
    let (session, mut scene) = (Session::open(), between_spheres());
    for (mirror, by) in scene.reflectors().into_iter().zip([Vec3::Y, Vec3::new(-0.3, 0.0, -0.6)]) {
        let Motion::Still(pose) = scene.objects[mirror as usize].motion else { panic!("moves") };
        let mut there = pose;
        there.translation += glam::Vec3A::from(0.5 * by);
        scene.objects[mirror as usize].motion = Motion::Keys(vec![(0.0, pose), (10.0, there)]);
    }
    let case = format!("{EYE},bounces=2");
    let mut engine = engine(&session, &scene, &case, &options(SIZE));
    for at in [0, 4, 9] {
        let moment = scene.at(at);
        let drawn = engine.frame(&moment, at == 0).unwrap().0;
        let tracer = tracer(&scene, &moment);
        let accuracy = measure::accuracy(&tracer.frame(SIZE), &drawn, &tracer).unwrap().0;
        let (share, bad) = of_order(&accuracy, 2);
        assert!(share > 0.02 && bad < 0.12, "frame {at}: {bad} of {share}");
        assert!(drawn == frame(&session, &scene, &case, SIZE, at), "frame {at}, drawn cold");
    }
}

#[test]
fn bundles_know_no_mixed_traces() {
    let (session, scene) = (Session::open(), between_spheres());
    let case = Case::parse(&format!("{EYE},bounces=2,traces=mixed"), &methods()).unwrap();
    let made = Engine::new(session.device(), &scene, &case, &methods(), &options(SIZE));
    let message = made.err().unwrap().to_string();
    assert!(message.contains("traces=apart"), "{message}");
}

#[test]
fn triangles_that_join_two_traces_are_torn_over_the_mirror() {
    let (session, scene) = (Session::open(), between_spheres());
    let case = "reflection-morphing:files=none,cell=0.25,bounces=2";
    let apart = judged(&session, &scene, case, SIZE, 0).1;
    let mixed = judged(&session, &scene, &format!("{case},traces=mixed"), SIZE, 0).1;
    let [(_, apart), (_, mixed)] = [apart, mixed].map(|accuracy| of_order(&accuracy, 1));
    assert!(mixed > apart + 0.05, "first orders: {mixed} mixed, {apart} apart");
}
