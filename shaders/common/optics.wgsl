// Snell's and Fresnel's laws. Rust twin: geometry/optics.rs.
#define_import_path common::optics

struct Refraction {
    // False beyond the critical angle.
    passes: bool,
    // Unit.
    direction: vec3<f32>,
}

// `ratio`: refractive index before the surface over the one behind; the normal points against the
// incident direction, both are unit vectors.
fn snell(incident: vec3<f32>, normal: vec3<f32>, ratio: f32) -> Refraction {
    let cosine = -dot(incident, normal);
    let squared = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
    if squared < 0.0 {
        return Refraction(false, vec3(0.0));
    }
    let behind = ratio * incident + (ratio * cosine - sqrt(squared)) * normal;
    return Refraction(true, normalize(behind));
}

// Share of unpolarised light reflected; 1 beyond the critical angle.
fn fresnel(cosine: f32, ratio: f32) -> f32 {
    let squared = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
    if squared < 0.0 {
        return 1.0;
    }
    let behind = sqrt(squared);
    let across = (ratio * cosine - behind) / (ratio * cosine + behind);
    let along = (cosine - ratio * behind) / (cosine + ratio * behind);
    return 0.5 * (across * across + along * along);
}
