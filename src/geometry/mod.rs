//! Pure maths: rays, laws of reflection, shapes and their meshes, the camera. No scene, no GPU.

pub mod alhazen;
pub mod angle;
pub mod bezier;
pub mod bvh;
pub mod camera;
pub mod cube;
pub mod depth_rows;
pub mod face_ray;
pub mod latlong;
pub mod mesh;
pub mod optics;
pub mod polynomial;
pub mod proxy;
pub mod random;
pub mod ray_bundle;
pub mod ray_octree;
pub mod reflection_plane;
pub mod shapes;
pub mod sphere_map;
pub mod subdivide;
pub mod texel_line;
pub mod tree;
pub mod wave;
pub mod wide_tree;

pub use camera::{Camera, Projection};
pub use mesh::Mesh;

/// A half line. `direction` has unit length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    pub origin: glam::Vec3,
    pub direction: glam::Vec3,
}

impl Ray {
    /// The point `t` metres along the ray.
    pub fn at(&self, t: f32) -> glam::Vec3 {
        self.origin + t * self.direction
    }
}
