//! Following light back through mirrors.

use glam::{Vec3, Vec4};

use super::{Hit, Tracer};
use crate::geometry::optics::reflect;
use crate::scene::{Ids, Mirror, NO_OBJECT, Status, shading};

/// From here on a mirror shows its reflection rather than itself: the record follows the heavier
/// of the two layers.
const HEAVIER_LAYER: f32 = 0.5;

/// One mirror met, and where the ray went from there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounce {
    pub hit: Hit,
    /// B: unit direction of the mirrored ray.
    pub mirrored: Vec3,
}

/// A chain of mirrors and what it shows at its end.
#[derive(Clone, Debug, PartialEq)]
pub struct Chain {
    /// The mirrors met, the first being the pixel's own (R and N are its point and normal).
    pub bounces: Vec<Bounce>,
    /// The surface whose colour is shown; `None` where the last mirrored ray leaves the scene.
    pub shown: Option<Hit>,
    /// Light arriving at R: throughput of later mirrors included, the first one's not.
    pub radiance: Vec3,
    /// Reflectors met, packed as in [`Ids`].
    pub trace: u32,
    /// Metres from R to the point shown; infinite for the environment.
    pub path: f32,
}

impl Chain {
    /// Number of mirrors met; at least 1.
    pub fn order(&self) -> u32 {
        self.bounces.len() as u32
    }

    /// The last mirror met.
    pub fn last(&self) -> &Bounce {
        &self.bounces[self.bounces.len() - 1]
    }

    /// S as the record stores it: a point with w = 1, or a direction with w = 0.
    pub fn point(&self) -> Vec4 {
        match &self.shown {
            Some(hit) => hit.point.extend(1.0),
            None => self.last().mirrored.extend(0.0),
        }
    }

    pub fn ids(&self) -> Ids {
        let (object, triangle, status) = match &self.shown {
            Some(hit) => (hit.object, hit.triangle, Status::Found),
            None => (NO_OBJECT, 0, Status::Environment),
        };
        Ids::new(object, triangle, self.trace, self.order(), status)
    }
}

impl Tracer<'_> {
    /// Follow the mirrored ray from `first`, a point of a reflector that a ray travelling along
    /// `incident` (unit length) meets.
    ///
    /// The chain ends where the scene is left, on a surface that shows more of itself than of its
    /// reflection, or on the last mirror allowed, which shows its diffuse colour.
    pub fn chain(&self, first: Hit, incident: Vec3) -> Chain {
        let mut chain = Chain {
            bounces: Vec::with_capacity(2),
            shown: None,
            radiance: Vec3::ZERO,
            trace: 0,
            path: 0.0,
        };
        let mut bounce = Bounce { hit: first, mirrored: reflect(incident, first.normal) };
        let end = loop {
            let order = chain.order();
            chain.trace = Ids::extended(chain.trace, order, self.ranks[bounce.hit.object as usize]);
            chain.bounces.push(bounce);
            let Some(hit) = self.leave(&bounce.hit, bounce.mirrored) else {
                chain.path = f32::INFINITY;
                break shading::environment(self.scene, bounce.mirrored);
            };
            chain.path += hit.distance;
            let heavy = self.mirror(&hit).is_some_and(|mirror| mirror.reflectance >= HEAVIER_LAYER);
            if !heavy || chain.order() >= self.bounces() {
                chain.shown = Some(hit);
                break self.leaving(&hit, bounce.mirrored, self.bounces() - chain.order());
            }
            bounce = Bounce { hit, mirrored: reflect(bounce.mirrored, hit.normal) };
        };
        chain.radiance = self.through(&chain.bounces, end);
        chain
    }

    /// Light arriving at the first of `bounces` when `end` arrives at the last: what the later
    /// mirrors pass on of it, and what they scatter themselves.
    pub fn through(&self, bounces: &[Bounce], end: Vec3) -> Vec3 {
        let later = bounces.iter().skip(1).rev();
        later.fold(end, |arriving, bounce| self.composite(&bounce.hit, arriving))
    }

    /// The colour of the surface at `hit` when `radiance` arrives there along the mirrored ray.
    pub fn composite(&self, hit: &Hit, radiance: Vec3) -> Vec3 {
        let reflected = self
            .mirror(hit)
            .map_or(Vec3::ZERO, |mirror| mirror.reflectance * mirror.tint * radiance);
        self.diffuse(hit) + reflected
    }

    /// Light leaving `hit` back along a ray that travelled along `incident`, through at most
    /// `bounces` mirrors, the one at `hit` included.
    pub fn leaving(&self, hit: &Hit, incident: Vec3, bounces: u32) -> Vec3 {
        let (mut hit, mut incident) = (*hit, incident);
        let (mut radiance, mut throughput) = (Vec3::ZERO, Vec3::ONE);
        for left in (0..=bounces).rev() {
            radiance += throughput * self.diffuse(&hit);
            let Some(mirror) = self.mirror(&hit).filter(|_| left > 0) else {
                break;
            };
            throughput *= mirror.reflectance * mirror.tint;
            incident = reflect(incident, hit.normal);
            let Some(next) = self.leave(&hit, incident) else {
                radiance += throughput * shading::environment(self.scene, incident);
                break;
            };
            hit = next;
        }
        radiance
    }

    /// Light scattered diffusely at `hit`.
    pub fn diffuse(&self, hit: &Hit) -> Vec3 {
        shading::shade(self.scene, hit.object, hit.normal, hit.uv)
    }

    /// The mirror that the surface at `hit` is, if it is one.
    pub fn mirror(&self, hit: &Hit) -> Option<Mirror> {
        self.scene.material_of(hit.object).mirror
    }
}
