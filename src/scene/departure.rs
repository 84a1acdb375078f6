//! How light leaves a specular surface: one direction and one share for each lobe. Its twin on the
//! GPU is `shaders/bindings/departure.wgsl`.

use glam::Vec3;

use super::{Lobe, Material};
use crate::geometry::optics::{fresnel, reflect, refract};

/// From this share of the light on, a surface shows what lies at the end of a lobe rather than
/// itself: the record follows the heaviest of the layers that are blended.
const HEAVIER_LAYER: f32 = 0.5;

/// One way on from a surface point, against the light's travel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Departure {
    pub lobe: Lobe,
    /// Unit: B of the papers for the reflected lobe, T for the refracted one.
    pub direction: Vec3,
    /// Share of the light that comes this way, 0 to 1, whatever its colour.
    pub share: f32,
    /// What arriving radiance is multiplied by: the share times the surface's tint.
    pub weight: Vec3,
}

impl Material {
    /// The way on along `lobe` for a ray that travelled along `incident`; `None` where there is
    /// none: on a diffuse surface, behind a mirror, beyond the critical angle.
    ///
    /// `normal` points against the ray, both have unit length; `front` says whether the ray met
    /// the outside of the surface.
    pub fn depart(
        &self,
        lobe: Lobe,
        incident: Vec3,
        normal: Vec3,
        front: bool,
    ) -> Option<Departure> {
        let (direction, share, tint) = match (self.glass, self.mirror, lobe) {
            (Some(glass), _, _) => {
                let ratio = if front { 1.0 / glass.index } else { glass.index };
                let reflected = fresnel(-incident.dot(normal), ratio);
                match lobe {
                    Lobe::Reflected => (reflect(incident, normal), reflected, Vec3::ONE),
                    Lobe::Refracted => {
                        (refract(incident, normal, ratio)?, 1.0 - reflected, glass.tint)
                    }
                }
            }
            (None, Some(mirror), Lobe::Reflected) => {
                (reflect(incident, normal), mirror.share(-incident.dot(normal)), mirror.tint)
            }
            (None, _, _) => return None,
        };
        Some(Departure { lobe, direction, share, weight: share * tint })
    }

    /// Both ways on, the absent ones left out.
    pub fn departures(
        &self,
        incident: Vec3,
        normal: Vec3,
        front: bool,
    ) -> impl Iterator<Item = Departure> + use<> {
        let lobes = [Lobe::Reflected, Lobe::Refracted];
        let ways = lobes.map(|lobe| self.depart(lobe, incident, normal, front));
        ways.into_iter().flatten()
    }
}

impl Departure {
    /// Whether this is the layer a record follows through a surface met on the way.
    pub fn is_heaviest(&self) -> bool {
        match self.lobe {
            Lobe::Reflected => self.share >= HEAVIER_LAYER,
            // Of two equal halves the reflected one is followed.
            Lobe::Refracted => self.share > HEAVIER_LAYER,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Glass, Mirror, Pattern};
    use super::*;

    fn material(mirror: Option<Mirror>, glass: Option<Glass>) -> Material {
        Material { name: "m".into(), pattern: Pattern::Colour(Vec3::ZERO), mirror, glass }
    }

    #[test]
    fn glass_splits_all_the_light_and_exactly_one_share_is_heaviest() {
        let glass = material(None, Some(Glass { index: 1.5, tint: Vec3::ONE }));
        for front in [true, false] {
            for degrees in 0..90 {
                let (sine, cosine) = (degrees as f32).to_radians().sin_cos();
                let incident = Vec3::new(sine, -cosine, 0.0);
                let ways: Vec<_> = glass.departures(incident, Vec3::Y, front).collect();
                let sum: f32 = ways.iter().map(|way| way.share).sum();
                assert!((sum - 1.0).abs() < 1e-6, "{degrees}: {ways:?}");
                assert_eq!(ways.iter().filter(|way| way.is_heaviest()).count(), 1);
            }
        }
    }

    #[test]
    fn mirrors_reflect_only_and_weak_ones_are_not_followed() {
        let tint = Vec3::new(1.0, 0.5, 0.0);
        for (reflectance, followed) in [(0.4, false), (0.5, true)] {
            let mirror = material(Some(Mirror::plain(reflectance, tint)), None);
            let ways: Vec<_> = mirror.departures(Vec3::NEG_Y, Vec3::Y, true).collect();
            let [way] = ways.as_slice() else { panic!("{ways:?}") };
            assert_eq!((way.direction, way.weight), (Vec3::Y, reflectance * tint));
            assert_eq!(way.is_heaviest(), followed);
        }
        assert_eq!(material(None, None).departures(Vec3::NEG_Y, Vec3::Y, true).count(), 0);
    }
}
