use std::f32::consts::PI;

use glam::{Vec2, Vec3, Vec3Swizzles};
use proptest::prelude::*;

use super::*;
use crate::geometry::random::SplitMix64;

const SIZE: u32 = 128;
const LIMITS: Limits = Limits { tolerance: 0.25 / 128.0, jump: 10.0 / 128.0 };

/// A depth image of `height` at each texel's centre, -1 to 1 across.
fn image(height: impl Fn(Vec2) -> f32) -> Vec<f32> {
    let middle = 0.5 * SIZE as f32;
    let at = |i: u32| {
        let texel = Vec2::new((i % SIZE) as f32, (i / SIZE) as f32);
        height((texel + 0.5 - middle) / middle)
    };
    (0..SIZE * SIZE).map(at).collect()
}

fn ball(p: Vec2) -> f32 {
    let square = 0.81 - p.length_squared();
    if square > 0.0 { 0.05 + square.sqrt() } else { 0.0 }
}

/// A hilly sheet with things before it, so that rows have bends and silhouettes.
fn landscape(p: Vec2) -> f32 {
    if p.length() > 0.95 {
        return 0.0;
    }
    if (p - Vec2::new(0.3, 0.2)).length() < 0.2 {
        return 0.8;
    }
    0.3 + 0.1 * (7.0 * p.x).sin() * (5.0 * p.y).cos()
}

fn shape(step_deg: u32, segments: u32) -> RowShape {
    RowShape { size: SIZE, angles: 180 / step_deg, segments }
}

fn rows(texels: &[f32], shape: RowShape) -> DepthRows {
    rows_by(simplify, texels, shape)
}

fn rows_by(rule: Simplify, texels: &[f32], shape: RowShape) -> DepthRows {
    DepthRows::build(Heights { texels, size: SIZE }, shape, LIMITS, rule)
}

/// Mean error of rows at their samples.
fn error(rows: &DepthRows, texels: &[f32]) -> f32 {
    let heights = Heights { texels, size: SIZE };
    let mut samples = vec![0.0; SIZE as usize];
    let mut sum = 0.0;
    for (map, row) in (0..rows.shape.rows()).map(|row| (row / SIZE, row % SIZE)) {
        sample_row(heights, rows.shape, LIMITS.jump, (map, row), &mut samples);
        let kept = rows.row(map, row);
        for (i, &sample) in samples.iter().enumerate() {
            sum += (height_at(kept, i as f32 + 0.5) - sample).abs();
        }
    }
    sum / (rows.shape.rows() * SIZE) as f32
}

/// The height of a row's segments at x, 0 where none is.
fn height_at(row: &[Packed], x: f32) -> f32 {
    let on = |segment: &Segment| segment.x[0] <= x && x <= segment.x[1];
    let segments = row.iter().map(|&packed| Segment::unpacked(packed, SIZE));
    segments.into_iter().find(on).map_or(0.0, |Segment { x: [a, b], height: [from, to] }| {
        from + (to - from) * (x - a) / (b - a)
    })
}

/// Lines over the disc, downwards, whatever their direction.
fn lines(count: u32) -> Vec<ImageLine> {
    let mut random = SplitMix64::new(7);
    let middle = Vec2::splat(0.5 * SIZE as f32);
    let line = |_| {
        let [turn, off, low, high] = [(); 4].map(|_| random.within(Vec3::ZERO, Vec3::ONE).x);
        let along = Vec2::from_angle(2.0 * PI * turn);
        let across = (off - 0.5) * 0.9 * SIZE as f32;
        let half = (middle.x * middle.x - across * across).sqrt() - 0.5;
        let origin = middle + across * along.perp();
        ImageLine {
            start: (origin - half * along).extend(0.7 + 0.3 * high),
            end: (origin + half * along).extend(0.3 * low),
        }
    };
    (0..count).map(line).collect()
}

#[test]
fn a_segment_survives_its_packing() {
    let segment = Segment { x: [3.5, 97.0], height: [0.125, 0.75] };
    let back = Segment::unpacked(segment.packed(SIZE), SIZE);
    for end in [0, 1] {
        assert!((back.x[end] - segment.x[end]).abs() < 1e-3);
        assert!((back.height[end] - segment.height[end]).abs() < 1e-5);
    }
}

proptest! {
    #[test]
    fn a_row_keeps_to_its_budget_and_its_silhouettes(
        heights in prop::collection::vec(
            prop_oneof![2 => Just(0.0f32), 3 => 0.2f32..0.25, 1 => 0.7f32..0.72], 32),
        most in 1usize..20,
    ) {
        let mut segments = vec![[0; 2]; most];
        let swept = sweep(&heights, LIMITS, &mut segments) as usize;
        prop_assert!(swept <= most);
        let list: Vec<_> = segments[..swept].iter().map(|&s| Segment::unpacked(s, 32)).collect();
        prop_assert!(list.windows(2).all(|pair| pair[0].x[1] <= pair[1].x[0] + 1e-3), "{list:?}");
        prop_assert_eq!(swept > 0, heights.iter().any(|&h| h > 0.0));
        let count = simplify(&heights, LIMITS, &mut segments) as usize;
        prop_assert!(count <= most);
        let list: Vec<_> = segments[..count].iter().map(|&s| Segment::unpacked(s, 32)).collect();
        for pair in list.windows(2) {
            prop_assert!(pair[0].x[1] <= pair[1].x[0] + 1e-3, "from left to right: {pair:?}");
        }
        prop_assert_eq!(count > 0, heights.iter().any(|&h| h > 0.0));
        if count < most {
            // Nothing was left out for want of segments.
            for (i, &height) in heights.iter().enumerate() {
                let x = i as f32 + 0.5;
                let near = |s: &&Segment| s.x[0] - 1e-3 <= x && x <= s.x[1] + 1e-3;
                let Some(s) = list.iter().find(near) else {
                    prop_assert_eq!(height, 0.0);
                    continue;
                };
                let part = (x - s.x[0]) / (s.x[1] - s.x[0]);
                let stored = s.height[0] + part * (s.height[1] - s.height[0]);
                prop_assert!((stored - height).abs() < LIMITS.jump, "{stored} for {height}");
            }
        }
    }
}

#[test]
fn more_segments_are_nearer_to_the_row() {
    let texels = image(landscape);
    for rule in [simplify, sweep] as [Simplify; 2] {
        let error_of = |segments: u32| error(&rows_by(rule, &texels, shape(20, segments)), &texels);
        let errors = [2, 4, 8, 16, 32].map(error_of);
        assert!(errors.is_sorted_by(|a, b| a > b), "{errors:?}");
        assert!(errors[4] < LIMITS.tolerance, "{errors:?}");
    }
}

#[test]
fn rows_swept_are_nearly_as_near_as_rows_split_and_within_the_tolerance_where_segments_do() {
    for texels in [image(landscape), image(ball)] {
        for segments in [4, 8, 16] {
            let [split, swept] = ([simplify, sweep] as [Simplify; 2])
                .map(|rule| error(&rows_by(rule, &texels, shape(20, segments)), &texels));
            let allowed = (1.4 * split).max(LIMITS.tolerance);
            assert!(swept < allowed, "{segments} segments: {split} split, {swept} swept");
        }
    }
    // Level at both ends, where segments go on beyond the samples' centres.
    let wave = |i: u32| 0.5 + 0.1 * (6.0 * PI * i as f32 / (SIZE - 1) as f32).cos();
    let samples: Vec<f32> = (0..SIZE).map(wave).collect();
    let mut segments = [[0; 2]; 64];
    let count = sweep(&samples, LIMITS, &mut segments) as usize;
    assert!((30..60).contains(&count), "{count}");
    for (i, &sample) in samples.iter().enumerate() {
        let error = (height_at(&segments[..count], i as f32 + 0.5) - sample).abs();
        assert!(error < 1.02 * LIMITS.tolerance, "{error} at {i}");
    }
}

#[test]
fn maps_are_the_image_rotated() {
    let texels = image(landscape);
    let heights = Heights { texels: &texels, size: SIZE };
    let shape = shape(20, 32);
    let mut samples = vec![0.0; SIZE as usize];
    for (map, row) in [(0, 40), (3, 64), (7, 100)] {
        sample_row(heights, shape, LIMITS.jump, (map, row), &mut samples);
        for (i, &sample) in samples.iter().enumerate() {
            let place = Vec2::new(i as f32 + 0.5, row as f32 + 0.5);
            let back = shape.rotated(place, -shape.angle(map));
            assert!(shape.rotated(back, shape.angle(map)).abs_diff_eq(place, 1e-3));
            let middle = 0.5 * SIZE as f32;
            if (place - middle).length() < middle {
                assert!((heights.at(back, LIMITS.jump) - sample).abs() < LIMITS.jump);
            }
        }
    }
}

#[test]
fn a_ray_along_a_maps_rows_meets_what_a_march_meets() {
    let texels = image(ball);
    let rows = rows(&texels, shape(20, 64));
    let heights = Heights { texels: &texels, size: SIZE };
    let (mut hits, mut near) = (0, 0);
    for line in lines(400) {
        // Turned to the nearest map, from either side.
        let across = (line.end - line.start).xy();
        let middle = Vec2::splat(0.5 * SIZE as f32);
        let turn = (across.to_angle() / (PI / 9.0)).round() * (PI / 9.0) - across.to_angle();
        let turned =
            |p: Vec3| (middle + Vec2::from_angle(turn).rotate(p.xy() - middle)).extend(p.z);
        let line = ImageLine { start: turned(line.start), end: turned(line.end) };
        let rule = Rule { skins: false, re_anchor: false, jump: LIMITS.jump };
        let found = search(&rows, &line, rule);
        let marched = march(heights, &line, LIMITS.jump, false);
        if let (Some(found), Some(marched)) = (found.place, marched.place) {
            hits += 1;
            near += i32::from(found.distance(marched) < 1.5);
        }
    }
    // Where a ray grazes the ball, a height off by a tolerance is texels off along it.
    assert!(20 * near > 19 * hits, "{near} of {hits}");
    assert!(hits > 100, "{hits} hits");
}

/// How far beside their rays the rows pass that were hit, where they were, on average; and
/// x tan(half the step), x from the middle of the ray's part on.
fn lateral(step_deg: u32, re_anchor: bool) -> [f32; 2] {
    let texels = image(ball);
    let rows = rows(&texels, shape(step_deg, 64));
    let (mut sum, mut bound, mut hits) = (0.0, 0.0, 0);
    for line in lines(4000) {
        let found = search(&rows, &line, Rule { skins: false, re_anchor, jump: LIMITS.jump });
        let Some(place) = found.place else { continue };
        let along = (line.end - line.start).xy().normalize();
        let from_middle = line.at(0.5).xy() - place;
        sum += if re_anchor {
            // The point lies on the ray; the row it was found in does not.
            rows_away(&rows, &line, found.share)
        } else {
            from_middle.perp_dot(along).abs()
        };
        bound += from_middle.length() * (0.5 * (step_deg as f32).to_radians()).tan();
        hits += 1;
    }
    assert!(hits > 1000);
    [sum / hits as f32, bound / hits as f32]
}

/// How far beside the ray the row of the re-anchored hit passes where it was hit.
fn rows_away(rows: &DepthRows, line: &ImageLine, share: f32) -> f32 {
    let once = search(rows, line, Rule { skins: false, re_anchor: false, jump: LIMITS.jump });
    let across = (line.end - line.start).xy();
    let step = PI / rows.shape.angles as f32;
    let off = across.to_angle().rem_euclid(step);
    let off = off.min(step - off);
    (share - once.share).abs() * across.length() * off.tan()
}

#[test]
fn rays_are_missed_sideways_by_their_angle_and_re_anchoring_mends_it() {
    for step_deg in [20, 10, 3, 2] {
        let [off, bound] = lateral(step_deg, false);
        // Angles fall anywhere between 0 and half the step: half of what the worst gives.
        let ratio = off / bound;
        assert!((0.35..0.65).contains(&ratio), "{step_deg} degrees: {off} of {bound} texels");
        let [again, _] = lateral(step_deg, true);
        if step_deg >= 10 {
            assert!(4.0 * again < off, "{step_deg} degrees: {again} after {off} texels");
        }
    }
}

#[test]
fn skins_catch_what_passes_behind() {
    let texels = image(|p| if p.x.abs() < 0.2 && p.y.abs() < 0.6 { 0.8 } else { 0.0 });
    let rows = rows(&texels, shape(10, 16));
    let heights = Heights { texels: &texels, size: SIZE };
    let y = 64.3;
    let line = ImageLine { start: Vec3::new(2.0, y, 0.5), end: Vec3::new(126.0, y, 0.4) };
    let back = ImageLine { start: line.end, end: line.start };
    for (line, edge) in [(line, 51.2), (back, 76.8)] {
        let rule = Rule { skins: true, re_anchor: false, jump: LIMITS.jump };
        let skin = search(&rows, &line, rule).place.unwrap();
        let marched = march(heights, &line, LIMITS.jump, true).place.unwrap();
        assert!((skin.x - edge).abs() < 1.5 && (marched.x - edge).abs() < 1.5, "{skin} {marched}");
        let gap = search(&rows, &line, Rule { skins: false, ..rule });
        let marched = march(heights, &line, LIMITS.jump, false);
        assert!(gap.place.is_none() && gap.behind && gap.row_exists);
        assert!(marched.place.is_none() && marched.behind);
    }
}

#[test]
fn a_row_is_read_far_less_than_its_texels() {
    let texels = image(landscape);
    let rows = rows(&texels, shape(10, 32));
    let heights = Heights { texels: &texels, size: SIZE };
    let [mut segments, mut marched] = [0, 0];
    for line in lines(1000) {
        segments +=
            search(&rows, &line, Rule { skins: false, re_anchor: true, jump: LIMITS.jump }).reads;
        marched += march(heights, &line, LIMITS.jump, false).reads;
    }
    // Of 128 texels; the wider the image, the more there are to a segment.
    assert!(3 * segments < 2 * marched, "{segments} segments, {marched} texels");
}
