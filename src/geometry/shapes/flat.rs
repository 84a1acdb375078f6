//! Rectangles and boxes.

use glam::{Vec2, Vec3};

use crate::geometry::Mesh;

/// A rectangle of `size` metres along x and z about the origin, seen from above (+y).
/// Texture coordinates are metres from the centre: u along +x, v along -z.
pub fn plane(size: Vec2) -> Mesh {
    let mut mesh = Mesh::default();
    append_rectangle(&mut mesh, Vec3::ZERO, size.x * Vec3::X, -size.y * Vec3::Z);
    mesh
}

/// A box of `size` metres along x, y and z about the origin, seen from outside.
/// Texture coordinates are metres from the centre of each face, v up (on top and bottom: away from
/// the front, +z).
pub fn cuboid(size: Vec3) -> Mesh {
    let (x, y, z) = (size.x * Vec3::X, size.y * Vec3::Y, size.z * Vec3::Z);
    let mut mesh = Mesh::default();
    // Centre, direction to the right and direction up of each face, seen from outside.
    let faces = [(x, -z, y), (-x, z, y), (y, x, -z), (-y, x, z), (z, x, y), (-z, -x, y)];
    for (outward, right, up) in faces {
        append_rectangle(&mut mesh, 0.5 * outward, right, up);
    }
    mesh
}

/// Appends the rectangle about `centre` with the sides `right` and `up`.
fn append_rectangle(mesh: &mut Mesh, centre: Vec3, right: Vec3, up: Vec3) {
    let normal = right.cross(up).normalize();
    let size = Vec2::new(right.length(), up.length());
    mesh.append_grid(1, 1, |column, row| {
        let at = Vec2::new(column as f32, row as f32) - Vec2::splat(0.5);
        (centre + at.x * right + at.y * up, normal, at * size)
    });
}
