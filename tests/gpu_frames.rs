//! Frames through a real Vulkan device: the picture, the footprint, the record, the times.

use std::sync::Arc;

use mirrorbench::experiment::engine::{Engine, Fallback, RecordMode, RunOptions};
use mirrorbench::gpu::Device;
use mirrorbench::methods::{Case, METHODS, MethodInfo};
use mirrorbench::scene::{self, Scene};

fn main_device() -> Arc<Device> {
    Device::open("auto", true).expect("a Vulkan device")
}

fn engine(device: &Arc<Device>, scene: &Scene, case: &str, size: [u32; 2]) -> Engine {
    let methods: Vec<&'static MethodInfo> = METHODS.iter().collect();
    let case = Case::parse(case, &methods).unwrap();
    let options = RunOptions {
        size,
        record: RecordMode::Full,
        fallback: Fallback::None,
        shader_dir: None,
        dump: None,
        seed: 0,
    };
    Engine::new(device, scene, &case, &methods, &options).unwrap()
}

#[test]
fn first_frame() {
    let device = main_device();
    let scene = scene::load("columns").unwrap();
    let mut engine = engine(&device, &scene, "environment-map", [320, 180]);
    let (frame, times) = engine.frame(&scene.at(0), true).unwrap();
    mirrorbench::experiment::frame_file::write_png(
        "/tmp/columns.png".as_ref(),
        frame.size,
        &frame.colour,
    )
    .unwrap();
    for p in times.prepare.iter().chain(&times.passes) {
        println!("{:40} {:8.3} ms {}", p.name, p.gpu_ms, p.invocations);
    }
    println!("{} {:?} {}", times.frame_gpu_ms, times.counters, times.prepare_bytes);
    println!("{:#?}", device.validation().messages());
}
