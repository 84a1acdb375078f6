//! Cases that give reflectors, or parts of one, different methods.

mod gpu_support;

use std::collections::BTreeMap;

use gpu_support::{Session, engine, frame, judged, options};
use mirrorbench::scene::{self, ObjectId, Scene};

const SIZE: [u32; 2] = [128, 96];

fn named(scene: &Scene, name: &str) -> ObjectId {
    scene.objects.iter().position(|object| object.name == name).unwrap() as ObjectId
}

#[test]
fn each_reflector_is_served_by_its_own_method() {
    let (session, scene) = (Session::open(), scene::load("two-spheres").unwrap());
    let names: Vec<_> =
        scene.reflectors().iter().map(|&o| scene.objects[o as usize].name.clone()).collect();
    let case = format!("{}=environment-map;*=none", names[0]);
    let hybrid = frame(&session, &scene, &case, SIZE, 0);
    let whole = frame(&session, &scene, "environment-map", SIZE, 0);
    let first = scene.reflectors()[0];
    let mut seen = [0, 0];
    for i in hybrid.reflector_pixels() {
        let served = hybrid.reflector[i] == first;
        seen[usize::from(served)] += 1;
        let expected = if served { whole.record.ids[i] } else { scene::Ids::MISSING };
        assert_eq!(hybrid.record.ids[i], expected);
    }
    assert!(seen.iter().all(|&n| n > 20), "{seen:?}");
}

#[test]
fn a_part_does_not_stand_in_the_map_of_another() {
    let (session, scene) = (Session::open(), scene::load("hybrid-teapot").unwrap());
    for method in
        ["environment-map", "distance-impostor@revised", "z-buffered-map@revised:size=256"]
    {
        let hybrid = frame(&session, &scene, &format!("*.spout={method};*=none"), SIZE, 0);
        let whole = frame(&session, &scene, method, SIZE, 0);
        let spout = named(&scene, "teapot.spout");
        let pixels: Vec<usize> = hybrid
            .reflector_pixels()
            .into_iter()
            .filter(|&i| hybrid.reflector[i] == spout)
            .collect();
        assert!(pixels.len() > 40, "{}", pixels.len());
        for i in pixels {
            assert_eq!(hybrid.record.ids[i], whole.record.ids[i], "{method}");
            assert_eq!(hybrid.record.radiance[i], whole.record.radiance[i], "{method}");
        }
    }
}

#[test]
fn each_part_counts_its_own_work() {
    let (session, scene) = (Session::open(), scene::load("two-spheres").unwrap());
    let count = |case: &str| -> BTreeMap<String, u64> {
        let (_, times) =
            engine(&session, &scene, case, &options(SIZE)).frame(&scene.at(0), true).unwrap();
        times.counters.into_iter().collect()
    };
    let [first, second] = [0, 1].map(|i| {
        let reflector = scene.reflectors()[i] as usize;
        scene.objects[reflector].name.clone()
    });
    let whole = ["distance-impostor", "ray-traced"].map(count);
    let hybrid = count(&format!("{first}=distance-impostor;{second}=ray-traced"));
    let other = count(&format!("{first}=ray-traced;{second}=distance-impostor"));
    for (counted, method) in whole.iter().zip([0, 1]) {
        assert!(!counted.is_empty());
        for (name, &all) in counted {
            // The largest of a counter's values is no sum.
            if name.starts_with("max") {
                continue;
            }
            let (mine, theirs) = [(&first, &second), (&second, &first)][method];
            let parts = hybrid[&format!("{mine}/{name}")] + other[&format!("{theirs}/{name}")];
            assert_eq!(parts, all, "{name}");
        }
    }
}

#[test]
fn a_body_morphed_and_the_rest_mapped_errs_part_by_part_as_they_do() {
    let (session, scene) = (Session::open(), scene::load("hybrid-teapot").unwrap());
    let of = |case: &str| judged(&session, &scene, case, [240, 180], 0).1;
    let hybrid = of("*.body=reflection-morphing:files=none;*=environment-map");
    let morphed = of("reflection-morphing:files=none");
    let mapped = of("environment-map");
    for (i, part) in hybrid.by_reflector.iter().enumerate() {
        let own = if part.reflector == "teapot.body" { &morphed } else { &mapped };
        assert_eq!(*part, own.by_reflector[i]);
    }
    let body = |accuracy: &mirrorbench::measure::Accuracy| {
        accuracy.by_reflector.iter().find(|part| part.reflector == "teapot.body").unwrap().group
    };
    assert!(body(&hybrid).share > 0.5);
    let [morphed, mapped] = [&morphed, &mapped].map(|of| body(of).bad_share.one);
    assert!(morphed < 0.8 * mapped, "{morphed} {mapped}");
    let parts: f64 =
        hybrid.by_reflector.iter().map(|p| p.group.share * p.group.bad_share.one).sum();
    assert!((parts - hybrid.bad_share.one).abs() < 1e-9);
}
