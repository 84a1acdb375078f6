//! Reflection morphing over several mirrors: a vertex has one projection by each chain of them (Martin &
//! Popescu 2004, sections 4.1 and 9).

mod gpu_support;

use glam::{Vec3, Vec4Swizzles};
use gpu_support::{Session, frame, judged, tracer};
use mirrorbench::geometry::Camera;
use mirrorbench::measure::Accuracy;
use mirrorbench::scene::{self, CameraPath, Scene, Status};

const SIZE: [u32; 2] = [160, 96];

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

#[test]
fn the_record_tells_the_chain() {
    let (session, scene) = (Session::open(), between_spheres());
    let case = "reflection-morphing:files=none,cell=0.25,bounces=2";
    let tested = frame(&session, &scene, case, SIZE, 0);
    let truth = tracer(&scene, &scene.at(0)).frame(SIZE);
    let [mut alike, mut near, mut lit] = [0, 0, 0];
    for i in tested.reflector_pixels() {
        let [a, b] = [&truth, &tested].map(|frame| frame.record.ids[i]);
        let is_second = |ids: scene::Ids| ids.order() == 2 && ids.status() == Status::Found;
        let seen_in = [&truth, &tested].map(|frame| frame.reflector[i]);
        if !is_second(a) || !is_second(b) || a.object != b.object || seen_in[0] != seen_in[1] {
            continue;
        }
        assert_eq!(a.trace, b.trace, "pixel {i}");
        let [p, q] = [&truth, &tested].map(|frame| frame.record.last[i]);
        alike += 1;
        near += usize::from(p.xyz().distance(q.xyz()) < 0.05 && (p.w - q.w).abs() < 0.05 * p.w);
        let [p, q] = [&truth, &tested].map(|frame| frame.record.radiance[i]);
        lit += usize::from(p.abs_diff_eq(q, 0.1));
    }
    assert!(alike > 120, "{alike} pixels show the same object by two mirrors");
    assert!(near > alike * 8 / 10, "{near} of {alike}");
    assert!(lit > alike * 6 / 10, "{lit} of {alike}");
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
