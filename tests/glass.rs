//! Refraction, Fresnel's split and shadows in the truth, against closed forms.

mod truth_support;

use glam::{Vec3, Vec4Swizzles};
use mirrorbench::geometry::optics::{fresnel, refract};
use mirrorbench::scene::{CameraPath, Environment, Lobe, Scene, Status, shading};
use mirrorbench::truth::{Shapes, Tracer, TruthOptions};
use truth_support::{eye_ray, found, scene, tracer};

const SIZE: [u32; 2] = [96, 64];

/// A ball of glass over a floor, nothing else.
const GLASS_BALL: &str = r#"
[camera]
fov_deg = 40.0
eye = [0.3, 1.7, 4.0]
target = [0.0, 0.9, 0.0]
[[objects]]
name = "floor"
shape = { plane = { size = [40.0, 40.0] } }
material = "floor"
[[objects]]
name = "ball"
shape = { sphere = { radius = 1.0, edge = 0.05 } }
material = "glass"
position = [0.0, 1.05, 0.0]
"#;

fn glass_ball(index: f32) -> Scene {
    let mut scene = scene(GLASS_BALL);
    scene.bounces = 6;
    let ball = scene.select("ball")[0];
    let material = scene.objects[ball as usize].material;
    scene.materials[material].glass.as_mut().unwrap().index = index;
    scene
}

#[test]
fn a_ray_through_a_ball_turns_as_snell_says() {
    let scene = glass_ball(1.5);
    let tracer = tracer(&scene, Shapes::Analytic);
    let frame = tracer.frame(SIZE);
    let (centre, mut through) = (Vec3::new(0.0, 1.05, 0.0), 0);
    for pixel in frame.reflector_pixels() {
        let ray = eye_ray(&tracer, &frame, pixel);
        let hit = tracer.look(&ray).unwrap();
        if fresnel(-ray.direction.dot(hit.normal), 1.0 / 1.5) >= 0.5 {
            // At the rim more light stays inside than leaves at the far side.
            continue;
        }
        let chain = tracer.chain(hit, ray.direction, Lobe::Refracted).unwrap();
        // Enter, cross the chord, leave: the same angle on both sides.
        let inside = refract(ray.direction, hit.normal, 1.0 / 1.5).unwrap();
        let chord = -2.0 * inside.dot(hit.point - centre);
        let exit = hit.point + chord * inside;
        let outside = refract(inside, (centre - exit).normalize(), 1.5).unwrap();
        assert_eq!(chain.order(), 2);
        assert!(chain.last().hit.point.abs_diff_eq(exit, 1e-5));
        assert!(chain.last().outgoing.abs_diff_eq(outside, 1e-5));
        // Total deviation of the two refractions: 2 (theta_i - theta_t).
        let [theta_i, theta_t] =
            [ray.direction, inside].map(|d| d.dot(-hit.normal).clamp(-1.0, 1.0).acos());
        let turned = ray.direction.angle_between(chain.last().outgoing);
        assert!((turned - 2.0 * (theta_i - theta_t)).abs() < 2e-3, "{turned}");
        through += 1;
    }
    assert!(through > 500, "{through} rays");
}

#[test]
fn glass_as_dense_as_air_is_not_seen() {
    let mut scene = glass_ball(1.0);
    let seen = tracer(&scene, Shapes::Tessellated).frame(SIZE);
    let refracted = seen.refracted.as_ref().unwrap();
    let ball = scene.select("ball")[0];
    scene.objects.remove(ball as usize);
    let bare_tracer = tracer(&scene, Shapes::Tessellated);
    let mut compared = 0;
    for pixel in seen.reflector_pixels() {
        let ray = eye_ray(&bare_tracer, &seen, pixel);
        // The tint is white, so what shows is what lies behind.
        let behind = bare_tracer.look(&ray);
        match refracted.ids[pixel].status() {
            Status::Found => {
                let shown = refracted.point[pixel].xyz();
                assert!(shown.abs_diff_eq(behind.unwrap().point, 2e-3));
                compared += 1;
            }
            status => assert_eq!((status, behind), (Status::Environment, None)),
        }
        assert_eq!(refracted.ids[pixel].order(), 2);
    }
    assert!(compared > 200, "{compared} pixels");
}

#[test]
fn the_picture_is_the_sum_of_both_lobes() {
    let scene = glass_ball(1.5);
    let tracer = tracer(&scene, Shapes::Tessellated);
    let frame = tracer.frame(SIZE);
    let refracted = frame.refracted.as_ref().unwrap();
    for pixel in frame.reflector_pixels() {
        let ray = eye_ray(&tracer, &frame, pixel);
        let share = fresnel(-ray.direction.dot(frame.normal[pixel]), 1.0 / 1.5);
        let sum = share * frame.record.radiance[pixel] + (1.0 - share) * refracted.radiance[pixel];
        assert!(frame.colour[pixel].abs_diff_eq(sum, 1e-5));
        let lobes = [frame.record.ids[pixel], refracted.ids[pixel]].map(|ids| ids.lobe());
        assert_eq!(lobes, [Lobe::Reflected, Lobe::Refracted]);
    }
}

#[test]
fn glass_neither_adds_nor_loses_light() {
    let mut scene = glass_ball(1.5);
    scene.objects.remove(scene.select("floor")[0] as usize);
    scene.environment = Environment::Colour(Vec3::ONE);
    scene.bounces = 8;
    let tracer = tracer(&scene, Shapes::Analytic);
    let frame = tracer.frame(SIZE);
    for pixel in frame.reflector_pixels() {
        // In a white world all is white, but for what after 8 bounces is still inside: of the light
        // that enters, the share that is reflected each time. All angles inside are the same.
        let ray = eye_ray(&tracer, &frame, pixel);
        let share = fresnel(-ray.direction.dot(frame.normal[pixel]), 1.0 / 1.5);
        let left = (1.0 - share) * share.powi(7);
        let expected = Vec3::splat(1.0 - left);
        // Light too faint to follow is less than 1/4096.
        assert!(
            frame.colour[pixel].abs_diff_eq(expected, 3e-4),
            "{} at {share}",
            frame.colour[pixel]
        );
    }
}

#[test]
fn beyond_the_critical_angle_everything_is_reflected() {
    // From within the ball, looking past its middle by more than 1 / 1.5 of the radius.
    let mut scene = glass_ball(1.5);
    let eye = Vec3::new(0.0, 1.05 + 0.9, 0.0);
    let mut camera = scene.camera.at(0.0);
    (camera.eye, camera.target) = (eye, eye + Vec3::Z);
    scene.camera = CameraPath::Keys(vec![(0.0, camera)]);
    let tracer = tracer(&scene, Shapes::Analytic);
    let ray = tracer.moment().camera.ray([1, 1], glam::Vec2::splat(0.5));
    let hit = tracer.look(&ray).unwrap();
    assert!(!hit.front);
    assert_eq!(tracer.chain(hit, ray.direction, Lobe::Refracted), None);
    let way = tracer.depart(&hit, ray.direction, Lobe::Reflected).unwrap();
    assert_eq!(way.share, 1.0);
    // Caught for good: every bounce of the chain is a reflection inside the ball.
    let chain = tracer.chain(hit, ray.direction, Lobe::Reflected).unwrap();
    assert_eq!((chain.order(), chain.refractions()), (6, 0));
}

/// A mirror ball and a glass ball on a floor under a slanted sun.
const SHADY: &str = r#"
[camera]
fov_deg = 50.0
eye = [0.0, 4.0, 5.0]
target = [0.0, 0.5, 0.0]
[[objects]]
name = "floor"
shape = { plane = { size = [40.0, 40.0] } }
material = "red"
[[objects]]
name = "mirror"
shape = { sphere = { radius = 0.7, edge = 0.05 } }
material = "mirror"
position = [-1.0, 0.9, 0.0]
[[objects]]
name = "glass"
shape = { sphere = { radius = 0.7, edge = 0.05 } }
material = "glass"
position = [1.0, 0.9, 0.0]
"#;

#[test]
fn shadows_fall_where_the_sun_is_hidden_and_only_where_asked() {
    let mut scene = scene(SHADY);
    let lit = tracer(&scene, Shapes::Analytic).frame(SIZE);
    scene.lighting.shadows = true;
    let tracer = tracer(&scene, Shapes::Analytic);
    let shady = tracer.frame(SIZE);
    let floor = scene.select("floor")[0];
    let (mut dark, mut bright) = (0, 0);
    for pixel in (0..shady.object.len()).filter(|&pixel| shady.object[pixel] == floor) {
        let hit = tracer.look(&eye_ray(&tracer, &shady, pixel)).unwrap();
        let sunlit = |sunlit| shading::shade(&scene, floor, hit.normal, hit.uv, sunlit);
        // The mirror ball's shadow is a cylinder along the sun; glass lets the sun through.
        let towards = Vec3::new(-1.0, 0.9, 0.0) - hit.point;
        let away = towards.cross(scene.lighting.towards_sun).length();
        let hidden = away < 0.7;
        if (away - 0.7).abs() > 1e-4 {
            assert_eq!(shady.colour[pixel], sunlit(!hidden), "{}", hit.point);
        }
        assert_eq!(lit.colour[pixel], sunlit(true));
        *(if hidden { &mut dark } else { &mut bright }) += 1;
    }
    assert!(dark > 50 && bright > 500, "{dark} dark, {bright} bright");
    // And in the mirrors, as pictures of the floor have them.
    let reflected = found(&shady).filter(|&pixel| shady.record.ids[pixel].object == floor);
    let darkened = reflected.filter(|&i| shady.record.radiance[i] != lit.record.radiance[i]);
    let darkened = darkened.count();
    assert!(darkened > 0, "no mirrored pixel in the shade");
}

#[test]
fn strata_and_split_light_do_not_depend_on_the_number_of_threads() {
    let scene = glass_ball(1.5);
    let options = TruthOptions { spp: 9, ..TruthOptions::default() };
    let moment = scene.at(0);
    let [one, many] = [1, 3].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| Tracer::new(&scene, &moment, options).frame(SIZE))
    });
    assert_eq!(one, many);
}
