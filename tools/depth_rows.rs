//! What building simplified rotated depth maps takes, beside slide 39 of Popescu et al. 2006: `cargo bench
//! --bench depth_rows`. A depth image of 512x512 texels, a map every 10 degrees, on all cores and on the
//! Vulkan device there is, in turns, medians of several.

use std::error::Error;
use std::time::Instant;

use glam::Vec2;
use mirrorbench::geometry::depth_rows::{DepthRows, Heights, Limits, RowShape};
use mirrorbench::gpu::{Buffer, Device, Frame};
use mirrorbench::methods::depth_impostors::build::{RowBuffers, RowBuilder};

const SIZE: u32 = 512;
const ANGLES: u32 = 18;
const ROUNDS: usize = 9;
/// Slide 39: segments a row, and milliseconds.
const PUBLISHED: [(u32, f64); 4] = [(8, 210.0), (16, 300.0), (32, 480.0), (64, 980.0)];

/// Nine balls in a heap, with ripples: bends and silhouettes as on a statue.
fn heap(p: Vec2) -> f32 {
    let ball = |i: u32| {
        let turn = 2.4 * i as f32;
        let centre = 0.07 * i as f32 * Vec2::from_angle(turn);
        let radius = 0.42 - 0.025 * i as f32;
        let square = radius * radius - (p - centre).length_squared();
        let height = 0.3 + 0.04 * i as f32 + 0.5 * square.max(0.0).sqrt();
        if square > 0.0 { height + 0.003 * (40.0 * p.x).sin() * (40.0 * p.y).cos() } else { 0.0 }
    };
    (0..9).map(ball).fold(0.0, f32::max)
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_unstable_by(f64::total_cmp);
    times[times.len() / 2]
}

fn main() -> Result<(), Box<dyn Error>> {
    let middle = 0.5 * SIZE as f32;
    let at = |i: u32| {
        let texel = Vec2::new((i % SIZE) as f32, (i / SIZE) as f32);
        heap((texel + 0.5 - middle) / middle)
    };
    let texels: Vec<f32> = (0..SIZE * SIZE).map(at).collect();
    let heights = Heights { texels: &texels, size: SIZE };
    // A texel is as high as wide.
    let limits = Limits { tolerance: 0.25 / SIZE as f32, jump: 10.0 / SIZE as f32 };
    let device = Device::open("auto", false)?;
    let info = device.info();
    println!("{SIZE}x{SIZE} texels, {ANGLES} maps; {}", info.name);
    if info.is_software {
        println!("the device is software: its times are a processor's");
    }
    println!("segments  slide 39   all cores      device   rotate  simplify  used");
    for (segments, published) in PUBLISHED {
        let shape = RowShape { size: SIZE, angles: ANGLES, segments };
        let mut buffers = RowBuffers::new(&device, shape, 1)?;
        buffers.quads = Buffer::with_data(&device, "heights", &heights.quads())?;
        let builder = RowBuilder::new(&device, shape)?;
        let mut frame = Frame::new(&device)?;
        let [mut on_cores, mut on_device, mut rotate, mut simplify] = [(); 4].map(|()| Vec::new());
        let mut used = 0.0;
        for round in 0..=ROUNDS {
            let start = Instant::now();
            let rows = DepthRows::build(heights, shape, limits);
            let cores_ms = 1e3 * start.elapsed().as_secs_f64();
            frame.begin()?;
            builder.build(&mut frame, "bench", &buffers, 0, limits)?;
            let passes = frame.submit()?.passes;
            let ms = |name: &str| -> f64 {
                passes.iter().filter(|pass| pass.name.ends_with(name)).map(|pass| pass.gpu_ms).sum()
            };
            // The first round compiles.
            if round > 0 {
                on_cores.push(cores_ms);
                rotate.push(ms("/rotate"));
                simplify.push(ms("/simplify"));
                on_device.push(ms("/rotate") + ms("/simplify"));
            }
            let full = rows.counts.iter().filter(|&&count| count > 0).count();
            used = f64::from(rows.counts.iter().sum::<u32>()) / full as f64;
        }
        println!(
            "{segments:8} {published:6} ms {:8.1} ms {:8.1} ms {:8.1} {:9.1} {used:5.1}",
            median(on_cores),
            median(on_device),
            median(rotate),
            median(simplify)
        );
    }
    Ok(())
}
