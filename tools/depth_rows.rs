//! What building simplified rotated depth maps takes, beside slide 39 of Popescu et al. 2006: `cargo bench
//! --bench depth_rows`. A depth image of 512x512 texels, a map every 10 degrees, on all cores and on the
//! Vulkan device there is, in turns, medians of several.

use std::error::Error;
use std::time::Instant;

use glam::Vec2;
use mirrorbench::geometry::depth_rows::{
    DepthRows, Heights, Limits, RowShape, Segment, Simplify, sample_row, simplify, sweep,
};
use mirrorbench::gpu::{Device, Frame, Image, Shape};
use mirrorbench::methods::depth_impostors::build::{QUADS, RowBuffers, RowBuilder};

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

/// Mean and largest height error of rows' segments at their samples, the largest averaged over rows; in texels,
/// which here are as high as wide.
fn errors(rows: &DepthRows, heights: Heights, limits: Limits) -> [f64; 2] {
    let mut samples = vec![0.0; SIZE as usize];
    let (mut sum, mut shown, mut worst, mut full) = (0.0, 0u32, 0.0, 0u32);
    for row in (0..rows.shape.rows()).filter(|&row| rows.counts[row as usize] > 0) {
        let at = (row / SIZE, row % SIZE);
        sample_row(heights, rows.shape, limits.jump, at, &mut samples);
        let kept = rows.row(at.0, at.1).iter().map(|&packed| Segment::unpacked(packed, SIZE));
        let mut largest = 0.0f32;
        for Segment { x, height } in kept {
            let slope = (height[1] - height[0]) / (x[1] - x[0]);
            let (from, to) = (x[0].floor() as usize, x[1].ceil() as usize);
            for (i, &sample) in samples.iter().enumerate().take(to).skip(from) {
                let off = (height[0] + slope * (i as f32 + 0.5 - x[0]) - sample).abs();
                if sample > 0.0 && x[0] <= i as f32 + 0.6 && i as f32 + 0.4 <= x[1] {
                    largest = largest.max(off);
                    sum += f64::from(off);
                    shown += 1;
                }
            }
        }
        worst += f64::from(largest);
        full += 1;
    }
    [sum / f64::from(shown), worst / f64::from(full)].map(|error| error * f64::from(SIZE))
}

/// Segments that a row with any has on average.
fn used(rows: &DepthRows) -> f64 {
    let full = rows.counts.iter().filter(|&&count| count > 0).count();
    f64::from(rows.counts.iter().sum::<u32>()) / full as f64
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
    println!(
        "ms: slide 39; all cores, rows split and swept; the device, rows swept, of it turning and sweeping"
    );
    println!("then of rows split | swept: segments used, mean and largest error in texels");
    println!(
        "segments  slide  split  swept device   turn  sweep   used            mean            largest"
    );
    for (segments, published) in PUBLISHED {
        let shape = RowShape { size: SIZE, angles: ANGLES, segments };
        let mut buffers = RowBuffers::new(&device, shape, 1)?;
        buffers.quads = Image::with_data(
            &device,
            "heights",
            (QUADS, Shape::Array(1)),
            [SIZE; 2],
            &heights.quads(),
        )?;
        let builder = RowBuilder::new(&device, shape)?;
        let mut frame = Frame::new(&device)?;
        let mut times = [(); 5].map(|()| Vec::new());
        let mut by_rule = [([0.0; 2], 0.0); 2];
        for round in 0..=ROUNDS {
            let rules: [Simplify; 2] = [simplify, sweep];
            for (rule, which) in rules.into_iter().zip(0..) {
                let start = Instant::now();
                let rows = DepthRows::build(heights, shape, limits, rule);
                times[which].push(1e3 * start.elapsed().as_secs_f64());
                if round == 0 {
                    by_rule[which] = (errors(&rows, heights, limits), used(&rows));
                }
            }
            frame.begin()?;
            builder.build(&mut frame, "bench", &buffers, 0, limits)?;
            let passes = frame.submit()?.passes;
            let ms = |name: &str| -> f64 {
                passes.iter().filter(|pass| pass.name.ends_with(name)).map(|pass| pass.gpu_ms).sum()
            };
            times[2].push(ms("/rotate") + ms("/simplify"));
            times[3].push(ms("/rotate"));
            times[4].push(ms("/simplify"));
        }
        // The first round compiles.
        let [split, swept, on_device, turn, sweeps] =
            times.map(|times| median(times[1..].to_vec()));
        let [([mean, most], pieces), ([swept_mean, swept_most], swept_pieces)] = by_rule;
        println!(
            "{segments:8} {published:6} {split:6.1} {swept:6.1} {on_device:6.1} {turn:6.1} {sweeps:6.1} \
             {pieces:6.1} |{swept_pieces:5.1}   {mean:6.3} |{swept_mean:6.3}   {most:6.2} |{swept_most:6.2}"
        );
    }
    Ok(())
}
