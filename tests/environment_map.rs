//! Environment mapping in all its forms: where each is exact, and what each gets wrong.

mod gpu_support;
mod truth_support;

use glam::{Vec3, Vec4Swizzles};
use gpu_support::{Session, engine, frame, judged, options};
use mirrorbench::geometry::{Camera, Projection};
use mirrorbench::measure::Accuracy;
use mirrorbench::scene::{self, CameraPath, FrameRecord, Glass, NO_OBJECT, Scene};
use mirrorbench::truth::{Tracer, TruthOptions};

const SIZE: [u32; 2] = [128, 96];

/// The displacements of pixels where truth and method show the same object, sorted.
fn same_object(session: &Session, scene: &Scene, case: &str) -> (Vec<f32>, Accuracy) {
    let (tested, accuracy, maps) = judged(session, scene, case, SIZE, 0);
    let truth = gpu_support::tracer(scene, &scene.at(0)).frame(SIZE);
    let same = |i: &usize| tested.record.ids[*i].object == truth.record.ids[*i].object;
    let pixels = tested.reflector_pixels().into_iter().filter(same);
    let mut displaced: Vec<f32> =
        pixels.map(|i| maps.displacement_px[i]).filter(|d| d.is_finite()).collect();
    displaced.sort_by(f32::total_cmp);
    (displaced, accuracy)
}

fn finite(frame: &FrameRecord) -> bool {
    frame.reflector_pixels().into_iter().all(|i| {
        let record = &frame.record;
        record.radiance[i].is_finite() && record.point[i].is_finite() && frame.colour[i].is_finite()
    })
}

fn looking(eye: Vec3, target: Vec3, height: f32) -> CameraPath {
    let projection = Projection::Orthographic { height };
    let camera = Camera { eye, target, up: Vec3::Y, projection, near: 0.01, far: 100.0 };
    CameraPath::Keys(vec![(0.0, camera)])
}

#[test]
fn a_box_is_exact_on_the_walls_of_a_room() {
    // T1. Quads and box stand in the room; beside them the room is the proxy.
    let (session, scene) = (Session::open(), scene::load("patow-room").unwrap());
    let (by_box, accuracy) = same_object(&session, &scene, "environment-map:proxy=box");
    let at = |share: f64| by_box[((by_box.len() - 1) as f64 * share) as usize];
    assert!(by_box.len() > 1000 && at(0.5) < 0.1 && at(0.9) < 0.2, "{} {}", at(0.5), at(0.9));
    let bad = |case: &str| judged(&session, &scene, case, SIZE, 0).1.bad_share.one;
    let (by_sphere, by_none) = (bad("environment-map:proxy=sphere"), bad("environment-map"));
    assert!(accuracy.bad_share.one < by_sphere && by_sphere < by_none, "{by_sphere} {by_none}");
}

/// A mirror ball in a checkered ball of radius 3 m, the eye inside too.
const BALL_ROOM: &str = r#"
[camera]
fov_deg = 60.0
eye = [0.0, 0.4, 2.6]
target = [0.0, 0.0, 0.0]
[[objects]]
name = "mirror"
shape = { sphere = { radius = 1.0, slices = 128, stacks = 64 } }
material = "mirror"
[[objects]]
name = "room"
shape = { sphere = { radius = 3.0, slices = 256, stacks = 128 } }
material = "floor"
"#;

#[test]
fn a_finite_sphere_is_exact_at_its_radius() {
    let (session, scene) = (Session::open(), truth_support::scene(BALL_ROOM));
    let median = |case: &str| {
        let (displaced, _) = same_object(&session, &scene, case);
        displaced[displaced.len() / 2]
    };
    let exact = median("environment-map:proxy=sphere,proxy_radius=3");
    let fitted = median("environment-map:proxy=sphere");
    let smaller = median("environment-map:proxy=sphere,proxy_radius=2");
    let none = median("environment-map");
    assert!(exact < 0.1 && fitted < 0.1, "{exact} {fitted}");
    assert!(smaller > 0.5 && none > 2.0, "{smaller} {none}");
}

#[test]
fn all_projections_show_the_same() {
    let (session, scene) = (Session::open(), scene::load("columns").unwrap());
    let cube = frame(&session, &scene, "environment-map", SIZE, 0);
    let pixels = cube.reflector_pixels();
    for case in [
        "environment-map:projection=sphere",
        "environment-map:projection=latlong",
        "environment-map:projection=sphere,filter=nearest",
        "environment-map:projection=latlong,filter=mip",
        "environment-map:filter=nearest",
        "environment-map:filter=mip",
    ] {
        let other = frame(&session, &scene, case, SIZE, 0);
        assert!(finite(&other), "{case}");
        let same = |i: &&usize| {
            cube.record.ids[**i].object == other.record.ids[**i].object
                && (cube.record.ids[**i].object == NO_OBJECT
                    || cube.record.point[**i].distance(other.record.point[**i]) < 0.1)
        };
        let share = pixels.iter().filter(same).count() as f64 / pixels.len() as f64;
        // What is left lies on edges, a texel to one side or the other.
        assert!(share > 0.97, "{case}: {share}");
    }
}

#[test]
fn the_singular_direction_of_a_sphere_map_is_a_direction_like_any_other() {
    // Seen straight from behind under parallel rays every pixel of the flat mirror has r = (0, 0, -1).
    let (session, mut scene) = (Session::open(), scene::load("lecture").unwrap());
    scene.camera = looking(Vec3::new(0.0, 1.0, -4.0), Vec3::new(0.0, 1.0, 0.0), 3.0);
    for source in ["capture", "ball"] {
        for filter in ["nearest", "bilinear", "mip"] {
            let case = format!("environment-map:projection=sphere,source={source},filter={filter}");
            let seen = frame(&session, &scene, &case, SIZE, 0);
            let pixels = seen.reflector_pixels();
            assert!(pixels.len() > 1000 && finite(&seen), "{case}");
            let first = seen.record.ids[pixels[0]];
            assert!(pixels.iter().all(|&i| seen.record.ids[i] == first), "{case}");
            // The rim's texels are slivers: 5 degrees long with 1024 across the disc.
            let shown = seen.record.point[pixels[0]];
            let towards = shown.xyz() - shown.w * Vec3::Y;
            let off = towards.angle_between(Vec3::NEG_Z);
            assert!(off < 0.15, "{case}: {off}");
        }
    }
    // And from both sides of the seam and near the pole of the polar map.
    let polar = frame(&session, &scene, "environment-map:projection=latlong", SIZE, 0);
    assert!(finite(&polar));
}

#[test]
fn the_quiz_does_not_depend_on_the_maps_layout() {
    let (session, scene) = (Session::open(), scene::load("lecture").unwrap());
    for case in [
        "environment-map:projection=sphere",
        "environment-map:projection=latlong",
        "environment-map:filter=nearest,stage=fragment",
    ] {
        let seen = frame(&session, &scene, case, [640, 320], 0);
        let objects = seen.reflector_pixels().into_iter().map(|i| seen.record.ids[i].object);
        let mut names: Vec<&str> = objects
            .filter_map(|id| scene.objects.get(id as usize)?.name.strip_prefix("object-"))
            .collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names, ["1", "3", "4"], "{case}");
    }
}

/// A mirror ball of 0.2 m in Patow's room, seen as the map's ball is.
fn ball_portrait() -> Scene {
    let mut scene = scene::load("patow-room").unwrap();
    let sphere = scene.reflectors()[0] as usize;
    let mesh = scene.objects[sphere].mesh;
    scene.meshes[mesh] = mirrorbench::geometry::shapes::sphere(0.2, 256, 128);
    scene.camera = looking(Vec3::new(0.0, 0.0, 3.0), Vec3::ZERO, 0.44);
    scene
}

#[test]
fn a_mirror_balls_picture_is_the_picture_of_a_mirror_ball() {
    let (session, scene) = (Session::open(), ball_portrait());
    let size = [96, 96];
    let bad = |radius: &str| {
        let case =
            format!("environment-map:projection=sphere,source=ball,ball_radius={radius},size=512");
        judged(&session, &scene, &case, size, 0).1
    };
    // The same ball: each pixel finds in the map what its own ray met.
    let same = bad("0.2");
    assert!(same.bad_share.half < 0.04, "{same:?}");
    // A smaller one sees from elsewhere.
    let smaller = bad("0.01");
    assert!(smaller.bad_share.half > 0.2, "{smaller:?}");
}

#[test]
fn a_tiny_balls_picture_is_the_view_from_its_centre() {
    let (session, scene) = (Session::open(), scene::load("patow-room").unwrap());
    let capture = frame(&session, &scene, "environment-map:projection=sphere", SIZE, 0);
    let seen = |radius: &str| {
        let case = format!("environment-map:projection=sphere,source=ball,ball_radius={radius}");
        let ball = frame(&session, &scene, &case, SIZE, 0);
        let pixels = capture.reflector_pixels();
        let apart = |&i: &usize| {
            let (a, b) = (capture.record.point[i].xyz(), ball.record.point[i].xyz());
            capture.record.ids[i].object == ball.record.ids[i].object && a.distance(b) < 0.03
        };
        pixels.iter().filter(|i| apart(i)).count() as f64 / pixels.len() as f64
    };
    let (tiny, small) = (seen("0.0005"), seen("0.2"));
    assert!(tiny > 0.98 && small < 0.5, "{tiny} {small}");
}

fn mean_difference(a: &FrameRecord, b: &FrameRecord) -> f64 {
    let pixels = a.reflector_pixels();
    let sum: f32 = pixels.iter().map(|&i| (a.colour[i] - b.colour[i]).abs().element_sum()).sum();
    f64::from(sum) / (3 * pixels.len()) as f64
}

#[test]
fn colours_at_the_corners_of_a_square_mirror_make_a_gradient() {
    // T3: "think of what would happen for a square mirror".
    let (session, scene) = (Session::open(), scene::load("square-mirror").unwrap());
    let [pixel, ray, vertex] = ["pixel", "vertex-ray", "vertex"].map(|at| {
        frame(&session, &scene, &format!("environment-map:shade_at={at}"), [160, 120], 0)
    });
    // Rays blended from four corners are nearly those of the pixels; colours are nothing like them.
    let (of_rays, of_colours) = (mean_difference(&ray, &pixel), mean_difference(&vertex, &pixel));
    assert!(of_colours > 0.1 && of_rays < 0.5 * of_colours, "{of_rays} {of_colours}");
    // All that it shows are the points its four corners see.
    let points = vertex.reflector_pixels().into_iter().map(|i| vertex.record.point[i].to_array());
    let mut seen: Vec<_> = points.map(|point| point.map(f32::to_bits)).collect();
    seen.sort_unstable();
    seen.dedup();
    assert_eq!(seen.len(), 4);
}

#[test]
fn vertices_of_a_fine_mesh_do_nearly_as_well_as_pixels() {
    let (session, mut scene) = (Session::open(), scene::load("patow-room").unwrap());
    let mesh = scene.objects[scene.reflectors()[0] as usize].mesh;
    let off = |scene: &Scene, at: &str| {
        let pixel = frame(&session, scene, "environment-map", SIZE, 0);
        let other = frame(&session, scene, &format!("environment-map:shade_at={at}"), SIZE, 0);
        assert!(finite(&other));
        mean_difference(&other, &pixel)
    };
    let coarse = off(&scene, "vertex");
    scene.meshes[mesh] = mirrorbench::geometry::shapes::sphere(1.0, 256, 128);
    let (fine, fine_rays) = (off(&scene, "vertex"), off(&scene, "vertex-ray"));
    assert!(fine < 0.6 * coarse && fine_rays < fine, "{coarse} {fine} {fine_rays}");
}

/// A mirror ball in a box with checks finer than a pixel shows them.
const CHECKERED_BOX: &str = r#"
[camera]
fov_deg = 60.0
eye = [0.0, 0.3, 3.4]
target = [0.0, 0.0, 0.0]
[[objects]]
name = "mirror"
shape = { sphere = { radius = 1.0, slices = 128, stacks = 64 } }
material = "mirror"
[[objects]]
name = "room"
shape = { box = { size = [8.0, 8.0, 8.0] } }
material = "floor"
"#;

#[test]
fn mip_maps_alias_less() {
    let (session, scene) = (Session::open(), truth_support::scene(CHECKERED_BOX));
    let samples = TruthOptions { spp: 64, ..TruthOptions::default() };
    let size = [96, 72];
    let truth = Tracer::new(&scene, &scene.at(0), samples).frame(size);
    let squared = |filter: &str| {
        let case = format!("environment-map:proxy=box,filter={filter}");
        let seen = frame(&session, &scene, &case, size, 0);
        let pixels = seen.reflector_pixels();
        let sum: f32 = pixels
            .iter()
            .map(|&i| (seen.record.radiance[i] - truth.colour[i]).length_squared())
            .sum();
        f64::from(sum) / pixels.len() as f64
    };
    let [nearest, bilinear, mip] = ["nearest", "bilinear", "mip"].map(squared);
    assert!(mip < 0.5 * bilinear && bilinear < nearest, "{nearest} {bilinear} {mip}");
}

#[test]
fn both_record_modes_draw_the_same_picture_in_every_form() {
    let (session, scene) = (Session::open(), scene::load("teapot").unwrap());
    for case in [
        "environment-map:projection=sphere,source=ball,filter=mip,stage=fragment",
        "environment-map:projection=latlong,filter=nearest,proxy=sphere,shade_at=vertex",
        "environment-map:filter=mip,proxy=box,shade_at=vertex-ray",
    ] {
        let full = frame(&session, &scene, case, SIZE, 0);
        let mut options = options(SIZE);
        options.record = mirrorbench::experiment::engine::RecordMode::Radiance;
        let (radiance, _) =
            engine(&session, &scene, case, &options).frame(&scene.at(0), true).unwrap();
        assert_eq!(full.colour, radiance.colour, "{case}");
    }
}

#[test]
fn glass_by_a_map_is_right_where_its_two_errors_cancel() {
    // The map bends a ray by half and forgets where it passes the centre. Near the axis both cancel
    // on a wall at distance L behind a ball of radius R where (n - 1) / n = R / L: n = 1.36 here.
    let (session, mut scene) = (Session::open(), scene::load("glass-sphere").unwrap());
    let ball = scene.reflectors()[0] as usize;
    let material = scene.objects[ball].material;
    let size = [96, 96];
    let mut apart = |index: f32| {
        scene.materials[material].glass = Some(Glass { index, tint: Vec3::ONE });
        let seen = frame(&session, &scene, "environment-map", size, 0).refracted.unwrap();
        let truth = gpu_support::tracer(&scene, &scene.at(0)).frame(size);
        let traced = truth.refracted.as_ref().unwrap();
        let same = |i: &usize| {
            seen.ids[*i].object == traced.ids[*i].object && seen.ids[*i].object != NO_OBJECT
        };
        let pixels = truth.reflector_pixels().into_iter().filter(same);
        let mut apart: Vec<f32> =
            pixels.map(|i| seen.point[i].xyz().distance(traced.point[i].xyz())).collect();
        apart.sort_by(f32::total_cmp);
        apart[apart.len() / 2]
    };
    let [straight, right, strong] = [1.0, 1.36, 2.4].map(&mut apart);
    assert!(right < 0.15 && straight > 0.4 && strong > 0.4, "{straight} {right} {strong}");
}
