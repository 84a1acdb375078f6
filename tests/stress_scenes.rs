//! The stress scenes hold what their comments promise.

use glam::{Vec2, Vec3};
use mirrorbench::scene::{self, Moment, ObjectId, Scene, Surface};

fn only(scene: &Scene, name: &str) -> ObjectId {
    let found = scene.select(name);
    assert_eq!(found.len(), 1, "{name}");
    found[0]
}

fn position(moment: &Moment, object: ObjectId) -> Vec3 {
    moment.poses[object as usize].translation.into()
}

#[test]
fn the_ellipsoid_is_ten_times_as_long_as_thick_and_rolls_a_degree_a_frame() {
    let scene = scene::load("stress-ellipsoid").unwrap();
    let ellipsoid = only(&scene, "ellipsoid");
    let surface = scene.objects[ellipsoid as usize].surface;
    assert_eq!(surface, Some(Surface::Ellipsoid { radii: Vec3::new(1.5, 0.15, 0.5) }));
    for frame in 0..scene.frames {
        let long = scene.at(frame).poses[ellipsoid as usize].transform_vector3(Vec3::X);
        let roll = long.y.atan2(long.x).to_degrees();
        assert!((roll - frame as f32).abs() < 0.01 && long.z.abs() < 1e-5, "{roll} at {frame}");
    }
    assert_eq!(scene.frames, 91);
}

#[test]
fn the_sphere_leaves_the_picture_to_eighty_per_cent() {
    let scene = scene::load("stress-offscreen").unwrap();
    let sphere = only(&scene, "sphere");
    let share = |frame: u32, size: [u32; 2]| {
        let moment = scene.at(frame);
        let corners = scene.world_triangles(&moment, sphere).flatten();
        let rows = corners.map(|p| moment.camera.project(size, p).unwrap().y);
        let limits = (f32::INFINITY, f32::NEG_INFINITY);
        let (top, bottom) = rows.fold(limits, |(low, high), y| (low.min(y), high.max(y)));
        -top / (bottom - top)
    };
    for size in [[1280, 720], [400, 400]] {
        assert!(share(0, size).abs() < 5e-3, "{}", share(0, size));
        assert!((share(96, size) - 0.8).abs() < 5e-3, "{}", share(96, size));
        assert!((1..97).all(|frame| share(frame, size) > share(frame - 1, size)));
    }
}

#[test]
fn the_bar_crosses_the_border_of_the_hidden_region() {
    let scene = scene::load("stress-bar").unwrap();
    let (bar, sphere) = (only(&scene, "bar"), only(&scene, "sphere"));
    // Ends of the bar that lie in the shadow the sphere casts from the eye.
    let hidden = |frame: u32| {
        let moment = scene.at(frame);
        let (eye, centre) = (moment.camera.eye, position(&moment, sphere));
        let reach = eye.distance(centre);
        let ends = [-2.0, 2.0].map(|x| {
            let end = moment.poses[bar as usize].transform_point3(x * Vec3::X);
            assert!(end.distance(centre) > 1.05, "the bar is outside the sphere");
            let cosine = (end - eye).normalize().dot((centre - eye) / reach);
            let behind = (end - centre).dot(eye - centre) < 1.0;
            behind && cosine > (1.0 - 1.0 / (reach * reach)).sqrt()
        });
        ends.into_iter().filter(|hidden| *hidden).count()
    };
    let counts: Vec<usize> = (0..scene.frames).map(hidden).collect();
    assert_eq!((counts[0], counts[96]), (0, 0), "beside it at first, through it at last");
    assert!(counts.iter().filter(|count| **count == 1).count() > 20, "{counts:?}");
}

#[test]
fn box_and_ball_stay_a_millimetre_from_the_sphere() {
    let scene = scene::load("stress-contact").unwrap();
    let [sphere, cube, ball] = ["sphere", "box", "ball"].map(|name| only(&scene, name));
    for frame in 0..scene.frames {
        let moment = scene.at(frame);
        let centre = position(&moment, sphere);
        let from_cube = moment.poses[cube as usize].inverse().transform_point3(centre);
        // The face of +x is square to the sphere's centre.
        assert!(from_cube.y.hypot(from_cube.z) < 1e-4, "{from_cube}");
        let gaps = [from_cube.x - 0.15 - 1.0, position(&moment, ball).distance(centre) - 1.15];
        assert!(gaps.iter().all(|gap| (gap - 0.001).abs() < 2e-5), "{gaps:?} at {frame}");
    }
    let bearing = |frame: u32| {
        let from = position(&scene.at(frame), cube);
        from.x.atan2(from.z).to_degrees()
    };
    assert!((bearing(0) + 90.0).abs() < 0.1 && bearing(48).abs() < 0.1);
    assert!((bearing(96) - 90.0).abs() < 0.1, "from its left by its front to its right");
}

#[test]
fn the_sheet_turns_its_outside_then_its_inside_and_lies_in_its_partner() {
    let scene = scene::load("open-sheet").unwrap();
    let sheet = only(&scene, "sheet");
    let object = &scene.objects[sheet as usize];
    let (mesh, partner) = (scene.mesh_of(sheet), &scene.meshes[object.closed.unwrap()]);
    assert!(partner.is_closed() && !mesh.is_closed());
    for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
        let around = Vec2::new(p.x, p.z);
        assert!((around.length() - 0.7).abs() < 1e-6 && p.y.abs() <= 1.0);
        assert!(n.abs_diff_eq(Vec3::new(p.x, 0.0, p.z) / 0.7, 1e-5), "the normals point out");
    }
    for (frame, faces) in [(0, 1.0), (48, 0.0), (96, -1.0)] {
        let middle = scene.at(frame).poses[sheet as usize].transform_vector3(Vec3::NEG_Z);
        assert!((middle.z - faces).abs() < 1e-5, "{middle} at {frame}");
    }
}

#[test]
fn the_hollow_mirrors_are_a_cap_a_third_of_a_torus_and_a_saddle() {
    let [dish, torus, saddle] = ["dish", "torus", "saddle"].map(|name| {
        let scene = scene::load(name).unwrap();
        let mirror = scene.reflectors()[0];
        scene.mesh_of(mirror).clone()
    });
    // A cap of the sphere of 1 m about (0, 1, 0), 0.8 m across.
    let centre = Vec3::Y;
    assert!(dish.positions.iter().all(|p| (p.distance(centre) - 1.0).abs() < 1e-4));
    let rim = dish.positions.iter().map(|p| p.x.hypot(p.z)).fold(0.0, f32::max);
    assert!((rim - 0.4).abs() < 1e-5);
    let off_torus = |p: &Vec3| (p.x.hypot(p.z) - 1.0).hypot(p.y) - 0.35;
    assert!(torus.positions.iter().all(|p| off_torus(p).abs() < 1e-5));
    let azimuth = |p: &Vec3| (-p.z).atan2(p.x).to_degrees();
    let most = torus.positions.iter().map(azimuth).fold(0.0, f32::max);
    assert!((most - 120.0).abs() < 1e-3);
    // z up in the file is y up here, and y there is -z.
    let height = |p: &Vec3| 0.4 * (p.x * p.x - p.z * p.z);
    assert!(saddle.positions.iter().all(|p| (p.y - height(p)).abs() < 1e-6));
}
