use std::f32::consts::TAU;

use glam::{Affine3A, DVec3, Quat, Vec2, Vec3};

use super::{Form, Line, Shape};
use crate::geometry::bvh::Bvh;
use crate::geometry::shapes::{self, Sweep};
use crate::geometry::{Mesh, Ray};
use crate::scene::Surface;

const SHEETS: [Surface; 2] = [
    Surface::Cylinder { radius: 0.8, height: 1.5, capped: false },
    Surface::Rectangle { size: Vec2::new(1.5, 2.5) },
];

/// The distance from a surface, or what has its sign: positive outside.
type Distance = fn(DVec3) -> f64;

/// Closed surfaces.
const SOLIDS: [(Surface, Distance); 5] = [
    (Surface::Sphere { radius: 1.1 }, |p| p.length() - f64::from(1.1f32)),
    (Surface::Ellipsoid { radii: Vec3::new(1.5, 0.5, 0.75) }, |p| {
        (p / DVec3::new(1.5, 0.5, 0.75)).length() - 1.0
    }),
    (Surface::Cylinder { radius: 0.75, height: 1.5, capped: true }, |p| {
        f64::max(p.x.hypot(p.z) - 0.75, p.y.abs() - 0.75)
    }),
    (Surface::Torus { ring: 1.0, tube: 0.375 }, |p| (p.x.hypot(p.z) - 1.0).hypot(p.y) - 0.375),
    (Surface::Torus { ring: 1.0, tube: 0.03125 }, |p| (p.x.hypot(p.z) - 1.0).hypot(p.y) - 0.03125),
];

fn surfaces() -> impl Iterator<Item = Surface> {
    SOLIDS.into_iter().map(|(surface, _)| surface).chain(SHEETS)
}

fn mesh_of(surface: Surface, slices: u32) -> Mesh {
    match surface {
        Surface::Sphere { radius } => shapes::sphere(radius, slices, slices / 2),
        Surface::Ellipsoid { radii } => shapes::ellipsoid(radii, slices, slices / 2),
        Surface::Cylinder { radius, height, capped } => {
            shapes::cylinder(radius, height, capped, slices)
        }
        Surface::Rectangle { size } => shapes::plane(size),
        Surface::Torus { ring, tube } => shapes::torus(ring, tube, slices / 2, Sweep::full(slices)),
    }
}

fn pose() -> Affine3A {
    let turn = Quat::from_rotation_x(0.7) * Quat::from_rotation_y(-1.3);
    Affine3A::from_rotation_translation(turn, Vec3::new(0.6, -0.4, 1.2))
}

/// Numbers from 0 to 1 that fill their cube evenly: multiples of irrationals.
fn even(step: u32) -> [f64; 4] {
    let roots = [2.0, 3.0, 5.0, 7.0].map(f64::sqrt);
    roots.map(|root| (f64::from(step) * root).fract())
}

/// A direction made from two numbers from 0 to 1.
fn direction(a: f64, b: f64) -> DVec3 {
    let up = 2.0 * a - 1.0;
    let (sin, cos) = (std::f64::consts::TAU * b).sin_cos();
    (DVec3::new(cos, 0.0, sin) * (1.0 - up * up).sqrt()).with_y(up)
}

/// Points all over a solid with a tangent each. The cylinder's rims are left out, where a tangent of
/// one part need not be one of the other; its radius is half its height.
fn points(surface: Surface, form: &dyn Form) -> impl Iterator<Item = (DVec3, DVec3)> {
    let points = (1..400).map(move |step| {
        let [a, b, c, d] = even(step);
        let point = form.snap((0.5 + c) * 1.5 * direction(a, b));
        (point, direction(b, d).reject_from(form.normal(point)).normalize())
    });
    let creased = matches!(surface, Surface::Cylinder { .. });
    let at_rim = move |p: DVec3| creased && (p.x.hypot(p.z) - p.y.abs()).abs() < 0.01;
    points.filter(move |&(point, _)| !at_rim(point))
}

#[test]
fn meshes_have_their_vertices_on_the_closed_form() {
    for surface in surfaces() {
        let shape = Shape::new(0, &pose(), surface);
        let mesh = mesh_of(surface, 24);
        for ((&vertex, &normal), &uv) in mesh.positions.iter().zip(&mesh.normals).zip(&mesh.uvs) {
            // Where parts meet a vertex stands for one of them, the one it has the normal of: a
            // little within that part the closed form has to agree.
            let inward = 1.0 - 2e-6 * (Vec3::ONE - normal.abs().round());
            let capped = matches!(surface, Surface::Cylinder { capped: true, .. });
            let point = pose().transform_point3(if capped { inward * vertex } else { vertex });
            let local = shape.local(point);
            assert!(shape.form.snap(local).distance(local) < 1e-5, "{surface:?}: {vertex}");
            let expected = pose().transform_vector3(normal);
            let found = shape.normal(point);
            assert!(found.abs_diff_eq(expected, 1e-5), "{surface:?}: {found} for {expected}");
            let mut off = shape.uv(point) - uv;
            if !matches!(surface, Surface::Rectangle { .. }) {
                // Both ends of a turn are one place, and at a pole the turn has no meaning.
                off -= off.round();
                off.x *= f32::from(vertex.x.hypot(vertex.z) > 1e-4);
            }
            assert!(off.abs().max_element() < 1e-5, "{surface:?}: uv off by {off} for {uv}");
        }
    }
}

#[test]
fn rays_meet_the_closed_form_where_they_meet_a_fine_mesh() {
    for surface in surfaces() {
        let shape = Shape::new(0, &pose(), surface);
        let mesh = mesh_of(surface, 400);
        let place = |corner: Vec3| pose().transform_point3(corner);
        let triangles: Vec<[Vec3; 3]> =
            (0..mesh.triangles.len()).map(|index| mesh.corners(index).map(place)).collect();
        let bvh = Bvh::new(&triangles);
        let (low, high) = mesh.bounds().unwrap();
        let (mut hits, mut differ) = (0, 0);
        const RAYS: u32 = 2000;
        for step in 1..=RAYS {
            let [a, b, c, d] = even(step);
            // Every third ray starts in the middle of things.
            let reach = if step % 3 == 0 { 0.3 } else { 4.0 };
            let origin = place(reach * direction(a, b).as_vec3());
            let aim = Vec3::new(c as f32, d as f32, (c + d).fract() as f32);
            let direction = (place(low + aim * (high - low)) - origin).normalize();
            let ray = Ray { origin, direction };
            let met = bvh.nearest(&ray, [0.0, 9.0], |_, _| true);
            let found = shape.nearest(&ray, [0.0, 9.0], None);
            hits += u32::from(found.is_some());
            let agree = match (met, found) {
                (Some(met), Some((point, front))) => {
                    met.front == front && ray.at(met.t).distance(point) < 2e-3
                }
                (met, found) => met.is_none() && found.is_none(),
            };
            differ += u32::from(!agree);
        }
        // Silhouettes differ.
        assert!(hits > RAYS / 20 && differ <= RAYS / 100, "{surface:?}: {differ} of {hits} differ");
    }
}

/// The line stays on one side of the solid from `start` to `end`, and is on the surface at `end`
/// where the surface is `met`. Samples are dense near the start, where grazing lines would fail.
fn stays(line: &Line, side: f64, solid: Distance, end: f64, met: bool) -> bool {
    let samples = (1..500).map(|step| f64::from(step) / 500.0);
    let clear =
        samples.flat_map(|s| [s, s * s * s]).all(|s| side * solid(line.at(s * end)) > -1e-12);
    clear && (!met || solid(line.at(end)).abs() < 1e-12)
}

/// Sines of the angle between line and surface.
const SLOPES: [f64; 6] = [0.7, 0.2, 1e-2, 1e-3, 1e-5, 1e-7];

#[test]
fn lines_through_a_point_of_a_solid_meet_it_there_or_before() {
    for (surface, solid) in SOLIDS {
        let form = Shape::new(0, &Affine3A::IDENTITY, surface).form;
        for ((point, tangent), step) in points(surface, form.as_ref()).zip(0..) {
            // At the least slope a line from afar would pass within rounding of the surface.
            let slope = SLOPES[step % 5] * if step % 4 < 2 { -1.0 } else { 1.0 };
            let direction = (tangent + slope * form.normal(point)).normalize();
            let distance = [0.2, 2.0, 30.0][step % 3];
            let line = Line { origin: point - distance * direction, direction };
            let outside = solid(line.origin) > 0.0;
            let (t, front) = form
                .nearest(&line, [0.0, f64::INFINITY], None)
                .unwrap_or_else(|| panic!("{surface:?}: missed at {point}, slope {slope}"));
            assert_eq!(front, outside, "{surface:?} at {point}, slope {slope}");
            // Half a digit of the distance is lost where the line nearly touches.
            assert!(t < distance + 1e-6, "{surface:?}: {t} beyond {distance}, slope {slope}");
            let side = if outside { 1.0 } else { -1.0 };
            assert!(stays(&line, side, solid, t, true), "{surface:?} at {point}, slope {slope}");
        }
    }
}

#[test]
fn lines_from_a_solid_never_meet_their_start_and_always_the_next_crossing() {
    for (surface, solid) in SOLIDS {
        let form = Shape::new(0, &Affine3A::IDENTITY, surface).form;
        let mut returned = 0;
        for (origin, tangent) in points(surface, form.as_ref()) {
            for (slope, own) in SLOPES.iter().flat_map(|slope| [(slope, true), (slope, false)]) {
                let side = if own { 1.0 } else { -1.0 };
                let direction = (tangent + side * slope * form.normal(origin)).normalize();
                let line = Line { origin, direction };
                let found = form.nearest(&line, [0.0, f64::INFINITY], Some(own));
                if let Some((t, front)) = found {
                    assert_eq!(front, own, "{surface:?} at {origin}, slope {slope}");
                    assert!(t > 0.01 * slope, "{surface:?}: {t} m, slope {slope}");
                    returned += u32::from(own);
                }
                assert!(own || found.is_some(), "{surface:?} leaks at {origin}, slope {slope}");
                let end = found.map_or(10.0, |(t, _)| t);
                assert!(
                    stays(&line, side, solid, end, found.is_some()),
                    "{surface:?} at {origin}, slope {slope}, outside {own}: to {end}"
                );
            }
        }
        let concave = matches!(surface, Surface::Torus { .. });
        assert_eq!(returned > 0, concave, "{surface:?}: {returned}");
    }
}

#[test]
fn sheets_have_two_sides() {
    let sheet = |surface| Shape::new(0, &Affine3A::IDENTITY, surface);
    let nearest = |shape: &Shape, origin: Vec3, towards: Vec3, own| {
        let ray = Ray { origin, direction: towards.normalize() };
        shape.nearest(&ray, [0.0, f32::INFINITY], own)
    };
    let plane = sheet(Surface::Rectangle { size: Vec2::new(2.0, 4.0) });
    let from_above = nearest(&plane, Vec3::new(0.5, 1.0, 1.5), Vec3::NEG_Y, None);
    assert_eq!(from_above, Some((Vec3::new(0.5, 0.0, 1.5), true)));
    let from_below = nearest(&plane, Vec3::new(0.5, -1.0, 1.5), Vec3::Y, None);
    assert_eq!(from_below, Some((Vec3::new(0.5, 0.0, 1.5), false)));
    assert_eq!(nearest(&plane, Vec3::new(1.5, 1.0, 0.5), Vec3::NEG_Y, None), None);
    for (y, own) in [(1.0, true), (-1.0, false)] {
        let grazing = Vec3::new(1.0, 1e-7 * y, 0.0);
        assert_eq!(nearest(&plane, Vec3::new(-0.5, 0.0, 0.0), grazing, Some(own)), None);
    }

    let tube = sheet(Surface::Cylinder { radius: 0.5, height: 2.0, capped: false });
    let across = |own, up| nearest(&tube, Vec3::new(0.5, 0.0, 0.0), Vec3::new(-1.0, up, 0.0), own);
    assert_eq!(across(Some(false), 0.9).map(|hit| hit.1), Some(false));
    assert_eq!(across(Some(false), 1.1), None, "out by the open end");
    assert_eq!(across(Some(true), 0.0), None);
    let through_the_end = nearest(&tube, Vec3::new(0.0, 1.5, 0.0), Vec3::new(0.4, -1.0, 0.0), None);
    let (point, front) = through_the_end.unwrap();
    assert!(point.abs_diff_eq(Vec3::new(0.5, 0.25, 0.0), 1e-6) && !front);
    assert_eq!(nearest(&tube, Vec3::new(0.1, 1.5, 0.0), Vec3::NEG_Y, None), None);
}

/// Starting points are rounded to singles, on either side of the surface: a ray led round the inside
/// of a mirror ball, or of a torus' tube, at grazing angles has to stay in.
#[test]
fn rounding_of_the_start_lets_no_ray_out() {
    let radius = 0.3;
    let rounds = [
        (Surface::Sphere { radius }, Vec3::new(0.6, 0.0, 0.8) * radius, Vec3::Y),
        (
            Surface::Torus { ring: 1.0, tube: radius },
            Vec3::new(0.6, 0.8, 0.0) * radius + Vec3::X,
            Vec3::Z,
        ),
    ];
    for ((surface, start, axis), slope) in
        rounds.into_iter().flat_map(|round| [1e-2, 1e-3, 1e-4].map(|slope| (round, slope)))
    {
        let shape = Shape::new(0, &pose(), surface);
        let mut point = pose().transform_point3(start);
        let mut turned = 0.0;
        while turned < 0.25 * TAU {
            let normal = shape.normal(point);
            let along = pose().transform_vector3(axis).cross(normal).normalize();
            let ray = Ray { origin: point, direction: (along - slope * normal).normalize() };
            let (next, front) = shape.nearest(&ray, [0.0, f32::INFINITY], Some(false)).unwrap();
            assert!(!front);
            let step = next.distance(point) / radius;
            let off = step / (2.0 * slope) - 1.0;
            assert!(off.abs() < 5e-7 / slope + 1e-3, "{surface:?}: {step} for slope {slope}");
            (point, turned) = (next, turned + step);
        }
    }
}
