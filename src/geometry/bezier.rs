//! Bicubic Bezier patches.

use glam::{Vec2, Vec3};

use super::Mesh;

/// Sixteen control points, row-major: v chooses the row, u the place in it.
pub type Patch = [Vec3; 16];

/// The surface of `patches`, each cut into `steps` by `steps` quads.
///
/// Normals are the exact ones, also at poles where a whole row of control points coincides; they
/// point along dP/du x dP/dv. Texture coordinates are (u, v) of each patch.
pub fn tessellate(patches: &[Patch], steps: u32) -> Mesh {
    let mut mesh = Mesh::default();
    for patch in patches {
        mesh.append_grid(steps, steps, |column, row| {
            let uv = Vec2::new(column as f32, row as f32) / steps as f32;
            let (position, normal) = point(patch, uv);
            (position, normal, uv)
        });
    }
    mesh.without_unused()
}

/// Position and unit normal of a patch at `uv` in [0, 1] x [0, 1].
pub fn point(patch: &Patch, uv: Vec2) -> (Vec3, Vec3) {
    let (bu, du) = (basis(uv.x), derivative(uv.x));
    let (bv, dv) = (basis(uv.y), derivative(uv.y));
    let position = sum(patch, bu, bv);
    let mut along_u = sum(patch, du, bv);
    let mut along_v = sum(patch, bu, dv);
    // At a pole one derivative vanishes. Its direction nearby is that of the mixed derivative,
    // taken away from the pole: dP/du(u, v + h) = dP/du + h d2P/dudv.
    let mixed = sum(patch, du, dv);
    let longest = along_u.length().max(along_v.length()).max(mixed.length());
    if along_u.length() <= VANISHING * longest {
        along_u = if uv.y < 0.5 { mixed } else { -mixed };
    } else if along_v.length() <= VANISHING * longest {
        along_v = if uv.x < 0.5 { mixed } else { -mixed };
    }
    (position, along_u.cross(along_v).normalize())
}

/// A derivative this much shorter than the others is the rounding of zero.
const VANISHING: f32 = 1e-5;

fn sum(patch: &Patch, u: [f32; 4], v: [f32; 4]) -> Vec3 {
    (0..16).map(|i| u[i % 4] * v[i / 4] * patch[i]).sum()
}

/// The cubic Bernstein polynomials.
fn basis(t: f32) -> [f32; 4] {
    let s = 1.0 - t;
    [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
}

/// Their derivatives.
fn derivative(t: f32) -> [f32; 4] {
    let s = 1.0 - t;
    [-3.0 * s * s, 3.0 * s * s - 6.0 * s * t, 6.0 * s * t - 3.0 * t * t, 3.0 * t * t]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x = 2 u - 1, z = 1 - 2 v, y = x^2 - z^2: a cubic patch holds it exactly.
    fn saddle() -> Patch {
        // Control values of t^2 over [-1, 1].
        let square = [1.0, -1.0 / 3.0, -1.0 / 3.0, 1.0];
        let line = [-1.0, -1.0 / 3.0, 1.0 / 3.0, 1.0];
        std::array::from_fn(|i| Vec3::new(line[i % 4], square[i % 4] - square[i / 4], -line[i / 4]))
    }

    #[test]
    fn a_saddle_has_the_positions_and_normals_of_its_closed_form() {
        let mesh = tessellate(&[saddle()], 9);
        assert_eq!(mesh.positions.len(), 100);
        for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
            assert!((p.y - (p.x * p.x - p.z * p.z)).abs() < 1e-5);
            let expected = Vec3::new(-2.0 * p.x, 1.0, 2.0 * p.z).normalize();
            assert!(n.abs_diff_eq(expected, 1e-5), "normal {n} at {p}, expected {expected}");
        }
    }

    /// A dome over a quarter turn whose last row of control points is one point.
    #[test]
    fn a_pole_has_the_normal_of_its_neighbourhood_and_no_flat_triangles() {
        let ring = |radius: f32, y: f32| {
            let c = 0.552_285; // of a quarter circle
            [(1.0, 0.0), (1.0, -c), (c, -1.0), (0.0, -1.0)]
                .map(|(x, z)| Vec3::new(radius * x, y, radius * z))
        };
        let rows = [ring(1.0, 0.0), ring(0.8, 0.7), ring(0.4, 1.0), ring(0.0, 1.0)];
        let patch: Patch = std::array::from_fn(|i| rows[i / 4][i % 4]);
        for u in [0.0, 0.3, 1.0] {
            assert!(point(&patch, Vec2::new(u, 1.0)).1.abs_diff_eq(Vec3::Y, 1e-5));
            for v in [0.1, 0.5, 0.9, 0.99] {
                let (position, normal) = point(&patch, Vec2::new(u, v));
                assert!(normal.dot(position) > 0.0, "{normal} at {position} points inwards");
            }
        }
        let mesh = tessellate(&[patch], 8);
        assert_eq!(mesh.triangles.len(), 2 * 8 * 8 - 8);
    }
}
