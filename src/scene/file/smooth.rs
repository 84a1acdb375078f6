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
/// A corner without a normal gets the mean of the normals of the faces around its position, weighted
/// by their angles there; faces turned away by more than `crease` (radians, below a quarter turn)
/// do not count, so that edges stay sharp. Angle weights make the result independent of how faces were
/// cut into triangles (Thürmer & Wüthrich 1998).
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
