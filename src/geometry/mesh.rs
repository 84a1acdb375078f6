//! Triangle meshes.

use std::collections::HashMap;

use glam::{DVec3, Vec2, Vec3};

/// An indexed triangle mesh with one normal and one texture coordinate a vertex.
///
/// Triangles are counter-clockwise seen from the side their normals point to. `positions`,
/// `normals` (unit length) and `uvs` have equal lengths; every index is below that length.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Metres, object space.
    pub positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
    /// Metres on planes and boxes, the unit square on closed shapes: what a pattern's size is in.
    pub uvs: Vec<Vec2>,
    pub triangles: Vec<[u32; 3]>,
}

/// Position, unit normal and texture coordinate of one vertex.
pub(super) type Vertex = (Vec3, Vec3, Vec2);

impl Mesh {
    /// The corners of a triangle, counter-clockwise.
    pub fn corners(&self, triangle: usize) -> [Vec3; 3] {
        self.triangles[triangle].map(|i| self.positions[i as usize])
    }

    /// The smallest and largest coordinates; `None` for a mesh without vertices.
    pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
        let (&first, rest) = self.positions.split_first()?;
        Some(rest.iter().fold((first, first), |(low, high), &p| (low.min(p), high.max(p))))
    }

    /// The centroid of its surface; the origin for a mesh without area.
    pub fn centroid(&self) -> Vec3 {
        let parts = (0..self.triangles.len()).map(|triangle| {
            let [a, b, c] = self.corners(triangle).map(|p| p.as_dvec3());
            let area = (b - a).cross(c - a).length();
            (area, area * (a + b + c) / 3.0)
        });
        let (area, moment) =
            parts.fold((0.0, DVec3::ZERO), |(area, moment), (a, m)| (area + a, moment + m));
        if area > 0.0 { (moment / area).as_vec3() } else { Vec3::ZERO }
    }

    /// Whether it has an inside: every edge borders as many triangles in one direction as in the
    /// other, vertices of equal position taken as one.
    pub fn is_closed(&self) -> bool {
        let mut surplus: HashMap<_, i32> = HashMap::new();
        for triangle in &self.triangles {
            let [a, b, c] = triangle.map(|vertex| self.place(vertex));
            for (from, to) in [(a, b), (b, c), (c, a)] {
                let (edge, turn) = if from < to { ((from, to), 1) } else { ((to, from), -1) };
                *surplus.entry(edge).or_default() += turn;
            }
        }
        !self.triangles.is_empty() && surplus.values().all(|&turns| turns == 0)
    }

    /// Of each triangle those on the other side of its edges, each opposite to a corner; `None` at a border.
    /// Vertices of equal position are taken as one.
    pub fn neighbours(&self) -> Vec<[Option<u32>; 3]> {
        let edges = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|vertex| self.place(vertex));
            [(b, c), (c, a), (a, b)]
        };
        let mut owner = HashMap::new();
        for (index, triangle) in self.triangles.iter().enumerate() {
            owner.extend(edges(triangle).map(|edge| (edge, index as u32)));
        }
        let beyond = |(from, to)| owner.get(&(to, from)).copied();
        self.triangles.iter().map(|triangle| edges(triangle).map(beyond)).collect()
    }

    /// The bits of a vertex's position: equal where two vertices are at one place.
    pub(super) fn place(&self, vertex: u32) -> [u32; 3] {
        // Adding zero makes one zero of both.
        (self.positions[vertex as usize] + 0.0).to_array().map(f32::to_bits)
    }

    /// The mesh enlarged about the origin. `factor` is positive, so normals stay.
    pub fn scaled(mut self, factor: f32) -> Mesh {
        for position in &mut self.positions {
            *position *= factor;
        }
        self
    }

    /// Appends `columns * rows` quads over a grid of `(columns + 1) * (rows + 1)` vertices, split
    /// into triangles that are counter-clockwise when the vertex moves right with the column
    /// and up with the row. Where neighbouring vertices coincide, as at the pole of a sphere, the
    /// triangle between them is left out.
    pub(super) fn append_grid(
        &mut self,
        columns: u32,
        rows: u32,
        vertex: impl Fn(u32, u32) -> Vertex,
    ) {
        let first = self.positions.len() as u32;
        for row in 0..=rows {
            for column in 0..=columns {
                let (position, normal, uv) = vertex(column, row);
                self.positions.push(position);
                self.normals.push(normal);
                self.uvs.push(uv);
            }
        }
        for row in 0..rows {
            for column in 0..columns {
                let a = first + row * (columns + 1) + column;
                let (b, c, d) = (a + 1, a + columns + 1, a + columns + 2);
                self.push_unless_flat([a, b, d]);
                self.push_unless_flat([a, d, c]);
            }
        }
    }

    /// Appends a triangle if its area is not zero.
    pub(crate) fn push_unless_flat(&mut self, triangle: [u32; 3]) {
        let [a, b, c] = triangle.map(|i| self.positions[i as usize]);
        if !is_flat(a, b, c) {
            self.triangles.push(triangle);
        }
    }

    /// Drops vertices no triangle uses, such as the doubled ones at a pole.
    pub(super) fn without_unused(self) -> Mesh {
        const UNUSED: u32 = u32::MAX;
        let mut moved = vec![UNUSED; self.positions.len()];
        let mut kept = Mesh::default();
        for triangle in &self.triangles {
            let corners = triangle.map(|i| {
                let i = i as usize;
                if moved[i] == UNUSED {
                    moved[i] = kept.positions.len() as u32;
                    kept.positions.push(self.positions[i]);
                    kept.normals.push(self.normals[i]);
                    kept.uvs.push(self.uvs[i]);
                }
                moved[i]
            });
            kept.triangles.push(corners);
        }
        kept
    }
}

/// Whether a triangle has no area at single precision: its height is below a few roundings of its
/// longest side.
pub(crate) fn is_flat(a: Vec3, b: Vec3, c: Vec3) -> bool {
    let longest =
        (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
    (b - a).cross(c - a).length() <= 4.0 * f32::EPSILON * longest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::shapes::{Sweep, cuboid, cylinder, plane, sphere, torus};

    #[test]
    fn a_centroid_is_of_the_surface_not_of_the_vertices() {
        let mut bowl = sphere(1.0, 64, 64);
        bowl.triangles.retain(|t| t.iter().all(|&i| bowl.positions[i as usize].y < 1e-6));
        // Of a half sphere at half its height (Archimedes), though its vertices crowd at the pole.
        assert!(
            bowl.centroid().abs_diff_eq(Vec3::new(0.0, -0.5, 0.0), 2e-3),
            "{}",
            bowl.centroid()
        );
        assert_eq!(Mesh::default().centroid(), Vec3::ZERO);
    }

    #[test]
    fn what_has_an_inside_is_closed() {
        let ring = |angle| torus(1.0, 0.3, 8, Sweep { slices: 12, angle });
        for closed in [
            sphere(1.0, 12, 6),
            cylinder(0.5, 2.0, true, 7),
            cuboid(Vec3::ONE),
            ring(std::f32::consts::TAU),
        ] {
            assert!(closed.is_closed());
        }
        for open in [plane(Vec2::ONE), cylinder(0.5, 2.0, false, 7), ring(2.0), Mesh::default()] {
            assert!(!open.is_closed());
        }
        let mut turned = sphere(1.0, 12, 6);
        turned.triangles[3].swap(0, 1);
        assert!(!turned.is_closed(), "a triangle that faces the other way");
    }
    #[test]
    fn neighbours_share_an_edge_and_borders_have_none() {
        let mesh = sphere(1.0, 12, 6);
        let neighbours = mesh.neighbours();
        for (index, around) in neighbours.iter().enumerate() {
            for (corner, beyond) in around.iter().enumerate() {
                let beyond = beyond.unwrap() as usize;
                assert!(neighbours[beyond].contains(&Some(index as u32)));
                let [opposite, others] = [index, beyond].map(|triangle| mesh.corners(triangle));
                let shared = opposite.iter().filter(|p| others.contains(p)).count();
                assert!(shared == 2 && !others.contains(&opposite[corner]));
            }
        }
        let [one, other] = plane(Vec2::ONE).neighbours().try_into().unwrap();
        assert_eq!(one.into_iter().flatten().collect::<Vec<_>>(), [1]);
        assert_eq!(other.into_iter().flatten().collect::<Vec<_>>(), [0]);
    }
}
