// What every pass that draws the scene's surfaces hands from vertex to fragment.
#define_import_path bindings::surface

#import bindings::scene::{materials, objects, shade, vertices, world_direction, world_position}
#import common::camera::facing

struct Surface {
    // Invariant, so that two passes over the same surface agree on its depth.
    @builtin(position) @invariant clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
    @location(3) @interpolate(flat) object: u32,
}

// A vertex in the world; where it lands in clip space is the pass's to say.
fn surface_vertex(index: u32, object: u32) -> Surface {
    let vertex = vertices[index];
    let pose = objects[object];
    var out: Surface;
    out.position = world_position(pose, vertex.position);
    out.normal = world_direction(pose, vertex.normal);
    out.uv = vec2(vertex.u, vertex.v);
    out.object = object;
    return out;
}

// The surface's own light along a ray that arrives with direction `incident`.
fn surface_colour(surface: Surface, incident: vec3<f32>) -> vec3<f32> {
    let material = materials[objects[surface.object].material];
    return shade(material, facing(surface.normal, incident), surface.uv);
}
