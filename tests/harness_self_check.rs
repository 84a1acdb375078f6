//! The harness must notice: each fault put in here has to be found.

mod gpu_support;
mod snapshot_support;

use gpu_support::{Session, frame, judged};
use mirrorbench::gpu::{
    Attachments, Depth, Device, Format, Frame, GraphicsPipeline, Image, Load, Shape, Stencil,
};
use mirrorbench::scene;
use snapshot_support::{EDGE_SHARE, Picture, difference};

const SIZE: [u32; 2] = [96, 64];

#[test]
fn a_validation_error_is_heard() {
    let session = Session::open();
    let device = session.device();
    // A pipeline for another format than the attachment's.
    let attachments = Attachments {
        colours: &[Format::Rgba32Float],
        depth_stencil: false,
        depth: Depth::Off,
        stencil: Stencil::Off,
    };
    draw_background(device, &attachments);
    assert!(!session.faults().is_empty(), "the validation layers said nothing");
}

fn draw_background(device: &std::sync::Arc<Device>, attachments: &Attachments) {
    let scene = std::sync::Arc::new(scene::load("sky").unwrap());
    let gpu_scene = mirrorbench::stages::GpuScene::new(device, &scene).unwrap();
    let camera = mirrorbench::stages::CameraUniform::new(&scene.at(0).camera, SIZE);
    let file = "stages/background.wgsl";
    let pipeline = GraphicsPipeline::new(device, file, &[], attachments).unwrap();
    let image = Image::new(device, "target", Format::Rgba16Float, SIZE, Shape::Flat).unwrap();
    let mut frame = Frame::new(device).unwrap();
    frame.begin().unwrap();
    let pass = frame.pass("test/background").graphics(&pipeline);
    gpu_scene
        .bind(pass)
        .uniform("camera", &camera)
        .colour("colour", &image, Load::Clear([0.0; 4]))
        .draw(|draw| draw.vertices(3))
        .unwrap();
}

#[test]
fn a_leaked_object_is_found() {
    let session = Session::open();
    let image = Image::new(session.device(), "leaked", Format::R32Float, [4, 4], Shape::Flat);
    std::mem::forget(image.unwrap());
    let faults = session.faults();
    assert!(faults.iter().any(|f| f.contains("still alive")), "{faults:?}");
}

#[test]
fn another_method_is_not_taken_for_the_right_one() {
    let session = Session::open();
    let scene = scene::load("lecture").unwrap();
    let right = judged(&session, &scene, "planar-mirror", SIZE, 0).1.bad_share.one;
    let swapped = judged(&session, &scene, "environment-map", SIZE, 0).1.bad_share.one;
    assert!(right < 0.01 && swapped > 0.1, "{right} against {swapped}");
}

#[test]
fn one_changed_pixel_fails_a_snapshot() {
    let session = Session::open();
    let scene = scene::load("columns").unwrap();
    let picture = Picture::of(&frame(&session, &scene, "environment-map", SIZE, 0));
    let mut changed = picture.clone();
    changed.bytes[3 * (SIZE[0] as usize * 30 + 48)] ^= 0x40;
    assert!(difference(&picture, &picture, 0.0).is_ok());
    assert!(difference(&picture, &changed, 0.0).is_err());
    let smaller = Picture { size: [SIZE[0], SIZE[1] - 1], ..picture.clone() };
    assert!(difference(&picture, &smaller, EDGE_SHARE).is_err());
}
