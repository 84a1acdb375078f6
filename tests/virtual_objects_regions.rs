//! Virtual objects at the border of what the reflector hides (stress T17), and with most of the reflector
//! off the picture (T16): the published rule tears triangles there, the revised one cuts them.

mod gpu_support;

use gpu_support::{Session, judged};
use mirrorbench::scene;

const SIZE: [u32; 2] = [480, 270];

#[test]
fn nothing_is_stretched_across_the_border_of_what_is_hidden() {
    let (session, scene) = (Session::open(), scene::load("stress-bar").unwrap());
    // The bar enters the shadow, is half in it, and is through.
    for frame in [20, 60, 100] {
        let [published, revised] = ["virtual-objects", "virtual-objects@revised:split_px=0.25"]
            .map(|case| judged(&session, &scene, case, SIZE, frame).1);
        let torn = |a: &mirrorbench::measure::Accuracy| a.missing + a.spurious;
        assert!(torn(&revised) < 0.005, "frame {frame}: {}", torn(&revised));
        assert!(torn(&published) > 4.0 * torn(&revised), "frame {frame}: {}", torn(&published));
        let farthest = revised.displacement_px.unwrap().max;
        assert!(farthest < 1.0, "frame {frame}: {farthest} px off");
    }
}

#[test]
fn a_reflector_off_the_picture_is_searched_whole() {
    let (session, scene) = (Session::open(), scene::load("stress-offscreen").unwrap());
    for frame in [0, 48, 96] {
        let revised =
            judged(&session, &scene, "virtual-objects@revised:split_px=0.25", SIZE, frame).1;
        let torn = revised.missing + revised.spurious;
        assert!(torn < 0.02, "frame {frame}: {torn}");
        let farthest = revised.displacement_px.unwrap().max;
        assert!(farthest < 1.0, "frame {frame}: {farthest} px off");
    }
}

#[test]
fn what_breaks_the_law_of_reflection_is_flagged_and_nothing_else() {
    let (session, scene) = (Session::open(), scene::load("columns").unwrap());
    let (mut far, mut near, mut doubted) = (0, 0, [0, 0]);
    for case in ["virtual-objects:residual_px=1", "virtual-objects@revised:split_px=0"] {
        let (frame, _, maps) = judged(&session, &scene, case, SIZE, 0);
        for (ids, &displacement) in frame.record.ids.iter().zip(&maps.displacement_px) {
            // Half a pixel either side of the bound, as one Newton step is no measure.
            if displacement > 1.5 {
                far += 1;
                doubted[0] += u32::from(ids.flag());
            } else if displacement < 0.5 {
                near += 1;
                doubted[1] += u32::from(ids.flag());
            }
        }
    }
    assert!(far > 500 && near > 2000, "{far} far, {near} near");
    assert!(doubted[0] * 100 >= 99 * far, "{} of {far} flagged", doubted[0]);
    assert!(doubted[1] * 100 <= near, "{} of {near} flagged for nothing", doubted[1]);
}

#[test]
fn a_published_search_may_start_coarse_to_fine() {
    let (session, scene) = (Session::open(), scene::load("columns").unwrap());
    let [centre, pyramid] = ["centre", "pyramid"].map(|start| {
        let case = format!("virtual-objects:start={start}");
        judged(&session, &scene, &case, [160, 120], 0).1.bad_share.one
    });
    assert!(pyramid < centre + 0.02, "{pyramid:?} for {centre:?}");
}
