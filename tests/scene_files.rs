//! The shipped scenes load and hold what they promise.

use mirrorbench::scene::{self, Surface};

#[test]
fn every_shipped_scene_loads() {
    let scenes = scene::list().unwrap();
    assert!(!scenes.is_empty());
    for (name, about) in scenes {
        let scene = scene::load(&name).unwrap();
        assert_eq!((&scene.name, &scene.about), (&name, &about));
        assert!(!scene.reflectors().is_empty(), "{name} has no mirror");
        eprintln!(
            "{name}: {} objects, {} triangles, {} vertices, {:?}",
            scene.objects.len(),
            scene.triangles(),
            scene.vertices(),
            scene.bounds(&scene.at(0))
        );
    }
}

#[test]
fn a_sphere_knows_its_closed_form() {
    let scene = scene::load("columns").unwrap();
    let sphere = scene.select("sphere")[0];
    let surface = scene.objects[sphere as usize].surface;
    assert_eq!(surface, Some(Surface::Sphere { radius: 1.0 }));
}
