//! Second bounces of `virtual-objects`: what mirrors show of mirrors, against the truth.

mod gpu_support;

use glam::Vec4Swizzles;
use gpu_support::{Session, frame, judged, tracer};
use mirrorbench::measure::OrderAccuracy;
use mirrorbench::scene::{self, FrameRecord, Scene};

const SIZE: [u32; 2] = [160, 100];
/// Both spheres in full view, each in the other.
const BEHIND: u32 = 240;
const ONCE: &str = "virtual-objects@revised";
const TWICE: &str = "virtual-objects@revised:bounces=2";

#[test]
fn two_bounces_show_what_mirrors_show_in_mirrors() {
    let (session, scene) = (Session::open(), scene::load("two-spheres").unwrap());
    let by_order = |case| judged(&session, &scene, case, SIZE, BEHIND).1.by_order;
    let (once, twice) = (by_order(ONCE), by_order(TWICE));
    let shares = |orders: &[OrderAccuracy]| [0, 1, 2].map(|i| orders[i].group.bad_share.one);
    let ([first, second, third], [_, second_once, _]) = (shares(&twice), shares(&once));
    assert!(once[1].order == 2 && once[1].group.share > 0.03, "{once:?}");
    // Of two bounces one shows the mirror itself.
    assert_eq!(second_once, 1.0);
    assert!(second < 0.12 && twice[1].group.missing < 0.05, "{twice:?}");
    assert_eq!(third, 1.0);
    assert!((first - once[0].group.bad_share.one).abs() < 0.002, "{once:?} {twice:?}");
}

/// Pixels that both show by two mirrors, the same object.
fn agreed(truth: &FrameRecord, tested: &FrameRecord) -> Vec<usize> {
    let same = |&i: &usize| {
        let [a, b] = [truth, tested].map(|frame| frame.record.ids[i]);
        a.order() == 2 && b.order() == 2 && (a.object, a.status()) == (b.object, b.status())
    };
    (0..truth.reflector.len()).filter(same).collect()
}

#[test]
fn records_of_two_bounces_are_the_truths() {
    let (session, scene) = (Session::open(), scene::load("two-spheres").unwrap());
    let tested = frame(&session, &scene, TWICE, SIZE, BEHIND);
    let truth = tracer(&scene, &scene.at(BEHIND)).frame(SIZE);
    let pixels = agreed(&truth, &tested);
    assert!(pixels.len() > 100, "only {}", pixels.len());
    let close = |i: &usize| {
        let (a, b) = (&truth.record, &tested.record);
        let (last, given) = (a.last[*i], b.last[*i]);
        let far = last.w == given.w || (last.w - given.w).abs() < 0.02 * last.w;
        assert_eq!(a.ids[*i].trace, b.ids[*i].trace);
        far && last.xyz().distance(given.xyz()) < 1e-3
            && a.radiance[*i].distance(b.radiance[*i]) < 0.1
    };
    let share = pixels.iter().filter(|i| close(i)).count() as f64 / pixels.len() as f64;
    assert!(share > 0.8, "{share}");
}

#[test]
fn one_mirror_of_the_hall_shows_the_others() {
    // Of all mirrors one alone is asked for, which shows each of the ten others.
    let (session, scene) = (Session::open(), scene::load("hall-of-mirrors").unwrap());
    let case = format!("sphere-8={TWICE};*=none");
    let tested = frame(&session, &scene, &case, SIZE, 0);
    let truth = tracer(&scene, &scene.at(0)).frame(SIZE);
    let sphere = scene.objects.iter().position(|o| o.name == "sphere-8").unwrap() as u32;
    let twice = |frame: &FrameRecord, i: usize| {
        frame.reflector[i] == sphere && frame.record.ids[i].order() == 2
    };
    let asked: Vec<usize> = (0..truth.reflector.len()).filter(|&i| twice(&truth, i)).collect();
    assert!(asked.len() > 30, "only {}", asked.len());
    let agreed = agreed(&truth, &tested);
    let found = asked.iter().filter(|i| agreed.contains(i)).count() as f64;
    assert!(found > 0.8 * asked.len() as f64, "{found} of {}", asked.len());
}

#[test]
fn weak_mirrors_end_the_chain() {
    let session = Session::open();
    let mut scene: Scene = scene::load("two-spheres").unwrap();
    for mirror in scene.materials.iter_mut().filter_map(|material| material.mirror.as_mut()) {
        mirror.reflectance = 0.4;
    }
    let [once, twice] = [ONCE, TWICE].map(|case| frame(&session, &scene, case, SIZE, BEHIND));
    assert_eq!(once.record.ids, twice.record.ids);
}
