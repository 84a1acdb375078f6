//! Scene points followed through the truth's mirrors from frame to frame.
//!
//! A track is one point of one object (or one direction of the sky) as one chain of mirrors shows it.
//! It begins at a pixel's centre, moves to where the next frame's mirrored path ends at the point, and
//! ends where the chain does, where something hides the point, or at the picture's border.

use std::collections::HashSet;

use glam::{UVec2, Vec2, Vec3, Vec4, Vec4Swizzles};
use rayon::prelude::*;

use super::displacement::Queue;
use super::field::Target;
use super::judge::{Court, DEPTH_TOLERANCE, at};
use super::mirrors::{Key, Mirrors};
use super::root::centre;
use crate::scene::{Lobe, NO_OBJECT, ObjectId};
use crate::truth::{Chain, Tracer};

/// About so many points are followed at a time: of more pixels, every second or third is.
const POINTS: f32 = 16384.0;

/// How far from where its last step leads a point is looked for.
const LONGEST_STEP_PX: f32 = 32.0;

/// What is followed: it moves with what it is on.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Spot {
    /// A point in its object's space.
    Surface {
        object: ObjectId,
        local: Vec3,
    },
    /// A point of a surface that changes its shape: on a triangle, by the weights of the second and
    /// third corner.
    Wobbling {
        object: ObjectId,
        triangle: u32,
        barycentrics: Vec2,
    },
    Sky {
        direction: Vec3,
    },
}

impl Spot {
    fn shown_by(chain: &Chain, tracer: &Tracer) -> Spot {
        match &chain.shown {
            Some(hit) if tracer.scene().wobbles(hit.object) => Spot::Wobbling {
                object: hit.object,
                triangle: hit.triangle,
                barycentrics: tracer.barycentrics(hit),
            },
            Some(hit) => {
                let from_world = tracer.moment().poses[hit.object as usize].inverse();
                Spot::Surface { object: hit.object, local: from_world.transform_point3(hit.point) }
            }
            None => Spot::Sky { direction: chain.last().outgoing },
        }
    }

    /// The world's point (w = 1) or direction (w = 0) at a tracer's moment.
    fn at(&self, tracer: &Tracer) -> Vec4 {
        match *self {
            Spot::Surface { object, local } => {
                tracer.moment().poses[object as usize].transform_point3(local).extend(1.0)
            }
            Spot::Wobbling { object, triangle, barycentrics } => {
                tracer.point_on(object, triangle, barycentrics).extend(1.0)
            }
            Spot::Sky { direction } => direction.extend(0.0),
        }
    }

    /// The object; [`NO_OBJECT`] for the sky.
    fn object(&self) -> ObjectId {
        match *self {
            Spot::Surface { object, .. } | Spot::Wobbling { object, .. } => object,
            Spot::Sky { .. } => NO_OBJECT,
        }
    }
}

/// One point at one frame.
#[derive(Clone, Debug)]
pub(super) struct Track {
    spot: Spot,
    /// The mirrors it is seen in.
    pub chain: Chain,
    /// Where it is now: a position of the image whose mirrored path ends at it.
    pub at: Vec2,
    /// Where it was a frame before; `None` where the track begins.
    pub before: Option<Vec2>,
    /// The point (w = 1) or direction (w = 0) now, in the world.
    pub point: Vec4,
}

impl Track {
    fn begin(chain: &Chain, pixel: UVec2, tracer: &Tracer) -> Track {
        let spot = Spot::shown_by(chain, tracer);
        let (chain, point) = (chain.clone(), spot.at(tracer));
        Track { spot, chain, at: centre(pixel), before: None, point }
    }

    /// The object it is on; [`NO_OBJECT`] for the sky.
    pub fn object(&self) -> ObjectId {
        self.spot.object()
    }

    pub fn key(&self) -> Key {
        Mirrors::of(&self.chain).key
    }

    /// The track one frame on.
    fn follow(&self, court: &Court, queue: &mut Queue) -> Option<Track> {
        let size = court.truth.size;
        let inside =
            |at: Vec2| at.cmpge(Vec2::ZERO).all() && at.as_uvec2().cmplt(size.into()).all();
        let last = UVec2::from(size).as_vec2() - 0.5;
        let expected = self.before.map_or(self.at, |before| 2.0 * self.at - before);
        let expected = expected.clamp(Vec2::splat(0.5), last);
        let point = self.spot.at(court.tracer);
        let query =
            court.query(Mirrors::of(&self.chain), Target::new(point), expected, LONGEST_STEP_PX)?;
        let root = query.root(queue).filter(|&root| inside(root))?;
        let chain = self.seen_at(root, point, court)?;
        Some(Track { spot: self.spot, chain, at: root, before: Some(self.at), point })
    }

    /// The chain at a position, as long as it is the track's and nothing hides the point.
    fn seen_at(&self, position: Vec2, point: Vec4, court: &Court) -> Option<Chain> {
        let tracer = court.tracer;
        let ray = tracer.moment().camera.ray(court.truth.size, position);
        let chain = tracer.chain(tracer.look(&ray)?, ray.direction, Lobe::Reflected)?;
        let alike = Mirrors::of(&chain).key == self.key()
            && chain.bounces[0].hit.object == self.chain.bounces[0].hit.object;
        let shows = match &chain.shown {
            None => self.object() == NO_OBJECT,
            Some(shown) => {
                let last = chain.last().hit.point;
                let distance = last.distance(point.xyz());
                shown.object == self.object()
                    && (last.distance(shown.point) - distance).abs() <= DEPTH_TOLERANCE * distance
            }
        };
        (alike && shows).then_some(chain)
    }
}

/// All points followed at one frame.
#[derive(Default)]
pub(super) struct Tracks {
    pub live: Vec<Track>,
    /// By live track, its place among those of the frame before; `None` where it has just begun.
    pub parents: Vec<Option<usize>>,
}

impl Tracks {
    /// Moves every track on to the next frame and begins new ones where none is; of two that meet,
    /// the older stays.
    pub fn advance(&mut self, court: &Court) {
        let followed: Vec<Option<Track>> = self
            .live
            .par_iter()
            .map_init(Queue::new, |queue, track| track.follow(court, queue))
            .collect();
        self.live.clear();
        self.parents.clear();
        let mirrors = court.truth.reflector_pixels();
        let stride = (mirrors.len() as f32 / POINTS).sqrt().ceil().max(1.0) as u32;
        let mut taken = HashSet::new();
        for (parent, track) in followed.into_iter().enumerate() {
            let Some(track) = track else { continue };
            if taken.insert(track.at.as_uvec2() / stride) {
                self.live.push(track);
                self.parents.push(Some(parent));
            }
        }
        for pixel in mirrors {
            let Some(chain) = &court.chains[pixel] else { continue };
            let pixel = at(court.truth.size, pixel);
            if taken.insert(pixel / stride) {
                self.live.push(Track::begin(chain, pixel, court.tracer));
                self.parents.push(None);
            }
        }
    }
}
