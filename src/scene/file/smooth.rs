//! Vertex normals for meshes that have none.

use std::collections::HashMap;

use glam::{Vec2, Vec3};

use crate::geometry::Mesh;
use crate::geometry::mesh::is_flat;

/// One corner of a triangle as read from a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    pub position: Vec3,
    /// Where the file has one.
    pub normal: Option<Vec3>,
    pub uv: Vec2,
}

/// A face's unit normal and its angle at a corner.
type Wedge = (Vec3, f32);

/// Bits of position, normal and texture coordinate.
type VertexKey = ([u32; 3], [u32; 3], [u32; 2]);

/// The bits of a vector; -0.0 is 0.0.
fn bits(v: Vec3) -> [u32; 3] {
    (v + Vec3::ZERO).to_array().map(f32::to_bits)
}

/// The mesh of `triangles`, without those that have no area.
///
/// A corner without a normal gets the mean of the normals of the faces around its position,
/// weighted by their angles there; faces turned away by more than `crease` (radians, below a quarter
/// turn) do not count, so that edges stay sharp. Angle weights make the result independent of how
/// faces were cut into triangles (Thürmer & Wüthrich 1998).
pub fn smoothed(triangles: &[[Corner; 3]], crease: f32) -> Mesh {
    let solid: Vec<&[Corner; 3]> =
        triangles.iter().filter(|[a, b, c]| !is_flat(a.position, b.position, c.position)).collect();
    let mut wedges: HashMap<[u32; 3], Vec<Wedge>> = HashMap::new();
    for triangle in &solid {
        let normal = face_normal(triangle);
        for place in 0..3 {
            let [here, next, last] = [0, 1, 2].map(|k| triangle[(place + k) % 3].position);
            let angle = (next - here).angle_between(last - here);
            wedges.entry(bits(here)).or_default().push((normal, angle));
        }
    }
    let mut mesh = Mesh::default();
    let mut known: HashMap<VertexKey, u32> = HashMap::new();
    for triangle in solid {
        let facing = face_normal(triangle);
        let indices = triangle.map(|corner| {
            let around = &wedges[&bits(corner.position)];
            let given = corner.normal.and_then(Vec3::try_normalize);
            let normal = given.unwrap_or_else(|| mean_normal(around, facing, crease));
            let key = (bits(corner.position), bits(normal), corner.uv.to_array().map(f32::to_bits));
            *known.entry(key).or_insert_with(|| {
                mesh.positions.push(corner.position);
                mesh.normals.push(normal);
                mesh.uvs.push(corner.uv);
                mesh.positions.len() as u32 - 1
            })
        });
        mesh.triangles.push(indices);
    }
    mesh
}

fn face_normal([a, b, c]: &[Corner; 3]) -> Vec3 {
    (b.position - a.position).cross(c.position - a.position).normalize()
}

fn mean_normal(around: &[Wedge], facing: Vec3, crease: f32) -> Vec3 {
    let least = crease.cos() - 1e-4; // a face always counts for itself
    let smooth = around.iter().filter(|(normal, _)| normal.dot(facing) >= least);
    smooth.map(|(normal, angle)| *angle * *normal).sum::<Vec3>().try_normalize().unwrap_or(facing)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::shapes::{cuboid, sphere};

    fn corners(mesh: &Mesh) -> Vec<[Corner; 3]> {
        let corner = |position| Corner { position, normal: None, uv: Vec2::ZERO };
        (0..mesh.triangles.len()).map(|t| mesh.corners(t).map(corner)).collect()
    }

    #[test]
    fn a_round_surface_becomes_smooth() {
        let exact = sphere(1.0, 32, 16);
        let mesh = smoothed(&corners(&exact), 0.7);
        assert_eq!(mesh.triangles.len(), exact.triangles.len());
        for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
            assert!(n.angle_between(*p) < 0.02, "normal {n} at {p}");
        }
        // One vertex a position: 15 rings of 32 and two poles.
        assert_eq!(mesh.positions.len(), 15 * 32 + 2);
    }

    #[test]
    fn the_edges_of_a_box_stay_sharp_and_its_faces_flat() {
        let mesh = smoothed(&corners(&cuboid(Vec3::new(1.0, 2.0, 3.0))), 0.7);
        assert_eq!((mesh.positions.len(), mesh.triangles.len()), (24, 12));
        for (index, triangle) in mesh.triangles.iter().enumerate() {
            let [a, b, c] = mesh.corners(index);
            let facing = (b - a).cross(c - a).normalize();
            for &corner in triangle {
                assert!(mesh.normals[corner as usize].abs_diff_eq(facing, 1e-6));
            }
        }
    }

    #[test]
    fn a_normal_does_not_depend_on_how_faces_are_cut() {
        // Three squares of a cube's corner, one of them cut into four triangles.
        let corner = |x: f32, y: f32, z: f32| Corner {
            position: Vec3::new(x, y, z),
            normal: None,
            uv: Vec2::ZERO,
        };
        let at = corner(0.0, 0.0, 0.0);
        let fan = |points: &[Corner]| -> Vec<[Corner; 3]> {
            points.windows(2).map(|pair| [at, pair[0], pair[1]]).collect()
        };
        let mut triangles = fan(&[corner(1.0, 0.0, 0.0), corner(0.0, 1.0, 0.0)]);
        triangles.extend(fan(&[corner(0.0, 1.0, 0.0), corner(0.0, 0.0, 1.0)]));
        triangles.extend(fan(&[
            corner(0.0, 0.0, 1.0),
            corner(0.2, 0.0, 0.8),
            corner(0.5, 0.0, 0.5),
            corner(0.9, 0.0, 0.1),
            corner(1.0, 0.0, 0.0),
        ]));
        let mesh = smoothed(&triangles, 2.0);
        assert!(mesh.normals[0].abs_diff_eq(Vec3::splat(1.0 / 3.0f32.sqrt()), 1e-5));
    }

    #[test]
    fn triangles_without_area_are_left_out_and_given_normals_kept() {
        let corner = |x: f32, normal| Corner {
            position: Vec3::new(x, x * x, 0.0),
            normal,
            uv: Vec2::new(x, 0.0),
        };
        let flat = [corner(0.0, None), corner(0.0, None), corner(1.0, None)];
        let up = Some(Vec3::new(0.0, 2.0, 0.0));
        let given = [corner(0.0, up), corner(1.0, up), corner(2.0, up)];
        let mesh = smoothed(&[flat, given], 0.7);
        assert_eq!((mesh.positions.len(), mesh.triangles.len()), (3, 1));
        assert!(mesh.normals.iter().all(|&n| n == Vec3::Y));
    }
}
