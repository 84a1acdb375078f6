//! The shipped scenes load, are sound, and hold what their comments promise.

use std::collections::BTreeSet;

use glam::{Vec2, Vec3, Vec3Swizzles};
use mirrorbench::geometry::optics::reflect;
use mirrorbench::scene::{self, Moment, Motion, ObjectId, Pattern, Scene, Surface};

fn only(scene: &Scene, name: &str) -> ObjectId {
    let found = scene.select(name);
    assert_eq!(found.len(), 1, "{name}");
    found[0]
}

fn position(moment: &Moment, object: ObjectId) -> Vec3 {
    moment.poses[object as usize].translation.into()
}

#[test]
fn every_shipped_scene_loads_and_is_sound() {
    let scenes = scene::list().unwrap();
    let names: Vec<&str> = scenes.iter().map(|(name, _)| name.as_str()).collect();
    for promised in ["columns", "kitchen", "lecture", "patow-room", "sky", "teapot", "two-spheres"]
    {
        assert!(names.contains(&promised), "{promised} is missing");
    }
    for (name, about) in &scenes {
        let scene = scene::load(name).unwrap();
        assert_eq!((&scene.name, &scene.about), (name, about));
        assert!(!scene.reflectors().is_empty(), "{name} has no mirror");
        assert_eq!(scene.hash.len(), 64);
        for mesh in &scene.meshes {
            assert_sound(name, mesh);
        }
        let texels = scene.images.iter().flat_map(|image| &image.texels);
        for texel in texels {
            let half = texel.to_array().map(|c| half::f16::from_f32(c).to_f32());
            assert_eq!(half, texel.to_array(), "{name} has a texel that is not half precision");
            assert!(texel.min_element() >= 0.0 && texel.is_finite());
        }
        for frame in [0, scene.frames / 2, scene.frames - 1] {
            let moment = scene.at(frame);
            assert_eq!(moment.poses.len(), scene.objects.len());
            let (low, high) = scene.bounds(&moment);
            let depth = moment.camera.eye.distance(0.5 * (low + high)) + low.distance(high) / 2.0;
            assert!(depth < moment.camera.far, "{name} reaches beyond far at frame {frame}");
        }
    }
}

fn assert_sound(name: &str, mesh: &mirrorbench::geometry::Mesh) {
    assert!(mesh.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-4), "{name}: normals");
    for index in 0..mesh.triangles.len() {
        let [a, b, c] = mesh.corners(index);
        let area = (b - a).cross(c - a).length();
        assert!(area > 0.0 && area.is_finite(), "{name}: triangle {index} has area {area}");
    }
}

#[test]
fn a_scene_names_its_content() {
    let columns = scene::load("columns").unwrap();
    let sphere = only(&columns, "sphere");
    assert_eq!(columns.objects[sphere as usize].surface, Some(Surface::Sphere { radius: 1.0 }));
    assert_eq!(columns.reflectors(), [sphere]);
    assert_eq!(columns.select("column-?").len(), 8);
    assert_ne!(columns.hash, scene::load("columns-dolly").unwrap().hash);

    let kitchen = scene::load("kitchen").unwrap();
    let mirrors: Vec<&str> = kitchen
        .reflectors()
        .into_iter()
        .map(|id| kitchen.objects[id as usize].name.as_str())
        .collect();
    assert_eq!(mirrors, ["pan.Steel-Pot", "bowl.CERAMIC_white", "ball"]);
    let [first, second] = [1, 2].map(|n| kitchen.select(&format!("chair-{n}"))[0] as usize);
    assert_eq!(kitchen.objects[first].mesh, kitchen.objects[second].mesh, "meshes are shared");

    let teapot = scene::load("teapot").unwrap();
    assert_eq!(teapot.reflectors(), teapot.select("teapot"));
    assert_eq!(teapot.reflectors().len(), 6);
}

/// 32 patches of 12 x 12 quads; the poles of lid and bottom lose a triangle for each quad there.
#[test]
fn the_teapot_faces_outwards() {
    let teapot = scene::load("teapot").unwrap();
    let triangles =
        |part: &str| teapot.mesh_of(only(&teapot, &format!("teapot.{part}"))).triangles.len();
    assert_eq!(triangles("body"), 8 * 2 * 144);
    assert_eq!(triangles("bottom"), 4 * (2 * 144 - 12));
    let body = teapot.mesh_of(only(&teapot, "teapot.body"));
    for (p, n) in body.positions.iter().zip(&body.normals) {
        assert!(n.xz().dot(p.xz()) > 0.0, "normal {n} at {p}");
    }
    let bottom = teapot.mesh_of(only(&teapot, "teapot.bottom"));
    assert!(bottom.normals.iter().all(|n| n.y < 1e-5), "horizontal at the rim, else down");
}

/// The particle stays clear of the sphere and of the front columns through its whole turn.
#[test]
fn the_cube_of_columns_touches_nothing() {
    let scene = scene::load("columns").unwrap();
    let cube = only(&scene, "cube");
    assert!(matches!(scene.objects[cube as usize].motion, Motion::Orbit { period: 96.0, .. }));
    for frame in 0..96 {
        let moment = scene.at(frame);
        for &corner in &scene.mesh_of(cube).positions {
            let corner = moment.poses[cube as usize].transform_point3(corner);
            assert!(corner.distance(Vec3::Y) > 1.0, "inside the sphere at frame {frame}");
            for column in scene.select("column-*") {
                let gap = corner.xz().distance(position(&moment, column).xz()) - 0.15;
                assert!(gap > 0.0, "inside a column at frame {frame}");
            }
        }
    }
}

/// Distance along a ray to a quad, the object's plane of half width `half`.
fn hit_quad(moment: &Moment, quad: ObjectId, half: f32, from: Vec3, along: Vec3) -> Option<f32> {
    let object_from_world = moment.poses[quad as usize].inverse();
    let origin = object_from_world.transform_point3(from);
    let direction = object_from_world.transform_vector3(along);
    let t = -origin.y / direction.y;
    let at = origin + t * direction;
    (t > 0.0 && at.x.abs() <= half && at.z.abs() <= half).then_some(t)
}

#[test]
fn the_hidden_quad_is_hidden_from_the_map_but_not_from_the_mirror() {
    let scene = scene::load("patow-room").unwrap();
    let (quad, hidden) = (only(&scene, "quad"), only(&scene, "hidden-quad"));
    for frame in [0, 60, 180] {
        let moment = scene.at(frame);
        for (x, z) in [(-0.4, -0.4), (0.4, -0.4), (0.4, 0.4), (-0.4, 0.4)] {
            let corner = moment.poses[hidden as usize].transform_point3(Vec3::new(x, 0.0, z));
            let t = hit_quad(&moment, quad, 0.6, Vec3::ZERO, corner);
            assert!(t.is_some_and(|t| t < 1.0), "a corner is seen from the map's centre");
        }
        let size = [300, 300];
        let seen = (0..300 * 300).filter(|i| {
            let pixel = Vec2::new((i % 300) as f32 + 0.5, (i / 300) as f32 + 0.5);
            let ray = moment.camera.ray(size, pixel);
            let b = ray.origin.dot(ray.direction);
            let root = b * b - ray.origin.length_squared() + 1.0;
            if root < 0.0 {
                return false;
            }
            let point = ray.at(-b - root.sqrt());
            let mirrored = reflect(ray.direction, point);
            hit_quad(&moment, hidden, 0.4, point, mirrored).is_some()
                && hit_quad(&moment, quad, 0.6, point, mirrored).is_none()
        });
        let seen = seen.count();
        assert!(seen > 20, "the mirror shows {seen} pixels of it at frame {frame}");
    }
}

/// The nearest of the lecture's cylinders (a circle of the plan) along a ray of the plan.
fn nearest(circles: &[(u32, Vec2, f32)], from: Vec2, along: Vec2) -> Option<(f32, u32)> {
    let along = along.normalize();
    let hit = |&(number, centre, radius): &(u32, Vec2, f32)| {
        let b = (from - centre).dot(along);
        let root = b * b - (from - centre).length_squared() + radius * radius;
        let t = -b - root.max(0.0).sqrt();
        (root > 0.0 && t > 0.0).then_some((t, number))
    };
    circles.iter().filter_map(hit).min_by(|a, b| a.0.total_cmp(&b.0))
}

/// The quiz: who is seen directly, in the mirror, and in the mirror by an environment map.
#[test]
fn the_lecture_plan_gives_the_three_sets_of_the_quiz() {
    let scene = scene::load("lecture").unwrap();
    let moment = scene.at(0);
    let circles: Vec<(u32, Vec2, f32)> = (1..=4)
        .map(|number| {
            let id = only(&scene, &format!("object-{number}"));
            let (_, high) = scene.mesh_of(id).bounds().unwrap();
            (number, position(&moment, id).xz(), high.x)
        })
        .collect();
    let eye = moment.camera.eye.xz();
    let size = [4000, 2000];
    let [mut direct, mut traced, mut mapped] = [(); 3].map(|()| BTreeSet::new());
    let mut bearings = Vec::new();
    for column in 0..size[0] {
        let ray = moment.camera.ray(size, Vec2::new(column as f32 + 0.5, 1000.0));
        let along = ray.direction.xz().normalize();
        bearings.push(along.y.atan2(along.x).to_degrees());
        let to_mirror = -eye.y / along.y;
        let at = eye + to_mirror * along;
        let mirror = (to_mirror > 0.0 && at.x.abs() <= 1.0).then_some(to_mirror);
        match (nearest(&circles, eye, along), mirror) {
            (Some((t, number)), mirror) if mirror.is_none_or(|m| t < m) => {
                direct.insert(number);
            }
            (_, Some(_)) => {
                let mirrored = Vec2::new(along.x, -along.y);
                traced.extend(nearest(&circles, at, mirrored).map(|(_, number)| number));
                mapped.extend(nearest(&circles, Vec2::ZERO, mirrored).map(|(_, number)| number));
            }
            _ => {}
        }
    }
    assert_eq!(direct, BTreeSet::from([3, 4]), "directly");
    assert_eq!(traced, BTreeSet::from([2, 3, 4]), "in the mirror");
    assert_eq!(mapped, BTreeSet::from([1, 3, 4]), "in the mirror by an environment map");
    let lowest = bearings.iter().copied().fold(f32::INFINITY, f32::min);
    let highest = bearings.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    assert!((lowest + 95.0).abs() < 0.1 && (highest - 5.0).abs() < 0.1, "{lowest} to {highest}");
}

#[test]
fn the_kitchen_camera_comes_from_1_8_m_to_a_quarter_metre_from_the_bowl() {
    let scene = scene::load("kitchen").unwrap();
    let bowl = only(&scene, "bowl");
    let nearest = |frame: u32| {
        let moment = scene.at(frame);
        let points = scene.world_triangles(&moment, bowl).flatten();
        points.map(|p| p.distance(moment.camera.eye)).fold(f32::INFINITY, f32::min)
    };
    assert!((nearest(0) - 1.8).abs() < 0.01, "{} m", nearest(0));
    assert!((nearest(192) - 0.25).abs() < 0.01, "{} m", nearest(192));
    assert!((1..193).all(|frame| nearest(frame) < nearest(frame - 1)));
}

#[test]
fn diffuse_colours_of_mesh_files_become_materials() {
    let kitchen = scene::load("kitchen").unwrap();
    let glass = only(&kitchen, "bottle.bottle_glass_green");
    assert_eq!(kitchen.material_of(glass).pattern, Pattern::Colour(Vec3::new(0.0, 0.16, 0.0)));
}

#[test]
fn an_obj_file_gives_an_object_a_material() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    // A quad of iron and a triangle of steel, corners counted from the end. The normal is not named.
    let obj = "mtllib a.mtl\nv 0 0 0\nv 2 0 0\nv 2 0 -2\nv 0 0 -2\nvn 0 3 4\nusemtl Iron\n\
               f 1 2 3 4\nvt 0.5 0.25\nusemtl Blue steel\nf -4/-1 -3/-1 -2/-1\n";
    write("a.obj", obj);
    write("a.mtl", "newmtl Iron\nKd 0.5 0.25 0\nnewmtl Blue steel\nKd 0 0 1\n");
    let text = r#"about = "test"
camera = { fov_deg = 60, eye = [0, 1, 4], target = [0, 0, 0] }
environment = { colour = [1, 1, 1] }
materials.mirror = { mirror = { reflectance = 0.5 } }
[[objects]]
name = "part"
shape = { obj = { file = "a.obj", materials = { "Blue steel" = "mirror" } } }
scale = 0.5
"#;
    write("test.toml", text);
    let path = folder.path().join("test.toml");
    let scene = scene::load(path.to_str().unwrap()).unwrap();
    let names: Vec<&str> = scene.objects.iter().map(|object| object.name.as_str()).collect();
    assert_eq!(names, ["part.Blue-steel", "part.Iron"]);
    assert!(scene.is_reflector(0) && !scene.is_reflector(1));
    assert_eq!(scene.material_of(1).pattern, Pattern::Colour(Vec3::new(0.5, 0.25, 0.0)));
    let [steel, iron] = [0, 1].map(|object| scene.mesh_of(object));
    assert_eq!((steel.triangles.len(), iron.triangles.len()), (1, 2));
    assert!(steel.uvs.iter().all(|&uv| uv == Vec2::new(0.5, 0.25)));
    assert!(iron.normals.iter().all(|n| n.abs_diff_eq(Vec3::Y, 1e-6)));
    assert_eq!(iron.bounds(), Some((Vec3::new(0.0, 0.0, -1.0), Vec3::new(1.0, 0.0, 0.0))));

    // Normals that faces name are kept.
    write("a.obj", &obj.replace("f 1 2 3 4", "f 1//1 2//1 3//1 4//1").replace("/-1", "/-1/1"));
    let with_normals = scene::load(path.to_str().unwrap()).unwrap();
    for normal in with_normals.meshes.iter().flat_map(|mesh| &mesh.normals) {
        assert!(normal.abs_diff_eq(Vec3::new(0.0, 0.6, 0.8), 1e-6));
    }
    write("a.obj", obj);

    // The hash covers the assets too.
    write("a.mtl", "newmtl Iron\nKd 0.5 0.5 0\nnewmtl Blue steel\nKd 0 0 1\n");
    assert_ne!(scene.hash, scene::load(path.to_str().unwrap()).unwrap().hash);
}

#[test]
fn clutter_is_scattered_clear_of_mirror_and_camera() {
    for count in [60, 150, 400] {
        let scene = scene::load(&format!("clutter-{count}")).unwrap();
        let moment = scene.at(0);
        let balls: Vec<ObjectId> = ["red", "ochre", "green", "blue", "violet"]
            .map(|c| format!("{c}-*"))
            .iter()
            .flat_map(|pattern| scene.select(pattern))
            .collect();
        assert_eq!(balls.len(), count);
        let mut places = BTreeSet::new();
        for &ball in &balls {
            let Some(Surface::Sphere { radius }) = scene.objects[ball as usize].surface else {
                panic!("no ball")
            };
            assert!((0.15..=0.4).contains(&radius), "radius {radius}");
            let place = position(&moment, ball);
            assert!(place.abs().max_element() <= 4.6);
            assert!(place.length() >= 1.0 + radius);
            assert!(place.distance(moment.camera.eye) >= radius + 0.7);
            places.insert(place.to_array().map(f32::to_bits));
        }
        assert_eq!(places.len(), count, "every ball has a place of its own");
    }
}

#[test]
fn the_poles_stand_off_the_wall_and_clear_of_the_sphere() {
    let scene = scene::load("stress-pole").unwrap();
    let moment = scene.at(0);
    let wall = position(&moment, only(&scene, "wall"));
    let sphere = position(&moment, only(&scene, "sphere"));
    for (number, gap) in (1..).zip([0.1, 0.2, 0.4, 0.7, 1.0]) {
        let pole = only(&scene, &format!("pole-{number}"));
        let Some(Surface::Cylinder { radius, .. }) = scene.objects[pole as usize].surface else {
            panic!("no pole")
        };
        assert_eq!(radius, 0.02);
        let place = position(&moment, pole);
        assert!((wall.z - place.z - gap).abs() < 1e-5, "{place}");
        assert!(place.xz().distance(sphere.xz()) > 1.5);
    }
}

#[test]
fn the_box_leaves_the_sphere_from_a_millimetre_to_a_metre() {
    let scene = scene::load("stress-gap").unwrap();
    let cube = only(&scene, "box");
    let gap = |frame: u32| {
        let moment = scene.at(frame);
        let centre = position(&moment, only(&scene, "sphere"));
        let sphere = moment.poses[cube as usize].inverse().transform_point3(centre);
        // The face square to the sphere's centre is that of -z.
        assert!(sphere.xy().length() < 1e-4, "{sphere}");
        -sphere.z - 0.15 - 1.0
    };
    assert!((gap(0) - 0.001).abs() < 2e-5 && (gap(144) - 1.0).abs() < 2e-5);
    assert!((1..145).all(|frame| gap(frame) > gap(frame - 1)));
}

#[test]
fn sticks_point_every_way() {
    let scene = scene::load("sticks").unwrap();
    let sticks: Vec<_> = scene.objects.iter().filter(|object| object.group.contains('-')).collect();
    assert_eq!(sticks.len(), 200);
    assert!(sticks.iter().all(|stick| stick.mesh == sticks[0].mesh), "one mesh for all");
    let axes = sticks.iter().map(|stick| match stick.motion {
        Motion::Still(pose) => Vec3::from(pose.matrix3.y_axis),
        _ => panic!("a stick moves"),
    });
    let squares = axes.map(|axis| axis * axis).sum::<Vec3>() / 200.0;
    assert!((squares - 1.0 / 3.0).abs().max_element() < 0.1, "{squares}");
}

#[test]
fn the_scenes_of_2006_have_the_papers_numbers() {
    // Estalella et al. 2006, section 6: vertices before subdivision, reflectors.
    for (name, vertices, near, reflectors) in
        [("kitchen-table1", 11_379, 0, 1), ("ufo", 63_884, 50, 1), ("ants", 14_859, 5, 8)]
    {
        let scene = scene::load(name).unwrap();
        let found = scene.vertices();
        assert!(found.abs_diff(vertices) <= near, "{name} has {found} vertices");
        assert_eq!(scene.reflectors().len(), reflectors, "{name}");
    }
}

#[test]
fn the_camera_of_the_kitchen_ends_a_quarter_metre_from_the_bowl() {
    let scene = scene::load("kitchen-table1").unwrap();
    let moment = scene.at(scene.frames - 1);
    let bowl = only(&scene, "bowl");
    let points = scene.mesh_of(bowl).positions.iter();
    let away = points
        .map(|&p| moment.camera.eye.distance(moment.poses[bowl as usize].transform_point3(p)));
    let nearest = away.fold(f32::MAX, f32::min);
    assert!((nearest - 0.25).abs() < 0.03, "{nearest} m");
}
