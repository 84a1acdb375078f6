// The triangles of one reflector, each with the rays that leave its corners: its cell is the space between
// them, and of what lies there the triangle shows the image.
#define_import_path explosion_map::cell

#import explosion_map::sphere::Ray

// Three a triangle.
@group(0) @binding(2) var<storage, read> rays: array<Ray>;

// What mirrors a vertex: a point of the reflector and the normal there.
struct Plane {
    point: vec3<f32>,
    normal: vec3<f32>,
    found: bool,
}

fn plane_in(triangle: u32, weights: vec3<f32>) -> Plane {
    let a = rays[3u * triangle];
    let b = rays[3u * triangle + 1u];
    let c = rays[3u * triangle + 2u];
    let point = weights.x * a.point + weights.y * b.point + weights.z * c.point;
    let normal = weights.x * a.normal + weights.y * b.normal + weights.z * c.normal;
    return Plane(point, normalize(normal), true);
}

// Newton steps to where a cell holds a point; after three nothing changes.
const STEPS: u32 = 3u;
// Weights so far below 0 only tell which way the point lies.
const OUTSIDE: f32 = -0.5;

// The weights of a triangle's corners at a point: those of the point in the triangle that the three rays make so
// far out. Below 0 beyond an edge. By Newton steps from the middle and the distance to the point: the cubic
// equation of the distance has roots on the far side of infinity, too.
fn weights_at(triangle: u32, v: vec3<f32>) -> vec3<f32> {
    let a = rays[3u * triangle];
    let b = rays[3u * triangle + 1u];
    let c = rays[3u * triangle + 2u];
    var y = 1.0 / 3.0;
    var z = 1.0 / 3.0;
    var along = distance(v, (a.point + b.point + c.point) / 3.0);
    for (var step = 0u; step < STEPS; step += 1u) {
        let direction = a.direction + y * (b.direction - a.direction) + z * (c.direction - a.direction);
        let by_y = b.point - a.point + along * (b.direction - a.direction);
        let by_z = c.point - a.point + along * (c.direction - a.direction);
        let left = v - a.point - along * a.direction - y * by_y - z * by_z;
        let volume = dot(cross(by_y, by_z), direction);
        if volume == 0.0 {
            break;
        }
        y += dot(cross(left, by_z), direction) / volume;
        z += dot(cross(by_y, left), direction) / volume;
        // Rays start at the reflector.
        along = max(along + dot(cross(by_y, by_z), left) / volume, 0.0);
        if min(min(y, z), 1.0 - y - z) < OUTSIDE {
            break;
        }
    }
    return vec3(1.0 - y - z, y, z);
}
