//! Portraits of single objects, against rays through each texel's centre and against moved objects.

mod gpu_support;
mod truth_support;

use std::sync::Arc;

use glam::Vec3;
use gpu_support::Session;
use half::f16;
use mirrorbench::geometry::Ray;
use mirrorbench::geometry::bvh::Bvh;
use mirrorbench::gpu::Frame;
use mirrorbench::scene::{ObjectId, Scene, shading};
use mirrorbench::stages::{
    GpuScene, PortraitStage, PortraitView, Portraits, Sight, own_from_world, own_points,
};

const SIZE: u32 = 64;
const LAYERS: u32 = 3;

/// A ring and a box, which both turn and move, before a wall that is in nobody's picture.
fn scene() -> Scene {
    truth_support::scene(
        r#"
        [camera]
        fov_deg = 40.0
        eye = [0.0, 1.0, 6.0]
        target = [0.0, 0.0, 0.0]
        [[objects]]
        name = "wall"
        shape = { plane = { size = [9.0, 9.0] } }
        material = "floor"
        [[objects]]
        name = "ring"
        shape = { torus = { ring = 0.6, tube = 0.25, edge = 0.1 } }
        material = "floor"
        position = [1.0, 1.0, 0.5]
        rotation_deg = [50.0, 20.0, 10.0]
        orbit = { centre = [0.0, 0.0, 0.0], period_s = 2.0 }
        [[objects]]
        name = "box"
        shape = { box = { size = [0.5, 1.0, 0.7] } }
        material = "red"
        position = [-1.0, 0.5, 0.0]
        rotation_deg = [0.0, 30.0, 0.0]
        orbit = { centre = [0.0, 0.0, 0.0], period_s = 3.0 }
        "#,
    )
}

const RING: ObjectId = 1;
const BOX: ObjectId = 2;

struct Read {
    views: Vec<PortraitView>,
    albedo: Vec<[f16; 4]>,
    radiance: Vec<[f16; 4]>,
    point: Vec<[f32; 4]>,
    normal: Vec<[f32; 4]>,
    ids: Vec<[u32; 2]>,
}

/// Two pictures of the ring and one of the box, taken at one frame and lit at another.
fn taken(session: &Session, scene: &Scene, take: u32, light: u32) -> Read {
    let device = session.device();
    let mut gpu_scene = GpuScene::new(device, &Arc::new(scene.clone())).unwrap();
    let stage = PortraitStage::new(device).unwrap();
    let mut portraits = Portraits::new(device, "test", SIZE, LAYERS, 3).unwrap();
    let mut frame = Frame::new(device).unwrap();
    frame.begin().unwrap();
    let moment = scene.at(take);
    gpu_scene.pose(&mut frame, &moment).unwrap();
    let wanted = [(RING, Sight::Central), (BOX, Sight::Central), (RING, Sight::Parallel)];
    for (layer, (object, sight)) in wanted.into_iter().enumerate() {
        let points = own_points(scene, &moment, &[object]);
        // The same place of own space whenever it is taken.
        let view = PortraitView::facing(&points, Vec3::new(1.0, 1.5, 2.0), sight);
        let target = (&mut portraits, layer as u32);
        stage.take(&mut frame, &gpu_scene, "test", target, &[object], view).unwrap();
    }
    frame.submit().unwrap();
    frame.begin().unwrap();
    gpu_scene.pose(&mut frame, &scene.at(light)).unwrap();
    stage.light(&mut frame, &gpu_scene, "test", &portraits).unwrap();
    frame.submit().unwrap();
    Read {
        views: (0..LAYERS).map(|layer| *portraits.view(layer).unwrap()).collect(),
        albedo: portraits.albedo.read().unwrap(),
        radiance: portraits.radiance.read().unwrap(),
        point: portraits.point.read().unwrap(),
        normal: portraits.normal.read().unwrap(),
        ids: portraits.ids.read().unwrap(),
    }
}

/// The ray through a texel's centre, own space.
fn through(view: &PortraitView, [x, y]: [u32; 2]) -> Ray {
    let at = |i: u32| (i as f32 + 0.5) / SIZE as f32 * 2.0 - 1.0;
    let [right, up, towards] = view.axes;
    let on_plane = view.centre + at(x) * view.half.x * right - at(y) * view.half.y * up;
    if view.eye_distance == 0.0 {
        return Ray { origin: on_plane + 10.0 * towards, direction: -towards };
    }
    let eye = view.centre + view.eye_distance * towards;
    Ray { origin: eye, direction: (on_plane - eye).normalize() }
}

#[test]
fn each_texel_holds_what_its_centre_sees() {
    let (session, scene) = (Session::open(), scene());
    let read = taken(&session, &scene, 7, 7);
    let moment = scene.at(7);
    for (layer, object) in [RING, BOX, RING].into_iter().enumerate() {
        let to_own = own_from_world(&moment, object);
        let corners: Vec<_> = scene
            .world_triangles(&moment, object)
            .map(|corners| corners.map(|p| to_own.transform_point3(p)))
            .collect();
        let (tree, view) = (Bvh::new(&corners), read.views[layer]);
        let (mut covered, mut wrong) = (0, 0);
        for texel in 0..SIZE * SIZE {
            let at = layer * (SIZE * SIZE) as usize + texel as usize;
            let ray = through(&view, [texel % SIZE, texel / SIZE]);
            let hit = tree.nearest(&ray, [0.0, f32::INFINITY], |_, _| true);
            let drawn = read.albedo[at][3].to_f32() == 1.0;
            let Some(hit) = hit else {
                wrong += u32::from(drawn);
                continue;
            };
            covered += 1;
            let point = ray.origin + hit.t * ray.direction;
            let [x, y, z, before] = read.point[at];
            let n = Vec3::from_slice(&read.normal[at][..3]);
            let same = drawn
                && point.distance(Vec3::new(x, y, z)) < 1e-3
                && (before - (point - view.centre).dot(view.axes[2])).abs() < 1e-3
                && n.dot(ray.direction) < 0.05
                && (read.normal[at][3] == 1.0) == hit.front
                && read.ids[at][0] == object;
            wrong += u32::from(!same);
        }
        assert!(covered > SIZE * SIZE / 4, "layer {layer}: only {covered} texels covered");
        // Outlines may differ by the rasteriser's grid.
        assert!(wrong < covered / 50, "layer {layer}: {wrong} of {covered} differ");
    }
}

#[test]
fn what_moves_needs_light_alone() {
    let (session, scene) = (Session::open(), scene());
    let [still, moved] = [0, 11].map(|take| taken(&session, &scene, take, 11));
    let mut worst = 0.0f32;
    for (a, b) in still.radiance.iter().zip(&moved.radiance) {
        // Where both rasterise the same; rounding decides at outlines.
        if a[3] == b[3] {
            let apart = a.iter().zip(b).map(|(a, b)| (a.to_f32() - b.to_f32()).abs());
            worst = apart.fold(worst, f32::max);
        }
    }
    assert!(worst < 5e-3, "lit anew, light is {worst} off");
    let unlit = taken(&session, &scene, 0, 0);
    assert!(unlit.radiance != still.radiance, "light must have changed");
}

#[test]
fn light_is_the_scenes_own_shading() {
    let (session, scene) = (Session::open(), scene());
    let read = taken(&session, &scene, 3, 3);
    let moment = scene.at(3);
    let texels = (SIZE * SIZE) as usize;
    for at in (texels..2 * texels).filter(|&at| read.albedo[at][3].to_f32() == 1.0) {
        let own = Vec3::from_slice(&read.normal[at][..3]);
        let normal = moment.poses[BOX as usize].transform_vector3(own);
        let expected = shading::shade(&scene, BOX, normal, glam::Vec2::ZERO, true);
        let [r, g, b, _] = read.radiance[at].map(f16::to_f32);
        assert!(expected.abs_diff_eq(Vec3::new(r, g, b), 2e-3), "texel {at}");
    }
}
