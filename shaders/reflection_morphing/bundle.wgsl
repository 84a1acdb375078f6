// Where a point is seen, given the ray nearest to it: through that ray (Martin & Popescu 2004), or between the
// four rays of the map that it runs among. Rust twin: geometry/ray_bundle.rs.
#define_import_path reflection_morphing::bundle

#import common::cube::{cube_direction, cube_texel}
#import reflection_morphing::octree::{RaySegment, octree, segments}

#ifdef RAY_MAP
// For each texel, layer after layer, the place of its segment, or `NONE`.
@group(0) @binding(45) var<storage, read> ray_map: array<u32>;
#endif

const NONE: u32 = 0xffffffffu;

struct Seen {
    // Of the first reflector.
    point: vec3<f32>,
    // Metres from there to the point seen, along the trace.
    way: f32,
    // The point lies within a bundle; or so near to one, at the rim, that the next ray may run there.
    within: bool,
    known: bool,
}

fn texels() -> u32 {
    return 6u * octree.map * octree.map;
}

// The ray's first reflector's point, and the metres from there to the last one's.
fn before(ray: u32) -> vec4<f32> {
    let last = segments[ray];
    var at = last.start;
    var way = 0.0;
#ifdef RAY_MAP
    for (var texel = last.texel; texel >= texels(); texel -= texels()) {
        let start = segments[ray_map[texel - texels()]].start;
        way += distance(start, at);
        at = start;
    }
#endif
    return vec4(at, way);
}

// Through one ray, the nearest.
fn seen_by_ray(point: vec3<f32>, nearest: u32) -> Seen {
    let first = before(nearest);
    let on = distance(segments[nearest].start, point);
    return Seen(first.xyz, first.w + on, true, true);
}

#ifdef POINT_BUNDLE
// How far beyond its four rays a bundle is trusted at the rim, in texels: as far as the next would be.
const RIM: f32 = 1.0;
// Rounding, in texels.
const SLACK: f32 = 1e-3;
// Quads walked over, and Newton's steps in each.
const QUADS: u32 = 6u;
const STEPS: u32 = 4u;

// The texel at a place of a face, or of the next face where the place is beside it.
fn texel_at(face: u32, at: vec2<i32>) -> u32 {
    let size = i32(octree.map);
    if all(at >= vec2(0)) && all(at < vec2(size)) {
        return (face * octree.map + u32(at.y)) * octree.map + u32(at.x);
    }
    let beside = cube_texel(cube_direction(face, (vec2<f32>(at) + 0.5) / f32(size)));
    let place = min(vec2<u32>(beside.uv * f32(size)), vec2(octree.map - 1u));
    return (beside.face * octree.map + place.y) * octree.map + place.x;
}

// Four neighbouring rays; `whole` where all are of the trace.
struct Quad {
    rays: vec4<u32>,
    whole: bool,
}

fn quad_at(like: RaySegment, face: u32, at: vec2<i32>) -> Quad {
    let layer = like.texel / texels() * texels();
    var quad = Quad(vec4(NONE), true);
    for (var corner = 0; corner < 4; corner += 1) {
        let ray = ray_map[layer + texel_at(face, at + vec2(corner & 1, corner >> 1u))];
        quad.rays[corner] = ray;
        if ray == NONE {
            quad.whole = false;
        } else if segments[ray].trace != like.trace {
            quad.whole = false;
        }
    }
    return quad;
}

fn way_of(segment: RaySegment) -> vec3<f32> {
    let along = segment.end - segment.start;
    return along / max(length(along), 1e-30);
}

// Where between four rays one runs through a point: `d x (point - p)` is 0, for the start `p` and the way `d`
// there. z: 1 where there is such a place.
fn place_in(quad: Quad, point: vec3<f32>) -> vec3<f32> {
    let a = segments[quad.rays.x];
    let b = segments[quad.rays.y];
    let c = segments[quad.rays.z];
    let d = segments[quad.rays.w];
    let way_a = way_of(a);
    let way_b = way_of(b);
    let way_c = way_of(c);
    let way_d = way_of(d);
    var place = vec2(0.5);
    for (var step = 0u; step < STEPS; step += 1u) {
        let p_x = mix(b.start - a.start, d.start - c.start, place.y);
        let p_y = mix(c.start - a.start, d.start - b.start, place.x);
        let d_x = mix(way_b - way_a, way_d - way_c, place.y);
        let d_y = mix(way_c - way_a, way_d - way_b, place.x);
        let start = mix(mix(a.start, b.start, place.x), mix(c.start, d.start, place.x), place.y);
        let way = mix(mix(way_a, way_b, place.x), mix(way_c, way_d, place.x), place.y);
        let towards = point - start;
        let law = cross(way, towards);
        let x = cross(d_x, towards) - cross(way, p_x);
        let y = cross(d_y, towards) - cross(way, p_y);
        // The least squares of law + x * dx + y * dy.
        let xx = dot(x, x);
        let xy = dot(x, y);
        let yy = dot(y, y);
        let determinant = xx * yy - xy * xy;
        if determinant <= 1e-6 * xx * yy {
            return vec3(0.0);
        }
        let lx = dot(x, law);
        let ly = dot(y, law);
        place -= vec2(yy * lx - xy * ly, xx * ly - xy * lx) / determinant;
        place = clamp(place, vec2(-8.0), vec2(9.0));
    }
    let start = mix(mix(a.start, b.start, place.x), mix(c.start, d.start, place.x), place.y);
    let way = mix(mix(way_a, way_b, place.x), mix(way_c, way_d, place.x), place.y);
    return vec3(place, select(0.0, 1.0, dot(way, point - start) > 0.0));
}

// Between the four rays of a quad.
fn seen_between(quad: Quad, place: vec2<f32>, point: vec3<f32>) -> Seen {
    let b = place;
    let a = 1.0 - b;
    let weights = vec4(a.x * a.y, b.x * a.y, a.x * b.y, b.x * b.y);
    var first = vec4(0.0);
    var last = vec3(0.0);
    for (var corner = 0u; corner < 4u; corner += 1u) {
        first += weights[corner] * before(quad.rays[corner]);
        last += weights[corner] * segments[quad.rays[corner]].start;
    }
    return Seen(first.xyz, first.w + distance(last, point), true, true);
}

// Between four rays, beginning beside the nearest.
fn seen(point: vec3<f32>, nearest: u32) -> Seen {
    var out = Seen(vec3(0.0), 0.0, false, false);
    let like = segments[nearest];
    let texel = like.texel % texels();
    let face = texel / (octree.map * octree.map);
    let home = vec2<i32>(vec2(texel % octree.map, texel / octree.map % octree.map));
    var at = home;
    var quad = quad_at(like, face, at);
    for (var side = 1; side < 4 && !quad.whole; side += 1) {
        at = home - vec2(side & 1, side >> 1u);
        quad = quad_at(like, face, at);
    }
    for (var walked = 0u; walked < QUADS && quad.whole; walked += 1u) {
        let found = place_in(quad, point);
        if found.z == 0.0 {
            return out;
        }
        let place = found.xy;
        let outside = abs(place - clamp(place, vec2(0.0), vec2(1.0)));
        let beyond = max(outside.x, outside.y);
        if beyond <= SLACK {
            return seen_between(quad, place, point);
        }
        at += vec2<i32>(clamp(floor(place), vec2(-2.0), vec2(2.0)));
        let next = quad_at(like, face, at);
        if !next.whole && beyond <= RIM {
            out = seen_between(quad, place, point);
            out.within = false;
            return out;
        }
        quad = next;
    }
    return out;
}
#else
fn seen(point: vec3<f32>, nearest: u32) -> Seen {
    return seen_by_ray(point, nearest);
}
#endif
