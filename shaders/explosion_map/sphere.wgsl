// The spheres of an explosion map, and where directions from their centre are on it.
#define_import_path explosion_map::sphere

struct Spheres {
    // World; of all of them.
    centre: vec3<f32>,
    // One or two: layers of the map.
    layers: u32,
    // Axes of the map, of unit length; the third is towards its middle.
    right: vec3<f32>,
    // Radii, metres; the second counts where there are two.
    near: f32,
    up: vec3<f32>,
    far: f32,
    axis: vec3<f32>,
    // Of the map, texels.
    side: u32,
}

// A ray from a corner of the reflector's triangles: where the light goes that the eye sends there.
struct Ray {
    // World; direction and normal of unit length.
    point: vec3<f32>,
    // 1 where the surface faces away from the eye.
    away: u32,
    normal: vec3<f32>,
    direction: vec3<f32>,
}

fn radius_of(spheres: Spheres, layer: u32) -> f32 {
    return select(spheres.near, spheres.far, layer == 1u);
}

// The unit direction from the centre to where a ray that starts inside leaves the sphere.
fn leaves(spheres: Spheres, layer: u32, ray: Ray) -> vec3<f32> {
    let from_centre = ray.point - spheres.centre;
    let along = dot(from_centre, ray.direction);
    let radius = radius_of(spheres, layer);
    let within = max(radius * radius - dot(from_centre, from_centre) + along * along, 0.0);
    return normalize(from_centre + (sqrt(within) - along) * ray.direction);
}

// Where a unit direction is on the map, in texels: Blythe 1999, equations 5 and 6, which keep areas. It is
// singular opposite to the axis.
fn map_place(spheres: Spheres, direction: vec3<f32>) -> vec2<f32> {
    let across = vec2(dot(direction, spheres.right), dot(direction, spheres.up));
    let ahead = dot(direction, spheres.axis);
    let place = 1.0 + across * inverseSqrt(max(2.0 * (ahead + 1.0), 1e-12));
    return 0.5 * f32(spheres.side) * place;
}
