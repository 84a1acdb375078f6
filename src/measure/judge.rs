//! One pixel's answers against the truth's, one for each lobe of its reflector.

use glam::{UVec2, Vec2, Vec3, Vec4, Vec4Swizzles};
use rayon::prelude::*;

use super::accuracy::Class;
use super::displacement::{Query, Queue, REACH_PX};
use super::field::{Field, Segment, Target};
use super::mirrors::Mirrors;
use super::root::centre;
use crate::geometry::Ray;
use crate::scene::{FrameRecord, Ids, Lobe, ReflectionRecord, Status, shading};
use crate::truth::{Chain, Tracer};

/// Relative difference of distances over which a depth is wrong.
pub(super) const DEPTH_TOLERANCE: f32 = 0.05;

/// What became of one compared pixel: the worse of its lobes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Judged {
    pub missing: bool,
    pub spurious: bool,
    pub wrong_object: bool,
    pub wrong_depth: bool,
    pub unreachable: bool,
    /// Where the answer is of the truth's kind and belongs somewhere.
    pub displacement_px: Option<f32>,
    /// Meaningful with a displacement.
    pub angle_deg: f32,
    /// The pixel's colour with the truth's S and with the answer's, both shaded by the truth.
    pub shaded: [Vec3; 2],
}

impl Judged {
    /// Two equal answers.
    const EQUAL: Judged = Judged {
        missing: false,
        spurious: false,
        wrong_object: false,
        wrong_depth: false,
        unreachable: false,
        displacement_px: Some(0.0),
        angle_deg: 0.0,
        shaded: [Vec3::ZERO; 2],
    };

    /// A pixel of which another lobe became `other`: what is wrong with either is wrong with it.
    fn with(self, other: Judged) -> Judged {
        let displacements = self.displacement_px.zip(other.displacement_px);
        let [[a, b], [c, d]] = [self.shaded, other.shaded];
        Judged {
            missing: self.missing || other.missing,
            spurious: self.spurious || other.spurious,
            wrong_object: self.wrong_object || other.wrong_object,
            wrong_depth: self.wrong_depth || other.wrong_depth,
            unreachable: self.unreachable || other.unreachable,
            displacement_px: displacements.map(|(a, b)| a.max(b)),
            angle_deg: self.angle_deg.max(other.angle_deg),
            shaded: [a + c, b + d],
        }
    }

    pub fn class(&self) -> Class {
        let faults = [
            (self.missing, Class::Missing),
            (self.spurious, Class::Spurious),
            (self.wrong_object, Class::WrongObject),
            (self.wrong_depth, Class::WrongDepth),
            (self.unreachable, Class::Unreachable),
        ];
        faults.into_iter().find(|(fault, _)| *fault).map_or(Class::Placed, |(_, class)| class)
    }
}

/// The part of a record that is compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Answer {
    pub status: Status,
    pub ids: Ids,
    pub point: Vec4,
}

impl Answer {
    const NONE: Answer = Answer { status: Status::Missing, ids: Ids::MISSING, point: Vec4::ZERO };

    /// Of a record, where there is one.
    pub fn of(record: Option<&ReflectionRecord>, pixel: usize) -> Self {
        let Some(record) = record else { return Answer::NONE };
        let (ids, point) = (record.ids[pixel], record.point[pixel]);
        // A point that is not a number is no answer.
        let status = if point.is_finite() { ids.status() } else { Status::Missing };
        Answer { status, ids, point }
    }

    /// Whether both show the same spot of the same surface, whoever found it.
    pub fn equals(&self, other: &Answer) -> bool {
        let spot = |answer: &Answer| (answer.status, answer.ids.object, answer.ids.triangle);
        spot(self) == spot(other) && self.point == other.point
    }
}

const LOBES: [Lobe; 2] = [Lobe::Reflected, Lobe::Refracted];

/// Judge every compared pixel, in that order.
pub(super) fn judge_all(
    truth: &FrameRecord,
    tested: &FrameRecord,
    tracer: &Tracer,
    compared: &[usize],
) -> Vec<Judged> {
    let lobes = || LOBES.into_iter().filter(|&lobe| truth.lobe(lobe).is_some());
    let answers =
        |lobe: Lobe, pixel: usize| [truth, tested].map(|frame| Answer::of(frame.lobe(lobe), pixel));
    let differs = |&pixel: &usize| {
        lobes().any(|lobe| {
            let [expected, answer] = answers(lobe, pixel);
            !expected.equals(&answer)
        })
    };
    if !compared.iter().any(differs) {
        return vec![Judged::EQUAL; compared.len()];
    }
    let of_lobe = |lobe: Lobe| -> Vec<Option<Judged>> {
        let court = Court::new(truth, tracer, lobe);
        let judged = compared
            .par_iter()
            .map_init(Queue::new, |queue, &pixel| court.judge(pixel, answers(lobe, pixel), queue));
        judged.collect()
    };
    let by_lobe: Vec<_> = lobes().map(of_lobe).collect();
    let pixel = |i: usize| {
        let judged = by_lobe.iter().filter_map(|lobe| lobe[i]);
        judged.reduce(Judged::with).unwrap_or(Judged::EQUAL)
    };
    (0..compared.len()).map(pixel).collect()
}

/// What judging any pixel of one lobe needs.
pub(super) struct Court<'a> {
    pub tracer: &'a Tracer<'a>,
    pub truth: &'a FrameRecord,
    lobe: Lobe,
    /// Every reflector pixel's chain.
    pub chains: Vec<Option<Chain>>,
    /// By order, from 1.
    fields: Vec<Field>,
}

impl<'a> Court<'a> {
    pub fn new(truth: &'a FrameRecord, tracer: &'a Tracer, lobe: Lobe) -> Self {
        let size = truth.size;
        let chains = chains(tracer, size, lobe);
        let longest = chains.iter().flatten().map(Chain::order).max().unwrap_or(0);
        let fields =
            (1..=longest).into_par_iter().map(|order| Field::new(size, &chains, order)).collect();
        Court { tracer, truth, lobe, chains, fields }
    }

    /// `None` where neither the truth nor the other shows anything by this lobe.
    fn judge(
        &self,
        pixel: usize,
        [expected, answer]: [Answer; 2],
        queue: &mut Queue,
    ) -> Option<Judged> {
        let Some(chain) = &self.chains[pixel] else {
            // The lobe is not there, or the truth is not of this tracer: only equality can be told.
            let bare = expected == Answer::NONE && answer.status == Status::Missing;
            let judged = if expected.equals(&answer) {
                Judged::EQUAL
            } else {
                Judged { missing: true, ..Judged::default() }
            };
            return (!bare).then_some(judged);
        };
        let shaded = self.shaded(pixel, chain, &expected, &answer);
        if expected.equals(&answer) {
            return Some(Judged { shaded, ..Judged::EQUAL });
        }
        let found = |answer: &Answer| answer.status == Status::Found;
        let both_found = found(&expected) && found(&answer);
        let missing = answer.status == Status::Missing || found(&expected) && !found(&answer);
        let spurious = !found(&expected) && found(&answer);
        let target = Target::new(answer.point);
        let here = centre(at(self.truth.size, pixel));
        let belongs = if missing || spurious {
            None
        } else {
            self.belongs(Mirrors::of(chain), target, here, queue)
        };
        Some(Judged {
            missing,
            spurious,
            wrong_object: both_found && expected.ids.object != answer.ids.object,
            wrong_depth: both_found && wrong_depth(chain, expected.point.xyz(), answer.point.xyz()),
            unreachable: !missing && !spurious && belongs.is_none(),
            displacement_px: belongs.map(|there| there.distance(here)),
            angle_deg: Segment::after(chain.last()).angle_deg(target),
            shaded,
        })
    }

    /// The position of the image from which mirrors show the target: `near` itself or right beside
    /// it, or else the nearest.
    pub fn belongs(
        &self,
        mirrors: Mirrors,
        target: Target,
        near: Vec2,
        queue: &mut Queue,
    ) -> Option<Vec2> {
        let query = self.query(mirrors, target, near, REACH_PX)?;
        query.root_beside().or_else(|| query.root(queue))
    }

    /// To ask for the position nearest to `near` from which mirrors show the target; `None` where no
    /// chain of the frame is that long.
    pub fn query<'c>(
        &'c self,
        mirrors: Mirrors<'c>,
        target: Target,
        near: Vec2,
        reach_px: f32,
    ) -> Option<Query<'c>> {
        Some(Query {
            tracer: self.tracer,
            size: self.truth.size,
            field: self.fields.get(mirrors.order() as usize - 1)?,
            near,
            reach_px,
            mirrors,
            target,
        })
    }

    /// The truth's colour at a position of a mirror; `None` beside the mirrors.
    pub fn colour(&self, position: Vec2) -> Option<Vec3> {
        let tracer = self.tracer;
        let ray = tracer.moment().camera.ray(self.truth.size, position);
        let hit = tracer.look(&ray).filter(|hit| tracer.scene().is_reflector(hit.object))?;
        Some(tracer.seen(&hit, ray.direction))
    }

    /// What this lobe adds to the colour at the pixel's centre, as traced and as it were with the
    /// answer at the chain's end; the reflector's own light with the first lobe. No answer is black.
    fn shaded(&self, pixel: usize, chain: &Chain, expected: &Answer, answer: &Answer) -> [Vec3; 2] {
        let arriving =
            if expected.equals(answer) { chain.radiance } else { self.arriving(chain, answer) };
        let first = &chain.bounces[0];
        let own = match self.lobe {
            Lobe::Reflected => self.tracer.diffuse(&first.hit),
            Lobe::Refracted => Vec3::ZERO,
        };
        let incident = self.eye_ray(pixel).direction;
        let way = self.tracer.depart(&first.hit, incident, self.lobe);
        let faded = self.tracer.scene().material_of(first.hit.object).faded(chain.path);
        let weight = way.map_or(Vec3::ZERO, |way| faded * way.weight);
        [chain.radiance, arriving].map(|radiance| own + weight * radiance)
    }

    fn eye_ray(&self, pixel: usize) -> Ray {
        let size = self.truth.size;
        self.tracer.moment().camera.ray(size, at(size, pixel).as_vec2() + 0.5)
    }

    /// Light arriving at R with the answer at the chain's end.
    fn arriving(&self, chain: &Chain, answer: &Answer) -> Vec3 {
        let tracer = self.tracer;
        let end = match answer.status {
            Status::Missing => return Vec3::ZERO,
            Status::Environment => shading::environment(tracer.scene(), answer.point.xyz()),
            Status::Found => {
                let point = answer.point.xyz();
                let incident = (point - chain.last().hit.point).normalize_or_zero();
                let Ids { object, triangle, .. } = answer.ids;
                let hit = tracer.surface_at(object, triangle, point, incident);
                let left = tracer.bounces().saturating_sub(chain.order());
                hit.map_or(Vec3::ZERO, |hit| tracer.leaving(&hit, incident, left, chain.throughput))
            }
        };
        chain.relit(end)
    }
}

/// Every reflector pixel's chain by a lobe, as the truth traces it.
pub(super) fn chains(tracer: &Tracer, size: [u32; 2], lobe: Lobe) -> Vec<Option<Chain>> {
    (0..(size[0] * size[1]) as usize)
        .into_par_iter()
        .map(|pixel| {
            let ray = tracer.moment().camera.ray(size, at(size, pixel).as_vec2() + 0.5);
            tracer.chain(tracer.look(&ray)?, ray.direction, lobe)
        })
        .collect()
}

pub(super) fn at(size: [u32; 2], pixel: usize) -> UVec2 {
    let pixel = pixel as u32;
    UVec2::new(pixel % size[0], pixel / size[0])
}

fn wrong_depth(chain: &Chain, expected: Vec3, answer: Vec3) -> bool {
    let last = chain.last().hit.point;
    let (right, given) = (last.distance(expected), last.distance(answer));
    (given - right).abs() > DEPTH_TOLERANCE * right
}
