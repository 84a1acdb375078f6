use std::collections::HashMap;
use std::f32::consts::{FRAC_PI_2, PI};

use glam::{Vec2, Vec3};

use super::*;
use crate::geometry::Mesh;

/// What every mesh promises: finite, unit normals, no triangle without area, counter-clockwise
/// seen from the side of the normals.
fn check(mesh: &Mesh) {
    assert!(!mesh.triangles.is_empty());
    assert_eq!(mesh.positions.len(), mesh.normals.len());
    assert_eq!(mesh.positions.len(), mesh.uvs.len());
    for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
        assert!(p.is_finite() && (n.length() - 1.0).abs() < 1e-5, "normal {n} at {p}");
    }
    for (index, triangle) in mesh.triangles.iter().enumerate() {
        let [a, b, c] = mesh.corners(index);
        let facing = (b - a).cross(c - a);
        assert!(facing.length() > 0.0, "triangle {index} has no area");
        for &corner in triangle {
            let normal = mesh.normals[corner as usize];
            assert!(facing.dot(normal) > 0.0, "triangle {index} faces {facing}, normal {normal}");
        }
    }
}

/// V - E + F, vertices counted by position; checks that every edge is met once each way.
fn euler_characteristic_of_closed(mesh: &Mesh) -> i64 {
    let mut ids: HashMap<[u32; 3], usize> = HashMap::new();
    // Adding zero makes -0.0 and 0.0 the same bits.
    let mut id = |p: Vec3| {
        let next = ids.len();
        *ids.entry((p + Vec3::ZERO).to_array().map(f32::to_bits)).or_insert(next)
    };
    let mut edges: HashMap<(usize, usize), usize> = HashMap::new();
    for index in 0..mesh.triangles.len() {
        let [a, b, c] = mesh.corners(index).map(&mut id);
        for edge in [(a, b), (b, c), (c, a)] {
            *edges.entry(edge).or_default() += 1;
        }
    }
    for (&(a, b), &count) in &edges {
        assert_eq!((count, edges.get(&(b, a))), (1, Some(&1)), "edge {a}-{b} is not closed");
    }
    ids.len() as i64 - edges.len() as i64 / 2 + mesh.triangles.len() as i64
}

fn assert_on(mesh: &Mesh, surface: impl Fn(Vec3) -> f32, normal: impl Fn(Vec3) -> Vec3) {
    for (&p, n) in mesh.positions.iter().zip(&mesh.normals) {
        assert!(surface(p).abs() < 1e-5, "{p} is {} off the surface", surface(p));
        assert!(n.abs_diff_eq(normal(p).normalize(), 1e-5), "normal {n} at {p}");
    }
}

#[test]
fn spheres_and_ellipsoids() {
    for (slices, stacks) in [(3, 2), (32, 16), (65, 33)] {
        let mesh = sphere(1.5, slices, stacks);
        check(&mesh);
        assert_on(&mesh, |p| p.length() - 1.5, |p| p);
        assert_eq!(euler_characteristic_of_closed(&mesh), 2);
        assert_eq!(mesh.triangles.len() as u32, 2 * slices * (stacks - 1));
    }
    let radii = Vec3::new(4.0, 1.1, 2.5);
    let mesh = ellipsoid(radii, 40, 20);
    check(&mesh);
    assert_on(&mesh, |p| (p / radii).length() - 1.0, |p| p / (radii * radii));
    assert_eq!(euler_characteristic_of_closed(&mesh), 2);
}

#[test]
fn edges_are_as_short_as_asked() {
    let (radius, edge) = (1.0, 0.05);
    let mesh = sphere(radius, arc_steps(radius, 2.0 * PI, edge), arc_steps(radius, PI, edge));
    for index in 0..mesh.triangles.len() {
        let [a, b, c] = mesh.corners(index);
        // Diagonals of a square of that side are allowed.
        let longest = (b - a).length().max((c - b).length()).max((a - c).length());
        assert!(longest <= edge * 2.0f32.sqrt() * 1.0001, "triangle {index}: {longest} m");
    }
}

#[test]
fn planes_and_boxes_measure_in_metres() {
    let mesh = plane(Vec2::new(4.0, 2.0));
    check(&mesh);
    assert!(mesh.normals.iter().all(|&n| n == Vec3::Y));
    assert!(mesh.positions.iter().zip(&mesh.uvs).all(|(p, uv)| (uv.x, uv.y) == (p.x, -p.z)));

    let size = Vec3::new(1.0, 2.0, 3.0);
    let mesh = cuboid(size);
    check(&mesh);
    assert_eq!((mesh.positions.len(), mesh.triangles.len()), (24, 12));
    assert_eq!(euler_characteristic_of_closed(&mesh), 2);
    assert_eq!(mesh.bounds(), Some((-0.5 * size, 0.5 * size)));
    for [a, b, c] in &mesh.triangles {
        for (i, j) in [(a, b), (b, c), (c, a)].map(|(&i, &j)| (i as usize, j as usize)) {
            let length = (mesh.positions[i] - mesh.positions[j]).length();
            let in_uv = (mesh.uvs[i] - mesh.uvs[j]).length();
            assert!((length - in_uv).abs() < 1e-6);
        }
    }
}

#[test]
fn cylinders() {
    let mesh = cylinder(0.3, 3.0, true, 24);
    check(&mesh);
    assert_eq!(euler_characteristic_of_closed(&mesh), 2);
    let side = cylinder(0.3, 3.0, false, 24);
    check(&side);
    assert_eq!(side.triangles.len(), 48);
    assert_on(&side, |p| Vec2::new(p.x, p.z).length() - 0.3, |p| Vec3::new(p.x, 0.0, p.z));
}

#[test]
fn tori() {
    let (ring, tube) = (1.0, 0.35);
    let surface = |p: Vec3| Vec2::new(Vec2::new(p.x, p.z).length() - ring, p.y).length() - tube;
    let normal = |p: Vec3| p - ring * Vec3::new(p.x, 0.0, p.z).normalize();
    let whole = torus(ring, tube, 12, Sweep::full(30));
    check(&whole);
    assert_on(&whole, surface, normal);
    assert_eq!(euler_characteristic_of_closed(&whole), 0);

    let section = torus(ring, tube, 12, Sweep { slices: 10, angle: FRAC_PI_2 });
    check(&section);
    assert_on(&section, surface, normal);
    assert!(section.positions.iter().all(|p| p.x > -1e-5 && p.z < 1e-5), "a quarter turn");
}

#[test]
fn surfaces_of_revolution() {
    // A cone: the normal leans up by the slope of its side.
    let cone = [Vec2::new(1.0, 0.0), Vec2::new(0.0, 2.0)];
    let mesh = revolution(&polyline_profile(&cone), Sweep::full(16));
    check(&mesh);
    assert!(mesh.normals.iter().all(|n| (n.y - 1.0 / 5.0f32.sqrt()).abs() < 1e-5));

    // The parabola y = r^2 is a Bezier curve exactly.
    let third = 1.0 / 3.0;
    let parabola = [(0.0, 0.0), (third, 0.0), (2.0 * third, third), (1.0, 1.0)].map(Vec2::from);
    let mesh = revolution(&bezier_profile(&parabola, 10), Sweep::full(20));
    check(&mesh);
    assert_on(&mesh, |p| p.y - p.x * p.x - p.z * p.z, |p| Vec3::new(2.0 * p.x, -1.0, 2.0 * p.z));
}
