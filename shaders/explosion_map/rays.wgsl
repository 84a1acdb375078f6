// The rays that leave the corners of one reflector's triangles. Where the surface faces away, the eye ray
// goes straight on: through the rim both are one, so the cells of what is hidden border those of what is
// mirrored.
#import bindings::scene::{indices, objects, vertices, world_direction, world_position}
#import common::camera::{Camera, arriving}
#import explosion_map::sphere::Ray

struct Corners {
    // The first in the scene's indices.
    first: u32,
    total: u32,
    reflector: u32,
    pad: u32,
}
@group(0) @binding(0) var<uniform> part: Corners;
@group(0) @binding(1) var<storage, read_write> rays: array<Ray>;
@group(0) @binding(30) var<uniform> camera: Camera;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= part.total {
        return;
    }
    let vertex = vertices[indices[part.first + id.x]];
    let pose = objects[part.reflector];
    let point = world_position(pose, vertex.position);
    let normal = normalize(world_direction(pose, vertex.normal));
    let incident = arriving(camera, point);
    let away = dot(normal, incident) >= 0.0;
    let direction = select(reflect(incident, normal), incident, away);
    rays[id.x] = Ray(point, u32(away), normal, direction);
}
