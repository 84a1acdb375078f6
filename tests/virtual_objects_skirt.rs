//! Open reflectors searched by themselves, carried on beyond their edge, beside a closed partner.

mod gpu_support;

use gpu_support::{Session, judged};
use mirrorbench::scene;

const SIZE: [u32; 2] = [200, 150];

#[test]
fn a_skirt_errs_less_than_a_closed_partner() {
    let (session, scene) = (Session::open(), scene::load("open-sheet").unwrap());
    for frame in [0, 24] {
        let bad = |case| judged(&session, &scene, case, SIZE, frame).1;
        let partner = bad("virtual-objects@revised");
        let skirt = bad("virtual-objects@revised:skirt=0.06");
        let [with, without] = [&skirt, &partner].map(|accuracy| accuracy.bad_share.one);
        assert!(with < 0.01 && with < 0.6 * without, "frame {frame}: {with} for {without}");
        assert!(skirt.missing < 0.5 * partner.missing, "frame {frame}");
    }
}

#[test]
fn a_closed_reflector_has_no_edge_to_carry_on() {
    let (session, scene) = (Session::open(), scene::load("stress-bar").unwrap());
    let frame = |case| gpu_support::frame(&session, &scene, case, SIZE, 0);
    assert_eq!(frame("virtual-objects@revised"), frame("virtual-objects@revised:skirt=0.06"));
}
