//! The truth against what is known without tracing.

mod truth_support;

use glam::{Vec3, Vec4Swizzles};
use mirrorbench::geometry::alhazen::reflected_point;
use mirrorbench::geometry::optics::reflect;
use mirrorbench::scene::{FrameRecord, Lobe, NO_OBJECT, Scene, Status, shading};
use mirrorbench::truth::{Shapes, Tracer, TruthOptions};
use truth_support::{BALL, FLAT, TWO_BALLS, eye_ray, found, off_ray, scene, tracer};

const SIZE: [u32; 2] = [96, 64];

/// What a mirror of the test scenes does to the light it reflects.
const MIRROR: Vec3 = Vec3::new(0.9, 0.9 * 0.9, 0.9 * 0.8);

#[test]
fn a_flat_mirror_shows_the_mirrored_ceiling() {
    let scene = scene(FLAT);
    let tracer = tracer(&scene, Shapes::Tessellated);
    let frame = tracer.frame(SIZE);
    let [mirror, ceiling] = ["mirror", "ceiling"].map(|name| scene.select(name)[0]);
    let mut pixels = 0;
    for pixel in found(&frame) {
        let ray = eye_ray(&tracer, &frame, pixel);
        let eye = ray.origin;
        // Where the prolonged eye ray meets the ceiling's mirror image at y = -3.
        let through = ray.at((-3.0 - eye.y) / ray.direction.y);
        let expected = through * Vec3::new(1.0, -1.0, 1.0);
        let shown = frame.record.point[pixel].xyz();
        let length = eye.distance(through);
        assert!(shown.distance(expected) < 1e-5 * length, "{shown} instead of {expected}");
        let r = frame.position[pixel];
        assert!(r.y.abs() < 1e-6 && off_ray(&ray, r) < 1e-5);
        assert!((r.distance(eye) + frame.record.last[pixel].w - length).abs() < 1e-4);
        assert_eq!((frame.reflector[pixel], frame.record.ids[pixel].object), (mirror, ceiling));
        assert_eq!((frame.normal[pixel], frame.record.ids[pixel].order()), (Vec3::Y, 1));
        // The ceiling is seen from below: its side away from its own normal.
        let light = shading::shade(&scene, ceiling, Vec3::NEG_Y, tracer_uv(expected), true);
        assert!(frame.record.radiance[pixel].abs_diff_eq(light, 1e-6) || near_an_edge(expected));
        assert!(frame.colour[pixel].abs_diff_eq(MIRROR * frame.record.radiance[pixel], 1e-6));
        pixels += 1;
    }
    assert!(pixels > 1000);
}

/// Texture coordinates of a plane are metres from its centre in x and -z.
fn tracer_uv(point: Vec3) -> glam::Vec2 {
    glam::Vec2::new(point.x, -point.z)
}

fn near_an_edge(point: Vec3) -> bool {
    let cell = 4.0 * tracer_uv(point);
    (cell - cell.round()).abs().min_element() < 1e-3
}

#[test]
fn an_analytic_sphere_reflects_where_alhazen_says() {
    let scene = scene(BALL);
    let tracer = tracer(&scene, Shapes::Analytic);
    let frame = tracer.frame(SIZE);
    let eye = tracer.moment().camera.eye.as_dvec3();
    let mut pixels = 0;
    for pixel in found(&frame) {
        let seen = frame.record.point[pixel].xyz().as_dvec3();
        let r = reflected_point(Vec3::Y.as_dvec3(), 1.0, eye, seen).unwrap();
        assert!(frame.position[pixel].as_dvec3().distance(r) < 1e-4);
        pixels += 1;
    }
    assert!(pixels > 500);
}

#[test]
fn the_tessellated_sphere_converges_to_the_analytic_one() {
    let error = |edge: &str| {
        let scene = scene(&BALL.replace("edge = 0.05", &format!("edge = {edge}")));
        let [meshed, exact] = [Shapes::Tessellated, Shapes::Analytic]
            .map(|shapes| tracer(&scene, shapes).frame(SIZE));
        let floor = scene.select("floor")[0];
        let shows_floor = |frame: &FrameRecord, pixel: usize| {
            // Far points of the floor differ by metres for the least turn.
            frame.record.ids[pixel].object == floor && frame.record.last[pixel].w < 5.0
        };
        let errors: Vec<f32> = (0..exact.reflector.len())
            .filter(|&pixel| shows_floor(&meshed, pixel) && shows_floor(&exact, pixel))
            .map(|pixel| meshed.record.point[pixel].distance(exact.record.point[pixel]))
            .collect();
        assert!(errors.len() > 300);
        errors.iter().sum::<f32>() / errors.len() as f32
    };
    let [coarse, middle, fine] = ["0.2", "0.1", "0.05"].map(error);
    // Second order in the edge's length.
    assert!(coarse / middle > 3.0 && middle / fine > 3.0, "{coarse} {middle} {fine}");
    assert!(fine < 0.02, "{fine} m");
}

/// Every curved closed form, turned and moved, cut into so many steps.
const CURVED: [&str; 5] = [
    "sphere = { radius = 1.0, slices = STEPS, stacks = STEPS }",
    "ellipsoid = { radii = [1.3, 0.6, 0.9], slices = STEPS, stacks = STEPS }",
    "cylinder = { radius = 0.7, height = 1.5, slices = STEPS }",
    "cylinder = { radius = 0.7, height = 1.5, slices = STEPS, capped = false }",
    "torus = { ring = 1.0, tube = 0.4, slices = STEPS, stacks = STEPS }",
];

/// A mirror of that shape before the sky.
fn mirror(shape: &str) -> Scene {
    let camera = &BALL[..BALL.find("[[objects]]").unwrap()];
    scene(&format!(
        "{camera}[[objects]]\nname = \"it\"\nshape = {{ {shape} }}\nmaterial = \"mirror\"\n\
         position = [0.2, 0.9, -0.3]\nrotation_deg = [50.0, 30.0, 20.0]\nscale = 1.1"
    ))
}

/// Of the pixels where either shows the object: the share where the two disagree on that, on the
/// side of a crease or on the length of the chain; and the mean angle between the normals of
/// those that agree and are not seen at a glancing angle, where the mesh may be off by anything.
fn difference(scene: &Scene) -> (f32, f32) {
    let tracers = [Shapes::Tessellated, Shapes::Analytic].map(|shapes| tracer(scene, shapes));
    let [meshed, exact] = [0, 1].map(|index: usize| tracers[index].frame(SIZE));
    let (mut covered, mut differ, mut angles) = (0, 0, Vec::new());
    for pixel in 0..exact.reflector.len() {
        let seen = [&meshed, &exact].map(|frame| frame.reflector[pixel]);
        if seen == [NO_OBJECT; 2] {
            continue;
        }
        let [a, b] = [&meshed, &exact].map(|frame| frame.record.ids[pixel].order());
        // As a chord: an arc cosine in singles rounds small angles to nothing.
        let angle = meshed.normal[pixel].distance(exact.normal[pixel]);
        covered += 1;
        if seen[0] != seen[1] || a != b || angle > 0.5 {
            differ += 1;
        } else if eye_ray(&tracers[1], &exact, pixel).direction.dot(exact.normal[pixel]) < -0.3 {
            angles.push(angle);
        }
    }
    assert!(angles.len() > 300, "{} of {covered} pixels", angles.len());
    (differ as f32 / covered as f32, angles.iter().sum::<f32>() / angles.len() as f32)
}

#[test]
fn meshes_converge_to_their_closed_forms() {
    for shape in CURVED {
        let [coarse, middle, fine] =
            ["32", "64", "128"].map(|steps| difference(&mirror(&shape.replace("STEPS", steps))));
        // Second order in the step, as the distance of a chord from its arc is.
        for (coarser, finer) in [(coarse, middle), (middle, fine)] {
            let ratio = coarser.1 / finer.1;
            assert!((3.6..4.4).contains(&ratio), "{shape}: {ratio} from {coarser:?} to {finer:?}");
        }
        assert!(fine.0 < 0.01, "{shape}: {fine:?}");
    }
}

#[test]
fn a_plane_is_its_own_closed_form() {
    let (differ, angle) = difference(&mirror("plane = { size = [2.0, 1.5] }"));
    assert!(differ == 0.0 && angle < 1e-6, "{differ} {angle}");
}

#[test]
fn what_has_no_closed_form_stays_a_mesh() {
    for shape in [
        "box = { size = [1.0, 1.2, 0.8] }",
        "torus = { ring = 1.0, tube = 0.4, sweep_deg = 300.0 }",
    ] {
        assert_eq!(difference(&mirror(shape)), (0.0, 0.0), "{shape}");
    }
}

#[test]
fn a_ball_alone_shows_the_sky() {
    let start = BALL.find("[[objects]]\nname = \"ball\"").unwrap();
    let end = BALL.find("[[objects]]\nname = \"box\"").unwrap();
    let camera = &BALL[..BALL.find("[[objects]]").unwrap()];
    let scene = scene(&format!("{camera}{}", &BALL[start..end]));
    let tracer = tracer(&scene, Shapes::Tessellated);
    let frame = tracer.frame(SIZE);
    let mut pixels = 0;
    for pixel in 0..frame.reflector.len() {
        let ray = eye_ray(&tracer, &frame, pixel);
        if frame.reflector[pixel] == NO_OBJECT {
            assert_eq!(frame.colour[pixel], shading::environment(&scene, ray.direction));
            assert_eq!(frame.depth[pixel], f32::INFINITY);
            continue;
        }
        let direction = reflect(ray.direction, frame.normal[pixel]);
        let ids = frame.record.ids[pixel];
        assert_eq!((ids.status(), ids.object, ids.order()), (Status::Environment, NO_OBJECT, 1));
        assert_eq!(frame.record.point[pixel], direction.extend(0.0));
        let sky = shading::environment(&scene, direction);
        assert_eq!(frame.record.radiance[pixel], sky);
        assert!(frame.colour[pixel].abs_diff_eq(MIRROR * sky, 1e-6));
        assert_eq!(frame.record.last[pixel], frame.position[pixel].extend(f32::INFINITY));
        pixels += 1;
    }
    assert!(pixels > 1000);
}

/// Two parallel mirrors a metre either side of the eye, in the planes x = -1 and x = 1.
const HALL: &str = r#"
[camera]
fov_deg = 40.0
eye = [0.0, 0.0, 0.0]
target = [1.0, 0.0, 0.1]
[[objects]]
name = "right"
shape = { plane = { size = [90.0, 90.0] } }
material = "mirror"
position = [1.0, 0.0, 0.0]
rotation_deg = [0.0, 0.0, 90.0]
[[objects]]
name = "left"
shape = { plane = { size = [90.0, 90.0] } }
material = "mirror"
position = [-1.0, 0.0, 0.0]
rotation_deg = [0.0, 0.0, 90.0]
"#;

#[test]
fn between_two_mirrors_the_chain_has_the_length_allowed() {
    let scene = scene(HALL);
    let [right, left] = ["right", "left"].map(|name| scene.select(name)[0]);
    for bounces in [1, 2, 3] {
        let options = TruthOptions { bounces: Some(bounces), ..TruthOptions::default() };
        let tracer = Tracer::new(&scene, &scene.at(0), options);
        let frame = tracer.frame([8, 8]);
        for pixel in found(&frame) {
            let ids = frame.record.ids[pixel];
            assert_eq!((frame.reflector[pixel], ids.order()), (right, bounces));
            // The mirror at the end shows its own colour, black.
            assert_eq!(ids.object, if bounces % 2 == 1 { left } else { right });
            assert_eq!(frame.record.radiance[pixel], Vec3::ZERO);
            // 1 + rank, first bounce lowest: right, left, right.
            assert_eq!(ids.trace, [1, 0x201, 0x1_0201][bounces as usize - 1]);
            // Unfolded, the path is straight: two metres in x a bounce.
            let ray = eye_ray(&tracer, &frame, pixel);
            let unfolded = 2.0 * bounces as f32 / ray.direction.x;
            assert!((frame.record.last[pixel].w - unfolded).abs() < 1e-4 * unfolded);
        }
        assert_eq!(found(&frame).count(), 64);
    }
}

#[test]
fn later_mirrors_dim_the_light_and_the_first_does_not() {
    let scene = scene(TWO_BALLS);
    let tracer = tracer(&scene, Shapes::Tessellated);
    let frame = tracer.frame(SIZE);
    let mut second = 0;
    for pixel in frame.reflector_pixels() {
        let chain = {
            let ray = eye_ray(&tracer, &frame, pixel);
            tracer.chain(tracer.look(&ray).unwrap(), ray.direction, Lobe::Reflected).unwrap()
        };
        let end = match &chain.shown {
            Some(hit) => tracer.diffuse(hit),
            None => shading::environment(&scene, chain.last().outgoing),
        };
        let dimmed = (1..chain.order()).fold(end, |light, _| MIRROR * light);
        assert!(frame.record.radiance[pixel].abs_diff_eq(dimmed, 1e-6));
        second += u32::from(chain.order() == 2);
    }
    assert!(second > 50);
}

#[test]
fn a_weak_mirror_ends_the_chain_but_not_the_light() {
    let scene = scene(&BALL.replace("material = \"red\"", "material = \"ghost\""));
    let tracer = tracer(&scene, Shapes::Tessellated);
    let frame = tracer.frame(SIZE);
    let ghost = scene.select("box")[0];
    let mut pixels = 0;
    for pixel in found(&frame).filter(|&pixel| frame.record.ids[pixel].object == ghost) {
        let ray = eye_ray(&tracer, &frame, pixel);
        let chain =
            tracer.chain(tracer.look(&ray).unwrap(), ray.direction, Lobe::Reflected).unwrap();
        if chain.order() == 1 && frame.reflector[pixel] != ghost {
            let itself = tracer.diffuse(&chain.shown.unwrap());
            assert!(frame.record.radiance[pixel].cmpgt(itself + 0.01).all());
            pixels += 1;
        }
    }
    assert!(pixels > 10);
}

#[test]
fn inside_a_mirror_ball_the_mesh_agrees_with_the_closed_form() {
    // The eye at the ball's centre looks at itself: mirrored rays come back through it.
    let scene = scene(
        r#"
[camera]
fov_deg = 60.0
eye = [0.0, 1.0, 0.0]
target = [0.0, 1.0, -1.0]
[[objects]]
name = "ball"
shape = { sphere = { radius = 1.0, edge = 0.02 } }
material = "mirror"
position = [0.0, 1.0, 0.0]
"#,
    );
    for shapes in [Shapes::Tessellated, Shapes::Analytic] {
        let options = TruthOptions { bounces: Some(1), shapes, spp: 1 };
        let tracer = Tracer::new(&scene, &scene.at(0), options);
        let frame = tracer.frame([32, 32]);
        assert_eq!(found(&frame).count(), 1024, "{shapes:?}: light leaves the ball");
        for pixel in found(&frame) {
            let (r, s) = (frame.position[pixel], frame.record.point[pixel].xyz());
            assert!((r + s).abs_diff_eq(2.0 * Vec3::Y, 3e-3), "{shapes:?}: from {r} to {s}");
        }
    }
}

#[test]
fn the_picture_is_averaged_and_the_record_is_not() {
    let scene = scene(BALL);
    let options = TruthOptions { spp: 16, ..TruthOptions::default() };
    let smooth = Tracer::new(&scene, &scene.at(0), options).frame(SIZE);
    let sharp = tracer(&scene, Shapes::Tessellated).frame(SIZE);
    assert_eq!(smooth.record, sharp.record);
    assert_ne!(smooth.colour, sharp.colour);
    // Against the mean over an image eight times finer, sixteen strata err far less than one ray.
    let fine = tracer(&scene, Shapes::Tessellated).frame(SIZE.map(|side| 8 * side));
    let mean = |pixel: u32| {
        let (x, y) = (8 * (pixel % SIZE[0]), 8 * (pixel / SIZE[0]));
        let cells = (0..64).map(|k| ((y + k / 8) * fine.size[0] + x + k % 8) as usize);
        cells.map(|cell| fine.colour[cell]).sum::<Vec3>() / 64.0
    };
    let error = |frame: &FrameRecord| -> f32 {
        let pixels = (0..SIZE[0] * SIZE[1]).zip(&frame.colour);
        pixels.map(|(pixel, colour)| colour.distance(mean(pixel))).sum()
    };
    let (one, sixteen) = (error(&sharp), error(&smooth));
    assert!(sixteen < 0.3 * one, "{sixteen} of {one}");
}

#[test]
fn the_frame_does_not_depend_on_the_number_of_threads() {
    let scene = scene(TWO_BALLS);
    let tracer = tracer(&scene, Shapes::Tessellated);
    let [one, two] = [1, 2].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| tracer.frame(SIZE))
    });
    assert_eq!(one, two);
}

#[test]
fn depth_is_measured_along_the_view_between_the_planes() {
    let scene = scene(FLAT);
    let mut moment = scene.at(0);
    let options = TruthOptions::default();
    let frame = Tracer::new(&scene, &moment, options).frame(SIZE);
    let [_, _, back] = moment.camera.axes();
    for pixel in frame.reflector_pixels() {
        let depth = (moment.camera.eye - frame.position[pixel]).dot(back);
        assert!((frame.depth[pixel] - depth).abs() < 1e-5);
    }
    let nearest = frame.depth.iter().copied().fold(f32::INFINITY, f32::min);
    moment.camera.near = nearest + 1.0;
    moment.camera.far = nearest + 2.0;
    let sliced = Tracer::new(&scene, &moment, options).frame(SIZE);
    let finite = || sliced.depth.iter().filter(|depth| depth.is_finite());
    assert!(finite().count() > 100);
    assert!(finite().all(|&depth| depth >= nearest + 0.999 && depth <= nearest + 2.001));
}
