//! The measures themselves: known errors put into a record must be found, as large as they are.

mod truth_support;

use glam::{UVec2, Vec2, Vec3, Vec4, Vec4Swizzles};
use mirrorbench::geometry::alhazen::reflected_point;
use mirrorbench::measure::{Accuracy, BadShare, Class, Maps, accuracy};
use mirrorbench::scene::{FrameRecord, Ids, Lobe, NO_OBJECT, Scene, Status};
use mirrorbench::truth::{Shapes, Tracer};
use truth_support::{BALL, FLAT, TWO_BALLS, at, eye_ray, scene, tracer};

const SIZE: [u32; 2] = [160, 120];

fn compare(truth: &FrameRecord, tested: &FrameRecord, tracer: &Tracer) -> (Accuracy, Maps) {
    accuracy(truth, tested, tracer).unwrap()
}

/// Show at `pixel` what `from` shows at `other`.
fn take(frame: &mut FrameRecord, pixel: usize, from: &FrameRecord, other: usize) {
    frame.record.ids[pixel] = from.record.ids[other];
    frame.record.point[pixel] = from.record.point[other];
    frame.record.last[pixel] = from.record.last[other];
    frame.record.radiance[pixel] = from.record.radiance[other];
}

/// The truth with what pixels of the same chain and kind show moved by `shift` columns; the pixels
/// where that could be done.
fn shifted(truth: &FrameRecord, shift: usize) -> (FrameRecord, Vec<usize>) {
    let mut tested = truth.clone();
    let key = |pixel: usize| {
        let ids = truth.record.ids[pixel];
        (truth.reflector[pixel], ids.trace, ids.status())
    };
    let width = truth.size[0] as usize;
    let mut moved = truth.reflector_pixels();
    moved.retain(|&pixel| pixel % width + shift < width && key(pixel) == key(pixel + shift));
    for &pixel in &moved {
        take(&mut tested, pixel, truth, pixel + shift);
    }
    (tested, moved)
}

#[test]
fn the_truth_against_itself_is_without_error() {
    let scene = scene(TWO_BALLS);
    let tracer = tracer(&scene, Shapes::Tessellated);
    let truth = tracer.frame(SIZE);
    let (accuracy, maps) = compare(&truth, &truth, &tracer);
    let none = BadShare { half: 0.0, one: 0.0, two: 0.0, four: 0.0 };
    assert_eq!((accuracy.bad_share, accuracy.covered), (none, 1.0));
    let shares = [
        accuracy.missing,
        accuracy.spurious,
        accuracy.wrong_object,
        accuracy.wrong_depth,
        accuracy.unreachable,
        accuracy.footprint_mismatch,
        accuracy.relmse,
        accuracy.relmse_shading,
        accuracy.flip.mean,
        accuracy.flip.p95,
    ];
    assert_eq!(shares, [0.0; 10]);
    for quantiles in [accuracy.displacement_px, accuracy.angle_deg] {
        let quantiles = quantiles.unwrap();
        assert_eq!([quantiles.median, quantiles.p95, quantiles.max], [0.0; 3]);
    }
    assert_eq!(accuracy.psnr, None);
    let placed = maps.class.iter().filter(|class| **class == Class::Placed).count();
    assert_eq!(placed, truth.reflector_pixels().len());
}

#[test]
fn the_truth_found_once_more_by_the_search_is_in_its_place() {
    // Triangle ids are off by one, so no answer counts as equal and every root is searched for.
    for text in [BALL, TWO_BALLS] {
        let scene = scene(text);
        let tracer = tracer(&scene, Shapes::Tessellated);
        let truth = tracer.frame(SIZE);
        let mut tested = truth.clone();
        for ids in &mut tested.record.ids {
            ids.triangle ^= 1;
        }
        let (accuracy, _) = compare(&truth, &tested, &tracer);
        assert_eq!(accuracy.covered, 1.0);
        assert!(accuracy.displacement_px.unwrap().max < 0.02, "{accuracy:?}");
        let angle = accuracy.angle_deg.unwrap().max;
        assert!(angle < 0.05, "{angle} degrees");
        assert_eq!(accuracy.bad_share.half, 0.0);
    }
}

#[test]
fn a_record_shifted_by_k_pixels_measures_k() {
    for shapes in [Shapes::Tessellated, Shapes::Analytic] {
        let scene = scene(BALL);
        let tracer = tracer(&scene, shapes);
        let truth = tracer.frame(SIZE);
        for k in [1, 3, 17] {
            let (tested, moved) = shifted(&truth, k);
            let (_, maps) = compare(&truth, &tested, &tracer);
            assert!(moved.len() > 1000);
            for pixel in moved {
                let measured = maps.displacement_px[pixel];
                // Equal neighbours cannot be told apart from an answer in place.
                let equal = tested.record.point[pixel] == truth.record.point[pixel];
                assert!((measured - k as f32).abs() < 0.05 || equal, "{measured} instead of {k}");
            }
        }
    }
}

#[test]
fn on_chains_of_two_mirrors_the_chain_is_held() {
    let scene = scene(TWO_BALLS);
    let tracer = tracer(&scene, Shapes::Tessellated);
    let truth = tracer.frame([480, 360]);
    let (tested, mut moved) = shifted(&truth, 2);
    moved.retain(|&pixel| truth.record.ids[pixel].order() == 2);
    assert!(moved.len() > 1000);
    let (_, maps) = compare(&truth, &tested, &tracer);
    let off = |pixel: &&usize| (maps.displacement_px[**pixel] - 2.0).abs() > 0.05;
    // A ball's picture in another ball shows nothing twice.
    assert_eq!(moved.iter().filter(off).count(), 0);
}

#[test]
fn displacement_agrees_with_alhazen() {
    let scene = scene(BALL);
    let tracer = tracer(&scene, Shapes::Analytic);
    let truth = tracer.frame(SIZE);
    let camera = tracer.moment().camera;
    let [centre, eye] = [Vec3::Y, camera.eye].map(|point| point.as_dvec3());
    let mut tested = truth.clone();
    for pixel in truth.reflector_pixels() {
        let point = &mut tested.record.point[pixel];
        if point.w == 1.0 {
            // Any movement will do, as long as it differs from pixel to pixel.
            let turn = pixel as f32;
            *point += 0.3 * Vec4::new(turn.sin(), (1.7 * turn).sin().abs(), turn.cos(), 0.0);
        }
    }
    let (_, maps) = compare(&truth, &tested, &tracer);
    let (mut pixels, mut largest) = (0, 0f32);
    for pixel in truth.reflector_pixels() {
        let seen = tested.record.point[pixel];
        let Some(r) = reflected_point(centre, 1.0, eye, seen.xyz().as_dvec3()) else { continue };
        if seen.w == 0.0 {
            continue;
        }
        let there = camera.project(SIZE, r.as_vec3()).unwrap();
        // Hidden behind the box, or beside the picture, there is no position to find.
        if tracer
            .look(&camera.ray(SIZE, there))
            .is_none_or(|hit| hit.point.distance(r.as_vec3()) > 0.01)
        {
            continue;
        }
        let expected = there.distance(at(&truth, pixel).as_vec2() + 0.5);
        let measured = maps.displacement_px[pixel];
        assert!((measured - expected).abs() < 0.05, "{measured} px instead of {expected}");
        pixels += 1;
        largest = largest.max(expected);
    }
    assert!(pixels > 1000 && largest > 10.0, "{pixels} pixels, up to {largest} px");
}

#[test]
fn in_a_flat_mirror_displacement_is_that_of_the_mirror_image() {
    let scene = scene(FLAT);
    let tracer = tracer(&scene, Shapes::Tessellated);
    let truth = tracer.frame(SIZE);
    let camera = tracer.moment().camera;
    let mut tested = truth.clone();
    for pixel in truth.reflector_pixels() {
        tested.record.point[pixel] += Vec4::new(0.11, 0.0, -0.07, 0.0);
    }
    let (_, maps) = compare(&truth, &tested, &tracer);
    let mut pixels = 0;
    for pixel in truth.reflector_pixels() {
        let image = tested.record.point[pixel].xyz() * Vec3::new(1.0, -1.0, 1.0);
        let there = camera.project(SIZE, image).unwrap();
        let r = tracer.look(&camera.ray(SIZE, there));
        if r.is_some_and(|hit| hit.object == truth.reflector[pixel]) && inside(there) {
            let expected = there.distance(at(&truth, pixel).as_vec2() + 0.5);
            let measured = maps.displacement_px[pixel];
            assert!((measured - expected).abs() < 0.05, "{measured} instead of {expected} {there}");
            pixels += 1;
        }
    }
    assert!(pixels > 5000);
}

#[test]
fn a_point_a_metre_off_along_the_ray_is_of_the_wrong_depth() {
    let scene = scene(BALL);
    let tracer = tracer(&scene, Shapes::Tessellated);
    let truth = tracer.frame(SIZE);
    let mut tested = truth.clone();
    let mut moved = truth.reflector_pixels();
    moved.retain(|&pixel| {
        // A metre is over 5 % of the distance.
        truth.record.ids[pixel].status() == Status::Found && truth.record.last[pixel].w < 15.0
    });
    for &pixel in &moved {
        let ray = (truth.record.point[pixel].xyz() - truth.position[pixel]).normalize();
        tested.record.point[pixel] += ray.extend(0.0);
    }
    let (accuracy, maps) = compare(&truth, &tested, &tracer);
    for &pixel in &moved {
        assert_eq!(maps.class[pixel], Class::WrongDepth);
        assert!(maps.displacement_px[pixel] < 0.05);
    }
    let share = moved.len() as f64 / truth.reflector_pixels().len() as f64;
    assert_eq!([accuracy.wrong_depth, accuracy.bad_share.four], [share; 2]);
}

#[test]
fn behind_the_ball_a_point_is_unreachable() {
    let scene = scene(BALL);
    let tracer = tracer(&scene, Shapes::Tessellated);
    let truth = tracer.frame(SIZE);
    let mut tested = truth.clone();
    let eye = tracer.moment().camera.eye;
    let behind = Vec3::Y + 2.0 * (Vec3::Y - eye).normalize();
    let mut hidden = truth.reflector_pixels();
    hidden.retain(|&pixel| truth.record.ids[pixel].status() == Status::Found);
    for &pixel in &hidden {
        tested.record.point[pixel] = behind.extend(1.0);
    }
    let (accuracy, maps) = compare(&truth, &tested, &tracer);
    assert!(hidden.iter().all(|&pixel| maps.displacement_px[pixel].is_nan()));
    let share = hidden.len() as f64 / truth.reflector_pixels().len() as f64;
    assert_eq!(accuracy.unreachable, share);
    assert!((accuracy.covered - (1.0 - share)).abs() < 1e-12);
    assert_eq!(accuracy.bad_share.four, share);
}

/// Whether a position lies within the picture's outermost pixel centres.
fn inside(position: Vec2) -> bool {
    let last = UVec2::from(SIZE).as_vec2() - 0.5;
    position.cmpge(Vec2::splat(0.5)).all() && position.cmple(last).all()
}

/// The first reflector pixels whose truth has that status.
fn some(truth: &FrameRecord, status: Status, count: usize) -> Vec<usize> {
    let mut pixels = truth.reflector_pixels();
    pixels.retain(|&pixel| truth.record.ids[pixel].status() == status);
    assert!(pixels.len() > count);
    pixels.truncate(count);
    pixels
}

fn give_up(frame: &mut FrameRecord, pixel: usize) {
    frame.record.ids[pixel] = Ids::MISSING;
    frame.record.point[pixel] = Vec4::ZERO;
    frame.record.radiance[pixel] = Vec3::ZERO;
    frame.colour[pixel] = Vec3::ZERO;
}

fn ball() -> Scene {
    scene(BALL)
}

#[test]
fn every_kind_of_error_is_counted_under_its_name() {
    let scene = ball();
    let tracer = tracer(&scene, Shapes::Tessellated);
    let truth = tracer.frame(SIZE);
    let mut tested = truth.clone();
    let found = some(&truth, Status::Found, 150);
    let sky = some(&truth, Status::Environment, 30);
    for &pixel in &found[..10] {
        give_up(&mut tested, pixel);
    }
    for &pixel in &found[10..30] {
        take(&mut tested, pixel, &truth, sky[0]);
    }
    for &pixel in &found[30..70] {
        tested.record.ids[pixel].object ^= 1;
    }
    for &pixel in &found[70..75] {
        tested.record.point[pixel].x = f32::NAN;
    }
    for &pixel in &sky[..7] {
        take(&mut tested, pixel, &truth, found[0]);
    }
    give_up(&mut tested, sky[8]);
    for &pixel in &found[100..103] {
        tested.reflector[pixel] = NO_OBJECT;
    }
    let (accuracy, maps) = compare(&truth, &tested, &tracer);
    let all = truth.reflector_pixels().len() as f64;
    let compared = all - 3.0;
    assert_eq!(accuracy.missing, 36.0 / compared);
    assert_eq!(accuracy.spurious, 7.0 / compared);
    assert_eq!(accuracy.wrong_object, 40.0 / compared);
    assert_eq!(accuracy.footprint_mismatch, 3.0 / all);
    assert_eq!(accuracy.unreachable, 0.0);
    assert_eq!(accuracy.wrong_depth, 0.0);
    assert_eq!(accuracy.bad_share.half, 83.0 / compared);
    assert_eq!(accuracy.covered, (compared - 43.0) / compared);
    let class = |pixel: usize| maps.class[pixel];
    assert_eq!(class(found[0]), Class::Missing);
    assert_eq!(class(found[72]), Class::Missing);
    assert_eq!(class(found[30]), Class::WrongObject);
    assert_eq!(class(sky[0]), Class::Spurious);
    assert_eq!(class(found[101]), Class::Footprint);
    assert_eq!(class(0), Class::Outside);
    assert!(accuracy.relmse > 0.0 && accuracy.relmse_shading > 0.0 && accuracy.flip.mean > 0.0);
    assert!(accuracy.psnr.unwrap() > 10.0);
}

#[test]
fn giving_up_never_helps() {
    let scene = ball();
    let tracer = tracer(&scene, Shapes::Tessellated);
    let truth = tracer.frame(SIZE);
    let (answered, _) = shifted(&truth, 3);
    let (before, _) = compare(&truth, &answered, &tracer);
    for keep in [0, 1, 4] {
        let mut tested = answered.clone();
        for pixel in truth.reflector_pixels() {
            if keep == 0 || pixel % 5 >= keep {
                give_up(&mut tested, pixel);
            }
        }
        let (after, _) = compare(&truth, &tested, &tracer);
        let shares = |a: &Accuracy| {
            let bad = a.bad_share;
            [bad.half, bad.one, bad.two, bad.four, 1.0 - a.covered, a.relmse_shading]
        };
        for (after, before) in shares(&after).into_iter().zip(shares(&before)) {
            assert!(after > before, "{after} after, {before} before");
        }
        if keep == 0 {
            assert_eq!((after.bad_share.four, after.displacement_px), (1.0, None));
        }
    }
    // Not even by drawing no reflector at all.
    let nothing =
        FrameRecord { reflector: vec![NO_OBJECT; truth.reflector.len()], ..truth.clone() };
    let (accuracy, _) = compare(&truth, &nothing, &tracer);
    assert_eq!((accuracy.bad_share.four, accuracy.footprint_mismatch), (1.0, 1.0));
}

#[test]
fn resampling_shows_in_the_picture_and_not_in_the_shading() {
    let scene = ball();
    let tracer = tracer(&scene, Shapes::Tessellated);
    let truth = tracer.frame(SIZE);
    let mut tested = truth.clone();
    for pixel in truth.reflector_pixels() {
        tested.colour[pixel] *= 1.1;
        tested.record.radiance[pixel] *= 1.1;
    }
    let (accuracy, maps) = compare(&truth, &tested, &tracer);
    assert_eq!((accuracy.relmse_shading, accuracy.bad_share.half), (0.0, 0.0));
    // A tenth of each channel, less where the floor of the denominator weighs in.
    assert!(accuracy.relmse > 0.005 && accuracy.relmse < 0.01);
    assert!(accuracy.flip.mean > 0.0);
    assert_eq!(maps.flip[0], 0.0);
}

#[test]
fn shading_the_truths_own_points_gives_the_truths_colours() {
    let scene = scene(TWO_BALLS);
    let tracer = tracer(&scene, Shapes::Tessellated);
    let truth = tracer.frame(SIZE);
    let mut tested = truth.clone();
    // Nothing moves by more than the last digits, but nothing is equal to the truth any more.
    for point in &mut tested.record.point {
        *point *= Vec4::new(1.0 + 3e-7, 1.0 + 3e-7, 1.0 + 3e-7, 1.0);
    }
    let (accuracy, _) = compare(&truth, &tested, &tracer);
    // Checker edges may fall to the other side.
    assert!(accuracy.relmse_shading < 2e-3, "{}", accuracy.relmse_shading);
    assert!(accuracy.displacement_px.unwrap().max < 0.05);
}

#[test]
fn directions_are_displaced_too() {
    let scene = ball();
    let tracer = tracer(&scene, Shapes::Analytic);
    let truth = tracer.frame(SIZE);
    let sky = some(&truth, Status::Environment, 200);
    let mut tested = truth.clone();
    let chain_direction = |pixel: usize| {
        let ray = eye_ray(&tracer, &truth, pixel + 2);
        let hit = tracer.look(&ray).filter(|hit| hit.object == truth.reflector[pixel])?;
        Some(tracer.chain(hit, ray.direction, Lobe::Reflected)?.bounces[0].outgoing)
    };
    let mut moved = sky;
    moved.retain(|&pixel| match chain_direction(pixel) {
        Some(direction) => {
            tested.record.point[pixel] = direction.extend(0.0);
            true
        }
        None => false,
    });
    let (_, maps) = compare(&truth, &tested, &tracer);
    assert!(moved.len() > 100);
    assert!(moved.iter().all(|&pixel| (maps.displacement_px[pixel] - 2.0).abs() < 0.05));
}

#[test]
fn the_fields_are_named_as_the_results_promise() {
    let scene = ball();
    let tracer = tracer(&scene, Shapes::Tessellated);
    let truth = tracer.frame([32, 24]);
    let (accuracy, _) = compare(&truth, &truth, &tracer);
    let json = serde_json::to_value(&accuracy).unwrap();
    let keys = |value: &serde_json::Value| -> Vec<String> {
        value.as_object().unwrap().keys().cloned().collect()
    };
    let expected = "bad_share covered missing spurious wrong_object wrong_depth unreachable \
        footprint_mismatch displacement_px angle_deg relmse relmse_shading psnr flip by_order by_reflector by_second";
    assert_eq!(keys(&json), expected.split_whitespace().collect::<Vec<_>>());
    assert_eq!(keys(&json["bad_share"]), ["0.5", "1", "2", "4"]);
    assert_eq!(keys(&json["angle_deg"]), ["median", "p95", "max"]);
    assert_eq!(keys(&json["by_order"][0]), ["order", "share", "bad_share", "missing"]);
    assert_eq!(keys(&json["by_reflector"][0]), ["reflector", "share", "bad_share", "missing"]);
    assert_eq!(keys(&json["flip"]), ["mean", "p95", "ppd", "exposure"]);
    assert_eq!(serde_json::from_value::<Accuracy>(json).unwrap(), accuracy);
}

#[test]
fn frames_of_different_sizes_are_refused() {
    let scene = ball();
    let tracer = tracer(&scene, Shapes::Tessellated);
    let error = accuracy(&tracer.frame([16, 12]), &tracer.frame([12, 16]), &tracer).unwrap_err();
    assert_eq!(error.to_string(), "the truth is 16x12 pixels, the other frame 12x16");
}
