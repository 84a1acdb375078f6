//! Cube maps: directions to faces and back, as Vulkan does it.
//!
//! Vulkan specification, "Cube Map Face Selection and Transformations": the face is that of the
//! largest component (z before y before x where they tie), `s = (sc / |rc| + 1) / 2`,
//! `t = (tc / |rc| + 1) / 2`, with
//!
//! | face | 0: +x | 1: -x | 2: +y | 3: -y | 4: +z | 5: -z |
//! |------|-------|-------|-------|-------|-------|-------|
//! | sc   | -z    | +z    | +x    | +x    | +x    | -x    |
//! | tc   | -y    | -y    | +z    | -z    | -y    | -y    |

use glam::{Vec2, Vec3};

/// The face a direction falls on, and where in it: (0, 0) is the corner of the first texel.
///
/// `direction` need not have unit length, but must not be zero.
pub fn face_uv(direction: Vec3) -> (u32, Vec2) {
    let d = direction;
    let a = d.abs();
    let (face, sc, tc, rc) = if a.z >= a.x && a.z >= a.y {
        if d.z > 0.0 { (4, d.x, -d.y, a.z) } else { (5, -d.x, -d.y, a.z) }
    } else if a.y >= a.x {
        if d.y > 0.0 { (2, d.x, d.z, a.y) } else { (3, d.x, -d.z, a.y) }
    } else if d.x > 0.0 {
        (0, -d.z, -d.y, a.x)
    } else {
        (1, d.z, -d.y, a.x)
    };
    (face, Vec2::new(0.5 * (sc / rc + 1.0), 0.5 * (tc / rc + 1.0)))
}

/// The direction (not normalised: its largest component is 1) of a point of a face, `face` below 6.
pub fn direction(face: u32, uv: Vec2) -> Vec3 {
    let s = 2.0 * uv.x - 1.0;
    let t = 2.0 * uv.y - 1.0;
    match face {
        0 => Vec3::new(1.0, -t, -s),
        1 => Vec3::new(-1.0, -t, s),
        2 => Vec3::new(s, 1.0, t),
        3 => Vec3::new(s, -1.0, -t),
        4 => Vec3::new(s, -t, 1.0),
        _ => Vec3::new(-s, -t, -1.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_lie_along_their_axes() {
        let axes = [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z];
        for (face, axis) in axes.into_iter().enumerate() {
            assert_eq!(direction(face as u32, Vec2::splat(0.5)), axis);
            assert_eq!(face_uv(axis), (face as u32, Vec2::splat(0.5)));
        }
    }

    #[test]
    fn every_point_of_every_face_comes_back() {
        for face in 0..6 {
            for i in 0..32 {
                for j in 0..32 {
                    let uv = (Vec2::new(i as f32, j as f32) + Vec2::splat(0.5)) / 32.0;
                    let (back, uv_back) = face_uv(3.7 * direction(face, uv));
                    assert_eq!(back, face);
                    assert!(uv_back.abs_diff_eq(uv, 1e-6), "face {face}: {uv} became {uv_back}");
                }
            }
        }
    }

    /// Seen from inside, every face is a mirrored view: s to the right and t down make the
    /// outward axis. A face with one axis turned would break this.
    #[test]
    fn faces_are_left_handed() {
        for face in 0..6 {
            let centre = direction(face, Vec2::splat(0.5));
            let right = direction(face, Vec2::new(1.0, 0.5)) - centre;
            let down = direction(face, Vec2::new(0.5, 1.0)) - centre;
            assert_eq!(right.cross(down), -centre, "face {face}");
        }
    }
}
