//! The search in a distance impostor: exact on planes in one secant, in any unit, never NaN; thin
//! things leak through steps longer than they are wide.

mod gpu_support;

use glam::{Vec3, Vec4, Vec4Swizzles};
use gpu_support::{Session, frame, judged, tracer};
use mirrorbench::geometry::random::SplitMix64;
use mirrorbench::gpu::{Buffer, ComputePipeline, Format, Frame, Image, Shape};
use mirrorbench::scene;

/// Towards the plane that the map shows.
const NORMAL: Vec3 = Vec3::new(0.48, 0.6, 0.64);

/// How the search is set.
#[derive(Clone, Copy)]
struct Set {
    size: u32,
    radial: bool,
    march: u32,
    refine: u32,
}

/// Search rays (start, direction) in the map of the plane `NORMAL` . p = `height`; an infinite height
/// leaves the environment alone.
fn searched(session: &Session, set: Set, height: f32, rays: &[(Vec3, Vec3)]) -> Vec<Vec4> {
    let device = session.device();
    let radial = [("RADIAL", 1)];
    let defines = if set.radial { &radial[..] } else { &[] };
    let fill = ComputePipeline::new(device, "tests/plane_distances.wgsl", defines).unwrap();
    let search = ComputePipeline::new(device, "tests/impostor.wgsl", defines).unwrap();
    let map =
        Image::new(device, "distances", Format::R32Float, [set.size; 2], Shape::Cube).unwrap();
    let inputs: Vec<Vec4> = rays.iter().flat_map(|(x, r)| [x.extend(0.0), r.extend(0.0)]).collect();
    let given = Buffer::with_data(device, "inputs", &inputs).unwrap();
    let answer = Buffer::storage(device, "outputs", 16 * rays.len() as u64).unwrap();
    let mut frame = Frame::new(device).unwrap();
    frame.begin().unwrap();
    let pass = frame.pass("test/plane").compute(&fill).store("distances", &map);
    pass.uniform("plane", &NORMAL.extend(height)).over_pixels([set.size; 2]).unwrap();
    let params = [0, 0, 0, set.size, set.march, set.refine, 0, 0];
    let pass = frame.pass("test/search").compute(&search).sample("distances", &map);
    let pass = pass.buffer("inputs", &given).buffer("outputs", &answer);
    pass.uniform("params", &params).over(rays.len() as u32).unwrap();
    frame.submit().unwrap();
    answer.read().unwrap()
}

fn random_direction(random: &mut SplitMix64) -> Vec3 {
    random.within(Vec3::NEG_ONE, Vec3::ONE).try_normalize().unwrap_or(Vec3::X)
}

/// Rays from the unit sphere to the plane; start and direction within about 40 degrees of its normal.
fn rays_to_the_plane() -> Vec<(Vec3, Vec3)> {
    let mut random = SplitMix64::new(5);
    let mut near = || loop {
        let direction = random_direction(&mut random);
        if direction.dot(NORMAL) > 0.77 {
            return direction;
        }
    };
    (0..4096).map(|_| (near(), near())).collect()
}

/// The largest angle between where the search looks and where the rays meet the plane.
fn worst_angle(session: &Session, set: Set, height: f32) -> f32 {
    let mut rays = rays_to_the_plane();
    rays.iter_mut().for_each(|(x, _)| *x *= height / 3.0);
    let looked = searched(session, set, height, &rays);
    let off = looked.iter().zip(&rays).map(|(looked, (x, r))| {
        let hit = *x + *r * ((height - x.dot(NORMAL)) / r.dot(NORMAL));
        looked.xyz().normalize().cross(hit.normalize()).length()
    });
    off.fold(0.0, f32::max)
}

#[test]
fn one_secant_is_exact_on_a_plane() {
    let session = Session::open();
    // A texel of 16 a side is an eighth wide at a face's middle.
    let inverse = Set { size: 16, radial: false, march: 0, refine: 1 };
    for march in [0, 1, 8, 64] {
        let worst = worst_angle(&session, Set { march, ..inverse }, 3.0);
        assert!(worst < 1e-6, "march {march}: {worst}");
        // In any unit.
        let far = worst_angle(&session, Set { march, ..inverse }, 3000.0);
        assert!(far < 1e-6, "march {march}, in millimetres: {far}");
    }
    let guess = worst_angle(&session, Set { refine: 0, ..inverse }, 3.0);
    assert!(guess > 0.03, "the first guess alone is off by {guess}");
    // ALGORITHMS T11: a plane's distances from the centre are not linear over the face.
    let radial = [16, 64]
        .map(|size| worst_angle(&session, Set { size, radial: true, refine: 4, ..inverse }, 3.0));
    assert!(radial[0] > 1e-3 && radial[1] < radial[0] / 4.0, "radial: {radial:?}");
}

#[test]
fn no_start_and_no_direction_give_nan() {
    let session = Session::open();
    let mut random = SplitMix64::new(9);
    let mut rays = Vec::new();
    for _ in 0..500 {
        let (a, b) = (random_direction(&mut random), random_direction(&mut random));
        // At the centre, anywhere, beyond the plane, very near and very far; towards and away.
        for length in [0.0, 1.0, 5.0, 1e-20, 1e20] {
            rays.extend([(length * a, b), (length * a, a), (length * a, -a)]);
        }
    }
    for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
        rays.extend([(axis, axis), (axis, -axis), (-axis, axis), (Vec3::ZERO, axis)]);
    }
    for radial in [false, true] {
        for march in [0, 1, 7, 64] {
            for height in [3.0, 1e-3, f32::INFINITY] {
                let set = Set { size: 8, radial, march, refine: 8 };
                for (out, ray) in searched(&session, set, height, &rays).iter().zip(&rays) {
                    let direction = out.xyz();
                    let sound = direction.is_finite() && direction != Vec3::ZERO;
                    assert!(sound, "{ray:?} gives {out} at march {march}, height {height}");
                }
            }
        }
    }
}

#[test]
fn poles_leak_where_steps_are_longer_than_they_are_wide() {
    // ALGORITHMS T6 and T10. A pole covers a degree of the map, the rays sweep 20 to 90.
    let (session, scene) = (Session::open(), scene::load("stress-pole").unwrap());
    let size = [480, 360];
    let truth = tracer(&scene, &scene.at(0)).frame(size);
    let is_pole = |id: u32| {
        scene.objects.get(id as usize).is_some_and(|object| object.name.starts_with("pole"))
    };
    let poles =
        truth.reflector_pixels().into_iter().filter(|&i| is_pole(truth.record.ids[i].object));
    let poles: Vec<usize> = poles.collect();
    assert!(poles.len() > 300, "{} pixels", poles.len());
    let kept =
        ["published", "revised:march=8", "revised:march=32", "revised:march=256"].map(|case| {
            let case = format!("distance-impostor@{case}");
            let drawn = frame(&session, &scene, &case, size, 0);
            let right = |&&i: &&usize| drawn.record.ids[i].object == truth.record.ids[i].object;
            poles.iter().filter(right).count() as f64 / poles.len() as f64
        });
    println!("share of the poles' pixels that show them: {kept:?}");
    assert!(kept[1] < kept[2] && kept[2] < kept[3], "{kept:?}");
    assert!(kept[1] < 0.5 && kept[3] > 0.9, "{kept:?}");
}

#[test]
fn searching_the_map_beats_it_and_marching_first_beats_secants() {
    let session = Session::open();
    for name in ["columns", "patow-room", "stress-pole", "stress-gap"] {
        let scene = scene::load(name).unwrap();
        let bad = ["environment-map", "distance-impostor", "distance-impostor@revised"]
            .map(|case| judged(&session, &scene, case, [128, 96], 0).1.bad_share.one);
        assert!(bad[1] < 0.5 * bad[0] && bad[2] < 0.7 * bad[1], "{name}: {bad:?}");
    }
}

#[test]
fn what_the_map_does_not_hold_is_flagged() {
    let session = Session::open();
    for (name, most) in [("columns", 0.25), ("patow-room", 0.05), ("stress-pole", 0.1)] {
        let scene = scene::load(name).unwrap();
        let size = [160, 120];
        let (tested, ..) = judged(&session, &scene, "distance-impostor@revised", size, 0);
        let truth = tracer(&scene, &scene.at(0)).frame(size);
        let pixels = tested.reflector_pixels();
        let flagged = |&&i: &&usize| tested.record.ids[i].flag();
        let silent = |&&i: &&usize| {
            let (ours, theirs) = (tested.record.ids[i], truth.record.ids[i]);
            truth.reflector[i] == tested.reflector[i]
                && !ours.flag()
                && ours.object != theirs.object
        };
        let share = |n: usize| n as f64 / pixels.len() as f64;
        let flags = share(pixels.iter().filter(flagged).count());
        let wrong = share(pixels.iter().filter(silent).count());
        println!("{name}: {flags} flagged, {wrong} of the wrong object without a flag");
        assert!(flags < most && wrong < 0.01, "{name}: {flags} flagged, {wrong} wrong in silence");
    }
}
