//! The truth against POV-Ray: the same scene, lit flat, round shapes in closed form in both.

mod referee_support;

use glam::{DVec3, Vec3};
use mirrorbench::scene::{FrameRecord, Lighting, NO_OBJECT, Scene, load};
use mirrorbench::truth::{Shapes, Tracer, TruthOptions};
use referee_support::pov_file::{Look, id_level};
use referee_support::povray;

const SIDE: u32 = 512;

#[test]
fn columns_agree() {
    agree("columns", load("columns").unwrap());
}

#[test]
fn patow_room_agrees() {
    agree("patow-room", load("patow-room").unwrap());
}

/// Chains of mirrors, cut off at the same length.
#[test]
fn two_spheres_agree() {
    for bounces in [2, 4] {
        let scene = Scene { bounces, ..load("two-spheres").unwrap() };
        agree(&format!("two-spheres, {bounces} bounces"), scene);
    }
}

/// At least 99.95 % of the reflector pixels show the same object, and 99.9 % of those the same colour
/// to 1/255.
fn agree(name: &str, mut scene: Scene) {
    scene.lighting = Lighting { ambient: Vec3::ONE, sun: Vec3::ZERO, ..scene.lighting };
    let moment = scene.at(0);
    let options = TruthOptions { shapes: Shapes::Analytic, ..TruthOptions::default() };
    let truth = Tracer::new(&scene, &moment, options).frame([SIDE, SIDE]);
    let ids = povray::render(&scene, &moment, Look::Ids, SIDE);
    let picture = povray::render(&scene, &moment, Look::Flat, SIDE);

    let mirrors = truth.reflector_pixels();
    assert!(mirrors.len() > 10_000, "{name} has {} reflector pixels", mirrors.len());
    let agreeing: Vec<usize> = mirrors
        .iter()
        .copied()
        .filter(|&pixel| same_objects(&scene, &truth, &ids, pixel))
        .collect();
    let close = agreeing.iter().filter(|&&pixel| {
        (truth.colour[pixel].as_dvec3() - picture[pixel]).abs().max_element() <= 1.0 / 255.0
    });
    let objects = agreeing.len() as f64 / mirrors.len() as f64;
    let colours = close.count() as f64 / agreeing.len() as f64;
    let found = format!(
        "{name}: of {} reflector pixels {:.4} % show the same object; of those {:.4} % the same colour",
        mirrors.len(),
        100.0 * objects,
        100.0 * colours
    );
    println!("{found}");
    assert!(objects >= 0.9995 && colours >= 0.999, "{found}");
}

/// Whether POV-Ray sees the same mirror at a pixel, and in it the same object.
fn same_objects(scene: &Scene, truth: &FrameRecord, ids: &[DVec3], pixel: usize) -> bool {
    let seen = id_level(Some(truth.reflector[pixel]));
    let shown = match truth.record.ids[pixel].object {
        NO_OBJECT => id_level(None),
        // The end of a chain that is cut off, where POV-Ray stops.
        mirror if scene.is_reflector(mirror) => 0.0,
        object => id_level(Some(object)),
    };
    (ids[pixel] - DVec3::new(shown, seen, 0.0)).abs().max_element() < 1e-3
}
