// Vertices where one reflector shows them to the eye: each is between four neighbouring rays (MORPH_VERTEX of
// Martin & Popescu 2004, section 6, at the eye's own place, where there is nothing to interpolate between).
#import bindings::record::count
#import bindings::scene::{objects, vertices, world_position}
#import common::camera::{Camera, arriving}
#import reflection_morphing::eye_bins::{
    BLOCK, Bundle, EyeRay, begins, bins, bundle_between, cell_at, farthest, index_of, level_of
}
#import virtual_objects::corner::{Corner, LOST, SHOWN, packed_found}

@group(0) @binding(1) var<storage, read> owners: array<u32>;
@group(0) @binding(3) var<storage, read_write> corners: array<Corner>;
// That of the view.
@group(0) @binding(4) var<uniform> camera: Camera;
@group(0) @binding(41) var<storage, read> rays: array<EyeRay>;
#ifndef BRUTE_FORCE
@group(0) @binding(43) var<storage, read> starts: array<u32>;
@group(0) @binding(44) var<storage, read> blocks: array<u32>;
@group(0) @binding(45) var<storage, read> lists: array<u32>;
#endif

const LOOK_UPS: u32 = 0u;
const RAYS: u32 = 1u;
const VALID: u32 = 2u;

// What Newton's steps take to any point of a bundle, and a few beside.
const STEPS: u32 = 6u;
// How far beside a bundle a point still counts as in it, as a share of its width; and how far from a point the
// ray found may pass it by.
const BESIDE: f32 = 1e-3;
// Beyond this after a step, as a share of its width from its middle, a point is in another bundle.
const AWAY: f32 = 2.5;

struct Place {
    // Where the ray through the point leaves the reflector.
    origin: vec3<f32>,
    // From there to the point.
    length: f32,
    within: bool,
}

// The ray of a bundle that meets a point: origins and directions are interpolated between the four.
fn place_in(bundle: Bundle, v: vec3<f32>) -> Place {
    let p_x = bundle.origins[1] - bundle.origins[0];
    let p_y = bundle.origins[2] - bundle.origins[0];
    let p_xy = bundle.origins[3] - bundle.origins[2] - p_x;
    let d_x = bundle.directions[1] - bundle.directions[0];
    let d_y = bundle.directions[2] - bundle.directions[0];
    let d_xy = bundle.directions[3] - bundle.directions[2] - d_x;
    var at = vec2(0.5);
    var length = dot(
        v - bundle.origins[0] - 0.5 * (p_x + p_y) - 0.25 * p_xy,
        normalize(bundle.directions[0] + bundle.directions[1] + bundle.directions[2] + bundle.directions[3]),
    );
    var out: Place;
    for (var step = 0u; step < STEPS; step += 1u) {
        let p = bundle.origins[0] + at.x * p_x + at.y * (p_y + at.x * p_xy);
        let d = bundle.directions[0] + at.x * d_x + at.y * (d_y + at.x * d_xy);
        let x = p_x + at.y * p_xy + length * (d_x + at.y * d_xy);
        let y = p_y + at.x * p_xy + length * (d_y + at.x * d_xy);
        let left = v - p - length * d;
        let across = cross(x, y);
        let volume = dot(across, d);
        let moved = vec2(dot(cross(left, y), d), dot(cross(x, left), d)) / volume;
        if step + 1u == STEPS || all(abs(moved) < vec2(0.1 * BESIDE)) {
            out.origin = p;
            out.length = length;
            out.within = all(abs(moved) < vec2(BESIDE)) && all(abs(at - 0.5) <= vec2(0.5 + BESIDE)) && length > 0.0;
            break;
        }
        at += moved;
        length += dot(across, left) / volume;
        // Also where there was no volume.
        if !all(abs(at - 0.5) < vec2(AWAY)) {
            break;
        }
    }
    return out;
}

struct Found {
    origin: vec3<f32>,
    // From the eye to the point.
    path: f32,
    bundle: u32,
    examined: u32,
    found: bool,
}

// A point may be in several bundles, as before a hollow mirror: that of the shortest path is taken, as what is
// seen by others is farther off. Of equals the first, so that the order of lists does not matter.
fn consider(found: Found, texel: u32, v: vec3<f32>) -> Found {
    var out = found;
    let below = texel + bins.size;
    let bundle = bundle_between(rays[texel], rays[texel + 1u], rays[below], rays[below + 1u]);
    if !bundle.is_whole {
        return out;
    }
    out.examined += 1u;
    let place = place_in(bundle, v);
    if !place.within {
        return out;
    }
    let path = dot(place.origin - camera.eye, arriving(camera, place.origin)) + place.length;
    if !out.found || path < out.path || path == out.path && texel < out.bundle {
        return Found(place.origin, path, texel, out.examined, true);
    }
    return out;
}

fn projected(v: vec3<f32>) -> Found {
    var out: Found;
#ifdef BRUTE_FORCE
    for (var texel = 0u; texel < bins.size * bins.size; texel += 1u) {
        if begins(texel) {
            out = consider(out, texel, v);
        }
    }
#else
    if any(v < bins.low) || any(v > bins.high) {
        return out;
    }
    let offset = v - bins.centre;
    let level = level_of(farthest(offset));
    let cell = index_of(cell_at(offset, level), level);
    let first = starts[cell] + blocks[cell / BLOCK];
    let last = starts[cell + 1u] + blocks[(cell + 1u) / BLOCK];
    // A list without room is not whole.
    if last <= bins.room {
        for (var place = first; place < last; place += 1u) {
            out = consider(out, lists[place], v);
        }
    }
#endif
    return out;
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let vertex = id.x;
    if vertex >= arrayLength(&owners) {
        return;
    }
    let owner = owners[vertex];
    let v = world_position(objects[owner], vertices[vertex].position);
    // Triangles that touch the eye cover no pixel: none but whole ones are drawn.
    var corner = Corner(v, 0u, camera.eye, packed_found(vec2(0.0), LOST));
    if owner != bins.reflector {
        let found = projected(v);
        count(LOOK_UPS, 1u);
        count(RAYS, found.examined);
        if found.found {
            // "Push this point along the ray from the desired view to itself" (figure 7).
            let p = found.origin;
            corner.image = p + distance(v, p) * arriving(camera, p);
            corner.found = packed_found(vec2(0.0), SHOWN);
            count(VALID, 1u);
        }
    }
    corners[vertex] = corner;
}
