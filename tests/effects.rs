//! What a mirror makes of its reflection: Fresnel's law, attenuation with distance, and both.

mod gpu_support;
mod truth_support;

use glam::Vec3;
use gpu_support::{Session, frame, judged, tracer};
use mirrorbench::scene::{Fade, Mirror, Scene};

const SIZE: [u32; 2] = [96, 64];
const TINT: Vec3 = Vec3::new(1.0, 0.9, 0.8);

/// All mirrors of a scene made this one.
fn with(mut scene: Scene, mirror: Mirror) -> Scene {
    for material in scene.materials.iter_mut().filter(|material| material.mirror.is_some()) {
        material.mirror = Some(mirror);
    }
    scene
}

fn effects() -> [Mirror; 3] {
    let plain = Mirror::plain(0.6, TINT);
    let fade = Some(Fade { distance: 2.0, floor: 0.2 });
    [
        Mirror { fresnel: true, reflectance: 0.1, ..plain },
        Mirror { fade, ..plain },
        Mirror { fresnel: true, fade, ..plain },
    ]
}

#[test]
fn shares_are_as_their_laws_say() {
    let [fresnel, fade, _] = effects();
    assert_eq!(fresnel.share(1.0), 0.1);
    assert_eq!(fresnel.share(0.0), 1.0);
    assert!((fresnel.share(0.5) - (0.1 + 0.9 / 32.0)).abs() < 1e-6);
    assert_eq!(fade.share(0.0), 0.6, "fading is not the mirror's share");
    let fade = fade.fade.unwrap();
    assert_eq!((fade.share(0.0), fade.share(f32::INFINITY)), (1.0, 0.2));
    assert!((fade.share(2.0) - (0.2 + 0.8 / std::f32::consts::E)).abs() < 1e-6);
}

#[test]
fn the_truths_picture_is_the_closed_form_over_a_flat_mirror() {
    let session = Session::open();
    for mirror in effects() {
        let scene = with(truth_support::scene(truth_support::FLAT), mirror);
        let (truth, drawn) = both(&session, &scene, "planar-mirror");
        let mut tested = 0;
        for i in truth_support::found(&truth) {
            let (position, point) = (truth.position[i], truth.record.point[i].truncate());
            let incident = (position - scene.at(0).camera.eye).normalize();
            let fade = mirror.fade.map_or(1.0, |fade| fade.share(position.distance(point)));
            let expected = mirror.share(-incident.y) * fade * TINT * truth.record.radiance[i];
            assert!(truth.colour[i].abs_diff_eq(expected, 1e-4), "{i}");
            assert!(drawn.colour[i].abs_diff_eq(expected, 4e-3) || at_edge(&truth, &drawn, i));
            tested += 1;
        }
        assert!(tested > 1000, "{tested}");
    }
}

/// Whether two frames show different sides of an edge of the pattern at a pixel.
fn at_edge(
    a: &mirrorbench::scene::FrameRecord,
    b: &mirrorbench::scene::FrameRecord,
    i: usize,
) -> bool {
    !a.record.radiance[i].abs_diff_eq(b.record.radiance[i], 1e-3)
}

fn both(
    session: &Session,
    scene: &Scene,
    case: &str,
) -> (mirrorbench::scene::FrameRecord, mirrorbench::scene::FrameRecord) {
    (tracer(scene, &scene.at(0)).frame(SIZE), frame(session, scene, case, SIZE, 0))
}

#[test]
fn rays_on_the_gpu_agree_over_two_mirrors_too() {
    let session = Session::open();
    for mirror in effects() {
        let scene = with(truth_support::scene(truth_support::TWO_BALLS), mirror);
        let (truth, drawn) = both(&session, &scene, "ray-traced");
        let pixels = truth.reflector_pixels();
        let same = |i: &&usize| drawn.colour[**i].abs_diff_eq(truth.colour[**i], 4e-3);
        let share = pixels.iter().filter(same).count() as f64 / pixels.len() as f64;
        assert!(share > 0.99, "{mirror:?}: {share}");
    }
}

#[test]
fn more_samples_see_the_same_effects() {
    // The mean over many samples of a pixel is near its centre where colours are smooth.
    let [_, _, both] = effects();
    let scene = with(truth_support::scene(truth_support::BALL), both);
    let moment = scene.at(0);
    let options = |spp| mirrorbench::truth::TruthOptions { spp, ..Default::default() };
    let [one, many] = [1, 16]
        .map(|spp| mirrorbench::truth::Tracer::new(&scene, &moment, options(spp)).frame(SIZE));
    let pixels = one.reflector_pixels();
    let near = |i: &&usize| many.colour[**i].abs_diff_eq(one.colour[**i], 0.02);
    let share = pixels.iter().filter(near).count() as f64 / pixels.len() as f64;
    assert!(share > 0.4, "{share}");
}

#[test]
fn what_fades_is_drawn_with_its_evidence_and_judged_as_it_looks() {
    let session = Session::open();
    let [_, fade, _] = effects();
    let scene = with(truth_support::scene(truth_support::FLAT), fade);
    let (_, accuracy, _) = judged(&session, &scene, "planar-mirror", SIZE, 0);
    assert!(accuracy.relmse_shading < 1e-3, "{accuracy:?}");
    let lean = mirrorbench::stages::RecordMode::Radiance;
    assert_eq!(lean.enough_for(&scene), mirrorbench::stages::RecordMode::Full);
}
