//! The Vulkan layer: what it refuses, what it reports, what it costs.

mod gpu_support;

use std::time::Duration;

use gpu_support::Session;
use mirrorbench::gpu::{Buffer, ComputePipeline, Device, Format, Frame, Image, Load, Shape};

#[test]
fn an_unbound_or_unknown_variable_is_an_error_that_names_pass_and_variable() {
    let session = Session::open();
    let device = session.device();
    let composite = ComputePipeline::new(device, "stages/composite.wgsl", &[]).unwrap();
    let image = Image::new(device, "test", Format::Rgba16Float, [8, 8], Shape::Flat).unwrap();
    let mut frame = Frame::new(device).unwrap();
    frame.begin().unwrap();
    let pass = frame.pass("test/unbound").compute(&composite).sample("direct", &image);
    let error = pass.over_pixels([8, 8]).unwrap_err().to_string();
    assert!(error.contains("test/unbound") && error.contains("is not bound"), "{error}");
    frame.begin().unwrap();
    let pass = frame.pass("test/unknown").compute(&composite).sample("nobody", &image);
    let error = pass.over_pixels([8, 8]).unwrap_err().to_string();
    assert!(error.contains("test/unknown") && error.contains("`nobody`"), "{error}");
}

#[test]
fn a_uniform_of_another_size_is_refused() {
    let session = Session::open();
    let device = session.device();
    let reflect = ComputePipeline::new(
        device,
        "environment_map/reflect.wgsl",
        &[("RECORD_FULL", 1), ("INDEX_SURFACE", 1)],
    );
    let reflect = reflect.unwrap();
    let mut frame = Frame::new(device).unwrap();
    frame.begin().unwrap();
    let pass = frame.pass("test/uniform").compute(&reflect).uniform("params", &[0.0f32; 3]);
    let error = pass.over(1).unwrap_err().to_string();
    assert!(error.contains("12 bytes in Rust and 48 in WGSL"), "{error}");
}

#[test]
fn a_buffer_or_image_beyond_the_limits_is_refused_with_the_numbers() {
    let session = Session::open();
    let device = session.device();
    let limit = device.storage_limit();
    let error = Buffer::storage(device, "huge", limit + 4).err().unwrap().to_string();
    assert!(error.contains("huge") && error.contains(&limit.to_string()), "{error}");
    let size = [1 << 30, 1];
    let image = Image::new(device, "wide", Format::R32Uint, size, Shape::Flat);
    let error = image.err().unwrap().to_string();
    assert!(error.contains("wide") && error.contains("1073741824"), "{error}");
}

#[test]
fn a_frame_replaces_a_part_of_a_buffer_and_nothing_beyond_it() {
    let session = Session::open();
    let device = session.device();
    let buffer = Buffer::with_data(device, "words", &[7u32; 8]).unwrap();
    let mut frame = Frame::new(device).unwrap();
    frame.begin().unwrap();
    // In the order recorded.
    frame.pass("test/first").copy(&buffer, 8, &[1u32, 2, 3]).unwrap();
    frame.pass("test/second").copy(&buffer, 12, &[9u32]).unwrap();
    for (offset, data) in [(28, &[0u32; 2][..]), (0, &[])] {
        let error = frame.pass("test/beyond").copy(&buffer, offset, data).err().unwrap();
        let message = error.to_string();
        let named = ["test/beyond", "words", "32 bytes"].iter().all(|part| message.contains(part));
        assert!(named, "{message}");
    }
    frame.submit().unwrap();
    assert_eq!(buffer.read::<u32>().unwrap(), [7, 7, 1, 9, 3, 7, 7, 7]);
}

#[test]
fn buffers_and_images_come_back_as_they_were_written() {
    let session = Session::open();
    let device = session.device();
    let words: Vec<u32> = (0..1000).map(|i| i * i).collect();
    assert_eq!(Buffer::with_data(device, "words", &words).unwrap().read::<u32>().unwrap(), words);
    let image = Image::new(device, "cleared", Format::Rgba32Uint, [5, 5], Shape::Cube).unwrap();
    let mut frame = Frame::new(device).unwrap();
    frame.begin().unwrap();
    frame.pass("test/clear").clear(&[("image", &image, Load::ClearWords([1, 2, 3, 4]))]).unwrap();
    frame.submit().unwrap();
    assert_eq!(image.read::<[u32; 4]>().unwrap(), vec![[1, 2, 3, 4]; 5 * 5 * 6]);
}

#[test]
fn mip_levels_of_all_layers_can_be_written_and_read() {
    let session = Session::open();
    let device = session.device();
    let shape = Shape::Array(2);
    let image = Image::with_levels(device, "levels", Format::Rg32Uint, [8, 8], shape, 4).unwrap();
    let halve = ComputePipeline::new(device, "tests/levels.wgsl", &[]).unwrap();
    let last = Image::new(device, "last", Format::Rg32Uint, [1, 1], shape).unwrap();
    let mut frame = Frame::new(device).unwrap();
    frame.begin().unwrap();
    frame.pass("test/clear").clear(&[("image", &image, Load::ClearWords([1, 2, 0, 0]))]).unwrap();
    for level in 1..4u32 {
        let pass = frame.pass("test/levels").compute(&halve).sample("source", &image);
        let pass = pass.uniform("source_level", &(level - 1));
        pass.store_level("halved", &image, level).over_pixels([8 >> level; 2]).unwrap();
    }
    let pass = frame.pass("test/last").compute(&halve).sample("source", &image);
    // The 1 x 1 level read as if it were 2 x 2: what lies outside is 0.
    pass.uniform("source_level", &3u32).store("halved", &last).over_pixels([1, 1]).unwrap();
    frame.submit().unwrap();
    assert_eq!(image.read::<[u32; 2]>().unwrap().len(), 2 * 64);
    let first = [64, 128];
    // Layer 1 gains 1 at every level: ((1 * 4 + 1) * 4 + 1) * 4 + 1, and 1 more at the last.
    assert_eq!(last.read::<[u32; 2]>().unwrap(), [first, [86, 128]]);
}

#[test]
fn what_a_recorded_pass_uses_may_be_dropped_before_the_submit() {
    let session = Session::open();
    let device = session.device();
    let mut frame = Frame::new(device).unwrap();
    frame.begin().unwrap();
    {
        let image = Image::new(device, "gone", Format::R32Float, [64, 64], Shape::Flat).unwrap();
        frame.pass("test/gone").clear(&[("image", &image, Load::Clear([1.0; 4]))]).unwrap();
    }
    frame.submit().unwrap();
}

#[test]
fn passes_are_timed_in_order_and_the_profiler_is_cheap() {
    let session = Session::open();
    let device = session.device();
    let buffer = Buffer::storage(device, "filled", 4096).unwrap();
    let mut frame = Frame::new(device).unwrap();
    let mut cheapest = Duration::MAX;
    for _ in 0..5 {
        frame.begin().unwrap();
        for i in 0..100 {
            frame.pass(&format!("test/fill-{i}")).fill(&[&buffer], i).unwrap();
        }
        let nap = || {
            std::thread::sleep(Duration::from_millis(2));
            Ok(())
        };
        frame.cpu("test/cpu", nap).unwrap();
        let recorded = frame.submit().unwrap();
        assert_eq!(recorded.passes.len(), 101);
        assert_eq!(recorded.passes[7].name, "test/fill-7");
        assert!(recorded.passes[100].cpu_ms >= 2.0);
        let begins: Vec<f64> = recorded.passes.iter().map(|p| p.begin_ms).collect();
        assert!(begins.is_sorted(), "{begins:?}");
        cheapest = cheapest.min(recorded.profiler_time);
    }
    assert_eq!(buffer.read::<u32>().unwrap(), vec![99; 1024]);
    assert!(cheapest < Duration::from_micros(20), "the profiler takes {cheapest:?} a pass");
}

#[test]
fn an_unknown_device_lists_those_there_are() {
    let error = Device::open("no such device", false).err().unwrap();
    assert_eq!(error.exit_code(), 3);
    assert!(error.to_string().contains("there are: 0 \""), "{error}");
}
