// The corners of the reflector's triangle that a pixel shows, for methods that work per vertex.
#define_import_path bindings::corners

#import bindings::departure::depart
#import bindings::scene::{indices, materials, objects, vertices, world_direction, world_position}
#import bindings::view::{MirrorPoint, camera, lobe}
#import common::camera::{arriving, facing}

struct Corner {
    // World.
    position: vec3<f32>,
    // Unit: how light leaves the reflector there; where it does not, as it leaves the pixel's point.
    outgoing: vec3<f32>,
    // What the rasteriser would give the corner at the pixel; the three add up to 1.
    weight: f32,
}

fn corner_of(at: MirrorPoint, position: vec3<f32>, normal: vec3<f32>) -> Corner {
    let object = objects[at.reflector];
    let incident = arriving(camera, position);
    let faced = facing(world_direction(object, normal), incident);
    let way = depart(materials[object.material], lobe, incident, faced, at.front);
    return Corner(position, select(at.outgoing, way.direction, way.exists), 0.0);
}

fn corners_of(at: MirrorPoint) -> array<Corner, 3> {
    let object = objects[at.reflector];
    let first = object.first_index + 3u * at.triangle;
    var position: array<vec3<f32>, 3>;
    var corners: array<Corner, 3>;
    for (var i = 0u; i < 3u; i += 1u) {
        let vertex = vertices[indices[first + i]];
        position[i] = world_position(object, vertex.position);
        corners[i] = corner_of(at, position[i], vertex.normal);
    }
    // Weights in space are those that interpolation with perspective has on the screen.
    let a = position[1] - position[0];
    let b = position[2] - position[0];
    let plane = cross(a, b);
    let p = at.position - position[0];
    corners[1].weight = dot(cross(p, b), plane) / dot(plane, plane);
    corners[2].weight = dot(cross(a, p), plane) / dot(plane, plane);
    corners[0].weight = 1.0 - corners[1].weight - corners[2].weight;
    return corners;
}
