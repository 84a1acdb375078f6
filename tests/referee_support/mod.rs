//! What the referees' tests and benchmark share: scenes, their triangles and rays, and Embree.
#![allow(dead_code, reason = "not every user needs everything")]

pub mod embree;
pub mod pov_file;
pub mod povray;

use glam::{UVec2, Vec3};
use mirrorbench::geometry::Ray;
use mirrorbench::scene::{self, Lobe, Moment, ObjectId, Scene};
use mirrorbench::truth::{Bounce, Tracer};

/// Two finely cut mirrors and a finely cut object between them: 600,000 triangles.
const FINE: &str = r#"
about = "test"
frames = 1
[environment]
colour = [0.0, 0.0, 0.0]
[camera]
fov_deg = 45.0
eye = [0.6, 2.2, 4.2]
target = [0.0, 0.8, 0.0]
[materials]
mirror = { mirror = { reflectance = 1.0 } }
floor = { checker = { even = [0.8, 0.7, 0.6], odd = [0.2, 0.2, 0.3], size = [0.25, 0.25] } }
red = { colour = [0.8, 0.1, 0.1] }
[[objects]]
name = "floor"
shape = { plane = { size = [8.0, 8.0] } }
material = "floor"
[[objects]]
name = "ring"
shape = { torus = { ring = 1.5, tube = 0.25, slices = 500, stacks = 200 } }
material = "mirror"
position = [0.0, 0.3, 0.0]
[[objects]]
name = "ball"
shape = { sphere = { radius = 0.8, slices = 500, stacks = 200 } }
material = "mirror"
position = [-0.5, 1.2, -0.3]
[[objects]]
name = "knob"
shape = { ellipsoid = { radii = [0.5, 0.8, 0.4], slices = 500, stacks = 202 } }
material = "red"
position = [0.9, 1.0, 0.3]
rotation_deg = [20.0, 0.0, 30.0]
"#;

/// The scene of a text.
pub fn scene(text: &str) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("fine.toml");
    std::fs::write(&path, text).unwrap();
    scene::load(path.to_str().unwrap()).unwrap()
}

pub fn fine() -> Scene {
    scene(FINE)
}

/// Every triangle of a moment in world space, objects one after the other: the truth's own list.
pub fn triangles(scene: &Scene, moment: &Moment) -> Vec<[Vec3; 3]> {
    let objects = 0..scene.objects.len() as ObjectId;
    objects.flat_map(|object| scene.world_triangles(moment, object)).collect()
}

/// The rays through the pixel centres of an image, tile by tile as the truth traces them.
pub fn primary(moment: &Moment, size: [u32; 2]) -> Vec<Ray> {
    const TILE: usize = 16;
    let [columns, rows] = size.map(|side| (0..side).step_by(TILE));
    let tiles = rows.flat_map(|y| columns.clone().map(move |x| (x, y)));
    let pixels = tiles.flat_map(|(x, y)| {
        let end = |start: u32, side: u32| (start + TILE as u32).min(side);
        let across = x..end(x, size[0]);
        (y..end(y, size[1])).flat_map(move |y| across.clone().map(move |x| UVec2::new(x, y)))
    });
    pixels.map(|pixel| moment.camera.ray(size, pixel.as_vec2() + 0.5)).collect()
}

/// Where the rays of an image meet mirrors, and the mirrored rays that leave from there.
pub fn mirrored(tracer: &Tracer, size: [u32; 2]) -> Vec<Bounce> {
    let lobe = Lobe::Reflected;
    let bounce = |ray: &Ray| {
        let hit = tracer.look(ray)?;
        let outgoing = tracer.depart(&hit, ray.direction, lobe)?.direction;
        Some(Bounce { hit, lobe, outgoing })
    };
    primary(tracer.moment(), size).iter().filter_map(bounce).collect()
}

/// The mirrored ray as one that needs no rule for its own surface: its origin raised a little.
pub fn raised(bounce: &Bounce) -> Ray {
    let Bounce { hit, outgoing, .. } = bounce;
    Ray { origin: hit.point + 1e-4 * hit.normal, direction: *outgoing }
}
