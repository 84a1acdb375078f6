// Proxies: simple shapes that stand for the scene around an environment map. Rust twin:
// geometry/proxy.rs.
#define_import_path common::proxy

// A vector at unit length; `other` where it has none.
fn unit_or(v: vec3<f32>, other: vec3<f32>) -> vec3<f32> {
    let squared = dot(v, v);
    if squared < 1.0e-30 {
        return other;
    }
    return v / sqrt(squared);
}

// The unit direction, from the centre of a sphere, of where a ray leaves it (Patow 1995, section 1).
// `start` is relative to the centre; a ray that misses keeps its direction, a unit vector.
fn from_sphere(start: vec3<f32>, along: vec3<f32>, radius: f32) -> vec3<f32> {
    let ahead = dot(start, along);
    let across = radius * radius - (dot(start, start) - ahead * ahead);
    if across < 0.0 {
        return along;
    }
    let t = sqrt(across) - ahead;
    if t < 0.0 {
        return along;
    }
    return unit_or(start + t * along, along);
}

// The same for a box with these corners relative to the centre: parallax-corrected cube maps.
fn from_box(start: vec3<f32>, along: vec3<f32>, low: vec3<f32>, high: vec3<f32>) -> vec3<f32> {
    // Finite also along an axis: a slab parallel to the ray is met nearly infinitely far away.
    let tiny = select(vec3(1.0e-20), vec3(-1.0e-20), along < vec3(0.0));
    let inverse = 1.0 / select(along, tiny, abs(along) < vec3(1.0e-20));
    let a = (low - start) * inverse;
    let b = (high - start) * inverse;
    let near = min(a, b);
    let far = max(a, b);
    let enter = max(near.x, max(near.y, near.z));
    let leave = min(far.x, min(far.y, far.z));
    if leave < max(enter, 0.0) {
        return along;
    }
    return unit_or(start + leave * along, along);
}
