//! Positions of the image whose mirrored path ends at a target: found on triangles of pixel
//! centres, polished by tracing.

use glam::{Mat2, Vec2, Vec3};

use super::field::{Corner, Segment, Target};

/// How far outside its triangle, in weights, a linear root still counts: the field is not linear,
/// and what one triangle gives away its neighbour may not take.
const MARGIN: f32 = 0.25;

/// Steps shorter than this end the polishing, pixels; under the 0.05 the measure promises.
const TOLERANCE_PX: f32 = 0.02;

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
    pub at: Vec2,
    pub miss: Miss,
    /// Change of the miss by x and y, a pixel.
    pub slope: Mat2,
}

/// The root of the miss on a triangle of pixel centres, taken to be linear between them.
pub(super) fn on_triangle(target: Target, corners: [Corner; 3]) -> Option<Guess> {
    let [(p0, a), (p1, b), (p2, c)] = corners;
    let mean = (a.direction + b.direction + c.direction).try_normalize()?;
    let miss = Miss::new(target, mean);
    let [m0, m1, m2] = [miss.of(&a)?, miss.of(&b)?, miss.of(&c)?];
    let by_weights = Mat2::from_cols(m1 - m0, m2 - m0);
    if by_weights.determinant() == 0.0 {
        return None;
    }
    let weights = by_weights.inverse() * -m0;
    let inside = weights.min_element() >= -MARGIN && weights.element_sum() <= 1.0 + MARGIN;
    let by_pixels = Mat2::from_cols(p1 - p0, p2 - p0);
    inside.then(|| Guess {
        at: p0 + by_pixels * weights,
        miss,
        slope: by_weights * by_pixels.inverse(),
    })
}

/// The slope at a position, from traced neighbours on whichever side continues the chain.
pub(super) fn traced_guess(
    target: Target,
    at: Vec2,
    trace: impl Fn(Vec2) -> Option<Segment>,
) -> Option<Guess> {
    const STEP_PX: f32 = 0.25;
    let here = trace(at)?;
    let miss = Miss::new(target, here.direction);
    let centre = miss.of(&here)?;
    let slope_along = |axis: Vec2| {
        [STEP_PX, -STEP_PX].into_iter().find_map(|step| {
            let there = miss.of(&trace(at + step * axis)?)?;
            Some((there - centre) / step)
        })
    };
    Some(Guess { at, miss, slope: Mat2::from_cols(slope_along(Vec2::X)?, slope_along(Vec2::Y)?) })
}

/// Follow a guess to the root by tracing, with Broyden's updates of the slope (C. G. Broyden,
/// Math. Comp. 1965): one path a step. `None` when it leaves the chain or does not settle.
pub(super) fn polish(guess: Guess, trace: impl Fn(Vec2) -> Option<Segment>) -> Option<Vec2> {
    let Guess { mut at, miss, mut slope } = guess;
    let traced = |position: Vec2| miss.of(&trace(position)?);
    let mut off = traced(at)?;
    for _ in 0..MOST_STEPS {
        if slope.determinant() == 0.0 {
            return None;
        }
        let full = slope.inverse() * -off;
        if !full.is_finite() {
            return None;
        }
        if full.length() < TOLERANCE_PX {
            return Some(at + full);
        }
        // A step off the reflector, or onto another chain, is tried again shorter.
        let full = full.clamp_length_max(LONGEST_STEP_PX);
        let (step, next) = [1.0, 0.5, 0.25].into_iter().find_map(|share| {
            let step = share * full;
            Some((step, traced(at + step)?))
        })?;
        let surprise = (next - off - slope * step) / step.length_squared();
        slope += Mat2::from_cols(surprise * step.x, surprise * step.y);
        at += step;
        off = next;
    }
    None
}
