//! Shapes as meshes: vertices and normals from the closed form, triangles counter-clockwise seen
//! from outside, closed shapes watertight (vertices that meet are equal bit by bit).

mod flat;
mod revolution;
#[cfg(test)]
mod tests;

pub use flat::{cuboid, plane};
pub use revolution::{
    Stretch, Sweep, arc_steps, bezier_profile, cylinder, ellipsoid, polyline_profile, revolution,
    sphere, torus,
};
