// Vertices where one reflector shows them to the eye: each is between four neighbouring rays (MORPH_VERTEX of
// Martin & Popescu 2004, section 6, at the eye's own place, where there is nothing to interpolate between).
#import bindings::record::count
#import bindings::scene::{objects, vertices, world_position}
#import common::camera::{Camera, arriving}
#import reflection_morphing::eye_bins::{
    BLOCK, Bundle, EyeRay, SHEAF, Sheaf, bins, bundle_between, cell_at, corner_of, farthest, index_of, level_of
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
@group(0) @binding(46) var<storage, read> sheaves: array<Sheaf>;
#endif
#ifdef FURTHER
// Of each ray the point of the first reflector on its way, and the metres from there to where it leaves the last.
@group(0) @binding(47) var<storage, read> firsts: array<vec4<f32>>;
#endif

const LOOK_UPS: u32 = 0u;
const RAYS: u32 = 1u;
const VALID: u32 = 2u;

// What Newton's steps take to any point of a bundle, and a few beside.
const STEPS: u32 = 6u;
// How far beside a bundle a point still counts as in it, as a share of its width; and how far from a point the
// ray found may pass it by.
const BESIDE: f32 = 1e-3;
// Farther from its middle than this after a step, as shares of its width, a point is in another bundle: for
// certain, and in all likelihood.
const AWAY: f32 = 2.5;
const ASTRAY: f32 = 1.0;

struct Place {
    // Between the bundle's rays, 0 to 1 along each side.
    at: vec2<f32>,
    // Where the ray through the point leaves the reflector.
    origin: vec3<f32>,
    // From there to the point.
    length: f32,
    // How often the bundle is turned over before.
    caustics: u32,
    within: bool,
}

// How often a bundle's rays cross before a length: its cross section is a + b l + c l^2, with a sign.
fn caustics_before(a: f32, b: f32, c: f32, length: f32) -> u32 {
    let at_end = a + length * (b + length * c);
    if a * at_end < 0.0 {
        return 1u;
    }
    // Both ends have one sign: between them it crosses twice or not at all.
    let turn = -0.5 * b;
    let is_within = turn * c > 0.0 && abs(turn) < abs(c) * length;
    return select(0u, 2u, is_within && b * b > 4.0 * a * c);
}

// The ray of a bundle that meets a point: origins and directions are interpolated between the four. Who is so far
// `away` from the middle is let go.
fn place_in(bundle: Bundle, v: vec3<f32>, away: f32) -> Place {
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
            out.at = at;
            out.origin = p;
            out.length = length;
            let x_l = d_x + at.y * d_xy;
            let y_l = d_y + at.x * d_xy;
            let x_0 = x - length * x_l;
            let y_0 = y - length * y_l;
            out.caustics = caustics_before(
                dot(cross(x_0, y_0), d),
                dot(cross(x_0, y_l) + cross(x_l, y_0), d),
                dot(cross(x_l, y_l), d),
                length,
            );
            out.within = all(abs(moved) < vec2(BESIDE)) && all(abs(at - 0.5) <= vec2(0.5 + BESIDE)) && length > 0.0;
            break;
        }
        at += moved;
        out.at = at;
        length += dot(across, left) / volume;
        // Also where there was no volume.
        if !all(abs(at - 0.5) < vec2(away)) {
            break;
        }
    }
    return out;
}

// The ray of a bundle that meets a point. Of several bundles with one, that turned over least often: before any
// caustic a path is the shortest of those beside it, as all are before a convex mirror. Of those that of the shortest
// path; of equals the first, so that the order of lists does not matter.
struct Found {
    // Where it leaves the last reflector, and the first, with the metres between.
    origin: vec3<f32>,
    first: vec4<f32>,
    caustics: u32,
    // From the eye to the point.
    path: f32,
    texel: u32,
    found: bool,
}

// Bundles looked into.
var<private> examined: u32;

fn bundle_at(texel: vec2<u32>) -> Bundle {
    let first = texel.y * bins.size + texel.x;
    let below = first + bins.size;
    return bundle_between(rays[first], rays[first + 1u], rays[below], rays[below + 1u]);
}

// Where a ray of the bundle at a texel leaves the first reflector, and the metres from there to the last.
fn first_of(place: Place, texel: u32) -> vec4<f32> {
#ifdef FURTHER
    let above = mix(firsts[texel], firsts[texel + 1u], place.at.x);
    let below = mix(firsts[texel + bins.size], firsts[texel + bins.size + 1u], place.at.x);
    return mix(above, below, place.at.y);
#else
    return vec4(place.origin, 0.0);
#endif
}

// With what a bundle gives, at its first texel.
fn with_place(found: Found, place: Place, texel: vec2<u32>) -> Found {
    let index = texel.y * bins.size + texel.x;
    let first = first_of(place, index);
    let path = dot(first.xyz - camera.eye, arriving(camera, first.xyz)) + (first.w + place.length);
    if found.found {
        let is_level = place.caustics == found.caustics;
        let is_same = is_level && path == found.path;
        if place.caustics > found.caustics || is_level && path > found.path || is_same && index >= found.texel {
            return found;
        }
    }
    return Found(place.origin, first, place.caustics, path, index, true);
}

// With what all bundles between two texels give, the second beyond the last.
fn with_all(found: Found, first: vec2<u32>, end: vec2<u32>, v: vec3<f32>) -> Found {
    var out = found;
    for (var y = first.y; y < end.y; y += 1u) {
        for (var x = first.x; x < end.x; x += 1u) {
            let bundle = bundle_at(vec2(x, y));
            if bundle.is_whole {
                examined += 1u;
                let place = place_in(bundle, v, AWAY);
                if place.within {
                    out = with_place(out, place, vec2(x, y));
                }
            }
        }
    }
    return out;
}

#ifdef BRUTE_FORCE
fn projected(v: vec3<f32>) -> Found {
    var out: Found;
    return with_all(out, vec2(0u), vec2(bins.size - 1u), v);
}
#else
// Whether a point is between a sheaf's rays at any length.
fn may_hold(sheaf: Sheaf, v: vec3<f32>) -> bool {
    var first = 0.0;
    var last = 1e30;
    let low = v - sheaf.low;
    let high = v - sheaf.high;
    for (var k = 0u; k < 3u; k += 1u) {
        // low_slope t <= low and high_slope t >= high.
        let slopes = vec2(sheaf.low_slope[k], -sheaf.high_slope[k]);
        let most = vec2(low[k], -high[k]);
        for (var side = 0u; side < 2u; side += 1u) {
            let at = most[side] / slopes[side];
            if slopes[side] > 0.0 {
                last = min(last, at);
            } else if slopes[side] < 0.0 {
                first = max(first, at);
            } else if most[side] < 0.0 {
                last = -1.0;
            }
        }
    }
    return first <= last;
}

// Bundles that a walk goes through.
const WALK: u32 = 6u;

// With what is found by going from a sheaf's middle from bundle to bundle, as each says the point is beside it.
fn with_walk(found: Found, first: vec2<u32>, end: vec2<u32>, v: vec3<f32>) -> Found {
    var texel = (first + end) / 2u;
    for (var step = 0u; step < WALK; step += 1u) {
        let bundle = bundle_at(texel);
        if !bundle.is_whole {
            break;
        }
        examined += 1u;
        let place = place_in(bundle, v, ASTRAY);
        if place.within {
            return with_place(found, place, texel);
        }
        let on = vec2<i32>(texel) + vec2<i32>(floor(clamp(place.at, vec2(-8.0), vec2(8.0))));
        let next = vec2<u32>(clamp(on, vec2<i32>(first), vec2<i32>(end) - 1));
        if all(next == texel) {
            break;
        }
        texel = next;
    }
    return found;
}

fn projected(v: vec3<f32>) -> Found {
    var out: Found;
    if any(v < bins.low) || any(v > bins.high) {
        return out;
    }
    let offset = v - bins.centre;
    let level = level_of(farthest(offset));
    let cell = index_of(cell_at(offset, level), level);
    let first = starts[cell] + blocks[cell / BLOCK];
    let last = starts[cell + 1u] + blocks[(cell + 1u) / BLOCK];
    // A list without room is not whole.
    if last > bins.room {
        return out;
    }
    // Walks find nearly all; where none does, nothing is passed over.
    for (var all = 0u; all < 2u && !out.found; all += 1u) {
        for (var place = first; place < last; place += 1u) {
            let sheaf = lists[place];
            if !may_hold(sheaves[sheaf], v) {
                continue;
            }
            let corner = corner_of(sheaf);
            let end = min(corner + SHEAF, vec2(bins.size - 1u));
            if all == 0u {
                out = with_walk(out, corner, end, v);
            } else {
                out = with_all(out, corner, end, v);
            }
        }
    }
    return out;
}
#endif

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
        count(RAYS, examined);
        if found.found {
            // "Push this point along the ray from the desired view to itself" (figure 7); over more reflectors, by
            // the way over all of them.
            let p = found.first.xyz;
            corner.image = p + (found.first.w + distance(v, found.origin)) * arriving(camera, p);
            corner.found = packed_found(vec2(0.0), SHOWN);
            count(VALID, 1u);
        }
    }
    corners[vertex] = corner;
}
