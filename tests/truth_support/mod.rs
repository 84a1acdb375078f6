//! Small scenes for the tests of the truth and the measures.
#![allow(dead_code, reason = "not every test file needs every scene")]

use glam::{UVec2, Vec2, Vec3};
use mirrorbench::geometry::Ray;
use mirrorbench::scene::{self, FrameRecord, Scene, Status};
use mirrorbench::truth::{Shapes, Tracer, TruthOptions};

/// Sky, light and the materials `mirror` (tinted), `floor` (checker), `red`, `glass` and `ghost` (a
/// weak mirror).
const COMMON: &str = r#"
about = "test"
frames = 1
[lighting]
ambient = [0.3, 0.3, 0.3]
sun = [0.6, 0.6, 0.6]
towards_sun = [0.4, 0.8, 0.3]
[environment]
gradient = { zenith = [0.2, 0.4, 0.8], horizon = [0.9, 0.9, 0.9], nadir = [0.3, 0.2, 0.2] }
[materials]
mirror = { mirror = { reflectance = 0.9, tint = [1.0, 0.9, 0.8] } }
glass = { glass = { index = 1.5 } }
ghost = { colour = [0.2, 0.3, 0.1], mirror = { reflectance = 0.25 } }
floor = { checker = { even = [0.8, 0.7, 0.6], odd = [0.2, 0.2, 0.3], size = [0.25, 0.25] } }
red = { colour = [0.8, 0.1, 0.1] }
"#;

/// A mirror ball on a floor, a red box beside it.
pub const BALL: &str = r#"
[camera]
fov_deg = 40.0
eye = [0.3, 1.7, 4.0]
target = [0.0, 0.9, 0.0]
[[objects]]
name = "floor"
shape = { plane = { size = [40.0, 40.0] } }
material = "floor"
[[objects]]
name = "ball"
shape = { sphere = { radius = 1.0, edge = 0.05 } }
material = "mirror"
position = [0.0, 1.0, 0.0]
[[objects]]
name = "box"
shape = { box = { size = [0.5, 1.0, 0.5] } }
material = "red"
position = [1.4, 0.5, 1.2]
"#;

/// Two mirror balls side by side over a floor.
pub const TWO_BALLS: &str = r#"
[camera]
fov_deg = 40.0
eye = [0.3, 1.7, 5.0]
target = [0.0, 0.9, 0.0]
[[objects]]
name = "floor"
shape = { plane = { size = [40.0, 40.0] } }
material = "floor"
[[objects]]
name = "left"
shape = { sphere = { radius = 1.0, edge = 0.05 } }
material = "mirror"
position = [-1.2, 1.0, 0.0]
[[objects]]
name = "right"
shape = { sphere = { radius = 1.0, edge = 0.05 } }
material = "mirror"
position = [1.2, 1.0, 0.0]
"#;

/// A flat mirror on the ground under a checkered ceiling three metres above it.
pub const FLAT: &str = r#"
[camera]
fov_deg = 40.0
eye = [0.0, 1.5, 4.0]
target = [0.0, 0.0, 0.0]
[[objects]]
name = "mirror"
shape = { plane = { size = [8.0, 8.0] } }
material = "mirror"
[[objects]]
name = "ceiling"
shape = { plane = { size = [60.0, 60.0] } }
material = "floor"
position = [0.0, 3.0, 0.0]
"#;

/// The scene of a text whose `about`, lighting, environment and materials are the common ones.
pub fn scene(text: &str) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("test.toml");
    // Top-level keys stand before the first table.
    std::fs::write(&path, format!("{COMMON}{text}")).unwrap();
    scene::load(path.to_str().unwrap()).unwrap()
}

pub fn tracer(scene: &Scene, shapes: Shapes) -> Tracer<'_> {
    Tracer::new(scene, &scene.at(0), TruthOptions { shapes, ..TruthOptions::default() })
}

/// Row and column of a pixel.
pub fn at(frame: &FrameRecord, pixel: usize) -> UVec2 {
    UVec2::new(pixel as u32 % frame.size[0], pixel as u32 / frame.size[0])
}

pub fn eye_ray(tracer: &Tracer, frame: &FrameRecord, pixel: usize) -> Ray {
    let centre: Vec2 = at(frame, pixel).as_vec2() + 0.5;
    tracer.moment().camera.ray(frame.size, centre)
}

/// Distance of a point from a line.
pub fn off_ray(ray: &Ray, point: Vec3) -> f32 {
    (point - ray.origin).cross(ray.direction).length()
}

/// The reflector pixels that show a surface.
pub fn found(frame: &FrameRecord) -> impl Iterator<Item = usize> {
    let found = |&pixel: &usize| frame.record.ids[pixel].status() == Status::Found;
    frame.reflector_pixels().into_iter().filter(found)
}
