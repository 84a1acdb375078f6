//! Ray maps: what a camera that looks everywhere from one place sees by reflectors (Martin & Popescu 2004,
//! section 4.1).

use glam::Vec3;
use rayon::prelude::*;

use crate::geometry::Ray;
use crate::geometry::cube;
use crate::geometry::ray_octree::{Extent, RaySegment};
use crate::scene::{Ids, Lobe, Moment, ObjectId, Scene};
use crate::truth::{Bounce, Hit, Tracer, TruthOptions};

/// What a scene lacks a box by, as a share of its size: nothing lies in the planes of an octree's sides.
const MARGIN: f32 = 1e-3;

/// Traces ray maps at one moment: "the scene without the diffuse objects", so that these may move.
pub struct RayMapper<'s> {
    tracer: Tracer<'s>,
    /// Of each object its rank among the reflectors, and whether it has an inside.
    reflectors: Vec<Option<(u32, bool)>>,
    /// What all rays are clipped with.
    pub extent: Extent,
}

impl<'s> RayMapper<'s> {
    /// `still`: "if some diffuse objects are known to never move, they could be left in which reduces the
    /// number of rays"; what they hide from a location, its rays do not find.
    pub fn new(scene: &'s Scene, moment: &Moment, still: bool) -> Self {
        let mut reflectors = vec![None; scene.objects.len()];
        for (object, rank) in scene.reflectors().into_iter().zip(0..) {
            reflectors[object as usize] = Some((rank, scene.mesh_of(object).is_closed()));
        }
        let is_met = |object| scene.is_reflector(object) || still && !scene.is_moving(object);
        let tracer = Tracer::among(scene, moment, TruthOptions::default(), is_met);
        RayMapper { tracer, reflectors, extent: extent(scene) }
    }

    /// The rays of a map of `size` x `size` texels a face, as pieces from reflector to reflector: of the first
    /// layer those that left one reflector, and so on for `layers`. Faces in the order of cube maps, rows
    /// from the top; `texel` of each counts all of the map's, layer after layer.
    pub fn trace(&self, location: Vec3, size: u32, layers: u32) -> Vec<RaySegment> {
        let texels = 6 * size * size;
        let rows = (0..6 * size).into_par_iter();
        let mut segments: Vec<RaySegment> = rows
            .flat_map_iter(|row| {
                (0..size).flat_map(move |column| {
                    let texel = row * size + column;
                    let uv = glam::UVec2::new(column, row % size).as_vec2() + 0.5;
                    let direction = cube::direction(row / size, uv / size as f32).normalize();
                    let ray = Ray { origin: location, direction };
                    (0..).zip(self.chain(&ray, layers)).map(move |(layer, segment)| RaySegment {
                        texel: layer * texels + texel,
                        ..segment
                    })
                })
            })
            .collect();
        segments.par_sort_unstable_by_key(|segment| segment.texel);
        segments
    }

    /// What one camera ray gives, in the order its light is met.
    pub(super) fn chain(&self, ray: &Ray, layers: u32) -> Vec<RaySegment> {
        let mut segments = Vec::new();
        let Some(mut hit) = self.tracer.first(ray) else { return segments };
        let (mut incident, mut trace) = (ray.direction, 0);
        for order in 0..layers {
            let Some(next) = self.reflected(&hit, incident, &mut trace, order) else { break };
            let on = self.tracer.leave(&next);
            let leaves = self.extent.clip(hit.point, next.outgoing, f32::INFINITY);
            let length = on.map_or(leaves.map_or(0.0, |[_, to]| to), |on| on.distance);
            let end = hit.point + length * next.outgoing;
            segments.push(RaySegment { start: hit.point, trace, end, texel: 0 });
            let Some(on) = on else { break };
            (hit, incident) = (on, next.outgoing);
        }
        segments
    }

    /// The way on from a reflector; none from the inside of a closed one, where no eye looks from.
    fn reflected(&self, hit: &Hit, incident: Vec3, trace: &mut u32, order: u32) -> Option<Bounce> {
        let (rank, is_closed) = self.reflectors[hit.object as usize]?;
        if is_closed && !hit.front {
            return None;
        }
        let departure = self.tracer.depart(hit, incident, Lobe::Reflected)?;
        *trace = Ids::extended(*trace, order, rank);
        Some(Bounce { hit: *hit, lobe: Lobe::Reflected, outgoing: departure.direction })
    }
}

/// "A bounding box of the scene" (section 1.2), wherever things move to.
pub fn extent(scene: &Scene) -> Extent {
    let moving: Vec<ObjectId> =
        (0..scene.objects.len() as ObjectId).filter(|&object| scene.is_moving(object)).collect();
    let (mut low, mut high) = scene.bounds(&scene.at(0));
    if !moving.is_empty() {
        for frame in 1..scene.frames {
            let (a, b) = scene.bounds_of(&scene.at(frame), &moving);
            (low, high) = (low.min(a), high.max(b));
        }
    }
    let margin = MARGIN * (high - low).max_element().max(f32::MIN_POSITIVE);
    Extent { low: low - margin, high: high + margin }
}
