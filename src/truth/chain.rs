//! Following light back through mirrors and glass.

use glam::{Vec3, Vec4};

use super::{Hit, Tracer};
use crate::scene::{Departure, Ids, Lobe, NO_OBJECT, Status, shading};

/// Light that counts for less than this in the picture is not followed: half a step of a half float
/// at one. Only glass, which splits light in two at every surface, ever comes so far.
const FAINT: f32 = 1.0 / 4096.0;

/// One surface met that sends the ray on, and where it went from there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounce {
    pub hit: Hit,
    pub lobe: Lobe,
    /// Unit direction of the ray that leaves: B where it is mirrored, T where it is refracted.
    pub outgoing: Vec3,
}

impl Bounce {
    /// Whether the ray leaves on the side of the surface that its triangles' corners run
    /// counter-clockwise on.
    pub fn outside(&self) -> bool {
        self.hit.front == (self.lobe == Lobe::Reflected)
    }
}

/// A chain of mirrors and what it shows at its end.
#[derive(Clone, Debug, PartialEq)]
pub struct Chain {
    /// The reflectors met, the first being the pixel's own (R and N are its point and normal).
    pub bounces: Vec<Bounce>,
    /// The surface whose colour is shown; `None` where the last ray leaves the scene.
    pub shown: Option<Hit>,
    /// Light arriving at R: throughput of later bounces included, the first one's not. With glass
    /// on the way it is the sum over all ways on, of which the chain is the heaviest.
    pub radiance: Vec3,
    /// What later bounces make of light arriving at the last one.
    pub throughput: Vec3,
    /// Light arriving at the last bounce.
    pub end: Vec3,
    /// Reflectors met, packed as in [`Ids`].
    pub trace: u32,
    /// Metres from R to the point shown; infinite for the environment.
    pub path: f32,
}

impl Chain {
    /// Number of reflectors met; at least 1.
    pub fn order(&self) -> u32 {
        self.bounces.len() as u32
    }

    /// The last reflector met.
    pub fn last(&self) -> &Bounce {
        &self.bounces[self.bounces.len() - 1]
    }

    /// Which bounces refract, one bit each, the first lowest.
    pub fn refractions(&self) -> u32 {
        let bits = self.bounces.iter().enumerate();
        bits.fold(0, |bits, (i, bounce)| bits | u32::from(bounce.lobe == Lobe::Refracted) << i)
    }

    /// S as the record stores it: a point with w = 1, or a direction with w = 0.
    pub fn point(&self) -> Vec4 {
        match &self.shown {
            Some(hit) => hit.point.extend(1.0),
            None => self.last().outgoing.extend(0.0),
        }
    }

    pub fn ids(&self) -> Ids {
        let (object, triangle, status) = match &self.shown {
            Some(hit) => (hit.object, hit.triangle, Status::Found),
            None => (NO_OBJECT, 0, Status::Environment),
        };
        Ids::new(object, triangle, self.trace, self.order(), status).by(self.bounces[0].lobe)
    }

    /// Light arriving at R, were `end` to arrive at the last bounce.
    pub fn relit(&self, end: Vec3) -> Vec3 {
        self.radiance + self.throughput * (end - self.end)
    }
}

impl Tracer<'_> {
    /// Follow the ray that leaves `first`, a point of a reflector met by a ray travelling along
    /// `incident` (unit length), by a lobe; `None` where the reflector has no such lobe there.
    ///
    /// The chain ends where the scene is left, on a surface that shows more of itself than of its
    /// reflection, or on the last reflector allowed, which shows its diffuse colour.
    pub fn chain(&self, first: Hit, incident: Vec3, lobe: Lobe) -> Option<Chain> {
        let departure = self.depart(&first, incident, lobe)?;
        let mut bounce = Bounce { hit: first, lobe, outgoing: departure.direction };
        let mut chain = Chain {
            bounces: Vec::with_capacity(2),
            shown: None,
            radiance: Vec3::ZERO,
            throughput: Vec3::ONE,
            end: Vec3::ZERO,
            trace: 0,
            path: 0.0,
        };
        loop {
            let order = chain.order();
            chain.trace = Ids::extended(chain.trace, order, self.ranks[bounce.hit.object as usize]);
            chain.bounces.push(bounce);
            let Some(hit) = self.leave(&bounce) else {
                chain.path = f32::INFINITY;
                chain.end = shading::environment(self.scene, bounce.outgoing);
                break;
            };
            chain.path += hit.distance;
            let left = self.bounces() - chain.order();
            let ways = || self.departures(&hit, bounce.outgoing);
            let Some(way) = ways().find(|way| left > 0 && way.is_heaviest()) else {
                chain.shown = Some(hit);
                chain.end = self.leaving(&hit, bounce.outgoing, left, chain.throughput);
                break;
            };
            chain.radiance += chain.throughput * self.diffuse(&hit);
            for other in ways().filter(|other| other.lobe != way.lobe) {
                let throughput = chain.throughput * other.weight;
                chain.radiance += throughput * self.arriving(&hit, &other, left, throughput);
            }
            chain.throughput *= way.weight;
            bounce = Bounce { hit, lobe: way.lobe, outgoing: way.direction };
        }
        chain.radiance += chain.throughput * chain.end;
        Some(chain)
    }

    /// Light leaving `hit` back along a ray that travelled along `incident`, over at most `left`
    /// more bounces, the one at `hit` included; `throughput` is what of it reaches the eye.
    pub fn leaving(&self, hit: &Hit, incident: Vec3, left: u32, throughput: Vec3) -> Vec3 {
        let mut radiance = self.diffuse(hit);
        if left > 0 {
            for way in self.departures(hit, incident) {
                let throughput = throughput * way.weight;
                radiance += way.weight * self.arriving(hit, &way, left, throughput);
            }
        }
        radiance
    }

    /// The colour of the surface at `hit` as an eye sees it by a ray travelling along `incident`: what
    /// leaves it, but faded by the distance of what it mirrors.
    pub fn seen(&self, hit: &Hit, incident: Vec3) -> Vec3 {
        let material = self.scene.material_of(hit.object);
        if material.mirror.is_none_or(|mirror| mirror.fade.is_none()) {
            return self.leaving(hit, incident, self.bounces(), Vec3::ONE);
        }
        self.composite(hit, incident, |lobe| {
            let chain = self.chain(*hit, incident, lobe);
            chain.map_or(Vec3::ZERO, |chain| material.faded(chain.path) * chain.radiance)
        })
    }

    /// Light arriving at `hit` from a way on; `left` counts the bounce at `hit`.
    fn arriving(&self, hit: &Hit, way: &Departure, left: u32, throughput: Vec3) -> Vec3 {
        if throughput.max_element() < FAINT {
            return Vec3::ZERO;
        }
        match self.leave(&Bounce { hit: *hit, lobe: way.lobe, outgoing: way.direction }) {
            Some(next) => self.leaving(&next, way.direction, left - 1, throughput),
            None => shading::environment(self.scene, way.direction),
        }
    }

    /// The colour of the surface at `hit` when radiance arrives there by each of its lobes, met by
    /// a ray travelling along `incident`.
    pub fn composite(&self, hit: &Hit, incident: Vec3, radiance: impl Fn(Lobe) -> Vec3) -> Vec3 {
        let ways = self.departures(hit, incident);
        ways.fold(self.diffuse(hit), |sum, way| sum + way.weight * radiance(way.lobe))
    }

    /// Light scattered diffusely at `hit`.
    pub fn diffuse(&self, hit: &Hit) -> Vec3 {
        shading::shade(self.scene, hit.object, hit.normal, hit.uv, self.is_sunlit(hit))
    }

    /// The way on from `hit` for a ray that travelled along `incident`.
    pub fn depart(&self, hit: &Hit, incident: Vec3, lobe: Lobe) -> Option<Departure> {
        self.scene.material_of(hit.object).depart(lobe, incident, hit.normal, hit.front)
    }

    fn departures(&self, hit: &Hit, incident: Vec3) -> impl Iterator<Item = Departure> + use<> {
        self.scene.material_of(hit.object).departures(incident, hit.normal, hit.front)
    }

    /// Whether the sun reaches `hit`, as far as the scene asks.
    fn is_sunlit(&self, hit: &Hit) -> bool {
        let light = &self.scene.lighting;
        if !light.shadows || hit.normal.dot(light.towards_sun) <= 0.0 {
            return true;
        }
        // As a mirrored ray leaves: on the side of the surface that is seen.
        let towards = Bounce { hit: *hit, lobe: Lobe::Reflected, outgoing: light.towards_sun };
        let opaque = |object: u32| self.scene.material_of(object).glass.is_none();
        !self.surfaces.is_blocked(&towards, opaque)
    }
}
