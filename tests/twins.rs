//! Shader functions against their Rust twins on random inputs.

mod gpu_support;

use std::f32::consts::FRAC_PI_3;
use std::sync::Arc;

use glam::{Vec2, Vec3, Vec3Swizzles, Vec4, Vec4Swizzles};
use gpu_support::Session;
use mirrorbench::geometry::{Camera, Projection, cube, latlong, optics, proxy, sphere_map};
use mirrorbench::gpu::{Buffer, ComputePipeline, Frame};
use mirrorbench::measure::statistics::SplitMix64;
use mirrorbench::scene::{
    self, Environment, Glass, Image, Lobe, Material, Mirror, Pattern, Scene, shading,
};
use mirrorbench::stages::{CameraUniform, GpuScene};

const COUNT: u32 = 10_000;

/// Uniform numbers in -1 to 1.
fn numbers(seed: u64, count: usize) -> Vec<f32> {
    let mut random = SplitMix64::new(seed);
    (0..count).map(|_| (random.next_u64() >> 40) as f32 / (1u64 << 23) as f32 - 1.0).collect()
}

fn directions(seed: u64) -> Vec<Vec3> {
    let n = numbers(seed, 3 * COUNT as usize);
    n.chunks(3).map(|c| Vec3::from_slice(c).try_normalize().unwrap_or(Vec3::X)).collect()
}

/// Run one entry point of `shaders/tests/twins.wgsl` on inputs.
fn run(
    session: &Session,
    scene: &Scene,
    entry: &str,
    inputs: &[Vec4],
    outputs: usize,
    camera: &Camera,
) -> Vec<Vec4> {
    let device = session.device();
    let mut gpu_scene = GpuScene::new(device, &Arc::new(scene.clone())).unwrap();
    let pipeline = ComputePipeline::with_entry(device, "tests/twins.wgsl", entry, &[]).unwrap();
    let given = Buffer::with_data(device, "inputs", inputs).unwrap();
    let answer = Buffer::storage(device, "outputs", 16 * outputs as u64).unwrap();
    let mut frame = Frame::new(device).unwrap();
    frame.begin().unwrap();
    gpu_scene.pose(&mut frame, &scene.at(0)).unwrap();
    let pass = frame.pass("test/twins").compute(&pipeline);
    let pass = gpu_scene.bind(pass).buffer("inputs", &given).buffer("outputs", &answer);
    pass.uniform("camera", &CameraUniform::new(camera, [64, 48])).over(COUNT).unwrap();
    frame.submit().unwrap();
    answer.read().unwrap()
}

fn camera() -> Camera {
    Camera {
        eye: Vec3::new(1.0, 2.0, 3.0),
        target: Vec3::new(-0.5, 0.3, 0.1),
        up: Vec3::Y,
        projection: Projection::Perspective { fov_y: FRAC_PI_3 },
        near: 0.1,
        far: 100.0,
    }
}

#[test]
fn cube_maps() {
    let (session, scene) = (Session::open(), scene::load("sky").unwrap());
    let given = directions(1);
    let inputs: Vec<_> = given.iter().map(|d| d.extend(0.0)).collect();
    let outputs = run(&session, &scene, "cube", &inputs, 2 * inputs.len(), &camera());
    for (d, out) in given.iter().zip(outputs.chunks(2)) {
        let (face, uv) = cube::face_uv(*d);
        assert_eq!(out[0].z as u32, face, "{d}");
        assert!(out[0].xy().abs_diff_eq(uv, 1e-6), "{d}: {} instead of {uv}", out[0]);
        assert!(out[1].xyz().normalize().abs_diff_eq(*d, 1e-6), "{d} came back as {}", out[1]);
    }
}

#[test]
fn flat_maps() {
    let (session, scene) = (Session::open(), scene::load("sky").unwrap());
    let mut given = directions(11);
    let axes = [Vec3::X, Vec3::Y, Vec3::Z];
    // The sphere map's singular direction, the polar map's poles and its seam.
    given.splice(0..6, axes.into_iter().flat_map(|axis| [axis, -axis]));
    given[6] = Vec3::new(1e-19, -1e-19, -1.0);
    let inputs: Vec<_> = given.iter().map(|d| d.extend(0.0)).collect();
    let outputs = run(&session, &scene, "flat_maps", &inputs, 4 * inputs.len(), &camera());
    for (d, out) in given.iter().zip(outputs.chunks(4)) {
        assert!(out.iter().all(|v| v.is_finite()), "{d}: {out:?}");
        let (st, uv) = (sphere_map::place(*d), latlong::place(*d));
        // On the rim any place will do.
        let on_rim = d.z < -0.999_999;
        assert!(on_rim || out[0].xy().abs_diff_eq(st, 1e-5), "{d}: {} instead of {st}", out[0]);
        let across = (out[0].z - uv.x).abs();
        assert!(across.min(1.0 - across) < 1e-5 && (out[0].w - uv.y).abs() < 1e-5, "{d}: {uv}");
        assert!(out[1].xyz().abs_diff_eq(*d, 2e-3), "{d} came back as {}", out[1]);
        assert!(out[2].xyz().abs_diff_eq(*d, 1e-5), "{d} came back as {}", out[2]);
        let normal = sphere_map::normal(2.0 * d.xy());
        // Where the square root is steepest.
        assert!(out[3].xyz().abs_diff_eq(normal, 1e-3), "{d}: {} instead of {normal}", out[3]);
    }
}

#[test]
fn proxies() {
    let (session, scene) = (Session::open(), scene::load("sky").unwrap());
    let (starts, mut along) = (directions(12), directions(13));
    along.splice(0..2, [Vec3::X, Vec3::NEG_Y]);
    let inputs: Vec<Vec4> = starts
        .iter()
        .zip(&along)
        .flat_map(|(s, d)| [(1.1 * s).extend(0.0), d.extend(0.0)])
        .collect();
    let outputs = run(&session, &scene, "proxies", &inputs, 2 * starts.len(), &camera());
    let mut at_an_edge = 0;
    for ((s, d), out) in starts.iter().zip(&along).zip(outputs.chunks(2)) {
        let sphere = proxy::from_sphere(1.1 * s, *d, 1.2);
        let high = Vec3::new(0.9, 1.1, 1.3);
        let boxed = proxy::from_box(1.1 * s, *d, Vec3::splat(-1.0), high);
        assert!(out[0].xyz().abs_diff_eq(sphere, 1e-4), "{s} {d}: {} not {sphere}", out[0]);
        // A ray from outside that grazes the box may hit it on one side only.
        at_an_edge += u32::from(!out[1].xyz().abs_diff_eq(boxed, 1e-4));
    }
    assert!(at_an_edge <= 2, "{at_an_edge} differ");
}

#[test]
fn environments() {
    let session = Session::open();
    let mut scene = scene::load("teapot").unwrap();
    let Environment::LatLong { image } = scene.environment else { panic!("no lat-long image") };
    let given = directions(2);
    let inputs: Vec<_> = given.iter().map(|d| d.extend(0.0)).collect();
    let gradient =
        Environment::Gradient { zenith: Vec3::X, horizon: Vec3::Y, nadir: Vec3::splat(0.3) };
    let plain = Environment::Colour(Vec3::new(0.1, 0.2, 0.3));
    for environment in [Environment::LatLong { image }, gradient, plain] {
        scene.environment = environment;
        let outputs = run(&session, &scene, "sky", &inputs, inputs.len(), &camera());
        for (d, out) in given.iter().zip(outputs) {
            let expected = shading::environment(&scene, *d);
            // The arc tangent's 1e-6 radians, across this image's steepest texels.
            let tolerance = 0.01 * expected.max_element().max(1.0);
            assert!(
                out.xyz().abs_diff_eq(expected, tolerance),
                "{:?}, {d}: {out} instead of {expected}",
                scene.environment
            );
        }
    }
}

/// The scene `sky` with one material a pattern.
fn patterned() -> Scene {
    let mut scene = scene::load("sky").unwrap();
    let random = numbers(3, 3 * 7 * 5);
    let half = |v: f32| half::f16::from_f32(v).to_f32();
    let texels = random.chunks(3).map(|c| Vec3::from_slice(c).abs().map(half)).collect();
    scene.images = vec![Image { width: 7, height: 5, texels }];
    let (a, b) = (Vec3::new(0.9, 0.1, 0.2), Vec3::new(0.2, 0.7, 0.3));
    let patterns = [
        Pattern::Colour(a),
        Pattern::Checker { even: a, odd: b, size: Vec2::new(0.25, 0.5) },
        Pattern::Grid { ground: a, lines: b, size: Vec2::new(0.5, 0.3), line: 0.04 },
        Pattern::Image { image: 0, size: Vec2::new(1.5, 0.8) },
    ];
    let named =
        patterns.map(|pattern| Material { name: "m".into(), pattern, mirror: None, glass: None });
    let first = scene.materials.len();
    scene.materials.extend(named);
    // The twin shades objects; one a material.
    let object = scene.objects[0].clone();
    for material in first..scene.materials.len() {
        let name = format!("o{material}");
        scene.objects.push(scene::Object { material, name, ..object.clone() });
    }
    scene
}

#[test]
fn shading_of_every_pattern() {
    let (session, scene) = (Session::open(), patterned());
    let normals = directions(4);
    let uvs = numbers(5, 2 * COUNT as usize);
    let objects = 1..scene.objects.len();
    let inputs: Vec<_> = normals
        .iter()
        .zip(uvs.chunks(2))
        .enumerate()
        .flat_map(|(i, (n, uv))| {
            let object = &scene.objects[objects.clone().start + i % objects.len()];
            [n.extend(object.material as f32), Vec4::new(4.0 * uv[0], 4.0 * uv[1], 0.0, 0.0)]
        })
        .collect();
    let outputs = run(&session, &scene, "surface", &inputs, COUNT as usize, &camera());
    let mut edges = 0;
    for (i, (input, out)) in inputs.chunks(2).zip(outputs).enumerate() {
        let object = (objects.start + i % objects.len()) as u32;
        let expected = shading::shade(&scene, object, input[0].xyz(), input[1].xy(), true);
        edges += u32::from(!out.xyz().abs_diff_eq(expected, 1e-5));
    }
    // A division that rounds differently moves a pattern's edge past a point now and then.
    assert!(edges <= 5, "{edges} of {COUNT} points differ");
}

#[test]
fn eye_rays_and_facing_normals() {
    let (session, scene) = (Session::open(), scene::load("sky").unwrap());
    let n = numbers(6, 4 * COUNT as usize);
    let inputs: Vec<_> = n.chunks(4).map(Vec4::from_slice).collect();
    let orthographic = Projection::Orthographic { height: 2.0 };
    for camera in [camera(), Camera { projection: orthographic, ..camera() }] {
        let outputs = run(&session, &scene, "eye", &inputs, 2 * inputs.len(), &camera);
        for (i, out) in inputs.iter().zip(outputs.chunks(2)) {
            let pixel = (0.5 * i.xy() + 0.5) * Vec2::new(64.0, 48.0);
            let expected = camera.ray([64, 48], pixel).direction;
            assert!(out[0].xyz().abs_diff_eq(expected, 1e-5), "{pixel}: {} {expected}", out[0]);
            let incident = match camera.projection {
                Projection::Perspective { .. } => (i.xyz() - camera.eye).normalize(),
                Projection::Orthographic { .. } => expected,
            };
            let normal = i.yzw().normalize();
            let facing = optics::face_forward(normal, incident);
            let grazing = normal.dot(incident).abs() < 1e-5;
            assert!(grazing || out[1].xyz().abs_diff_eq(facing, 1e-5), "{i}: {}", out[1]);
        }
    }
}

#[test]
fn departures() {
    let (session, mut scene) = (Session::open(), scene::load("sky").unwrap());
    let tint = Vec3::new(1.0, 0.9, 0.7);
    let material = |mirror: Option<f32>, index: Option<f32>| Material {
        name: "m".into(),
        pattern: Pattern::Colour(Vec3::ZERO),
        mirror: mirror.map(|reflectance| Mirror::plain(reflectance, tint)),
        glass: index.map(|index| Glass { index, tint }),
    };
    scene.materials = vec![
        material(None, None),
        material(Some(0.8), None),
        material(Some(0.0), None),
        material(None, Some(1.5)),
        material(None, Some(0.7)),
    ];
    let kinds = scene.materials.len();
    let (incidents, normals) = (directions(5), directions(6));
    let inputs: Vec<Vec4> = incidents
        .iter()
        .zip(&normals)
        .enumerate()
        .flat_map(|(i, (incident, normal))| {
            let faced = optics::face_forward(*normal, *incident);
            [incident.extend((i % kinds) as f32), faced.extend((i % 2) as f32)]
        })
        .collect();
    let outputs = run(&session, &scene, "departures", &inputs, 4 * COUNT as usize, &camera());
    let (mut ways, mut at_the_limit) = (0, 0);
    for (i, (input, out)) in inputs.chunks(2).zip(outputs.chunks(4)).enumerate() {
        for (lobe, out) in [Lobe::Reflected, Lobe::Refracted].into_iter().zip(out.chunks(2)) {
            let (incident, normal) = (input[0].xyz(), input[1].xyz());
            let way = scene.materials[i % kinds].depart(lobe, incident, normal, i % 2 == 1);
            let agree = match way {
                None => out[0].w == 0.0,
                Some(way) => {
                    ways += 1;
                    out[0].w == 1.0
                        && out[0].xyz().abs_diff_eq(way.direction, 1e-4)
                        && out[1].abs_diff_eq(way.weight.extend(way.share), 1e-4)
                }
            };
            // There either side may be first to say that nothing passes, or a root be steep.
            at_the_limit += u32::from(!agree);
        }
    }
    assert!(ways > 8000 && at_the_limit <= 5, "{at_the_limit} of {ways} differ");
}
