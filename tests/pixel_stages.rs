//! Both forms of a method's shader over the reflectors' pixels give the same record.

mod gpu_support;

use std::collections::BTreeSet;

use gpu_support::{Session, engine, options};
use mirrorbench::experiment::engine::RecordMode;
use mirrorbench::scene::{self, FrameRecord, Scene};
use mirrorbench::stages::Footprint;

const SIZE: [u32; 2] = [96, 64];

/// A frame of a case and the work it counted.
fn drawn(session: &Session, scene: &Scene, case: &str) -> (FrameRecord, Vec<(String, u64)>) {
    // From the side one sphere of `two-spheres` hides part of the other.
    let at = if scene.frames > 120 { 100 } else { 0 };
    let (frame, times) =
        engine(session, scene, case, &options(SIZE)).frame(&scene.at(at), true).unwrap();
    (frame, times.counters)
}

fn reflectors_seen(frame: &FrameRecord) -> usize {
    frame.reflector_pixels().iter().map(|&i| frame.reflector[i]).collect::<BTreeSet<_>>().len()
}

fn same(session: &Session, scene: &Scene, compute: &str, fragment: &str) -> FrameRecord {
    let (by_list, listed) = drawn(session, scene, compute);
    let (by_stencil, counted) = drawn(session, scene, fragment);
    assert!(by_list.reflector_pixels().len() > 100);
    assert_eq!(by_list, by_stencil, "{} in {}", fragment, scene.name);
    // Each pixel is answered once.
    assert_eq!(listed, counted, "{} in {}", fragment, scene.name);
    by_list
}

#[test]
fn both_forms_give_the_same_record_where_reflectors_overlap() {
    let session = Session::open();
    for name in ["two-spheres", "hall-of-mirrors", "glass-sphere"] {
        let scene = scene::load(name).unwrap();
        let frame = same(&session, &scene, "environment-map", "environment-map:stage=fragment");
        assert!(name == "glass-sphere" || reflectors_seen(&frame) > 1, "{name}");
    }
}

#[test]
fn reflectors_that_share_a_stencil_value_keep_apart() {
    let (session, mut scene) = (Session::open(), scene::load("two-spheres").unwrap());
    let [first, second] = scene.reflectors()[..] else { panic!("two spheres") };
    // As many objects between them as give both the same value.
    let filler = scene.objects.last().unwrap().clone();
    for i in 0..255 - (second - first) {
        let mut object = filler.clone();
        object.name = format!("filler-{i}");
        scene.objects.insert(second as usize, object);
    }
    let [first, second] = scene.reflectors()[..] else { panic!("two spheres") };
    assert_eq!(Footprint::stencil_of(first), Footprint::stencil_of(second));
    let frame = same(&session, &scene, "environment-map", "environment-map:stage=fragment");
    assert_eq!(reflectors_seen(&frame), 2);
    let hybrid = ["sphere=environment-map;*=none", "sphere=environment-map:stage=fragment;*=none"];
    same(&session, &scene, hybrid[0], hybrid[1]);
}

#[test]
fn both_record_modes_draw_the_same_picture_as_fragments() {
    let (session, scene) = (Session::open(), scene::load("two-spheres").unwrap());
    let case = "environment-map:stage=fragment";
    let (full, _) = drawn(&session, &scene, case);
    let options = mirrorbench::experiment::engine::RunOptions {
        record: RecordMode::Radiance,
        ..options(SIZE)
    };
    let (radiance, _) =
        engine(&session, &scene, case, &options).frame(&scene.at(100), true).unwrap();
    assert_eq!(full.colour, radiance.colour);
}
