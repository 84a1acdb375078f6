//! The arc of a mirrored ray in a map, on the GPU against its Rust twin.

mod gpu_support;

use glam::{IVec2, Vec3, Vec4, Vec4Swizzles};
use gpu_support::Session;
use mirrorbench::geometry::random::SplitMix64;
use mirrorbench::geometry::reflection_plane::{
    deviation, direction_at, in_face, is_parallel, on_face,
};
use mirrorbench::geometry::texel_line::{TexelLine, Texels};
use mirrorbench::gpu::{Buffer, ComputePipeline, Frame};

const COUNT: usize = 4096;
const SIZE: u32 = 40;
const ROOM: usize = 80;

fn run(session: &Session, entry: &str, inputs: &[Vec4], outputs: usize) -> Vec<Vec4> {
    let device = session.device();
    let pipeline = ComputePipeline::with_entry(device, "tests/arc.wgsl", entry, &[]).unwrap();
    let given = Buffer::with_data(device, "inputs", inputs).unwrap();
    let answer = Buffer::with_data(device, "outputs", &vec![Vec4::ZERO; outputs]).unwrap();
    let mut frame = Frame::new(device).unwrap();
    frame.begin().unwrap();
    let pass = frame.pass("test/arc").compute(&pipeline);
    pass.buffer("inputs", &given).buffer("outputs", &answer).over(COUNT as u32).unwrap();
    frame.submit().unwrap();
    answer.read().unwrap()
}

#[test]
fn the_reflection_plane() {
    let session = Session::open();
    let mut random = SplitMix64::new(1);
    let corner = Vec3::splat(2.0);
    let inputs: Vec<Vec4> = (0..COUNT)
        .flat_map(|i| {
            let b = random.within(-corner, corner).normalize_or(Vec3::X);
            let mut w = random.within(-corner, corner);
            if i % 8 == 0 {
                // In line, or nearly.
                w = b * (2.0 * random.unit() - 1.0) + 2e-3 * random.unit() * w;
            }
            [b.extend(random.unit()), w.extend(0.0)]
        })
        .collect();
    let outputs = run(&session, "plane", &inputs, 8 * COUNT);
    let (mut at_the_limit, mut parallel, mut parts) = (0, 0, 0);
    for (input, out) in inputs.chunks(2).zip(outputs.chunks(8)) {
        let (b, w, t) = (input[0].xyz(), input[1].xyz(), input[0].w);
        assert!(out[0].xyz().abs_diff_eq(direction_at(b, w, t), 1e-6));
        let (expected, got) = (deviation(b, w), out[0].w);
        // Beside a right angle rounding decides which it is.
        assert!((got - expected).abs() < 1e-5 || b.dot(w).abs() < 1e-5, "{got} {expected}");
        let in_line = out[1].x == 1.0;
        at_the_limit += u32::from(in_line != is_parallel(b, w));
        parallel += u32::from(in_line);
        for (face, &got) in (0..6).zip(&out[2..]) {
            let expected = on_face(in_face(face, b), in_face(face, w));
            let ends = expected.map(|[a, b]| Vec4::new(a.x, a.y, b.x, b.y));
            let expected = ends.unwrap_or(Vec4::NEG_ONE);
            let close = in_line || got.abs_diff_eq(expected, 1e-3);
            // Arcs that touch a face's border may end there or not begin.
            at_the_limit += u32::from(!close);
            parts += u32::from(got != Vec4::NEG_ONE);
        }
    }
    assert!(parallel > 100 && parts > COUNT as u32, "{parallel} in line, {parts} parts");
    assert!(at_the_limit < 10, "{at_the_limit} differ");
}

#[test]
fn lines_on_a_face() {
    let session = Session::open();
    let mut random = SplitMix64::new(2);
    let mut place = || (SIZE as f32 * random.unit() * 4.0).round() / 4.0 + 0.0;
    let inputs: Vec<Vec4> =
        (0..COUNT).map(|_| Vec4::from_array([(); 4].map(|()| place()))).collect();
    let outputs = run(&session, "lines", &inputs, 2 * ROOM * COUNT);
    let mut different = 0;
    for (ends, out) in inputs.iter().zip(outputs.chunks(2 * ROOM)) {
        for (texels, out) in [Texels::Touched, Texels::Bresenham].into_iter().zip(out.chunks(ROOM))
        {
            let line = TexelLine::new(texels, ends.xy(), ends.zw(), SIZE);
            assert_eq!(out[0].w as u32, line.touched());
            let got = out.iter().take_while(|cell| cell.z == 1.0);
            let got: Vec<IVec2> = got.map(|cell| cell.xy().as_ivec2()).collect();
            let expected: Vec<IVec2> = line.collect();
            assert_eq!(got.len(), expected.len(), "{texels:?} of {ends}");
            assert!(texels == Texels::Touched || got == expected, "{texels:?} of {ends}");
            // At a corner of four texels rounding decides which of two is next.
            different += u32::from(got != expected);
        }
    }
    assert!(different < COUNT as u32 / 20, "{different} lines differ");
}
