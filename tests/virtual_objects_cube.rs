//! Virtual objects searched in cube maps of the reflector (`reflector_map=cube`): a map is made once however
//! the reflector lies, anew where its shape changes, and is no use for a shape that no point sees all of.

mod gpu_support;

use gpu_support::{Session, engine, frame, judged, options};
use mirrorbench::methods::{Case, METHODS};
use mirrorbench::scene;

const SIZE: [u32; 2] = [128, 72];
const CUBE: &str = "virtual-objects@revised:reflector_map=cube";

#[test]
fn maps_are_made_once_for_a_rigid_reflector_and_anew_for_one_that_wobbles() {
    let session = Session::open();
    for (name, redraws) in [("stress-ellipsoid", 0), ("columns-wobble", 1)] {
        let scene = scene::load(name).unwrap();
        let mut engine = engine(&session, &scene, CUBE, &options(SIZE));
        engine.frame(&scene.at(0), true).unwrap();
        let (later, times) = engine.frame(&scene.at(30), false).unwrap();
        let drawn = times.passes.iter().filter(|p| p.name == "virtual-objects/cube").count();
        assert_eq!(drawn, redraws, "{name}");
        // Turned or deformed meanwhile, the reflector is searched where it is.
        let fresh = frame(&session, &scene, CUBE, SIZE, 30);
        let same = later.record.ids.iter().zip(&fresh.record.ids).filter(|(a, b)| a == b).count();
        assert!(1000 * same >= 999 * later.record.ids.len(), "{name}: {same} pixels alike");
    }
}

#[test]
fn a_turned_reflector_is_searched_as_well_as_in_the_eyes_textures() {
    let (session, scene) = (Session::open(), scene::load("stress-ellipsoid").unwrap());
    let [screen, cube] = ["virtual-objects@revised", CUBE]
        .map(|case| judged(&session, &scene, case, SIZE, 30).1.bad_share.one);
    assert!(cube < screen + 0.02, "{cube} in the cube, {screen} as the eye sees it");
}

#[test]
fn a_bent_tube_is_right_in_the_eyes_textures_and_wrong_in_the_cube() {
    let (session, scene) = (Session::open(), scene::load("stress-tube").unwrap());
    let [screen, cube] = ["virtual-objects@revised", CUBE]
        .map(|case| judged(&session, &scene, case, [320, 180], 0).1.missing);
    assert!(screen < 0.01 && cube > 3.0 * screen + 0.01, "{screen} and {cube} missing");
}

#[test]
fn what_only_textures_of_the_view_have_is_refused() {
    let methods: Vec<_> = METHODS.iter().collect();
    for key in ["start=centre", "point=texel", "pattern=eight", "objective=dot", "cap=3"] {
        let error = Case::parse(&format!("{CUBE},{key}"), &methods).unwrap_err().to_string();
        assert!(error.contains("it needs reflector_map=screen"), "{error}");
    }
    let error = Case::parse("virtual-objects:step=0.5", &methods).unwrap_err().to_string();
    assert!(error.contains("it needs reflector_map=cube"), "{error}");
    let error = Case::parse(&format!("{CUBE},step=0.5"), &methods).unwrap_err().to_string();
    assert!(error.contains("it needs search=fixed-point"), "{error}");
}
