//! A ray over the faces of a cube map. In a face's own coordinates, u and v over the face and
//! w = 1/z, z the depth along the face's axis, a ray is a straight line and a plane is linear: the map
//! is projective. WGSL twin: `shaders/common/face_ray.wgsl`; the walk over cells is that of
//! `shaders/bindings/interval_search.wgsl`.

use glam::{IVec2, Vec2, Vec3, Vec3Swizzles};

use super::cube;

/// A piece of a ray over one face: (u, v, w), u and v in texels, w in 1/m, linear in between.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    pub face: u32,
    pub begin: Vec3,
    pub end: Vec3,
}

impl Segment {
    /// The texels the piece crosses, in order, and the share of it at which each is left: by whole
    /// numbers and parameters that come from these alone (Amanatides & Woo 1987).
    pub fn texels(&self, size: u32) -> Vec<(IVec2, f32)> {
        let way = (self.end - self.begin).xy();
        let steep = Vec2::select(way.abs().cmplt(Vec2::splat(1e-9)), Vec2::splat(1e-9), way);
        let rises = [steep.x > 0.0, steep.y > 0.0];
        let (down, up) = (self.begin.floor(), self.begin.ceil() - 1.0);
        // A ray that crosses two borders at once crosses the vertical one first.
        let first =
            Vec2::new(if rises[0] { down.x } else { up.x }, if rises[1] { up.y } else { down.y });
        let last = IVec2::splat(size as i32 - 1);
        let mut texel = first.as_ivec2().clamp(IVec2::ZERO, last);
        let (mut texels, mut at) = (Vec::new(), 0.0f32);
        loop {
            let border = texel + IVec2::from(rises.map(i32::from));
            let crossing = (border.as_vec2() - self.begin.xy()) / steep;
            at = crossing.min_element().min(1.0).max(at);
            texels.push((texel, at));
            if crossing.x <= crossing.y {
                texel.x += if rises[0] { 1 } else { -1 };
            } else {
                texel.y += if rises[1] { 1 } else { -1 };
            }
            if at >= 1.0 || texel.cmplt(IVec2::ZERO).any() || texel.cmpgt(last).any() {
                return texels;
            }
        }
    }
}

/// Coordinates of a vector on a face: to the right, down, and along the face's axis.
pub fn on_face(face: u32, p: Vec3) -> Vec3 {
    match face {
        0 => Vec3::new(-p.z, -p.y, p.x),
        1 => Vec3::new(p.z, -p.y, -p.x),
        2 => Vec3::new(p.x, p.z, p.y),
        3 => Vec3::new(p.x, -p.z, -p.y),
        4 => Vec3::new(p.x, -p.y, p.z),
        _ => Vec3::new(-p.x, -p.y, -p.z),
    }
}

/// The point, relative to the map's centre, of a place (u, v, w) on a face; w above 0.
pub fn point_of(face: u32, place: Vec3, size: u32) -> Vec3 {
    cube::direction(face, place.xy() / size as f32) / place.z
}

/// The face across the border to the left (0), right (1), top (2) or bottom (3).
fn face_across(face: u32, side: usize) -> u32 {
    let middle = Vec2::splat(0.5);
    let beyond = [Vec2::NEG_X, Vec2::X, Vec2::NEG_Y, Vec2::Y][side];
    cube::face_uv(cube::direction(face, middle + 2.0 * beyond)).0
}

/// The pieces of the ray from `w`, relative to the map's centre, in a unit direction, over a map of
/// `size` texels a side: at most six, from the face `w` is seen on to the one `direction` points to.
///
/// Patow 1995, section 2: all directions the ray is seen in lie between \[W\] and B, at
/// (1 - t) B + t \[W\]; the ray is followed in his 1 - t.
pub fn segments(w: Vec3, direction: Vec3, size: u32) -> Vec<Segment> {
    let far = w.length();
    // From the centre itself every point is seen in the same direction.
    let start = if far > 1e-20 { w / far } else { direction };
    let nearness = 1.0 / far.max(1e-20);
    let mut face = cube::face_uv(start).0;
    let (mut pieces, mut along) = (Vec::new(), 0.0f32);
    for _ in 0..6 {
        let (a, b) = (on_face(face, start), on_face(face, direction));
        let borders = |p: Vec3| [p.z + p.x, p.z - p.x, p.z + p.y, p.z - p.y];
        let (before, after) = (borders(a), borders(b));
        let exit = |side: usize| {
            let at = (before[side] / (before[side] - after[side])).max(along);
            (after[side] < 0.0 && at < 1.0).then_some((at, side))
        };
        let first = (0..4).filter_map(exit).min_by(|x, y| x.0.total_cmp(&y.0));
        let leave = first.map_or(1.0, |(at, _)| at);
        let place = |along: f32| {
            let p = a * (1.0 - along) + b * along;
            let depth = p.z.max(1e-20);
            let uv = (0.5 * (p.xy() / depth + 1.0)).clamp(Vec2::ZERO, Vec2::ONE);
            (size as f32 * uv).extend((1.0 - along) * nearness / depth)
        };
        pieces.push(Segment { face, begin: place(along), end: place(leave) });
        let Some((at, side)) = first else { break };
        (along, face) = (at, face_across(face, side));
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::random::SplitMix64;

    const SIZE: u32 = 64;

    /// Starts about the centre, and unit directions.
    fn rays(seed: u64, count: usize) -> Vec<(Vec3, Vec3)> {
        let mut random = SplitMix64::new(seed);
        let ray = |_| {
            let start = random.within(Vec3::NEG_ONE, Vec3::ONE);
            (start, random.rotation() * Vec3::X)
        };
        (0..count).map(ray).collect()
    }

    #[test]
    fn a_ray_is_straight_on_every_face() {
        for (start, direction) in rays(1, 2000) {
            let pieces = segments(start, direction, SIZE);
            let first = point_of(pieces[0].face, pieces[0].begin, SIZE);
            assert!(first.abs_diff_eq(start, 1e-4), "{start} became {first}");
            let last = pieces[pieces.len() - 1];
            assert_eq!((last.end.z, last.face), (0.0, cube::face_uv(direction).0));
            for piece in &pieces {
                for share in [0.1, 0.5, 0.9] {
                    let place = piece.begin.lerp(piece.end, share);
                    let point = point_of(piece.face, place, SIZE) - start;
                    let off = point.cross(direction).length();
                    assert!(point.dot(direction) > -1e-3);
                    assert!(off <= 2e-4 * (1.0 + point.length()), "{off} m off after {point}");
                }
            }
        }
    }

    #[test]
    fn pieces_follow_one_another_over_seams() {
        let mut crossed = 0;
        for (start, direction) in rays(2, 2000) {
            for pair in segments(start, direction, SIZE).windows(2) {
                let [end, begin] = [(pair[0].face, pair[0].end), (pair[1].face, pair[1].begin)]
                    .map(|(face, place)| cube::direction(face, place.xy() / SIZE as f32));
                assert!(end.abs_diff_eq(begin, 1e-4), "{end} is not {begin}");
                assert!((pair[0].end.z - pair[1].begin.z).abs() <= 1e-3 * pair[0].end.z);
                crossed += 1;
            }
        }
        assert!(crossed > 1000, "only {crossed} seams");
    }

    #[test]
    fn texels_are_neighbours_and_hold_the_ray() {
        for (start, direction) in rays(3, 1000) {
            for piece in segments(start, direction, SIZE) {
                let mut enter = 0.0;
                let texels = piece.texels(SIZE);
                for pair in texels.windows(2) {
                    assert_eq!((pair[1].0 - pair[0].0).abs().element_sum(), 1, "{pair:?}");
                }
                for (texel, leave) in texels {
                    let middle = piece.begin.lerp(piece.end, 0.5 * (enter + leave)).xy();
                    let away = middle - texel.as_vec2() - 0.5;
                    assert!(away.abs().max_element() <= 0.5 + 1e-3, "{away} from {texel}");
                    enter = leave;
                }
                assert!(enter > 1.0 - 1e-4, "the walk ends at {enter}");
            }
        }
    }

    #[test]
    fn rays_along_an_axis_and_from_the_centre_have_pieces_without_nan() {
        for direction in [Vec3::X, Vec3::NEG_Y, Vec3::Z, Vec3::ONE.normalize()] {
            for start in [Vec3::ZERO, 0.5 * direction, -0.5 * direction, 0.3 * Vec3::Y] {
                for piece in segments(start, direction, SIZE) {
                    assert!(!piece.begin.is_nan() && !piece.end.is_nan(), "{piece:?}");
                    assert!(!piece.texels(SIZE).is_empty());
                }
            }
        }
    }
}
