//! The layered capture against rays: through each texel's centre, all surfaces in order.

mod gpu_support;
mod truth_support;

use std::fmt::Write;
use std::sync::Arc;

use glam::{Vec2, Vec3};
use gpu_support::Session;
use half::f16;
use mirrorbench::geometry::bvh::Bvh;
use mirrorbench::geometry::{Ray, cube};
use mirrorbench::gpu::Frame;
use mirrorbench::measure::statistics::SplitMix64;
use mirrorbench::scene::{NO_OBJECT, ObjectId, Scene};
use mirrorbench::stages::{GpuScene, LayeredCapture, LayeredCaptureStage, RecordMode, Sides};

const SIZE: u32 = 64;
const LAYERS: u32 = 5;
const CENTRE: Vec3 = Vec3::new(0.1, 0.2, -0.1);

/// Boxes and balls all round the centre, a ball about the centre that is left out, and no walls.
fn clutter() -> Scene {
    let mut random = SplitMix64::new(7);
    let mut number = |low: f32, high: f32| {
        low + (high - low) * (random.next_u64() >> 40) as f32 / (1u64 << 24) as f32
    };
    let mut text = String::from(
        "[camera]\nfov_deg = 40.0\neye = [0.0, 0.0, 9.0]\ntarget = [0.0, 0.0, 0.0]\n\
         [[objects]]\nname = \"mirror\"\nshape = { sphere = { radius = 0.5, edge = 0.2 } }\n\
         material = \"mirror\"\n",
    );
    for i in 0..60 {
        let towards = Vec3::new(number(-1.0, 1.0), number(-1.0, 1.0), number(-1.0, 1.0));
        let at = number(1.5, 5.0) * towards.normalize_or(Vec3::X);
        let shape = if i % 2 == 0 {
            format!("sphere = {{ radius = {}, edge = 0.2 }}", number(0.2, 0.7))
        } else {
            let mut side = || number(0.3, 1.2);
            format!("box = {{ size = [{}, {}, {}] }}", side(), side(), side())
        };
        let turn = [number(0.0, 90.0), number(0.0, 90.0)];
        writeln!(
            text,
            "[[objects]]\nname = \"o{i}\"\nshape = {{ {shape} }}\nmaterial = \"red\"\n\
             position = [{}, {}, {}]\nrotation_deg = [{}, {}, 0.0]",
            at.x, at.y, at.z, turn[0], turn[1]
        )
        .unwrap();
    }
    truth_support::scene(&text)
}

struct Read {
    surface: Vec<[u32; 2]>,
    radiance: Vec<[f16; 4]>,
    ids: Vec<[u32; 2]>,
}

fn captured(session: &Session, scene: &Scene, exclude: &[ObjectId], mode: RecordMode) -> Read {
    captured_sides(session, scene, exclude, mode, Sides::Both)
}

fn captured_sides(
    session: &Session,
    scene: &Scene,
    exclude: &[ObjectId],
    mode: RecordMode,
    sides: Sides,
) -> Read {
    let device = session.device();
    let mut gpu_scene = GpuScene::new(device, &Arc::new(scene.clone())).unwrap();
    let stage = LayeredCaptureStage::new(device, mode, sides).unwrap();
    let mut map = LayeredCapture::new(device, "test map", SIZE, LAYERS, mode).unwrap();
    let mut frame = Frame::new(device).unwrap();
    frame.begin().unwrap();
    gpu_scene.pose(&mut frame, &scene.at(0)).unwrap();
    stage.capture(&mut frame, &gpu_scene, "test", &mut map, CENTRE, exclude).unwrap();
    frame.submit().unwrap();
    Read {
        surface: map.surface.read().unwrap(),
        radiance: map.radiance.read().unwrap(),
        ids: map.ids.map_or_else(Vec::new, |ids| ids.read().unwrap()),
    }
}

/// One surface behind a texel.
#[derive(Clone, Copy, Debug)]
struct Behind {
    object: ObjectId,
    triangle: u32,
    /// 1/z, z along the face's axis.
    w: f32,
    /// dw/du and dw/dv per texel.
    gradient: Vec2,
    /// Whether its front is towards the centre.
    facing: bool,
}

/// What rays through texels meet, in order.
struct Rays {
    tree: Bvh,
    corners: Vec<[Vec3; 3]>,
    owners: Vec<(ObjectId, u32)>,
}

impl Rays {
    fn new(scene: &Scene, exclude: &[ObjectId]) -> Rays {
        let (mut corners, mut owners) = (Vec::new(), Vec::new());
        for object in (0..scene.objects.len() as ObjectId).filter(|o| !exclude.contains(o)) {
            for (triangle, number) in scene.world_triangles(&scene.at(0), object).zip(0..) {
                corners.push(triangle);
                owners.push((object, number));
            }
        }
        Rays { tree: Bvh::new(&corners), corners, owners }
    }

    fn behind(&self, face: u32, place: [u32; 2]) -> Vec<Behind> {
        let at = |x: f32, y: f32| cube::direction(face, Vec2::new(x, y) / SIZE as f32);
        let (x, y) = (place[0] as f32 + 0.5, place[1] as f32 + 0.5);
        let towards = at(x, y);
        let ray = Ray { origin: CENTRE, direction: towards.normalize() };
        let mut found = Vec::new();
        let mut from = 0.0;
        while let Some(hit) = self.tree.nearest(&ray, [from, f32::INFINITY], |_, _| true) {
            from = hit.t * (1.0 + 1e-6);
            let [a, b, c] = self.corners[hit.triangle as usize];
            let (object, triangle) = self.owners[hit.triangle as usize];
            // On the plane n . p = d, 1/z is n . D / d, where D reaches the face: affine.
            let plane = (b - a).cross(c - a) / (b - a).cross(c - a).dot(a - CENTRE);
            let gradient =
                Vec2::new(plane.dot(at(x + 1.0, y) - towards), plane.dot(at(x, y + 1.0) - towards));
            let w = plane.dot(towards);
            found.push(Behind { object, triangle, w, gradient, facing: hit.front });
        }
        found
    }
}

/// Every texel of a layer: its rank in the images, its face, its column and row.
fn texels() -> impl Iterator<Item = (usize, u32, [u32; 2])> {
    (0..6 * SIZE * SIZE).map(|i| {
        let (face, place) = (i / (SIZE * SIZE), i % (SIZE * SIZE));
        (i as usize, face, [place % SIZE, place / SIZE])
    })
}

#[test]
fn each_layer_holds_the_next_surface_behind_every_texel() {
    let (session, scene) = (Session::open(), clutter());
    let exclude = scene.reflectors();
    let rays = Rays::new(&scene, &exclude);
    for sides in [Sides::Both, Sides::Facing] {
        let read = captured_sides(&session, &scene, &exclude, RecordMode::Full, sides);
        compare(&read, &rays, sides);
    }
}

/// What was read against what rays meet.
fn compare(read: &Read, rays: &Rays, sides: Sides) {
    let layer_texels = (6 * SIZE * SIZE) as usize;
    let mut compared = [0u32; LAYERS as usize];
    let (mut wrong, mut of_neighbour, mut steep) = (0, 0, 0);
    for (i, face, place) in texels() {
        let mut expected = rays.behind(face, place);
        expected.retain(|behind| sides == Sides::Both || behind.facing);
        for layer in 0..LAYERS as usize {
            let at = layer * layer_texels + i;
            let w = f32::from_bits(read.surface[at][0]);
            let Some(behind) = expected.get(layer) else {
                wrong += u32::from(w != 0.0 || read.ids[at] != [NO_OBJECT, 0]);
                continue;
            };
            compared[layer] += 1;
            let same = read.ids[at][0] == behind.object && (w / behind.w - 1.0).abs() < 1e-3;
            wrong += u32::from(!same);
            // Beside an edge of two triangles of an object either may be drawn.
            let its_own = read.ids[at][1] == behind.triangle;
            of_neighbour += u32::from(same && !its_own);
            if same && its_own {
                let [u, v] = [0, 16].map(|shift| (read.surface[at][1] >> shift) as u16);
                let gradient = Vec2::new(f16::from_bits(u).to_f32(), f16::from_bits(v).to_f32());
                let scale = behind.gradient.abs().max_element();
                // Half floats, of differences of depths with a relative error of 2^-24 or two.
                let close = gradient.abs_diff_eq(behind.gradient, 2e-3 * scale + 1e-6 * behind.w);
                steep += u32::from(!close);
            }
        }
    }
    let all: u32 = compared.iter().sum();
    assert!(compared[1] > 1000, "too little behind one another: {compared:?}");
    assert!(sides == Sides::Facing || compared[3] > 1000, "{compared:?}");
    // A rasteriser's corners lie on a grid of 1/256 of a texel, so at outlines it may differ.
    assert!(wrong < all / 300, "{wrong} of {all} differ");
    assert!(of_neighbour < all / 100, "{of_neighbour} of {all} on another triangle");
    assert!(steep < all / 300, "{steep} of {all} gradients differ");
}

#[test]
fn nothing_is_stored_behind_nothing() {
    let (session, scene) = (Session::open(), clutter());
    let read = captured(&session, &scene, &scene.reflectors(), RecordMode::Full);
    let layer_texels = (6 * SIZE * SIZE) as usize;
    for (i, ..) in texels() {
        let depths: Vec<_> = (0..LAYERS as usize)
            .map(|layer| f32::from_bits(read.surface[layer * layer_texels + i][0]))
            .collect();
        let ordered = depths.windows(2).all(|pair| pair[1] < pair[0] || pair == [0.0, 0.0]);
        assert!(ordered, "texel {i}: {depths:?}");
    }
}

#[test]
fn the_same_capture_is_the_same_to_the_last_bit_with_evidence_or_without() {
    let (session, scene) = (Session::open(), clutter());
    let [full, again, lean] = [RecordMode::Full, RecordMode::Full, RecordMode::Radiance]
        .map(|mode| captured(&session, &scene, &[], mode));
    assert!(full.surface == again.surface && full.ids == again.ids, "captured twice");
    assert!(full.surface == lean.surface && full.radiance == lean.radiance, "without evidence");
    assert!(lean.ids.is_empty());
}

#[test]
fn where_nothing_is_the_environment_shines() {
    let (session, scene) = (Session::open(), clutter());
    let read = captured(&session, &scene, &scene.reflectors(), RecordMode::Full);
    let mut seen = 0;
    let layer_texels = (6 * SIZE * SIZE) as usize;
    for (i, face, [x, y]) in texels().filter(|(i, ..)| read.surface[*i][0] == 0) {
        let uv = (Vec2::new(x as f32, y as f32) + 0.5) / SIZE as f32;
        let towards = cube::direction(face, uv).normalize();
        let expected = mirrorbench::scene::shading::environment(&scene, towards);
        for layer in 0..LAYERS as usize {
            let [r, g, b, _] = read.radiance[layer * layer_texels + i].map(f16::to_f32);
            assert!(expected.abs_diff_eq(Vec3::new(r, g, b), 1e-3), "texel {i}: {r} {g} {b}");
        }
        seen += 1;
    }
    assert!(seen > 1000, "only {seen} texels show the environment");
}
