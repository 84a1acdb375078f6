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
