// For every vertex V the plane of the reflector that mirrors it, looked up in the explosion map by its
// direction from the spheres' centre, and V' there (Ofek & Rappoport 1998).
#import bindings::record::{count, count_most}
#import bindings::scene::{objects, vertices, world_position}
#import common::camera::arriving
#import explosion_map::cell::{Plane, plane_in, rays}
#import explosion_map::sphere::{Spheres, leaves, map_place}
#ifdef CELL_WALK
#import explosion_map::walk::walk
#endif
#import virtual_objects::corner::{Corner, HIDDEN, LOST, SHOWN, packed_found, status_of}
#import virtual_objects::reflector::{camera, image_of}

struct Search {
    // Vertices to reflect.
    total: u32,
    // The reflector itself, which it does not reflect.
    reflector: u32,
    // Most triangles looked at in a walk.
    cap: u32,
    pad: u32,
}
@group(0) @binding(20) var<storage, read> search: Search;
@group(0) @binding(1) var<storage, read> spheres: Spheres;
// Whose vertex each is.
@group(0) @binding(3) var<storage, read> owners: array<u32>;
@group(0) @binding(4) var explosion_map: texture_2d_array<u32>;
@group(0) @binding(5) var<storage, read_write> corners: array<Corner>;

// Triangles looked at since the invocation began.
var<private> steps: u32;

// The triangle at a place of the map plus one, or that of a texel next to it: triangles smaller than a
// texel may have none of their own. 0: none there.
fn number_at(layer: u32, place: vec2<f32>) -> u32 {
    let texel = vec2<i32>(clamp(place, vec2(0.0), vec2(f32(spheres.side) - 1.0)));
    let own = textureLoad(explosion_map, texel, layer, 0).x;
    if own != 0u {
        return own;
    }
    var nearest = 0u;
    var least = 1e9;
    for (var i = 0; i < 9; i += 1) {
        let other = texel + vec2(i % 3 - 1, i / 3 - 1);
        if all(other >= vec2(0)) && all(other < vec2(i32(spheres.side))) {
            let away = vec2<f32>(other) + 0.5 - place;
            let number = textureLoad(explosion_map, other, layer, 0).x;
            if number != 0u && dot(away, away) < least {
                least = dot(away, away);
                nearest = number;
            }
        }
    }
    return nearest;
}

// Twice the area of a triangle on the map.
fn area(a: vec2<f32>, b: vec2<f32>, c: vec2<f32>) -> f32 {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// The weights of a triangle's corners at a place of the map, below 0 beyond an edge.
fn weights_on_map(layer: u32, triangle: u32, place: vec2<f32>) -> vec3<f32> {
    let a = map_place(spheres, leaves(spheres, layer, rays[3u * triangle]));
    let b = map_place(spheres, leaves(spheres, layer, rays[3u * triangle + 1u]));
    let c = map_place(spheres, leaves(spheres, layer, rays[3u * triangle + 2u]));
    let whole = area(a, b, c);
    if whole == 0.0 {
        return vec3(1.0, 0.0, 0.0);
    }
    let y = area(a, place, c) / whole;
    let z = area(a, b, place) / whole;
    return vec3(1.0 - y - z, y, z);
}

// The plane that mirrors what is seen in a direction from the centre, where it lies on the sphere.
fn plane_on_sphere(layer: u32, direction: vec3<f32>) -> Plane {
    let place = map_place(spheres, direction);
    let number = number_at(layer, place);
    var out: Plane;
    if number != 0u {
        steps += 1u;
        out = plane_in(number - 1u, weights_on_map(layer, number - 1u, place));
    }
    return out;
}

// How much the farther sphere counts at a distance from the centre.
fn share_of_far(away: f32) -> f32 {
#ifdef BLEND_INVERSE
    // A ray that leaves the reflector turns away from its direction at infinity as 1 / distance.
    let share = (1.0 / spheres.near - 1.0 / away) / (1.0 / spheres.near - 1.0 / spheres.far);
#else
    let share = (away - spheres.near) / (spheres.far - spheres.near);
#endif
    return clamp(share, 0.0, 1.0);
}

fn plane_for(v: vec3<f32>) -> Plane {
    let away = distance(v, spheres.centre);
    let direction = (v - spheres.centre) / max(away, 1e-9);
#ifdef CELL_WALK
    // Any triangle will do where the map has none.
    let number = max(number_at(0u, map_place(spheres, direction)), 1u);
    let found = walk(number - 1u, v, search.cap);
    steps = found.steps;
    return plane_in(found.triangle, found.weights);
#else
    let near = plane_on_sphere(0u, direction);
    if spheres.layers == 1u {
        return near;
    }
    let far = plane_on_sphere(1u, direction);
    if !near.found || !far.found {
        return far;
    }
    let share = share_of_far(away);
    let normal = normalize(mix(near.normal, far.normal, share));
    return Plane(mix(near.point, far.point, share), normal, true);
#endif
}

fn corner_of(v: vec3<f32>) -> Corner {
    let plane = plane_for(v);
    if !plane.found {
        // About the singular direction, or beyond all rays of an open reflector.
        let behind = dot(v - spheres.centre, spheres.axis) < 0.0;
        return Corner(v, 0u, v, packed_found(vec2(0.0), select(LOST, HIDDEN, behind)));
    }
    // Along the reflector's shadow what it shows is its own image, so what lies in it is left where it is.
    let away = dot(plane.normal, arriving(camera, plane.point)) > 0.0;
    if away || dot(v - plane.point, plane.normal) < 0.0 {
        return Corner(v, 0u, v, packed_found(vec2(0.0), HIDDEN));
    }
    return Corner(v, 0u, image_of(v, vec2(0.0), plane.point, plane.normal), packed_found(vec2(0.0), SHOWN));
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let index = id.x;
    if index >= search.total || owners[index] == search.reflector {
        return;
    }
    let corner = corner_of(world_position(objects[owners[index]], vertices[index].position));
    corners[index] = corner;
    count(0u, 1u);
    count(1u, steps);
    count_most(2u, steps);
    count(3u, select(0u, 1u, status_of(corner) == HIDDEN));
    count(4u, select(0u, 1u, status_of(corner) == LOST));
}
