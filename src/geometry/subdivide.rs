//! Meshes with no edge longer than asked: methods that move vertices bend a mesh only at its vertices
//! (Estalella et al. 2006, section 6; Martin & Popescu 2004, section 5).

use std::collections::HashMap;

use glam::Vec3;

use super::Mesh;

/// A mesh cut into smaller triangles that lie in those it came from.
#[derive(Clone, Debug, PartialEq)]
pub struct Subdivided {
    /// The same surface with the same interpolated normals and texture coordinates. A normal added on
    /// an edge is the mean of the ends', so it may be shorter than a unit vector.
    pub mesh: Mesh,
    /// The triangle of the original mesh each triangle lies in.
    pub sources: Vec<u32>,
}

/// Cuts every edge longer than `edge` metres in the middle, again and again, until none is left.
///
/// Whether and where an edge is cut depends on its two ends alone, so triangles that meet in an edge
/// still meet after it, across seams of doubled vertices too. Two runs give the same mesh.
///
/// `None` where the mesh would have more than `limit` triangles.
pub fn subdivide(mesh: &Mesh, edge: f32, limit: usize) -> Option<Subdivided> {
    let mut cut = Cutter { mesh: mesh.clone(), middles: HashMap::new(), edge_squared: edge * edge };
    let mut triangles: Vec<([u32; 3], u32)> = mesh.triangles.iter().copied().zip(0..).collect();
    loop {
        let mut finer = Vec::with_capacity(triangles.len());
        for &(triangle, source) in &triangles {
            cut.triangle(triangle, |part| finer.push((part, source)));
        }
        if finer.len() > limit {
            return None;
        }
        let done = finer.len() == triangles.len();
        triangles = finer;
        if done {
            break;
        }
    }
    let (parts, sources) = triangles.into_iter().unzip();
    Some(Subdivided { mesh: Mesh { triangles: parts, ..cut.mesh }, sources })
}

struct Cutter {
    mesh: Mesh,
    /// The vertex in the middle of each edge cut so far; ends in rising order.
    middles: HashMap<[u32; 2], u32>,
    edge_squared: f32,
}

impl Cutter {
    /// The pieces of a triangle after its long edges were cut once.
    fn triangle(&mut self, triangle: [u32; 3], mut push: impl FnMut([u32; 3])) {
        let middles = [0, 1, 2].map(|i| self.middle(triangle[i], triangle[(i + 1) % 3]));
        // Turned so that the pattern of cut edges is one of four.
        let turn = match middles.map(|m| m.is_some()) {
            [false, true, false] | [false, true, true] => 1,
            [false, false, true] | [true, false, true] => 2,
            _ => 0,
        };
        let [a, b, c] = [0, 1, 2].map(|i| triangle[(i + turn) % 3]);
        match [0, 1, 2].map(|i| middles[(i + turn) % 3]) {
            [Some(ab), Some(bc), Some(ca)] => {
                push([a, ab, ca]);
                push([ab, b, bc]);
                push([ca, bc, c]);
                push([ab, bc, ca]);
            }
            [Some(ab), Some(bc), None] => {
                push([ab, b, bc]);
                // The shorter diagonal of what is left.
                if self.length_squared(a, bc) <= self.length_squared(ab, c) {
                    push([a, ab, bc]);
                    push([a, bc, c]);
                } else {
                    push([a, ab, c]);
                    push([ab, bc, c]);
                }
            }
            [Some(ab), ..] => {
                push([a, ab, c]);
                push([ab, b, c]);
            }
            _ => push([a, b, c]),
        }
    }

    /// The vertex in the middle of a long edge.
    fn middle(&mut self, a: u32, b: u32) -> Option<u32> {
        if self.length_squared(a, b) <= self.edge_squared {
            return None;
        }
        let mesh = &mut self.mesh;
        Some(*self.middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
            let (i, j) = (a as usize, b as usize);
            mesh.positions.push(0.5 * (mesh.positions[i] + mesh.positions[j]));
            mesh.normals.push(0.5 * (mesh.normals[i] + mesh.normals[j]));
            mesh.uvs.push(0.5 * (mesh.uvs[i] + mesh.uvs[j]));
            mesh.positions.len() as u32 - 1
        }))
    }

    fn length_squared(&self, a: u32, b: u32) -> f32 {
        let at = |i: u32| -> Vec3 { self.mesh.positions[i as usize] };
        at(a).distance_squared(at(b))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::shapes::{cuboid, cylinder};

    fn area(mesh: &Mesh, triangle: usize) -> f32 {
        let [a, b, c] = mesh.corners(triangle);
        0.5 * (b - a).cross(c - a).length()
    }

    #[test]
    fn no_edge_is_longer_and_no_surface_is_lost() {
        let mesh = cylinder(0.15, 3.0, true, 24);
        let fine = subdivide(&mesh, 0.2, usize::MAX).unwrap();
        assert!(fine.mesh.triangles.len() > 4 * mesh.triangles.len());
        let mut covered = vec![0.0; mesh.triangles.len()];
        for (i, &source) in fine.sources.iter().enumerate() {
            let [a, b, c] = fine.mesh.corners(i);
            for (p, q) in [(a, b), (b, c), (c, a)] {
                assert!(p.distance(q) <= 0.2 * 1.00001, "an edge of {} m", p.distance(q));
            }
            covered[source as usize] += area(&fine.mesh, i);
            let [a, b, c] = mesh.corners(source as usize);
            let [d, e, f] = fine.mesh.corners(i);
            let same = (b - a).cross(c - a).dot((e - d).cross(f - d));
            assert!(same > 0.0, "triangle {i} was turned over");
        }
        for (i, covered) in covered.iter().enumerate() {
            assert!((covered - area(&mesh, i)).abs() < 1e-5, "{covered} of triangle {i}");
        }
        assert_eq!(fine, subdivide(&mesh, 0.2, usize::MAX).unwrap());
    }

    /// Every edge has a partner: by position, because creases double vertices.
    #[test]
    fn a_closed_mesh_stays_closed() {
        let fine = subdivide(&cuboid(Vec3::new(1.0, 0.3, 0.7)), 0.25, usize::MAX).unwrap().mesh;
        let bits = |p: Vec3| p.to_array().map(f32::to_bits);
        let mut open: HashMap<_, i32> = HashMap::new();
        for i in 0..fine.triangles.len() {
            let corners = fine.corners(i).map(bits);
            for (a, b) in [(0, 1), (1, 2), (2, 0)].map(|(a, b)| (corners[a], corners[b])) {
                *open.entry((a.min(b), a.max(b))).or_default() += if a < b { 1 } else { -1 };
            }
        }
        assert!(open.len() > 100 && open.values().all(|&count| count == 0), "edges are open");
    }

    #[test]
    fn a_fine_mesh_is_left_alone_and_an_endless_one_refused() {
        let mesh = cuboid(Vec3::ONE);
        let same = subdivide(&mesh, 2.0, 12).unwrap();
        assert_eq!((same.mesh, same.sources), (mesh.clone(), (0..12).collect()));
        assert_eq!(subdivide(&mesh, 0.1, 1000), None);
    }
}
