//! Pictures of reflection morphing with its one node at the eye (`nodes=eye`): against the truth while all moves,
//! and against themselves. `src/methods/reflection_morphing/eye/tests.rs` has its projections one by one.

mod gpu_support;

use gpu_support::{Session, engine, frame, judged, options};
use mirrorbench::geometry::{Camera, Projection};
use mirrorbench::scene::{self, CameraPath};

const SIZE: [u32; 2] = [128, 96];
const CASE: &str = "reflection-morphing:nodes=eye";

#[test]
fn moving_mirrors_and_columns_are_where_the_truth_has_them() {
    let (session, scene) = (Session::open(), scene::load("columns-moving").unwrap());
    for at in [0, 17, 41, 74] {
        let case = format!("{CASE},subdivide=0.1");
        let (_, accuracy, _) = judged(&session, &scene, &case, SIZE, at);
        assert!(accuracy.bad_share.one < 0.01, "frame {at}: {accuracy:?}");
        assert!(accuracy.displacement_px.unwrap().p95 < 0.2, "frame {at}: {accuracy:?}");
    }
}

#[test]
fn one_frame_is_the_same_bit_for_bit_whatever_came_before() {
    let (session, scene) = (Session::open(), scene::load("columns-moving").unwrap());
    let mut engine = engine(&session, &scene, CASE, &options(SIZE));
    let mut at = |n: u32| engine.frame(&scene.at(n), false).unwrap().0;
    let first = at(33);
    assert_eq!(first, at(33));
    let other = at(70);
    assert_ne!(first, other);
    assert_eq!(first, at(33));
    assert_eq!(other, frame(&session, &scene, CASE, SIZE, 70));
}

#[test]
fn nothing_is_prepared_but_the_meshes() {
    let (session, scene) = (Session::open(), scene::load("columns-moving").unwrap());
    let mut engine = engine(&session, &scene, CASE, &options(SIZE));
    let prepared = [0, 1].map(|at| engine.frame(&scene.at(at), at == 0).unwrap().1.prepare.len());
    assert_eq!(prepared, [1, 0]);
}

#[test]
fn a_flat_mirror_is_exact() {
    let (session, scene) = (Session::open(), scene::load("lecture").unwrap());
    let (_, accuracy, _) = judged(&session, &scene, CASE, [320, 160], 0);
    assert!(accuracy.displacement_px.unwrap().p95 < 0.05, "{accuracy:?}");
}

#[test]
fn parallel_rays_need_no_eye() {
    let (session, mut scene) = (Session::open(), scene::load("columns").unwrap());
    let camera = scene.camera.at(0.0);
    let projection = Projection::Orthographic { height: 2.6 };
    scene.camera = CameraPath::Keys(vec![(0.0, Camera { projection, ..camera })]);
    let case = format!("{CASE},subdivide=0.1");
    let (_, accuracy, _) = judged(&session, &scene, &case, SIZE, 0);
    assert!(accuracy.bad_share.one < 0.01, "{accuracy:?}");
}
