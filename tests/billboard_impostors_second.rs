//! What billboards show by two mirrors: mirrors in other mirrors, and mirrors in themselves.

mod gpu_support;

use gpu_support::{Session, judged};
use mirrorbench::measure::Second;
use mirrorbench::scene;

const SIZE: [u32; 2] = [192, 108];

/// Bad at a pixel where the truth meets two mirrors: the first again, and another.
fn second_order(session: &Session, name: &str, case: &str) -> [f64; 2] {
    let scene = scene::load(name).unwrap();
    let (_, accuracy, _) = judged(session, &scene, case, SIZE, 0);
    [Second::Own, Second::Other].map(|second| {
        let of = accuracy.by_second.iter().find(|one| one.second == second).unwrap().group;
        assert!(of.share > 0.015, "{name}: only {} of the pixels {second:?}", of.share);
        of.bad_share.one
    })
}

#[test]
fn stored_surfaces_put_mirrors_in_mirrors_right() {
    let session = Session::open();
    for (name, most) in [("table", 0.1), ("hall-of-mirrors", 0.12)] {
        let [_, quads] =
            second_order(&session, name, "billboard-impostors@revised:relief=off,far=direction");
        let [_, relief] = second_order(&session, name, "billboard-impostors@revised");
        assert!(quads > 0.5 && relief < most, "{name}: {relief} instead of {quads}");
    }
}

#[test]
fn a_mirror_shows_itself_in_pictures_of_its_own_parts() {
    let session = Session::open();
    for (name, most) in [("table", 0.3), ("hall-of-mirrors", 0.15)] {
        let [without, others] = second_order(&session, name, "billboard-impostors@revised:own=0");
        let [with, beside] = second_order(&session, name, "billboard-impostors@revised");
        assert!(without > 0.75 && with < most, "{name}: {with} instead of {without}");
        // And does not stand before what else it shows.
        assert!(beside < others + 0.03, "{name}: {beside} instead of {others}");
    }
}

#[test]
fn a_convex_mirror_never_shows_itself() {
    let session = Session::open();
    let scene = scene::load("two-spheres").unwrap();
    let (drawn, _, _) = judged(&session, &scene, "billboard-impostors@revised", SIZE, 240);
    let twice = drawn.record.ids.iter().filter(|ids| ids.order() > 1);
    let own = twice.clone().filter(|ids| ids.trace & 0xff == ids.trace >> 8 & 0xff).count();
    assert!(twice.count() > 100 && own == 0, "{own}");
}
