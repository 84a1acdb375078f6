//! Depth impostors (Popescu et al. 2006, slides 35 to 47): rows built on the device are the processor's, rays
//! meet in shaders what they meet there, and the slides' claims.

mod gpu_support;

use glam::{Vec2, Vec3, Vec3Swizzles, Vec4, Vec4Swizzles};
use gpu_support::{Session, engine, frame, judged, methods, options};
use mirrorbench::experiment::engine::Engine;
use mirrorbench::geometry::depth_rows::{
    DepthRows, Heights, ImageLine, Limits, Packed, RowShape, Rule, Segment, finish, march, search,
    sweep,
};
use mirrorbench::geometry::optics;
use mirrorbench::geometry::random::SplitMix64;
use mirrorbench::gpu::{Buffer, ComputePipeline, Frame, Image, Shape};
use mirrorbench::methods::Case;
use mirrorbench::methods::depth_impostors::build::{QUADS, RowBuffers, RowBuilder};
use mirrorbench::scene::{self, FrameRecord, Impostor, Scene, Status};

const SIZE: u32 = 128;
const LIMITS: Limits = Limits { tolerance: 0.25 / 128.0, jump: 10.0 / 128.0 };
const VIEW: [u32; 2] = [96, 72];

/// A hilly sheet with a thing before it.
fn landscape() -> Vec<f32> {
    let middle = 0.5 * SIZE as f32;
    let height = |p: Vec2| match p {
        p if p.length() > 0.95 => 0.0,
        p if (p - Vec2::new(0.3, 0.2)).length() < 0.2 => 0.8,
        p => 0.3 + 0.1 * (7.0 * p.x).sin() * (5.0 * p.y).cos(),
    };
    // As shaders have them.
    let packed = |height: f32| (height * 65535.0 + 0.5).floor() / 65535.0;
    let at = |i: u32| Vec2::new((i % SIZE) as f32, (i / SIZE) as f32);
    (0..SIZE * SIZE).map(|i| packed(height((at(i) + 0.5 - middle) / middle))).collect()
}

fn built(session: &Session, texels: &[f32], shape: RowShape) -> (RowBuffers, DepthRows) {
    let device = session.device();
    let heights = Heights { texels, size: SIZE };
    let mut buffers = RowBuffers::new(device, shape, 1).unwrap();
    buffers.quads =
        Image::with_data(device, "heights", (QUADS, Shape::Array(1)), [SIZE; 2], &heights.quads())
            .unwrap();
    let mut frame = Frame::new(device).unwrap();
    frame.begin().unwrap();
    let builder = RowBuilder::new(device, shape).unwrap();
    builder.build(&mut frame, "test", &buffers, 0, LIMITS).unwrap();
    frame.submit().unwrap();
    (buffers, DepthRows::build(heights, shape, LIMITS, sweep))
}

/// The height of a row's segments at x, 0 where none is.
fn height_at(row: &[Packed], x: f32) -> f32 {
    let segments = row.iter().map(|&packed| Segment::unpacked(packed, SIZE));
    let mut on = segments.filter(|segment| segment.x[0] <= x && x <= segment.x[1]);
    on.next().map_or(0.0, |Segment { x: [a, b], height: [from, to] }| {
        from + (to - from) * (x - a) / (b - a)
    })
}

#[test]
fn rows_built_on_the_device_are_the_processors() {
    let session = Session::open();
    let texels = landscape();
    for segments in [8, 16, 32, 64] {
        let shape = RowShape { size: SIZE, angles: 18, segments };
        let (buffers, rows) = built(&session, &texels, shape);
        let counts = buffers.counts.read::<u32>().unwrap();
        let ours = DepthRows {
            shape,
            counts: counts[..shape.rows() as usize].to_vec(),
            segments: buffers.segments.read::<Packed>().unwrap(),
        };
        let mut off = 0;
        for row in 0..shape.rows() {
            let at = (row / SIZE, row % SIZE);
            let [a, b] = [ours.row(at.0, at.1), rows.row(at.0, at.1)];
            assert_eq!(a.is_empty(), b.is_empty(), "row {at:?}");
            let apart =
                |i: u32| (height_at(a, i as f32 + 0.5) - height_at(b, i as f32 + 0.5)).abs();
            off += (0..SIZE).filter(|&i| apart(i) > 2.0 * LIMITS.tolerance).count();
        }
        // Of two splits that are as good, either may be taken.
        let share = off as f64 / f64::from(shape.rows() * SIZE);
        assert!(share < 0.002, "{segments} segments: {share} of the samples differ");
    }
}

/// Lines over the disc, downwards, whatever their direction.
fn lines(count: u32) -> Vec<ImageLine> {
    let mut random = SplitMix64::new(11);
    let mut number = || random.within(Vec3::ZERO, Vec3::ONE).x;
    let middle = 0.5 * SIZE as f32;
    let mut line = || {
        let along = Vec2::from_angle(std::f32::consts::TAU * number());
        let across = 0.9 * (number() - 0.5) * SIZE as f32;
        let half = (middle * middle - across * across).sqrt() - 0.5;
        let origin = Vec2::splat(middle) + across * along.perp();
        ImageLine {
            start: (origin - half * along).extend(0.7 + 0.3 * number()),
            end: (origin + half * along).extend(0.3 * number()),
        }
    };
    (0..count).map(|_| line()).collect()
}

#[test]
fn shaders_find_what_the_processor_finds() {
    let session = Session::open();
    let (device, texels) = (session.device(), landscape());
    let shape = RowShape { size: SIZE, angles: 18, segments: 32 };
    let (buffers, rows) = built(&session, &texels, shape);
    // The same rows in both.
    let segments = buffers.segments.read::<Packed>().unwrap();
    let rows = DepthRows { counts: buffers.counts.read::<u32>().unwrap(), segments, ..rows };
    let lines = lines(2048);
    let inputs: Vec<Vec4> =
        lines.iter().flat_map(|l| [l.start.extend(LIMITS.jump), l.end.extend(0.0)]).collect();
    let given = Buffer::with_data(device, "inputs", &inputs).unwrap();
    let forms: [&[&'static str]; 6] = [
        &[],
        &["SKINS"],
        &["RE_ANCHOR"],
        &["RE_ANCHOR", "FINISH"],
        &["MARCH"],
        &["MARCH", "SKINS"],
    ];
    for form in forms {
        let defines: Vec<_> = form.iter().map(|&define| (define, 1)).collect();
        let pipeline = ComputePipeline::new(device, "tests/depth_rows.wgsl", &defines).unwrap();
        let answer = Buffer::storage(device, "outputs", 16 * lines.len() as u64).unwrap();
        let mut frame = Frame::new(device).unwrap();
        frame.begin().unwrap();
        let pass = frame.pass("test/rows").compute(&pipeline);
        let pass = pass.storage_struct("impostors", &[SIZE, shape.angles, shape.segments, 1, 1, 1]);
        let pass = pass.sample("quads", &buffers.quads).optional();
        let pass = pass.buffer("counts", &buffers.counts).optional();
        let pass = pass.buffer("segments", &buffers.segments).optional();
        let pass = pass.buffer("inputs", &given).buffer("outputs", &answer);
        pass.over(lines.len() as u32).unwrap();
        frame.submit().unwrap();
        let said: Vec<Vec4> = answer.read().unwrap();
        let skins = form.contains(&"SKINS");
        let heights = Heights { texels: &texels, size: SIZE };
        let same = |(line, said): (&ImageLine, &Vec4)| {
            let (place, behind, reads) = if form.contains(&"MARCH") {
                let marched = march(heights, line, LIMITS.jump, skins);
                (marched.place, marched.behind, marched.reads)
            } else {
                let rule =
                    Rule { skins, re_anchor: form.contains(&"RE_ANCHOR"), jump: LIMITS.jump };
                let found = search(&rows, line, rule);
                let place = match form.contains(&"FINISH") {
                    true => found
                        .place
                        .map(|_| line.at(finish(heights, line, LIMITS.jump, found.share)).xy()),
                    false => found.place,
                };
                // A place between texels is found by two looks at the image.
                let looks = said.w as u32 - found.reads.min(said.w as u32);
                let all = if form.contains(&"FINISH") && looks <= 2 { looks } else { 0 };
                (place, found.behind, found.reads + all)
            };
            let bits = said.z as u32;
            let near = place.is_none_or(|place| place.distance(said.xy()) < 0.1);
            near && place.is_some() == (bits & 1 == 1)
                && behind == (bits & 2 == 2)
                && reads == said.w as u32
        };
        let alike = lines.iter().zip(&said).filter(|&pair| same(pair)).count();
        // Where a ray is between two rows, or between two texels, rounding decides.
        assert!(alike > 2000, "{form:?}: {alike} of {}", lines.len());
    }
}

/// The share of pixels that show the same object, and if any the same point within a centimetre.
fn agreement(a: &FrameRecord, b: &FrameRecord) -> f64 {
    let pixels = a.reflector_pixels();
    let same = |&&i: &&usize| {
        let [x, y] = [a, b].map(|frame| (frame.record.ids[i].object, frame.record.point[i]));
        x.0 == y.0 && (x.1.w == 0.0 || x.1.xyz().abs_diff_eq(y.1.xyz(), 0.01))
    };
    pixels.iter().filter(same).count() as f64 / pixels.len() as f64
}

fn statue() -> Scene {
    scene::load("statue").unwrap()
}

#[test]
fn either_build_draws_the_same_picture_and_each_twice() {
    let session = Session::open();
    let scene = statue();
    let [cores, device, again] = ["cpu", "gpu", "gpu"].map(|build| {
        frame(&session, &scene, &format!("depth-impostors:size=256,build={build}"), VIEW, 0)
    });
    let share = agreement(&cores, &device);
    assert!(share > 0.995, "{share}");
    assert_eq!(device.record.point, again.record.point);
    assert_eq!(device.colour, again.colour);
}

#[test]
fn rigid_motion_and_light_rebuild_nothing() {
    // "Rigid body transformations, color updates, and reflector updates do not require reconstruction"
    // (slide 39).
    let session = Session::open();
    let scene = statue();
    let case = "depth-impostors:size=128,build=gpu";
    let mut engine = engine(&session, &scene, case, &options(VIEW));
    let built = |engine: &mut Engine, at: u32| {
        let (_, times) = engine.frame(&scene.at(at), true).unwrap();
        let names = times.prepare.iter().chain(&times.passes).map(|pass| pass.name.clone());
        let names: Vec<String> = names.collect();
        let has = |what: &str| names.iter().any(|name| name == &format!("depth-impostors/{what}"));
        [has("portrait"), has("simplify"), has("portrait-light")]
    };
    assert_eq!(built(&mut engine, 0), [true, true, true]);
    assert_eq!(built(&mut engine, 60), [false, false, true]);
    // Images that follow what moves are built anew.
    let mut engine = self::engine(&session, &scene, &format!("{case},view=now"), &options(VIEW));
    assert_eq!(built(&mut engine, 0), [true, true, true]);
    assert_eq!(built(&mut engine, 60), [true, true, true]);
}

/// Metres from the points of the statue that a picture shows to the mirrored rays that show them, on average.
fn beside_rays(session: &Session, scene: &Scene, case: &str, at: u32) -> f32 {
    let drawn = frame(session, scene, case, [192, 144], at);
    let statue = scene.objects.iter().position(|o| o.group == "statue").unwrap() as u32;
    let eye = scene.at(at).camera.eye;
    let beside = |i: usize| {
        let incident = (drawn.position[i] - eye).normalize();
        let mirrored = optics::reflect(incident, drawn.normal[i]);
        (drawn.record.point[i].xyz() - drawn.position[i]).cross(mirrored).length()
    };
    let shown = drawn.reflector_pixels().into_iter();
    let shown = shown.filter(|&i| drawn.record.ids[i].object == statue);
    let beside: Vec<f32> = shown.map(beside).collect();
    assert!(beside.len() > 150, "{} pixels", beside.len());
    beside.iter().sum::<f32>() / beside.len() as f32
}

#[test]
fn re_anchoring_mends_what_few_angles_spoil() {
    // Slide 46: "One rotated depth map every 20, 10, 3, and 2 degrees".
    let (session, scene) = (Session::open(), statue());
    let beside = |search: &str| {
        let case = format!("depth-impostors@revised:size=256,views=1,{search}");
        beside_rays(&session, &scene, &case, 700)
    };
    // What the image's texels make of it.
    let marched = beside("search=march");
    let beyond = |step: u32, re_anchor: &str| {
        beside(&format!("step_deg={step},re_anchor={re_anchor}")) - marched
    };
    let once = [20, 10, 3].map(|step| beyond(step, "off"));
    for (pair, steps) in once.windows(2).zip([[20.0f32, 10.0], [10.0, 3.0]]) {
        let [wide, narrow] = steps.map(|step| (0.5 * step).to_radians().tan());
        let ratio = pair[0] / pair[1] / (wide / narrow);
        assert!((0.6..1.8).contains(&ratio), "{ratio} times the tangents' ratio: {once:?}");
    }
    for (once, step) in once.iter().zip([20, 10]) {
        let again = beyond(step, "on,finish=row");
        assert!(4.0 * again < *once, "{again} m after {once} m, beyond {marched} m");
        // Found on between the image's texels, even the march lies farther beside the rays.
        let finished = marched + beyond(step, "on");
        let once = marched + once;
        assert!(4.0 * finished < once, "{finished} m after {once} m");
        assert!(finished < marched, "{finished} m, marched {marched} m");
    }
}

#[test]
fn rows_are_read_four_times_less_than_the_image_at_equal_error() {
    let session = Session::open();
    let scene = statue();
    let run = |case: &str| {
        let mut engine = engine(&session, &scene, case, &options(VIEW));
        let (tested, times) = engine.frame(&scene.at(0), true).unwrap();
        let counted = |name: &str| {
            let found = times.counters.iter().find(|(counter, _)| counter == name);
            found.unwrap().1 as f64
        };
        let tracer = gpu_support::tracer(&scene, &scene.at(0));
        let (accuracy, _) =
            mirrorbench::measure::accuracy(&tracer.frame(VIEW), &tested, &tracer).unwrap();
        // A ray that is a point in the image reads one texel either way.
        let reads = counted("segments") + counted("texels") - counted("degenerate");
        let share = counted("rows") / (counted("rays") - counted("degenerate"));
        (accuracy.bad_share.one, reads, share)
    };
    let (bad_rows, of_rows, share) = run("depth-impostors@revised");
    let (bad_march, of_image, _) = run("depth-impostors@revised:search=march");
    assert!(4.0 * of_rows < of_image, "{of_rows} segments and texels, {of_image} texels");
    assert!(bad_rows < bad_march + 0.002, "{bad_rows} and {bad_march}");
    assert!(share > 0.9, "{share} of the rays have a row");
}

#[test]
fn a_mirror_sees_itself_in_its_own_images() {
    // Slide 50, future work: "self-reflections".
    let session = Session::open();
    let run = |scene: &str, own: u32| {
        let scene = scene::load(scene).unwrap();
        let case = format!("depth-impostors@revised:size=256,own={own}");
        let mut engine = engine(&session, &scene, &case, &options(VIEW));
        let (tested, times) = engine.frame(&scene.at(0), true).unwrap();
        let tracer = gpu_support::tracer(&scene, &scene.at(0));
        let (accuracy, _) =
            mirrorbench::measure::accuracy(&tracer.frame(VIEW), &tested, &tracer).unwrap();
        let met = times.counters.iter().find(|(name, _)| name == "self_met").unwrap().1;
        (accuracy, met)
    };
    let (without, none) = run("statue-knot", 0);
    let (with, some) = run("statue-knot", 6);
    assert!(none == 0 && some > 0, "{none} and {some} rays met their mirror");
    let [before, after] = [&without, &with].map(|accuracy| accuracy.bad_share.one);
    assert!(2.0 * after < before, "{before} bad without, {after} with");
    let [before, after] =
        [&without, &with].map(|accuracy| accuracy.by_order[1].group.bad_share.one);
    assert!(before > 0.8 && after < 0.4, "of order 2 {before} bad without, {after} with");
    let [before, after] =
        [&without, &with].map(|accuracy| accuracy.by_order[0].group.bad_share.one);
    assert!(after < before + 0.01, "of order 1 {before} bad without, {after} with");
    // A ball cannot see itself, and does not.
    assert_eq!(run("columns", 6).1, 0);
}

#[test]
fn a_backdrop_is_behind_all_impostors() {
    let (session, scene) = (Session::open(), scene::load("table").unwrap());
    let case = "depth-impostors@revised:size=128,step_deg=20,own=0,backdrop";
    let drawn = frame(&session, &scene, &format!("{case}=map"), VIEW, 0);
    let as_objects = frame(&session, &scene, &format!("{case}=images"), VIEW, 0);
    let exact = gpu_support::tracer(&scene, &scene.at(0)).frame(VIEW);
    let far = |record: &FrameRecord, i: usize| {
        let object = scene.objects.get(record.record.ids[i].object as usize);
        object.is_some_and(|object| object.impostor == Impostor::Backdrop)
    };
    let pixels = exact.reflector_pixels();
    let exact_far: Vec<usize> = pixels.iter().copied().filter(|&i| far(&exact, i)).collect();
    let shown = exact_far.iter().filter(|&&i| far(&drawn, i)).count();
    assert!(exact_far.len() > 100, "{}", exact_far.len());
    assert!(10 * shown > 9 * exact_far.len(), "{shown} of {}", exact_far.len());
    // And not before them.
    let near = pixels.iter().filter(|&&i| exact.record.ids[i].order() == 1 && !far(&exact, i));
    let hidden = near.clone().filter(|&&i| far(&drawn, i)).count();
    assert!(10 * hidden < near.count(), "{hidden} pixels show what is behind");
    // Not far enough away: images of its own put it where it is.
    let [mapped, imaged] = [&drawn, &as_objects].map(|drawn| {
        let there = |i: usize| drawn.record.point[i].abs_diff_eq(exact.record.point[i], 0.02);
        exact_far.iter().filter(|&&i| there(i)).count()
    });
    assert!(mapped < imaged, "{mapped} mapped, {imaged} in images");
}

#[test]
fn sizes_fit_whatever_a_scene_asks_for() {
    // Sixteen objects from both sides, beside the mirror's own images, in one buffer.
    let session = Session::open();
    let scene = scene::load("columns").unwrap();
    let case = "depth-impostors@revised:objects=64,segments=64,step_deg=3,views=4";
    let drawn = frame(&session, &scene, case, [32, 24], 0);
    assert!(!drawn.reflector_pixels().is_empty());
}

#[test]
fn what_turns_away_is_lost_but_to_images_from_all_round() {
    // ALGORITHMS T32: at frame 216 the statue shows the mirror its side, at 432 its back.
    let session = Session::open();
    let scene = statue();
    let missing = |case: &str, at: u32| {
        let (tested, _, maps) = judged(&session, &scene, case, [192, 144], at);
        gpu_support::wrong(&tested, &maps)[0].len()
    };
    let [front, back] = [0, 432].map(|at| missing("depth-impostors:size=256,build=gpu", at));
    assert!(2 * back > 3 * front, "{front} pixels, {back} when turned");
    let kept = "depth-impostors@revised:size=256,step_deg=10,view=start";
    let [one, two] = [1, 2].map(|views| missing(&format!("{kept},views={views}"), 432));
    assert!(2 * two < one, "{one} pixels, {two} with a second image");
    let anew = missing("depth-impostors@revised:size=256,step_deg=10", 432);
    assert!(2 * anew < one, "{anew} pixels, taken anew");
}

#[test]
fn gaps_are_nearer_to_the_truth_than_skins_and_flagged() {
    let session = Session::open();
    let scene = statue();
    let run = |silhouettes: &str| {
        let case =
            format!("depth-impostors@revised:size=256,step_deg=10,silhouettes={silhouettes}");
        judged(&session, &scene, &case, [192, 144], 600)
    };
    let [(skins, by_skins, _), (gaps, by_gaps, maps)] = ["skins", "gaps"].map(run);
    let [skins_bad, gaps_bad] = [by_skins, by_gaps].map(|accuracy| accuracy.bad_share.one);
    assert!(gaps_bad < skins_bad, "{skins_bad} with skins, {gaps_bad} with gaps");
    let flags = |f: &FrameRecord| {
        f.reflector_pixels().into_iter().filter(|&i| f.record.ids[i].flag()).count()
    };
    assert_eq!(flags(&skins), 0);
    assert!(flags(&gaps) > 0);
    let [all, unflagged] = gpu_support::wrong(&gaps, &maps);
    assert!(unflagged.len() < all.len(), "{} of {}", unflagged.len(), all.len());
}

#[test]
fn what_cannot_be_is_refused() {
    let session = Session::open();
    let refused = |scene: &Scene, case: &str| {
        let case = Case::parse(case, &methods()).unwrap();
        Engine::new(session.device(), scene, &case, &methods(), &options(VIEW))
            .err()
            .unwrap()
            .to_string()
    };
    let text = refused(&statue(), "depth-impostors:size=100");
    assert!(text.contains("a multiple of 8"), "{text}");
    assert!(Case::parse("depth-impostors:search=march,segments=8", &methods()).is_err());
}

#[test]
fn beyond_the_impostors_there_is_the_environment() {
    let (session, scene) = (Session::open(), statue());
    let case = "depth-impostors:size=128,build=gpu,objects=1";
    let drawn = frame(&session, &scene, case, VIEW, 0);
    let ids = drawn.reflector_pixels().into_iter().map(|i| drawn.record.ids[i]);
    let shown: Vec<_> = ids.collect();
    assert!(shown.iter().all(|id| id.status() != Status::Missing));
    let objects: std::collections::BTreeSet<_> =
        shown.iter().filter(|id| id.status() == Status::Found).map(|id| id.object).collect();
    assert_eq!(objects.len(), 1, "{objects:?}");
}
