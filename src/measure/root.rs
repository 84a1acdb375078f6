//! Positions of the image whose mirrored path ends at a target: found on triangles of pixel
//! centres, polished by tracing.

use glam::{Mat2, UVec2, Vec2, Vec3};

use super::field::{Corner, Segment, Target};

/// How far outside its triangle, in weights, a linear root still counts: the field is not linear,
/// and what one triangle gives away its neighbour may not take.
pub(super) const MARGIN: f32 = 0.25;

/// How far from a rim pixel its linear root may lie: towards a silhouette directions change with
/// the root of the distance, so a root less than a pixel outside seems more than two away.
pub(super) const RIM_PX: f32 = 2.5;

/// Steps shorter than this end the polishing, pixels; under the 0.05 the measure promises.
const TOLERANCE_PX: f32 = 0.005;

/// What the measure promises, pixels: no root is off by more.
pub(super) const CONFIRMED_PX: f32 = 0.05;

/// Longest step of the polishing, pixels.
const LONGEST_STEP_PX: f32 = 2.0;

const MOST_STEPS: usize = 12;

/// How a segment's direction misses the target, as the two components in a plane across it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Miss {
    target: Target,
    right: Vec3,
    up: Vec3,
}

impl Miss {
    /// Measured across `direction`, which should be near those that will be measured.
    pub fn new(target: Target, direction: Vec3) -> Self {
        let (right, up) = direction.any_orthonormal_pair();
        Miss { target, right, up }
    }

    /// Zero where the segment, prolonged, passes through the target; `None` behind it.
    pub fn of(&self, segment: &Segment) -> Option<Vec2> {
        let towards = self.target.seen_from(segment.origin);
        let off = towards - segment.direction;
        (towards.dot(segment.direction) > 0.0)
            .then(|| Vec2::new(off.dot(self.right), off.dot(self.up)))
    }
}

/// A position where the miss is about zero, and how the miss changes around it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Guess {
    /// Where to start.
    pub at: Vec2,
    /// Where the root seems to be.
    pub expected: Vec2,
    pub miss: Miss,
    /// Change of the miss by x and y, a pixel.
    pub slope: Mat2,
    /// The miss at the position where it is known already.
    pub off: Option<Vec2>,
}

impl Guess {
    /// From the position to where the root seems to be by the slope there, pixels.
    pub fn step(&self) -> Option<Vec2> {
        step(&self.slope, self.off?)
    }
}

/// The root of the miss on a triangle of pixel centres, taken to be linear between them.
pub(super) fn on_triangle(target: Target, corners: [Corner; 3]) -> Option<Guess> {
    let (guess, weights) = linear(target, corners)?;
    let inside = weights.min_element() >= -MARGIN && weights.element_sum() <= 1.0 + MARGIN;
    inside.then_some(guess)
}

/// The first of the corners, a pixel at the rim of its chain, if a root may lie around it.
pub(super) fn at_rim(target: Target, corners: [Corner; 3]) -> Option<Guess> {
    let (at, here) = corners[0];
    let (guess, _) = linear(target, corners)?;
    (guess.at.distance(at) < RIM_PX).then(|| Guess { at, off: guess.miss.of(&here), ..guess })
}

/// The root of the miss if it were linear as on a triangle, and the weights of its second and
/// third corner there.
fn linear(target: Target, corners: [Corner; 3]) -> Option<(Guess, Vec2)> {
    let [(p0, a), (p1, b), (p2, c)] = corners;
    let mean = (a.direction + b.direction + c.direction).try_normalize()?;
    let miss = Miss::new(target, mean);
    let [m0, m1, m2] = [miss.of(&a)?, miss.of(&b)?, miss.of(&c)?];
    let by_weights = Mat2::from_cols(m1 - m0, m2 - m0);
    if by_weights.determinant() == 0.0 {
        return None;
    }
    let weights = by_weights.inverse() * -m0;
    let by_pixels = Mat2::from_cols(p1 - p0, p2 - p0);
    let at = p0 + by_pixels * weights;
    Some((
        Guess { at, expected: at, miss, slope: by_weights * by_pixels.inverse(), off: None },
        weights,
    ))
}

/// Where a pixel's centre is in the image.
pub(super) fn centre(pixel: UVec2) -> Vec2 {
    pixel.as_vec2() + 0.5
}

/// The slope at a position, from rays traced `step_px` beside it on whichever side continues the chain.
pub(super) fn traced_guess(
    target: Target,
    at: Vec2,
    step_px: f32,
    trace: impl Fn(Vec2) -> Option<Segment>,
) -> Option<Guess> {
    let here = trace(at)?;
    let miss = Miss::new(target, here.direction);
    let off = miss.of(&here)?;
    let slope_along = |axis: Vec2| {
        [step_px, -step_px].into_iter().find_map(|step| {
            let there = miss.of(&trace(at + step * axis)?)?;
            Some((there - off) / step)
        })
    };
    let slope = Mat2::from_cols(slope_along(Vec2::X)?, slope_along(Vec2::Y)?);
    Some(Guess { at, expected: at, miss, slope, off: Some(off) })
}

/// Follow a guess to the root by tracing, with Broyden's updates of the slope (C. G. Broyden,
/// Math. Comp. 1965): one path a step. `None` when it leaves the chain or does not settle.
pub(super) fn polish(guess: Guess, trace: impl Fn(Vec2) -> Option<Segment>) -> Option<Vec2> {
    let Guess { mut at, mut miss, mut slope, off, .. } = guess;
    let target = miss.target;
    let mut off = off.or_else(|| miss.of(&trace(at)?))?;
    for _ in 0..MOST_STEPS {
        let full = step(&slope, off)?;
        if full.length() < TOLERANCE_PX {
            // A slope taken across a silhouette is so steep that any miss seems next to nothing in
            // pixels, so the slope right here has the last word.
            let fresh = traced_guess(target, at, CONFIRMED_PX, &trace)?;
            (miss, slope, off) = (fresh.miss, fresh.slope, fresh.off?);
            if step(&slope, off)?.length() < CONFIRMED_PX {
                return Some(at + full);
            }
            continue;
        }
        // A step off the reflector, or onto another chain, is tried again shorter.
        let full = full.clamp_length_max(LONGEST_STEP_PX);
        let (step, next) = [1.0, 0.5, 0.25, 0.125].into_iter().find_map(|share| {
            let step = share * full;
            Some((step, miss.of(&trace(at + step)?)?))
        })?;
        let surprise = (next - off - slope * step) / step.length_squared();
        slope += Mat2::from_cols(surprise * step.x, surprise * step.y);
        at += step;
        off = next;
    }
    None
}

/// Newton's step from where the miss is `off`.
fn step(slope: &Mat2, off: Vec2) -> Option<Vec2> {
    let step = (slope.determinant() != 0.0).then(|| slope.inverse() * -off)?;
    step.is_finite().then_some(step)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rays above a paraboloid mirror lit from above, a hundredth of a metre a pixel; none left
    /// of `end`.
    fn ray(position: Vec2, end: f32) -> Option<Segment> {
        let Vec2 { x, y } = 0.01 * position;
        let direction = Vec3::new(2.0 * x, 2.0 * y, 1.0 - x * x - y * y).normalize();
        (position.x >= end)
            .then_some(Segment { origin: Vec3::new(x, y, -x * x - y * y), direction })
    }

    fn corner(position: Vec2) -> Corner {
        (position, ray(position, f32::NEG_INFINITY).unwrap())
    }

    /// What the ray at a position shows `metres` away.
    fn targets(position: Vec2, metres: f32) -> [Target; 2] {
        let (_, Segment { origin, direction }) = corner(position);
        [Target::Point(origin + metres * direction), Target::Direction(direction)]
    }

    #[test]
    fn a_triangle_finds_the_roots_within_it_and_polishing_makes_them_exact() {
        for k in 0..200u32 {
            let s = k as f32;
            let first = UVec2::new(k % 50, k * 7 % 40);
            let (v, w) = ((s * 0.37).fract(), (s * 0.73).fract());
            let weights = if v + w > 1.0 { Vec2::new(1.0 - v, 1.0 - w) } else { Vec2::new(v, w) };
            let root = centre(first) + weights;
            let corners =
                [UVec2::ZERO, UVec2::X, UVec2::Y].map(|step| corner(centre(first + step)));
            for target in targets(root, 2.0) {
                let guess = on_triangle(target, corners).unwrap();
                assert!(guess.expected.distance(root) < 0.05);
                let found = polish(guess, |position| ray(position, f32::NEG_INFINITY)).unwrap();
                assert!(found.distance(root) < 0.02, "{found} instead of {root}");
            }
            for target in targets(root + 3.0, 2.0) {
                assert!(on_triangle(target, corners).is_none());
            }
        }
    }

    #[test]
    fn a_rim_pixel_finds_the_roots_around_it() {
        let at = Vec2::new(20.5, 11.5);
        let corners = [at, at + Vec2::X, at + Vec2::Y].map(corner);
        for target in targets(at - Vec2::new(1.3, 0.8), 2.0) {
            let guess = at_rim(target, corners).unwrap();
            assert_eq!(guess.at, at);
            let found = polish(guess, |position| ray(position, 18.0)).unwrap();
            assert!(found.distance(at - Vec2::new(1.3, 0.8)) < 0.02);
            // Where the mirror ends before, there is none.
            assert!(polish(guess, |position| ray(position, 19.9)).is_none());
        }
        for target in targets(at + 4.0, 2.0) {
            assert!(at_rim(target, corners).is_none());
        }
    }

    #[test]
    fn a_traced_guess_looks_to_the_side_that_is_there() {
        let at = Vec2::new(20.5, 11.5);
        for target in targets(at + 0.4, 2.0) {
            for end in [20.4, f32::NEG_INFINITY] {
                let guess = traced_guess(target, at, 0.25, |position| ray(position, end)).unwrap();
                let found = polish(guess, |position| ray(position, end)).unwrap();
                assert!(found.distance(at + 0.4) < 0.02);
            }
            assert!(traced_guess(target, at, 0.25, |position| ray(position, 21.0)).is_none());
        }
    }

    #[test]
    fn a_slope_across_a_silhouette_does_not_make_a_root() {
        let at = Vec2::new(20.5, 11.5);
        // A root is four pixels away, where no ray is.
        for target in targets(at - Vec2::new(4.0, 0.0), 2.0) {
            let guess = traced_guess(target, at, 0.25, |position| ray(position, 20.0)).unwrap();
            let steep = Guess { slope: guess.slope * 2000.0, ..guess };
            assert!((steep.slope.inverse() * guess.off.unwrap()).length() < TOLERANCE_PX);
            assert!(polish(steep, |position| ray(position, 20.0)).is_none());
        }
    }
}
