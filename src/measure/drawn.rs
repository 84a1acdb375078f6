//! Where a frame under test draws scene points.
//!
//! At every pixel centre p it shows a point that belongs at q(p) in the truth; between neighbouring
//! centres the map p -> q is taken to be linear. So a point that belongs at q is drawn where the map
//! reaches q, and `p - q` there, interpolated between pixels that show the same object through
//! the same mirrors, is its displacement. Of a picture shifted as a whole that is the shift, wherever
//! the point falls between pixel centres.
//!
//! Mirrors are those that the record names: where another mirror ends, a picture a little off
//! shows at p what belongs in mirrors that the truth does not show at p. Where they show a point several
//! times, q(p) is the place displaced most like the surroundings of p ([`super::usual`]): by the nearest
//! place, as in `displacement_px`, a steady picture would seem to jump wherever another place
//! becomes the nearest.

use std::collections::HashMap;

use glam::{IVec2, Mat2, UVec2, Vec2, Vec3, Vec4Swizzles};
use rayon::prelude::*;

use super::accuracy::finite;
use super::colour::displayed;
use super::displacement::Queue;
use super::field::Target;
use super::judge::{Answer, Court, DEPTH_TOLERANCE, at};
use super::mirrors::Mirrors;
use super::root::centre;
use super::track::Track;
use super::usual::Usual;
use crate::scene::{FrameRecord, NO_OBJECT, Status};

/// Neighbouring pixels whose points belong farther apart than this do not hang together: the picture
/// is torn between them.
const TORN_PX: f32 = 8.0;

/// A displacement this far from what is usual around it is doubted, pixels.
const STRAY_PX: f32 = 0.05;

/// What is usual is found anew so often; each time, up to so many pixels a pixel of slope are
/// believed. None at first: where the other of a fold's two places was found for most points, the
/// picture seems mirrored in the fold, and a slope would follow that.
const SLOPES: [f32; 4] = [0.0, 0.0, 0.5, 0.5];

/// How far outside a triangle, in weights, a point still counts as in it: rounding must not open
/// cracks between triangles.
const CRACK: f32 = 1e-3;

/// Points at a triangle's corners may be spread so much, in their own spread, around one inside it.
const SPREAD: f32 = 2.0;

/// What a pixel draws.
#[derive(Clone, Copy, Debug)]
struct Spot<'a> {
    answer: Answer,
    /// Those that the record says show it.
    mirrors: Mirrors<'a>,
    /// q: where it belongs, pixels.
    belongs: Vec2,
    /// p - q.
    displacement: Vec2,
}

impl Spot<'_> {
    fn hangs_together(&self, other: &Spot) -> bool {
        let side = |spot: &Spot| (spot.answer.status, spot.answer.ids.object, spot.mirrors.key);
        side(self) == side(other) && self.belongs.distance(other.belongs) <= TORN_PX
    }
}

/// Everything one frame draws in its mirrors.
pub(super) struct Drawn<'a> {
    tested: &'a FrameRecord,
    court: &'a Court<'a>,
    size: UVec2,
    /// By pixel; `None` where nothing is compared or what is shown belongs nowhere.
    spots: Vec<Option<Spot<'a>>>,
    /// By pixel of the truth, the triangles that reach it: those of pixel i are
    /// `reaching[first[i]..first[i + 1]]`.
    first: Vec<u32>,
    reaching: Vec<[u32; 3]>,
}

impl<'a> Drawn<'a> {
    pub fn new(tested: &'a FrameRecord, court: &'a Court<'a>) -> Self {
        let size = UVec2::from(tested.size);
        let known = known(court);
        let spots: Vec<Option<Spot>> = (0..tested.reflector.len())
            .into_par_iter()
            .map_init(Queue::new, |queue, pixel| spot(tested, court, &known, pixel, queue))
            .collect();
        let (first, reaching) = Default::default();
        let mut drawn = Drawn { tested, court, size, spots, first, reaching };
        for steepest in SLOPES {
            drawn.settle(steepest);
        }
        drawn.sort_triangles();
        drawn
    }

    /// Looks for the places of stray points again, where their surroundings make them expected.
    fn settle(&mut self, steepest: f32) {
        let known = |spot: &Spot| (spot.mirrors.key, spot.displacement);
        let known: Vec<_> = self.spots.iter().map(|spot| spot.as_ref().map(known)).collect();
        let usual = Usual::new(self.size, &known, steepest);
        let (court, tested) = (self.court, self.tested);
        self.spots.par_iter_mut().enumerate().for_each_init(Queue::new, |queue, (pixel, spot)| {
            let Some(spot) = spot else { return };
            let pixel = at(tested.size, pixel);
            let usual = usual.at(spot.mirrors.key, pixel);
            let Some(usual) = usual.filter(|usual| usual.distance(spot.displacement) > STRAY_PX)
            else {
                return;
            };
            let target = Target::new(spot.answer.point);
            let expected = centre(pixel) - usual;
            if let Some(root) = court.belongs(spot.mirrors, target, expected, queue) {
                (spot.belongs, spot.displacement) = (root, centre(pixel) - root);
            }
        });
    }

    /// p - q of a track's point, pixels: of the places where it is drawn the one nearest to
    /// `expected`. `None` where it is not drawn.
    pub fn displacement(&self, track: &Track, expected: Vec2) -> Option<Vec2> {
        let pixel = track.at.as_uvec2();
        let cell = (pixel.y * self.size.x + pixel.x) as usize;
        let triangles = &self.reaching[self.first[cell] as usize..self.first[cell + 1] as usize];
        let candidates = triangles.iter().filter_map(|triangle| self.on(*triangle, track));
        candidates
            .min_by(|a, b| a.distance_squared(expected).total_cmp(&b.distance_squared(expected)))
    }

    /// By pixel, its colour less the truth's where what is drawn belongs, both as displayed (0 to 1).
    /// `None` where that is not known.
    pub fn colour_errors(&self) -> Vec<Option<Vec3>> {
        let error = |(pixel, spot): (usize, &Option<Spot>)| {
            let colour = match spot.as_ref()? {
                // Nothing is to be lost by tracing the truth's own pixels again.
                Spot { displacement: Vec2::ZERO, .. } => self.court.truth.colour[pixel],
                Spot { belongs, .. } => self.court.colour(*belongs)?,
            };
            Some(displayed(finite(self.tested.colour[pixel])) - displayed(colour))
        };
        self.spots.par_iter().enumerate().map(error).collect()
    }

    /// Whether a track's point, expected at a displacement, is not there: the truth shows its object all
    /// around it, the frame nowhere around the place. At edges neither is certain.
    pub fn lacks(&self, track: &Track, expected: Vec2) -> bool {
        let truth = self.court.truth;
        let reflector = track.chain.bounces[0].hit.object;
        let is_truths = |pixel: usize| {
            let chain = self.court.chains[pixel].as_ref();
            chain.is_some_and(|chain| Mirrors::of(chain).key == track.key())
                && truth.reflector[pixel] == reflector
                && truth.record.ids[pixel].object == track.object()
        };
        let is_open = |pixel: usize| {
            let answer = Answer::of(Some(&self.tested.record), pixel);
            let other = answer.status == Status::Missing || answer.ids.object != track.object();
            other && [truth, self.tested].map(|frame| frame.reflector[pixel]) == [reflector; 2]
        };
        self.all_around(track.at, is_truths) && self.all_around(track.at + expected, is_open)
    }

    /// Whether something holds of the pixel at a position and its eight neighbours, all in the image.
    fn all_around(&self, position: Vec2, holds: impl Fn(usize) -> bool) -> bool {
        let corner = position.floor().as_ivec2() - 1;
        let steps = (0..9).map(|i| corner + IVec2::new(i % 3, i / 3));
        let inside =
            |at: IVec2| at.cmpge(IVec2::ZERO).all() && at.cmplt(self.size.as_ivec2()).all();
        steps.into_iter().all(|at| inside(at) && holds((at.y * self.size.x as i32 + at.x) as usize))
    }

    /// The displacement of a track's point if it is drawn on a triangle.
    fn on(&self, triangle: [u32; 3], track: &Track) -> Option<Vec2> {
        let [a, b, c] = self.corners(triangle)?;
        if a.mirrors.key != track.key() || a.answer.ids.object != track.object() {
            return None;
        }
        let edges = Mat2::from_cols(b.belongs - a.belongs, c.belongs - a.belongs);
        if edges.determinant() == 0.0 {
            return None;
        }
        let Vec2 { x: v, y: w } = edges.inverse() * (track.at - a.belongs);
        let u = 1.0 - v - w;
        let inside = u.min(v).min(w) >= -CRACK;
        let displacement = u * a.displacement + v * b.displacement + w * c.displacement;
        (inside && shows([a, b, c], [u, v, w], track)).then_some(displacement)
    }

    fn corners(&self, triangle: [u32; 3]) -> Option<[&Spot<'a>; 3]> {
        let [a, b, c] = triangle.map(|pixel| self.spots[pixel as usize].as_ref());
        Some([a?, b?, c?])
    }

    /// The two triangles of four neighbouring pixels, as far as they hang together.
    fn triangles(&self, pixel: UVec2) -> impl Iterator<Item = [u32; 3]> {
        let index = |dx: u32, dy: u32| (pixel.y + dy) * self.size.x + pixel.x + dx;
        let [a, b, c, d] = [index(0, 0), index(1, 0), index(1, 1), index(0, 1)];
        [[a, b, c], [a, c, d]].into_iter().filter(|triangle| {
            self.corners(*triangle).is_some_and(|[a, b, c]| {
                a.hangs_together(b) && b.hangs_together(c) && c.hangs_together(a)
            })
        })
    }

    /// By the pixels of the truth they reach.
    fn sort_triangles(&mut self) {
        let cells = (0..self.size.y.saturating_sub(1))
            .flat_map(|y| (0..self.size.x.saturating_sub(1)).map(move |x| UVec2::new(x, y)));
        let mut reaching: Vec<(u32, [u32; 3])> = Vec::new();
        for triangle in cells.flat_map(|cell| self.triangles(cell)) {
            reaching.extend(self.reached(triangle).map(|pixel| (pixel, triangle)));
        }
        reaching.sort_unstable();
        let pixels = self.size.x * self.size.y;
        let first = (0..=pixels).map(|pixel| reaching.partition_point(|(p, _)| *p < pixel) as u32);
        self.first = first.collect();
        self.reaching = reaching.into_iter().map(|(_, triangle)| triangle).collect();
    }

    /// The truth's pixels in the box around a triangle.
    fn reached(&self, triangle: [u32; 3]) -> impl Iterator<Item = u32> {
        let places = triangle.map(|pixel| self.spots[pixel as usize].map(|spot| spot.belongs));
        let places = || places.into_iter().flatten();
        let low = places().fold(Vec2::INFINITY, Vec2::min) - CRACK * TORN_PX;
        let high = places().fold(Vec2::NEG_INFINITY, Vec2::max) + CRACK * TORN_PX;
        // Conversion to integers saturates at zero.
        let (low, high) = (low.as_uvec2(), high.as_uvec2().min(self.size - 1));
        let width = self.size.x;
        (low.y..=high.y).flat_map(move |y| (low.x..=high.x).map(move |x| y * width + x))
    }
}

/// The first mirrors of the truth's chains by what a record says of them, order and trace.
type Known<'a> = HashMap<(u32, u32), Mirrors<'a>>;

fn known<'a>(court: &'a Court) -> Known<'a> {
    let mut known = HashMap::new();
    for mirrors in court.chains.iter().flatten().flat_map(Mirrors::beginnings) {
        known.entry(mirrors.recorded()).or_insert(mirrors);
    }
    known
}

/// What a pixel draws and where it belongs; `None` where truth and frame see different reflectors,
/// the answer is missing or the truth shows nothing by the mirrors it is of.
fn spot<'a>(
    tested: &FrameRecord,
    court: &'a Court,
    known: &Known<'a>,
    pixel: usize,
    queue: &mut Queue,
) -> Option<Spot<'a>> {
    let truth = court.truth;
    let reflector = tested.reflector[pixel];
    if reflector == NO_OBJECT || reflector != truth.reflector[pixel] {
        return None;
    }
    let chain = court.chains[pixel].as_ref()?;
    let [expected, answer] = [truth, tested].map(|frame| Answer::of(Some(&frame.record), pixel));
    let here = centre(at(tested.size, pixel));
    let recorded = (answer.ids.order(), answer.ids.trace);
    let (mirrors, belongs) = match answer.status {
        Status::Missing => return None,
        _ if answer.equals(&expected) => (Mirrors::of(chain), here),
        _ => {
            let own = Mirrors::beginnings(chain).find(|own| own.recorded() == recorded);
            let mirrors = own.or_else(|| known.get(&recorded).copied())?;
            (mirrors, court.belongs(mirrors, Target::new(answer.point), here, queue)?)
        }
    };
    Some(Spot { answer, mirrors, belongs, displacement: here - belongs })
}

/// Whether what a triangle shows is the track's point, and not another on the same mirrored ray.
fn shows(corners: [&Spot; 3], weights: [f32; 3], track: &Track) -> bool {
    if track.object() == NO_OBJECT {
        return true;
    }
    let points = corners.map(|spot| spot.answer.point.xyz());
    let shown: Vec3 = points.iter().zip(weights).map(|(&point, weight)| weight * point).sum();
    let spread = points.iter().map(|point| point.distance(shown)).fold(0.0, f32::max);
    let point = track.point.xyz();
    let distance = point.distance(track.chain.last().hit.point);
    shown.distance(point) <= SPREAD * spread + DEPTH_TOLERANCE * distance
}
