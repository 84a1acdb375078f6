//! Pictures of mirrors that show a point more than once: `roots=all` of virtual objects draws every branch of
//! reflections, where the published search has one point a vertex.

mod gpu_support;

use gpu_support::{Session, engine, judged, options, tracer};
use mirrorbench::measure::PathMeasure;
use mirrorbench::scene;

const SIZE: [u32; 2] = [128, 96];

/// Shares of the mirror's pixels that are wrong by over a pixel, and missing; published, then all roots.
fn shares(name: &str, frame: u32) -> [[f64; 2]; 2] {
    let (session, scene) = (Session::open(), scene::load(name).unwrap());
    ["virtual-objects", "virtual-objects@revised:roots=all"].map(|case| {
        let accuracy = judged(&session, &scene, case, SIZE, frame).1;
        println!("{name} {frame} {case}: {accuracy:?}");
        [accuracy.bad_share.one, accuracy.missing]
    })
}

#[test]
fn hollow_and_saddle_mirrors_are_drawn_in_all_their_branches() {
    // The teapot before the dish's focus; before the torus and the saddle.
    for (name, frame) in [("dish", 2), ("torus", 20), ("saddle", 20)] {
        let [[published, _], [bad, missing]] = shares(name, frame);
        assert!(bad < 0.05 && missing < 0.01, "{name}: {bad} bad, {missing} missing");
        assert!(published > 0.25 && published > 8.0 * bad, "{name}: {published} published, {bad}");
    }
}

#[test]
fn finer_textures_tear_no_holes() {
    let (session, scene) = (Session::open(), scene::load("dish").unwrap());
    let case = "virtual-objects@revised:roots=all,texture=256";
    let accuracy = judged(&session, &scene, case, SIZE, 2).1;
    assert!(accuracy.bad_share.one < 0.01 && accuracy.missing < 0.002, "{accuracy:?}");
}

#[test]
fn the_same_frame_is_the_same_bit_for_bit() {
    let session = Session::open();
    for (name, at) in [("dish", 2), ("saddle", 20)] {
        let scene = scene::load(name).unwrap();
        let case = "virtual-objects@revised:roots=all,texture=64";
        let mut engine = engine(&session, &scene, case, &options([64, 48]));
        let mut frame = || engine.frame(&scene.at(at), true).unwrap().0;
        let [first, second, third] = [frame(), frame(), frame()];
        assert!(first.record == second.record && second.record == third.record, "{name}");
    }
}

#[test]
fn what_moves_through_the_focus_does_not_pop() {
    let (session, scene, size) = (Session::open(), scene::load("dish").unwrap(), [64, 48]);
    let cases = ["virtual-objects@revised:roots=all,texture=64", "virtual-objects@revised"];
    let mut engines = cases.map(|case| engine(&session, &scene, case, &options(size)));
    let mut measure = PathMeasure::new(cases.len());
    for frame in 32..40 {
        let moment = scene.at(frame);
        let drawn = engines.each_mut().map(|e| e.frame(&moment, frame == 32).unwrap().0);
        let tracer = tracer(&scene, &moment);
        measure.frame(&tracer, &tracer.frame(size), &drawn).unwrap();
    }
    let [all, one] = <[_; 2]>::try_from(measure.finish()).ok().unwrap().map(|(steady, _)| steady);
    let about = format!("{all:?} beside {one:?}");
    assert!(all.pops == 0 && one.pops > 0, "{about}");
    // Not by showing less.
    assert!(all.covered > 0.75 && all.covered > one.covered, "{about}");
}

#[test]
fn open_mirrors_need_no_partner() {
    let (session, scene) = (Session::open(), scene::load("open-sheet").unwrap());
    // Its outside, and its inside, where it shows itself, too: those pixels are the second order's.
    for at in [0, 96] {
        let case = "virtual-objects@revised:roots=all,texture=64";
        let accuracy = judged(&session, &scene, case, [64, 48], at).1;
        let first = &accuracy.by_order[0];
        assert!(first.order == 1 && first.group.bad_share.one < 0.02, "{at}: {accuracy:?}");
    }
}
