//! Triangle meshes.

use glam::{Vec2, Vec3};

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

    /// The mesh enlarged about the origin. `factor` is positive, so normals stay.
    pub fn scaled(mut self, factor: f32) -> Mesh {
        for position in &mut self.positions {
            *position *= factor;
        }
        self
    }

    /// The mesh seen from its other side: normals and winding turned.
    pub fn flipped(mut self) -> Mesh {
        for normal in &mut self.normals {
            *normal = -*normal;
        }
        for [_, b, c] in &mut self.triangles {
            std::mem::swap(b, c);
        }
        self
    }

    /// Appends another mesh.
    pub fn append(&mut self, other: Mesh) {
        let first = self.positions.len() as u32;
        self.positions.extend(other.positions);
        self.normals.extend(other.normals);
        self.uvs.extend(other.uvs);
        self.triangles.extend(other.triangles.iter().map(|t| t.map(|i| first + i)));
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
