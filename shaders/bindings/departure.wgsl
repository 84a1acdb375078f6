// How light leaves a specular surface: one direction and one share for each lobe.
// Rust twin: scene/departure.rs.
#define_import_path bindings::departure

#import bindings::scene::Material
#import common::optics::{fresnel, snell}

const LOBE_REFLECTED: u32 = 0u;
const LOBE_REFRACTED: u32 = 1u;

// From this share on, a surface shows what lies at the end of a lobe rather than itself.
const HEAVIER_LAYER: f32 = 0.5;

struct Departure {
    // False on a diffuse surface, behind a mirror, beyond the critical angle.
    exists: bool,
    // Unit: B for the reflected lobe, T for the refracted one.
    direction: vec3<f32>,
    // Share of the light that comes this way, whatever its colour.
    share: f32,
    // What arriving radiance is multiplied by.
    weight: vec3<f32>,
}

const NO_DEPARTURE: Departure = Departure(false, vec3(0.0), 0.0, vec3(0.0));

// The way on along a lobe for a ray travelling along `incident`; the normal points against it, both
// are unit vectors. `front`: the ray met the outside of the surface.
fn depart(
    material: Material,
    lobe: u32,
    incident: vec3<f32>,
    normal: vec3<f32>,
    front: bool,
) -> Departure {
    if material.index > 0.0 {
        let ratio = select(material.index, 1.0 / material.index, front);
        let reflected = fresnel(-dot(incident, normal), ratio);
        if lobe == LOBE_REFLECTED {
            return Departure(true, reflect(incident, normal), reflected, vec3(reflected));
        }
        let behind = snell(incident, normal, ratio);
        let share = 1.0 - reflected;
        return Departure(behind.passes, behind.direction, share, share * material.tint);
    }
    if material.reflectance >= 0.0 && lobe == LOBE_REFLECTED {
        let share = mirror_share(material, -dot(incident, normal));
        return Departure(true, reflect(incident, normal), share, share * material.tint);
    }
    return NO_DEPARTURE;
}

// Share of light that a mirror reflects at this cosine between ray and normal: Fresnel's law in Schlick's
// approximation (1994, equation 15).
fn mirror_share(material: Material, cosine: f32) -> f32 {
    if material.fresnel == 0u {
        return material.reflectance;
    }
    let rest = 1.0 - clamp(cosine, 0.0, 1.0);
    return material.reflectance
        + (1.0 - material.reflectance) * (rest * rest) * (rest * rest) * rest;
}

// Whether this is the layer a record follows through a surface met on the way. Of two equal halves
// the reflected one is followed.
fn is_heaviest(lobe: u32, share: f32) -> bool {
    return share > HEAVIER_LAYER || lobe == LOBE_REFLECTED && share == HEAVIER_LAYER;
}
