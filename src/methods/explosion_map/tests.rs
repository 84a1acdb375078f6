//! Virtual vertices against the exact ones, on the device: vertices of shells about a mirror sphere, held
//! against Alhazen's root (ALGORITHMS T22).

use std::io::Write;
use std::sync::Arc;

use glam::{DVec3, Vec2, Vec3};

use super::{Corner, ExplosionMap};
use crate::error::Error;
use crate::geometry::alhazen::reflected_point;
use crate::gpu::{Buffer, Device, Frame};
use crate::methods::source::Lists;
use crate::methods::{Case, METHODS, Setup};
use crate::scene::{self, ObjectId, Scene};
use crate::stages::{CameraUniform, GpuScene, RecordMode, ReflectionRecord};

const VIEW: [u32; 2] = [320, 240];

/// Radii of the shells, in those of the mirror.
const SHELLS: [f32; 8] = [1.1, 1.5, 2.0, 3.0, 4.0, 8.0, 16.0, 64.0];
const ON_NEAR: usize = 2;
const ON_FAR: usize = 5;

/// A mirror sphere of 1 m about the origin, and the shells whose vertices are reflected.
fn shells() -> Scene {
    let mut text = r#"
        about = "test"
        environment = { colour = [0.5, 0.6, 0.7] }
        materials = { mirror = { mirror = { reflectance = 1.0 } }, grey = { colour = [0.5, 0.5, 0.5] } }
        [camera]
        fov_deg = 40.0
        eye = [0.3, 0.5, 4.0]
        target = [0.0, 0.0, 0.0]
        [[objects]]
        name = "mirror"
        shape = { sphere = { radius = 1.0, slices = 192, stacks = 96 } }
        material = "mirror"
        "#
    .to_owned();
    for radius in SHELLS {
        text += &format!(
            r#"
            [[objects]]
            name = "shell-{radius:?}"
            shape = {{ sphere = {{ radius = {radius:?}, slices = 61, stacks = 37 }} }}
            material = "grey"
            "#
        );
    }
    let mut file = tempfile::Builder::new().suffix(".toml").tempfile().unwrap();
    file.write_all(text.as_bytes()).unwrap();
    scene::load(file.path().to_str().unwrap()).unwrap()
}

/// What a case finds for the vertices of one shell.
#[derive(Debug)]
struct Misses {
    /// On the view from the point that mirrors a vertex to the one found, pixels, of vertices that have both:
    /// half of them, 95 of a hundred, and all are nearer.
    half: f32,
    most: f32,
    all: f32,
    /// Share of vertices that are hidden and not told so, or told so and not hidden.
    misjudged: f32,
}

fn made(device: &Arc<Device>, scene: &GpuScene, case: &str) -> Result<ExplosionMap, Error> {
    let case = Case::parse(case, &METHODS.iter().collect::<Vec<_>>()).unwrap();
    let part = &case.parts[0];
    ExplosionMap::new(&Setup {
        device,
        scene,
        variant: part.variant,
        values: &part.values,
        mode: RecordMode::Full,
        size: VIEW,
        reflectors: &scene.scene.reflectors(),
    })
}

/// What a case finds for each of [`SHELLS`], and its counters. Vertices are pushed, so that their images are
/// behind the points found.
fn misses(case: &str) -> (Vec<Misses>, Vec<u32>) {
    let device = Device::open("auto", true).unwrap();
    let mut scene = GpuScene::new(&device, &Arc::new(shells())).unwrap();
    let method = made(&device, &scene, case).unwrap();
    let moment = scene.scene.at(0);
    let camera = CameraUniform::new(&moment.camera, VIEW);
    let lists = Lists::new(&scene.scene, 0.0).unwrap();
    let source = lists.upload(&device).unwrap();
    let record = ReflectionRecord::new(&device, VIEW, RecordMode::Full, 1).unwrap();
    let bytes = size_of::<Corner>() as u64 * u64::from(source.count);
    let corners = Buffer::storage(&device, "corners", bytes).unwrap();
    let mut frame = Frame::new(&device).unwrap();
    frame.begin().unwrap();
    scene.pose(&mut frame, &moment).unwrap();
    record.clear(&mut frame).unwrap();
    let reflector = &method.reflectors[0];
    let spheres = method.map.fill(&mut frame, &scene, &camera, reflector).unwrap();
    let parts = (&method.map, &spheres, reflector);
    let to = (&camera, &record);
    method.search.run(&mut frame, &scene, to, parts, &source, &corners).unwrap();
    frame.submit().unwrap();
    let found: Vec<Corner> = corners.read().unwrap();
    let eye = moment.camera.eye.as_dvec3();
    let of_shell = |shell: usize| shell_misses(&camera, eye, &lists, &found, 1 + shell as ObjectId);
    ((0..SHELLS.len()).map(of_shell).collect(), record.counters(0).unwrap())
}

fn shell_misses(
    camera: &CameraUniform,
    eye: DVec3,
    lists: &Lists,
    found: &[Corner],
    shell: ObjectId,
) -> Misses {
    const SHOWN: u32 = 0;
    let place = |p: Vec3| 0.5 * camera.project(p).unwrap() * Vec2::from(VIEW.map(|n| n as f32));
    let (mut px, mut misjudged, mut total) = (Vec::new(), 0, 0);
    let all = lists.vertices.iter().zip(&lists.owners).zip(found);
    for ((vertex, _), corner) in all.filter(|&((_, &owner), _)| owner == shell) {
        let exact = reflected_point(DVec3::ZERO, 1.0, eye, vertex.position().as_dvec3());
        let shown = corner.found >> 28 == SHOWN;
        total += 1;
        misjudged += u32::from(exact.is_some() != shown);
        if let (Some(exact), true) = (exact, shown) {
            px.push(place(corner.image.into()).distance(place(exact.as_vec3())));
        }
    }
    px.sort_by(f32::total_cmp);
    let nearer = |share: f32| px[((px.len() - 1) as f32 * share) as usize];
    Misses {
        half: nearer(0.5),
        most: nearer(0.95),
        all: nearer(1.0),
        misjudged: misjudged as f32 / total as f32,
    }
}

#[test]
fn on_its_sphere_a_map_is_exact_and_errs_the_more_the_farther_from_it() {
    let (found, _) = misses("explosion-map:spheres=1,radius=2,image=push");
    let on = &found[ON_NEAR];
    assert!(on.all < 0.05 && on.misjudged < 0.01, "on the sphere {on:?}");
    // Outwards the error is bounded by what directions from the centre and from the reflector differ by.
    let half: Vec<f32> = found.iter().map(|m| m.half).collect();
    assert!(half[..=ON_NEAR].windows(2).all(|pair| pair[0] > 3.0 * pair[1]), "{half:?}");
    assert!(half[ON_NEAR..].windows(2).all(|pair| pair[0] < pair[1]), "{half:?}");
    assert!(half[ON_NEAR + 1] > 2.0 && half[7] > 8.0, "{half:?}");
}

#[test]
fn coarse_maps_are_as_exact_on_their_sphere_as_their_texels_are_wide() {
    // Weights beyond a triangle's edges carry on what its corners have.
    let worst = [16, 64, 256].map(|size| {
        let case = format!("explosion-map:spheres=1,radius=2,image=push,size={size}");
        misses(&case).0[ON_NEAR].most
    });
    assert!(worst[0] > worst[1] && worst[1] > worst[2] && worst[2] < 0.05, "{worst:?}");
}

#[test]
fn two_spheres_are_exact_on_both_and_blend_best_by_inverse_distance() {
    let [linear, inverse] = ["linear", "inverse"]
        .map(|blend| misses(&format!("explosion-map:radius=2,far=8,image=push,blend={blend}")).0);
    let (one, _) = misses("explosion-map:spheres=1,radius=2,image=push");
    for found in [&linear, &inverse] {
        assert!(found[ON_NEAR].most < 0.05 && found[ON_FAR].most < 0.05, "{found:?}");
        // Nearer and farther than both, as the one and as the other has it.
        assert_eq!(found[0].half, one[0].half);
        assert!(found[7].half > 1.0 && found[7].half < 0.5 * one[7].half, "{found:?}");
    }
    for between in ON_NEAR + 1..ON_FAR {
        let halves = [&one, &linear, &inverse].map(|found| found[between].half);
        assert!(halves[0] > 1.3 * halves[1] && halves[1] > 5.0 * halves[2], "{halves:?}");
    }
}

#[test]
fn walks_end_at_the_right_triangle_from_any_map() {
    for case in ["radius=1", "radius=2", "radius=8,size=16"] {
        let (found, counters) = misses(&format!("explosion-map@revised:{case}"));
        for (misses, radius) in found.iter().zip(SHELLS) {
            assert!(misses.most < 0.06 && misses.all < 0.2, "{case} at {radius}: {misses:?}");
            assert!(misses.misjudged < 0.02, "{case} at {radius}: {misses:?}");
        }
        let [searches, triangles, _, hidden, lost] = counters[..5] else { panic!() };
        assert!(triangles < 100 * searches, "{case}: {counters:?}");
        assert!(hidden > 0 && hidden < searches / 2 && lost == 0, "{case}: {counters:?}");
    }
}

#[test]
fn a_far_sphere_inside_the_near_one_is_refused() {
    let device = Device::open("auto", true).unwrap();
    let scene = GpuScene::new(&device, &Arc::new(shells())).unwrap();
    let refused = made(&device, &scene, "explosion-map:radius=3,far=2");
    let Some(Error::Usage(message)) = refused.err() else { panic!("not refused") };
    assert!(message.contains("far=2") && message.contains("radius=3"), "{message}");
}
