//! Patow's z-buffered map as published: what the paper claims of it, and where it must fail.

mod gpu_support;
mod truth_support;

use glam::Vec4Swizzles;
use gpu_support::{Session, engine, frame, judged, options, tracer};
use mirrorbench::experiment::engine::RecordMode;
use mirrorbench::scene::{self, FrameRecord, ObjectId, Scene, Status};

const SIZE: [u32; 2] = [128, 128];
const CASE: &str = "z-buffered-map";

/// Work a case counted on a frame, a reflector pixel, in the order of the method's counters.
struct Work {
    pixels: f64,
    texels: f64,
    again: f64,
    skipped: f64,
    reads: f64,
}

fn work(session: &Session, scene: &Scene, case: &str, size: [u32; 2]) -> Work {
    let (frame, times) =
        engine(session, scene, case, &options(size)).frame(&scene.at(0), true).unwrap();
    let pixels = frame.reflector_pixels().len() as f64;
    let count = |name: &str| {
        let found = times.counters.iter().find(|(counter, _)| counter == name);
        found.unwrap_or_else(|| panic!("no counter {name}")).1 as f64 / pixels
    };
    Work {
        pixels,
        texels: count("texels"),
        again: count("texels-again"),
        skipped: count("texels-skipped"),
        reads: count("map-reads"),
    }
}

fn object(scene: &Scene, name: &str) -> ObjectId {
    scene.objects.iter().position(|object| object.name == name).unwrap() as ObjectId
}

/// Share of some pixels for which something holds.
fn share(pixels: &[usize], holds: impl Fn(usize) -> bool) -> f64 {
    assert!(pixels.len() >= 30, "only {} pixels", pixels.len());
    pixels.iter().filter(|&&pixel| holds(pixel)).count() as f64 / pixels.len() as f64
}

/// Figure 6, and section 4's cure for it.
#[test]
fn one_layer_leaves_a_black_hole_and_two_fill_it() {
    let (session, scene) = (Session::open(), scene::load("patow-room").unwrap());
    let (one, accuracy, _) = judged(&session, &scene, "z-buffered-map:layers=1", SIZE, 0);
    assert!((0.01..0.03).contains(&accuracy.missing), "{accuracy:?}");
    let truth = tracer(&scene, &scene.at(0)).frame(SIZE);
    let hidden = object(&scene, "hidden-quad");
    let shows_hidden = |f: &FrameRecord, i: usize| f.record.ids[i].object == hidden;
    let pixels: Vec<_> =
        truth.reflector_pixels().into_iter().filter(|&i| shows_hidden(&truth, i)).collect();
    assert!(pixels.len() > 5, "the mirror shows {} pixels of the hidden quad", pixels.len());
    for &pixel in &pixels {
        assert!(!shows_hidden(&one, pixel), "a map of one layer cannot hold the hidden quad");
    }
    let holes = one.reflector_pixels();
    let holes = holes.iter().filter(|&&i| one.record.ids[i].status() == Status::Environment);
    for &pixel in holes {
        assert_eq!(one.colour[pixel], glam::Vec3::ZERO, "pixel {pixel} is not black");
    }
    let (two, accuracy, _) = judged(&session, &scene, CASE, SIZE, 0);
    assert!(accuracy.missing < 0.001, "{accuracy:?}");
    let found = pixels.iter().filter(|&&pixel| shows_hidden(&two, pixel)).count();
    assert!(2 * found > pixels.len(), "{found} of {} pixels of the hidden quad", pixels.len());
}

/// A box has a far side: with it among the surfaces kept, two layers end inside the box.
#[test]
fn two_layers_do_for_the_room_only_without_back_faces() {
    let (session, scene) = (Session::open(), scene::load("patow-room").unwrap());
    let missing = |case| judged(&session, &scene, case, SIZE, 0).1.missing;
    assert!(missing("z-buffered-map:surfaces=all") > 0.003);
    assert!(missing("z-buffered-map:surfaces=all,layers=3") < 0.001);
}

/// A flat mirror with a wall at its end: rays meet the wall at every distance down to nothing.
const CORNER: &str = r#"
[camera]
fov_deg = 50.0
eye = [2.0, 1.6, 0.5]
target = [-1.2, 0.0, 0.0]
[[objects]]
name = "mirror"
shape = { plane = { size = [4.0, 4.0] } }
material = "mirror"
[[objects]]
name = "wall"
shape = { plane = { size = [8.0, 8.0] } }
material = "red"
position = [-2.002, 0.0, 0.0]
rotation_deg = [90.0, 90.0, 0.0]
"#;

/// The limit is an angle at the reflector, a texel's width one at the map's centre: what is much
/// nearer to the first than to the second is off by more than the limit.
#[test]
fn what_nearly_touches_the_reflector_vanishes() {
    let (session, scene) = (Session::open(), truth_support::scene(CORNER));
    let size = [192, 128];
    let truth = tracer(&scene, &scene.at(0)).frame(size);
    // Distances from the reflector over those from the map's centre, which is the origin.
    let pixels = |low: f32, high: f32| -> Vec<usize> {
        let ratio = |i: usize| truth.record.last[i].w / truth.record.point[i].xyz().length();
        let found = |&i: &usize| truth.record.ids[i].status() == Status::Found;
        let near = truth.reflector_pixels().into_iter().filter(found);
        near.filter(|&i| (low..high).contains(&ratio(i))).collect()
    };
    for (case, none_left) in [(CASE, 0.3), ("z-buffered-map:search=image,line=touched", 0.25)] {
        let tested = frame(&session, &scene, case, size, 0);
        let vanished = |low, high| {
            let lost = |i: usize| tested.record.ids[i].status() != Status::Found;
            share(&pixels(low, high), lost)
        };
        assert!(vanished(0.0, 0.05) > 0.9, "{case}: {}", vanished(0.0, 0.05));
        assert!((0.2..0.8).contains(&vanished(0.1, 0.2)), "{case}: {}", vanished(0.1, 0.2));
        assert!(vanished(none_left, 5.0) < 0.001, "{case}: {}", vanished(none_left, 5.0));
    }
    // With three times the texels a third as near.
    let fine = frame(&session, &scene, "z-buffered-map:size=900,layers=1", size, 0);
    let lost = |i: usize| fine.record.ids[i].status() != Status::Found;
    assert!(share(&pixels(0.11, 5.0), lost) < 0.01);
}

/// Equation (1) adds a direction and a position: its steps fall elsewhere in other units.
#[test]
fn the_same_room_in_metres_centimetres_and_kilometres_gives_different_pictures() {
    let (session, scene) = (Session::open(), scene::load("patow-room").unwrap());
    let shown = |search: &str, unit: &str| {
        let unit = if search == "image" { "" } else { unit };
        frame(&session, &scene, &format!("{CASE}:search={search}{unit}"), SIZE, 0)
    };
    for search in ["vector", "hybrid"] {
        let metres = shown(search, ",unit_m=1");
        let pixels = metres.reflector_pixels();
        for unit in [",unit_m=0.01", ",unit_m=1000"] {
            let other = shown(search, unit);
            let different = share(&pixels, |i| metres.record.ids[i] != other.record.ids[i]);
            let least = if search == "vector" { 0.6 } else { 0.1 };
            assert!(different > least, "{search}{unit}: {different}");
        }
        let same = shown(search, ",unit_m=1");
        assert_eq!(metres, same, "{search}");
    }
}

/// A pole between the mirror and a wall.
const POLE: &str = r#"
[camera]
fov_deg = 40.0
eye = [0.3, 0.7, 4.0]
target = [0.0, 0.0, 0.0]
[[objects]]
name = "wall"
shape = { plane = { size = [20.0, 20.0] } }
material = "floor"
position = [-4.0, 0.0, 0.0]
rotation_deg = [90.0, 90.0, 0.0]
[[objects]]
name = "pole"
shape = { cylinder = { radius = 0.02, height = 6.0 } }
material = "red"
position = [-3.0, 0.0, 0.7]
[[objects]]
name = "ball"
shape = { sphere = { radius = 1.0, edge = 0.02 } }
material = "mirror"
"#;

/// The ray meets both, and the farther one deviates less by the map's coarseness.
#[test]
fn the_best_angle_sees_the_wall_through_a_thin_pole() {
    let (session, scene) = (Session::open(), truth_support::scene(POLE));
    let size = [300, 300];
    let truth = tracer(&scene, &scene.at(0)).frame(size);
    let (wall, pole) = (object(&scene, "wall"), object(&scene, "pole"));
    let shows_pole = |&i: &usize| truth.record.ids[i].object == pole;
    let pixels: Vec<_> = truth.reflector_pixels().into_iter().filter(shows_pole).collect();
    for case in [CASE, "z-buffered-map:search=image,line=touched,layers=1"] {
        let tested = frame(&session, &scene, case, size, 0);
        let through = share(&pixels, |i| tested.record.ids[i].object == wall);
        assert!(through > 0.4, "{case}: {through} of the pole's pixels show the wall");
    }
}

/// What is wrong in his own scene is of that kind, and neither finer faces nor a lower limit help.
#[test]
fn most_wrong_objects_of_the_room_are_seen_through_another() {
    let (session, scene) = (Session::open(), scene::load("patow-room").unwrap());
    let size = [256, 256];
    let truth = tracer(&scene, &scene.at(0)).frame(size);
    let wrong_and_through = |case: &str| {
        let tested = frame(&session, &scene, case, size, 0);
        let object = |f: &FrameRecord, i: usize| f.record.ids[i].object;
        let found = |f: &FrameRecord, i: usize| f.record.ids[i].status() == Status::Found;
        let mut wrong = truth.reflector_pixels();
        wrong.retain(|&i| found(&truth, i) && found(&tested, i));
        wrong.retain(|&i| object(&truth, i) != object(&tested, i));
        // Farther along much the same ray.
        let through = |i: usize| tested.record.last[i].w > 1.2 * truth.record.last[i].w;
        (wrong.len() as f64, share(&wrong, through))
    };
    let (wrong, through) = wrong_and_through(CASE);
    assert!(through > 0.6, "{through} of {wrong} pixels");
    let (finer, _) = wrong_and_through("z-buffered-map:size=600,threshold_deg=0.5");
    assert!(finer > 0.7 * wrong, "{finer} pixels instead of {wrong}");
}

/// "The algorithm complexity only depends on the number of reflective pixels rendered" (section 3).
#[test]
fn the_work_is_flat_in_the_scene_and_linear_in_reflective_pixels() {
    let session = Session::open();
    let room = scene::load("patow-room").unwrap();
    let few = work(&session, &room, CASE, SIZE);
    // A thousand boxes where there was one.
    let mut crowded = room.clone();
    let one = room.objects[object(&room, "box") as usize].clone();
    for i in 0..1000 {
        crowded.objects.push(scene::Object { name: format!("box-{i}"), ..one.clone() });
    }
    let many = work(&session, &crowded, CASE, SIZE);
    assert!(crowded.triangles() > 10 * room.triangles());
    assert_eq!((few.pixels, few.texels, few.reads), (many.pixels, many.texels, many.reads));
    let dense = work(&session, &scene::load("clutter-400").unwrap(), CASE, SIZE);
    assert!((dense.texels / few.texels - 1.0).abs() < 0.05, "{} {}", dense.texels, few.texels);
    // At most the length of each list is read.
    assert!(few.reads <= 2.0 * few.texels && dense.reads <= 2.0 * dense.texels);
    let large = work(&session, &room, CASE, [256, 256]);
    assert!((large.pixels / few.pixels - 4.0).abs() < 0.2);
    assert!((large.texels / few.texels - 1.0).abs() < 0.02, "{} {}", large.texels, few.texels);
    let pair = scene::load("two-spheres").unwrap();
    let single = scene::load("columns").unwrap();
    let [two, one] = [&pair, &single].map(|scene| work(&session, scene, CASE, SIZE).texels);
    assert!((two / one - 1.0).abs() < 0.2, "{two} texels a pixel of two mirrors, {one} of one");
}

/// Section 3: "many pixels of the reflection plane could be examined more than once, or even not
/// examined at all, depending on the step value taken".
#[test]
fn steps_of_t_examine_some_texels_twice_and_skip_others() {
    let (session, scene) = (Session::open(), scene::load("patow-room").unwrap());
    let case = |rest: &str| work(&session, &scene, &format!("{CASE}:search={rest}"), SIZE);
    let vector = case("vector");
    assert!((200.0..=201.0).contains(&vector.texels), "{}", vector.texels);
    assert!(vector.again > 20.0 && vector.skipped > 20.0, "{} {}", vector.again, vector.skipped);
    let touched = case("image,line=touched");
    assert!(
        touched.again < 0.01 && touched.skipped < 0.01,
        "{} {}",
        touched.again,
        touched.skipped
    );
    let fine = case("vector,steps=2000");
    assert!(fine.again > 1500.0 && fine.skipped < 10.0, "{} {}", fine.again, fine.skipped);
    // What every search sees of the arc adds up to the arc.
    for seen in [&vector, &fine, &case("hybrid"), &case("image"), &case("hybrid,line=touched")] {
        let whole = seen.texels - seen.again + seen.skipped;
        assert!((whole / touched.texels - 1.0).abs() < 0.01, "{whole}, not {}", touched.texels);
    }
    assert!(case("hybrid").texels < vector.texels, "the hybrid examines fewer");
}

#[test]
fn nothing_is_undefined_where_mirrored_ray_and_reflector_point_are_in_line() {
    let session = Session::open();
    let looking_at = |eye: &str, shape: &str| {
        truth_support::scene(&format!(
            "[camera]\nfov_deg = 40.0\neye = {eye}\ntarget = [0.0, 0.0, 0.0]\n\
             [[objects]]\nname = \"mirror\"\nshape = {shape}\nmaterial = \"mirror\"\n\
             [[objects]]\nname = \"wall\"\nshape = {{ plane = {{ size = [20.0, 20.0] }} }}\n\
             material = \"floor\"\nposition = [0.0, 6.0, 0.0]\nrotation_deg = [180.0, 0.0, 0.0]\n"
        ))
    };
    // B = [W] in the middle of the ball; the middle of the flat mirror is the map's centre.
    let scenes = [
        looking_at("[0.0, 0.0, 4.0]", "{ sphere = { radius = 1.0, slices = 32, stacks = 16 } }"),
        looking_at("[0.0, 4.0, 1.0]", "{ plane = { size = [3.0, 3.0] } }"),
    ];
    for scene in &scenes {
        for search in ["vector", "hybrid", "image"] {
            let tested = frame(&session, scene, &format!("{CASE}:search={search}"), [65, 65], 0);
            let middle = 32 * 65 + 32;
            assert!(tested.reflector_pixels().contains(&middle));
            for pixel in tested.reflector_pixels() {
                let record = &tested.record;
                assert!(record.point[pixel].is_finite(), "{search}: {}", record.point[pixel]);
                assert!(record.radiance[pixel].is_finite());
                assert_ne!(record.ids[pixel].status(), Status::Missing);
            }
        }
    }
}

#[test]
fn one_map_for_the_scene_is_the_reflectors_own_where_there_is_one() {
    let (session, room) = (Session::open(), scene::load("patow-room").unwrap());
    let own = frame(&session, &room, CASE, SIZE, 0);
    assert_eq!(own, frame(&session, &room, "z-buffered-map:map=scene", SIZE, 0));
    // Of several none is in it.
    let pair = scene::load("two-spheres").unwrap();
    let shared = frame(&session, &pair, "z-buffered-map:map=scene", SIZE, 0);
    let shown = |i: usize| shared.record.ids[i].object;
    let pixels = shared.reflector_pixels();
    assert_eq!(share(&pixels, |i| pair.reflectors().contains(&shown(i))), 0.0);
    assert!(share(&pixels, |i| shared.record.ids[i].status() == Status::Found) > 0.3);
}

#[test]
fn both_stages_and_both_record_modes_draw_the_same() {
    let (session, scene) = (Session::open(), scene::load("two-spheres").unwrap());
    for search in ["vector", "hybrid", "image"] {
        let case = format!("{CASE}:search={search}");
        let full = frame(&session, &scene, &case, SIZE, 0);
        let fragment = frame(&session, &scene, &format!("{case},stage=fragment"), SIZE, 0);
        assert_eq!(full, fragment, "{case}");
        let mut options = options(SIZE);
        options.record = RecordMode::Radiance;
        let lean = engine(&session, &scene, &case, &options).frame(&scene.at(0), true).unwrap().0;
        assert_eq!(full.colour, lean.colour, "{case}");
    }
}
