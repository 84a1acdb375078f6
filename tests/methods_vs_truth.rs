//! Each method against the truth on small views: exact where it must be, inside a band where it
//! errs (too good is suspicious), and in the order the papers claim.

mod gpu_support;

use std::collections::BTreeSet;

use glam::{Vec2, Vec3, Vec4Swizzles};
use gpu_support::{Session, frame, judged, mirror_in_a_room, tracer};
use mirrorbench::geometry::{Camera, Projection, cube, optics};
use mirrorbench::scene::{self, CameraPath, FrameRecord, Mirror, Pattern, Scene, Status};

const SIZE: [u32; 2] = [128, 96];

/// A case, a scene, and the band its `bad_share` at 1 px lies in. Environment maps of a near scene
/// are wrong nearly everywhere; what is right shows the environment or the far floor.
const BANDS: [(&str, &str, [f64; 2]); 60] = [
    ("environment-map", "sky", [0.0, 0.0]),
    ("environment-map", "columns", [0.3, 0.75]),
    ("environment-map", "patow-room", [0.8, 1.0]),
    ("environment-map:index=surface", "patow-room", [0.9, 1.0]),
    ("environment-map", "glass-sphere", [0.95, 1.0]),
    ("environment-map", "hall-of-mirrors", [0.5, 0.7]),
    ("distance-impostor", "sky", [0.0, 0.0]),
    ("distance-impostor", "columns", [0.15, 0.35]),
    ("distance-impostor@revised", "columns", [0.01, 0.05]),
    ("distance-impostor", "patow-room", [0.02, 0.07]),
    ("distance-impostor@revised", "patow-room", [0.01, 0.035]),
    ("distance-impostor@revised", "lecture", [0.03, 0.12]),
    ("distance-impostor@revised", "stress-pole", [0.002, 0.03]),
    ("distance-impostor@revised", "stress-gap", [0.002, 0.03]),
    ("screen-space", "sky", [0.0, 0.0]),
    ("screen-space", "columns", [0.2, 0.45]),
    ("screen-space", "patow-room", [0.7, 0.95]),
    ("screen-space", "lecture", [0.3, 0.55]),
    ("planar-mirror", "lecture", [0.0, 0.002]),
    ("z-buffered-map", "sky", [0.0, 0.0]),
    ("z-buffered-map", "patow-room", [0.008, 0.03]),
    ("z-buffered-map:layers=1", "clutter-60", [0.02, 0.1]),
    ("z-buffered-map@revised:size=256", "sky", [0.0, 0.0]),
    ("z-buffered-map@revised:size=256", "columns", [0.001, 0.03]),
    ("z-buffered-map@revised:size=256", "patow-room", [0.0, 0.005]),
    ("virtual-objects", "columns", [0.05, 0.4]),
    ("virtual-objects", "two-spheres", [0.1, 0.7]),
    ("virtual-objects:subdivide=0.37", "kitchen-table1", [0.5, 0.99]),
    ("virtual-objects@revised", "columns", [0.001, 0.1]),
    ("virtual-objects@revised:reflector_map=cube", "columns", [0.001, 0.1]),
    ("virtual-objects@revised", "two-spheres", [0.001, 0.1]),
    ("virtual-objects@revised", "kitchen-table1", [0.001, 0.1]),
    ("explosion-map", "sky", [0.0, 0.0]),
    ("explosion-map", "columns", [0.2, 0.45]),
    ("explosion-map@revised", "columns", [0.0, 0.02]),
    ("explosion-map@revised", "two-spheres", [0.001, 0.03]),
    ("explosion-map@revised", "kitchen-table1", [0.001, 0.1]),
    ("reflection-morphing:files=none", "columns", [0.03, 0.2]),
    ("reflection-morphing:files=none", "two-spheres", [0.05, 0.5]),
    ("reflection-morphing:nodes=eye", "columns", [0.0, 0.03]),
    ("reflection-morphing:nodes=eye", "columns-moving", [0.0, 0.03]),
    ("reflection-morphing:nodes=eye", "two-spheres", [0.003, 0.03]),
    ("reflection-morphing:nodes=eye,bounces=2", "two-spheres", [0.0005, 0.015]),
    ("reflection-morphing@revised:files=none", "columns", [0.001, 0.015]),
    ("depth-impostors:size=256", "sky", [0.0, 0.0]),
    ("depth-impostors:size=256", "statue", [0.01, 0.06]),
    ("depth-impostors@revised:size=256", "statue", [0.0005, 0.006]),
    ("depth-impostors@revised:size=256,step_deg=10", "columns", [0.001, 0.03]),
    ("depth-impostors@revised:size=256,search=march", "statue", [0.0005, 0.006]),
    ("billboard-impostors", "sky", [0.0, 0.0]),
    ("billboard-impostors", "columns", [0.08, 0.2]),
    ("billboard-impostors", "two-spheres", [0.08, 0.25]),
    ("billboard-impostors:size=256,map=256", "table", [0.08, 0.22]),
    ("billboard-impostors:size=256,map=256", "half-sunk", [0.08, 0.22]),
    ("billboard-impostors@revised", "columns", [0.0, 0.01]),
    ("billboard-impostors@revised", "two-spheres", [0.0, 0.01]),
    ("billboard-impostors@revised:size=256,map=256", "table", [0.005, 0.06]),
    ("billboard-impostors@revised:size=256,map=256", "half-sunk", [0.005, 0.06]),
    ("depth-impostors:size=256", "half-sunk", [0.06, 0.2]),
    ("depth-impostors@revised:size=256,step_deg=10", "half-sunk", [0.02, 0.08]),
];

#[test]
fn every_method_errs_within_its_band() {
    let session = Session::open();
    for (case, name, [low, high]) in BANDS {
        let scene = scene::load(name).unwrap();
        let (_, accuracy, _) = judged(&session, &scene, case, SIZE, 0);
        let bad = accuracy.bad_share.one;
        assert!(
            (low..=high).contains(&bad),
            "{case} on {name}: bad_share {bad}, not {low}..{high}"
        );
        // DESIGN 7: the footprints of rasteriser and tracer differ in at most 0.2 % of the pixels.
        let mismatch = accuracy.footprint_mismatch;
        assert!(mismatch <= 0.002, "{case} on {name}: footprint mismatch {mismatch}");
    }
}

#[test]
fn virtual_objects_in_a_flat_mirror_are_the_planar_mirrors() {
    // Any texel of a flat mirror gives the one plane, so the search cannot err.
    let (session, scene) = (Session::open(), scene::load("lecture").unwrap());
    let size = [320, 160];
    let exact = frame(&session, &scene, "planar-mirror", size, 0);
    let ours = frame(&session, &scene, "virtual-objects:cull=none", size, 0);
    let pixels = common(&exact, &ours);
    assert!(pixels.len() > 2000, "only {} pixels", pixels.len());
    let near = |i: &&usize| {
        let [a, b] = [&exact, &ours].map(|f| (f.record.ids[**i].object, f.record.point[**i]));
        a.0 == b.0 && a.1.abs_diff_eq(b.1, 1e-3 * a.1.length().max(1.0))
    };
    let share = pixels.iter().filter(near).count() as f64 / pixels.len() as f64;
    assert!(share > 0.995, "{share} of the pixels show the same point");
}

#[test]
fn a_closed_partner_is_searched_in_place_of_an_open_mirror() {
    // Half a sphere shows what the whole one does where both are seen, as the search does not end at
    // its rim (Estalella et al. 2006, section 5.1).
    let session = Session::open();
    let shape = "{ sphere = { radius = 0.8, slices = 96, stacks = 48 } }";
    let half = "{ revolution = { profile = [[0.0, -0.8], [0.44184, -0.8], [0.8, -0.44184], [0.8, 0.0]], \
                curve = \"bezier\", slices = 96, stacks = 24 } }";
    let case = "virtual-objects:cull=none";
    let whole = mirror_in_a_room(&session, case, SIZE, shape, "");
    let paired = mirror_in_a_room(&session, case, SIZE, half, &format!("closed = {shape}"));
    let alone = mirror_in_a_room(&session, case, SIZE, half, "");
    let right = |tested: &FrameRecord| {
        let pixels = common(&whole, tested);
        assert!(pixels.len() > 500, "only {} pixels", pixels.len());
        let same = |i: &&usize| {
            let (a, b) = (whole.record.point[**i], tested.record.point[**i]);
            whole.record.ids[**i].object == tested.record.ids[**i].object && a.abs_diff_eq(b, 0.05)
        };
        pixels.iter().filter(same).count() as f64 / pixels.len() as f64
    };
    let (paired, alone) = (right(&paired), right(&alone));
    assert!(paired > 0.9 && paired > alone + 0.02, "{paired} with a partner, {alone} without");
}

#[test]
fn what_is_hidden_covers_the_mirror_unless_it_is_left_out() {
    // The table is torn open in the middle of the region hidden behind the bowl.
    let (session, scene) = (Session::open(), scene::load("kitchen-table1").unwrap());
    let case = "virtual-objects:subdivide=0.37";
    let wrong = [case, &format!("{case},cull=none,unseen=draw")]
        .map(|case| judged(&session, &scene, case, [320, 240], 132).1.wrong_object);
    assert!(wrong[0] < 0.5 && wrong[1] > 0.6, "{wrong:?}");
}

#[test]
fn without_a_method_every_reflector_pixel_is_missing() {
    let session = Session::open();
    let scene = scene::load("columns").unwrap();
    let (_, accuracy, _) = judged(&session, &scene, "none", SIZE, 0);
    assert_eq!((accuracy.missing, accuracy.bad_share.four), (1.0, 1.0));
}

#[test]
fn a_sky_alone_is_read_from_the_right_texels() {
    let (session, scene) = (Session::open(), scene::load("sky").unwrap());
    let texels = 512.0;
    let tested = frame(&session, &scene, "environment-map", SIZE, 7);
    let moment = scene.at(7);
    let (truth, eye) = (tracer(&scene, &moment).frame(SIZE), moment.camera.eye);
    let pixels = common(&truth, &tested);
    assert!(pixels.len() > 1000, "only {} pixels", pixels.len());
    for i in pixels {
        assert_eq!(tested.record.ids[i].status(), Status::Environment);
        let incident = (tested.position[i] - eye).normalize();
        let mirrored = optics::reflect(incident, tested.normal[i]);
        let read = tested.record.point[i].xyz();
        // Both on the face of the texel read, in texels.
        let (face, texel) = cube::face_uv(read);
        let axis = cube::direction(face, Vec2::splat(0.5));
        // Drawn towards the face's middle a little, lest rounding puts it on the next face.
        let inwards = axis + 0.99 * (mirrored / mirrored.dot(axis) - axis);
        let exact = 0.5 + (cube::face_uv(inwards).1 - 0.5) / 0.99;
        let away = ((texel - exact) * texels).abs().max_element();
        assert!(away <= 0.501, "pixel {i}: {away} texels from {mirrored} to {read}");
        // The steepest change of this sky over one texel, and half-float rounding.
        let change = 0.7 * 2.0 / texels + 1.0 / 1024.0;
        let difference = (truth.record.radiance[i] - tested.record.radiance[i]).abs();
        assert!(difference.max_element() <= change, "pixel {i}: colour off by {difference}");
    }
}

#[test]
fn a_flat_mirror_is_exact() {
    let (session, scene) = (Session::open(), scene::load("lecture").unwrap());
    let (_, accuracy, _) = judged(&session, &scene, "planar-mirror", [320, 160], 0);
    let displacement = accuracy.displacement_px.unwrap();
    assert!(displacement.p95 < 0.05, "{displacement:?}");
    assert!(accuracy.covered > 0.998, "{accuracy:?}");
}

#[test]
fn a_flat_mirror_is_exact_under_parallel_rays() {
    let (session, mut scene) = (Session::open(), scene::load("lecture").unwrap());
    let camera = scene.camera.at(0.0);
    let projection = Projection::Orthographic { height: 3.0 };
    scene.camera = CameraPath::Keys(vec![(0.0, Camera { projection, ..camera })]);
    let (_, accuracy, _) = judged(&session, &scene, "planar-mirror", [160, 80], 0);
    assert!(accuracy.bad_share.half < 0.002 && accuracy.covered > 0.998, "{accuracy:?}");
    assert!(accuracy.footprint_mismatch <= 0.002, "{accuracy:?}");
}

#[test]
fn a_tinted_mirror_with_a_colour_of_its_own_looks_as_traced() {
    let (session, mut scene) = (Session::open(), scene::load("lecture").unwrap());
    let mirror = scene.objects[scene.reflectors()[0] as usize].material;
    scene.materials[mirror].pattern = Pattern::Colour(Vec3::new(0.1, 0.3, 0.2));
    scene.materials[mirror].mirror = Some(Mirror::plain(0.6, Vec3::new(1.0, 0.8, 0.5)));
    let size = [160, 80];
    let tested = frame(&session, &scene, "planar-mirror", size, 0);
    let truth = tracer(&scene, &scene.at(0)).frame(size);
    let pixels = common(&truth, &tested);
    let same = |i: &&usize| {
        // Half floats, of sums up to about 1.
        tested.colour[**i].abs_diff_eq(truth.colour[**i], 2e-3)
    };
    let share = pixels.iter().filter(same).count() as f64 / pixels.len() as f64;
    // What is left lies on the edges of the floor's checks.
    assert!(share > 0.99, "{share} of {} mirror pixels look as traced", pixels.len());
}

/// Numbers of the lecture's objects 1 to 4 among some pixels' objects.
fn quiz_objects(scene: &Scene, objects: impl Iterator<Item = u32>) -> BTreeSet<u32> {
    let number = |id: u32| {
        let name = &scene.objects.get(id as usize)?.name;
        name.strip_prefix("object-")?.parse().ok()
    };
    objects.filter_map(number).collect()
}

fn mirrored_objects(scene: &Scene, frame: &FrameRecord) -> BTreeSet<u32> {
    quiz_objects(scene, frame.reflector_pixels().into_iter().map(|i| frame.record.ids[i].object))
}

#[test]
fn the_lectures_quiz_has_the_lectures_answers() {
    let (session, scene) = (Session::open(), scene::load("lecture").unwrap());
    let size = [640, 320];
    let truth = tracer(&scene, &scene.at(0)).frame(size);
    assert_eq!(mirrored_objects(&scene, &truth), BTreeSet::from([2, 3, 4]));
    let by_map = frame(&session, &scene, "environment-map", size, 0);
    assert_eq!(mirrored_objects(&scene, &by_map), BTreeSet::from([1, 3, 4]));
    let exact = frame(&session, &scene, "planar-mirror", size, 0);
    assert_eq!(mirrored_objects(&scene, &exact), BTreeSet::from([2, 3, 4]));
    for seen in [&truth, &by_map] {
        let direct = (0..seen.object.len()).filter(|&i| seen.reflector[i] == scene::NO_OBJECT);
        let direct = quiz_objects(&scene, direct.map(|i| seen.object[i]));
        assert_eq!(direct, BTreeSet::from([3, 4]));
    }
}

#[test]
fn the_map_draws_near_columns_farther_off_the_nearer_the_camera() {
    // The abstract of Martin & Popescu 2004: "hundreds of pixels away from its correct location".
    let (session, scene) = (Session::open(), scene::load("columns-dolly").unwrap());
    let [far, near] = [0, 185].map(|at| {
        let (tested, _, maps) = judged(&session, &scene, "environment-map", [1280, 720], at);
        let column = |i: &usize| {
            let id = tested.record.ids[*i].object as usize;
            // The ring of 1.6 m, 0.45 m from the mirror.
            let name = scene.objects.get(id).map_or("", |o| o.name.as_str());
            ["column-1", "column-2", "column-3", "column-4"].contains(&name)
        };
        let shown = tested.reflector_pixels().into_iter().filter(column);
        let mut displaced: Vec<f32> =
            shown.map(|i| maps.displacement_px[i]).filter(|d| d.is_finite()).collect();
        assert!(displaced.len() > 500, "only {} pixels of columns", displaced.len());
        displaced.sort_by(f32::total_cmp);
        displaced[displaced.len() / 2]
    });
    assert!((15.0..40.0).contains(&far), "{far} px from 4 m");
    assert!(near > 100.0, "{near} px from 1.4 m");
}

#[test]
fn the_same_scene_gives_the_same_frame_twice() {
    let (session, scene) = (Session::open(), scene::load("kitchen").unwrap());
    let first = frame(&session, &scene, "environment-map", SIZE, 3);
    assert_eq!(first, frame(&session, &scene, "environment-map", SIZE, 3));
}

fn common(a: &FrameRecord, b: &FrameRecord) -> Vec<usize> {
    a.reflector_pixels().into_iter().filter(|&i| a.reflector[i] == b.reflector[i]).collect()
}

#[test]
fn both_record_modes_draw_the_same_picture() {
    let (session, scene) = (Session::open(), scene::load("patow-room").unwrap());
    for case in ["environment-map", "environment-map:index=surface"] {
        let full = frame(&session, &scene, case, SIZE, 0);
        let mut options = gpu_support::options(SIZE);
        options.record = mirrorbench::experiment::engine::RecordMode::Radiance;
        let mut engine = gpu_support::engine(&session, &scene, case, &options);
        let (radiance, _) = engine.frame(&scene.at(0), true).unwrap();
        assert_eq!(full.colour, radiance.colour, "{case}");
    }
}

#[test]
fn the_passes_of_a_720p_frame_add_up_to_it() {
    let (session, scene) = (Session::open(), scene::load("columns").unwrap());
    let options = gpu_support::options([1280, 720]);
    let mut engine = gpu_support::engine(&session, &scene, "environment-map", &options);
    let moments: Vec<_> = (0..4).map(|at| scene.at(at)).collect();
    for times in engine.burst(&moments).unwrap() {
        assert!(!times.prepare.is_empty(), "the cube moves, so every frame prepares");
        let sum: f64 = times.passes.iter().map(|p| p.gpu_ms).sum();
        let share = sum / times.frame_gpu_ms;
        assert!((0.95..=1.0).contains(&share), "{sum} of {} ms", times.frame_gpu_ms);
    }
}
