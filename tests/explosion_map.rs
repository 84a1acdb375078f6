//! Explosion maps in pictures: what the published rule errs by and the revised one does not, whatever the
//! sphere; and what is refused. `src/methods/explosion_map/tests.rs` holds vertices against exact ones.

mod gpu_support;

use gpu_support::{Session, frame, judged, methods, mirror_in_a_room};
use mirrorbench::measure::Accuracy;
use mirrorbench::methods::Case;
use mirrorbench::scene::{self, FrameRecord, Scene};

const SIZE: [u32; 2] = [128, 96];

fn accuracy(session: &Session, scene: &Scene, parameters: &str) -> Accuracy {
    judged(session, scene, &format!("explosion-map{parameters}"), SIZE, 0).1
}

#[test]
fn more_of_the_columns_is_right_with_two_spheres_and_nearly_all_with_walks() {
    let (session, scene) = (Session::open(), scene::load("columns").unwrap());
    let [one, linear, two, walks] =
        [":spheres=1,radius=2", ":blend=linear", "", "@revised"].map(|p| {
            let accuracy = accuracy(&session, &scene, p);
            assert!(accuracy.footprint_mismatch <= 0.002, "{p}: {accuracy:?}");
            accuracy.bad_share.one
        });
    assert!(one > linear && linear > two, "{one} {linear} {two}");
    assert!(two > 0.2 && walks < 0.02, "{two} {walks}");
}

#[test]
fn what_is_pushed_along_the_eye_ray_suffers_less_from_a_wrong_plane() {
    let (session, scene) = (Session::open(), scene::load("columns").unwrap());
    let [mirror, push] = ["", ":image=push"].map(|p| accuracy(&session, &scene, p).bad_share.one);
    assert!(push < 0.7 * mirror, "{push} against {mirror}");
    let [mirror, push] =
        ["@revised:image=mirror", "@revised"].map(|p| accuracy(&session, &scene, p).bad_share.one);
    assert!((mirror - push).abs() < 0.01, "at the right plane both are one: {mirror} {push}");
}

/// Share of the mirrors' pixels of which two frames show the same point.
fn agreement(one: &FrameRecord, other: &FrameRecord) -> f64 {
    let pixels = one.reflector_pixels();
    assert!(pixels.len() > 500, "only {} pixels", pixels.len());
    let same = |i: &&usize| {
        let (a, b) = (one.record.point[**i], other.record.point[**i]);
        a.abs_diff_eq(b, 1e-3 * a.length().max(1.0))
    };
    pixels.iter().filter(same).count() as f64 / pixels.len() as f64
}

#[test]
fn walks_give_the_same_picture_from_any_map() {
    let (session, scene) = (Session::open(), scene::load("two-spheres").unwrap());
    let usual = frame(&session, &scene, "explosion-map@revised", SIZE, 0);
    for other in ["radius=1", "radius=8", "size=16"] {
        let case = format!("explosion-map@revised:{other}");
        let share = agreement(&usual, &frame(&session, &scene, &case, SIZE, 0));
        assert!(share > 0.995, "{other}: {share} of the pixels show the same point");
    }
}

#[test]
fn a_walk_cut_short_errs() {
    let (session, scene) = (Session::open(), scene::load("columns").unwrap());
    let [one, four, enough] = ["@revised:cap=1", "@revised:cap=8", "@revised"]
        .map(|p| accuracy(&session, &scene, p).bad_share.one);
    assert!(one > four + 0.05 && four > enough + 0.01, "{one} {four} {enough}");
}

#[test]
fn triangles_that_reach_into_the_shadow_are_cut_by_the_pixel_or_missing() {
    let (session, scene) = (Session::open(), scene::load("columns").unwrap());
    let [cut, dropped] = ["cut", "drop"]
        .map(|hidden| accuracy(&session, &scene, &format!("@revised:subdivide=1,hidden={hidden}")));
    assert!(dropped.missing > cut.missing + 0.002, "{} {}", dropped.missing, cut.missing);
    // Nothing hidden is drawn over the mirror.
    assert!(cut.wrong_object < 0.02, "{cut:?}");
}

#[test]
fn a_closed_partner_is_mapped_in_place_of_an_open_mirror() {
    let shape = "{ sphere = { radius = 0.8, slices = 96, stacks = 48 } }";
    let half = "{ revolution = { profile = [[0.0, -0.8], [0.44184, -0.8], [0.8, -0.44184], [0.8, 0.0]], \
                curve = \"bezier\", slices = 96, stacks = 24 } }";
    let session = Session::open();
    let case = "explosion-map@revised";
    let whole = mirror_in_a_room(&session, case, SIZE, shape, "");
    let paired = mirror_in_a_room(&session, case, SIZE, half, &format!("closed = {shape}"));
    // The outlines differ where the half ends.
    let lower = |frame: &FrameRecord, i: usize| frame.position[i].y < 0.98;
    let pixels: Vec<usize> = whole
        .reflector_pixels()
        .into_iter()
        .filter(|&i| lower(&whole, i) && paired.reflector[i] == whole.reflector[i])
        .collect();
    assert!(pixels.len() > 500, "only {} pixels", pixels.len());
    let same = |i: &&usize| whole.record.point[**i].abs_diff_eq(paired.record.point[**i], 0.05);
    let share = pixels.iter().filter(same).count() as f64 / pixels.len() as f64;
    assert!(share > 0.98, "{share} of the pixels show the same point");
}

#[test]
fn a_mirror_that_wobbles_is_mapped_where_it_is() {
    // Reflectors' rays are cast anew each frame, from the vertices of that frame.
    let (session, scene) = (Session::open(), scene::load("columns-wobble").unwrap());
    let case = "explosion-map@revised";
    let mut engine = gpu_support::engine(&session, &scene, case, &gpu_support::options(SIZE));
    engine.frame(&scene.at(0), true).unwrap();
    let (warm, _) = engine.frame(&scene.at(6), false).unwrap();
    let cold = frame(&session, &scene, case, SIZE, 6);
    assert_eq!(warm.record, cold.record);
    assert!(agreement(&cold, &frame(&session, &scene, case, SIZE, 0)) < 0.9);
}

#[test]
fn parameters_without_meaning_are_refused() {
    for (parameters, valid) in [
        ("cell=cube", "sphere, walk"),
        ("spheres=3", "1, 2"),
        ("radius=0.5", "from 1"),
        ("spheres=1,far=9", "spheres"),
        ("spheres=1,blend=linear", "spheres"),
        ("cap=9", "cell"),
        ("image=glass", "mirror, push"),
        ("texture=64", "size"),
    ] {
        let refused = Case::parse(&format!("explosion-map:{parameters}"), &methods());
        let Err(error) = refused else { panic!("{parameters} is not refused") };
        assert!(error.to_string().contains(valid), "{parameters}: {error}");
    }
}
