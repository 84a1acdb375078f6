// A ray octree, and the ray that passes nearest to a point (Martin & Popescu 2004, section 4.2). Rust
// twins: geometry/ray_octree.rs and, for rays wherever they run, geometry/ray_octree/near.rs.
#define_import_path reflection_morphing::octree

struct RaySegment {
    // Where it leaves its last reflector, and where it ends, world.
    start: vec3<f32>,
    trace: u32,
    end: vec3<f32>,
    texel: u32,
}

struct Octree {
    low: vec3<f32>,
    // The rays asked for.
    trace: u32,
    high: vec3<f32>,
    segments: u32,
    // Texels along a side of the ray map's faces.
    map: u32,
    // The places that hold all rays of the trace, and 1 where they are few enough to be looked through.
    first: u32,
    end: u32,
    scan: u32,
}

@group(0) @binding(40) var<storage, read> octree: Octree;
// The root first: the place of the first of eight children, or `LEAF` and a leaf's number.
@group(0) @binding(41) var<storage, read> cells: array<u32>;
// Where each leaf's rays begin in `lists`, and where the last one's end.
@group(0) @binding(42) var<storage, read> starts: array<u32>;
@group(0) @binding(43) var<storage, read> lists: array<u32>;
@group(0) @binding(44) var<storage, read> segments: array<RaySegment>;

const LEAF: u32 = 0x80000000u;

struct Nearest {
    // The ray's place in `segments`, and whether there is any.
    ray: u32,
    found: bool,
    // Rays whose distance was taken.
    examined: u32,
    distance_squared: f32,
}

fn distance_squared(segment: RaySegment, point: vec3<f32>) -> f32 {
    let along = segment.end - segment.start;
    let way = point - segment.start;
    // A segment without length has no direction; then its start is nearest.
    let t = dot(way, along) / max(dot(along, along), 1.17549435e-38);
    let apart = way - clamp(t, 0.0, 1.0) * along;
    return dot(apart, apart);
}

// The leaf a point inside the octree is in.
fn leaf_of(point: vec3<f32>) -> u32 {
    var low = octree.low;
    var high = octree.high;
    var cell = cells[0];
    while (cell & LEAF) == 0u {
        let middle = 0.5 * (low + high);
        let upper = point >= middle;
        low = select(low, middle, upper);
        high = select(middle, high, upper);
        cell = cells[cell + dot(vec3<u32>(upper), vec3(1u, 2u, 4u))];
    }
    return cell & ~LEAF;
}

// Whether a ray is of those asked for: of the trace, or of any with the same first reflector.
fn is_asked_for(segment: RaySegment, trace: u32) -> bool {
#ifdef TRACES_MIXED
    return (segment.trace & 0xffu) == (trace & 0xffu);
#else
    return segment.trace == trace;
#endif
}

// What all invocations share, `trace` as here, is read once where no branch or loop is open, and by each lane where
// one is: software drivers know no better.

// The nearer of what was found and a ray; of two as near the first in the map.
fn nearer(nearest: Nearest, ray: u32, point: vec3<f32>, trace: u32) -> Nearest {
    let segment = segments[ray];
    if !is_asked_for(segment, trace) {
        return nearest;
    }
    let distance = distance_squared(segment, point);
    let tie = distance == nearest.distance_squared && ray < nearest.ray;
    let examined = nearest.examined + 1u;
    if !nearest.found || distance < nearest.distance_squared || tie {
        return Nearest(ray, true, examined, distance);
    }
    return Nearest(nearest.ray, true, examined, nearest.distance_squared);
}

#ifdef BRUTE_FORCE
// Of all rays (section 1.2).
fn nearest(point: vec3<f32>) -> Nearest {
    let trace = octree.trace;
    let end = octree.segments;
    var out = Nearest(0u, false, 0u, 0.0);
    for (var ray = 0u; ray < end; ray += 1u) {
        out = nearer(out, ray, point, trace);
    }
    return out;
}
#else ifdef LEAVES_NEIGHBOURS
const MAX_DEPTH: u32 = 10u;
// Of each level seven cells wait while one is open.
const WAITING: u32 = 71u;
// What a waiting cell's first word has besides a cell's: how often its box was halved. The second word is the
// box's corner, in cells of `MAX_DEPTH`.
const LEVEL: u32 = 27u;
const CELL: u32 = (1u << LEVEL) - 1u;

// Of the rays in a leaf, those that are nearer than what was found.
fn nearest_in(leaf: u32, found: Nearest, point: vec3<f32>, trace: u32) -> Nearest {
    var out = found;
    let end = starts[leaf + 1u];
    for (var place = starts[leaf]; place < end; place += 1u) {
        out = nearer(out, lists[place], point, trace);
    }
    return out;
}

// A point's distances from the lower and the upper half of a box's sides, squared.
struct Halves {
    lower: vec3<f32>,
    upper: vec3<f32>,
}

fn halves(point: vec3<f32>, corner: vec3<u32>, half: u32) -> Halves {
    let scale = (octree.high - octree.low) / f32(1u << MAX_DEPTH);
    let low = octree.low + vec3<f32>(corner) * scale;
    let middle = octree.low + vec3<f32>(corner + half) * scale;
    let high = octree.low + vec3<f32>(corner + 2u * half) * scale;
    let lower = point - clamp(point, low, middle);
    let upper = point - clamp(point, middle, high);
    return Halves(lower * lower, upper * upper);
}

// Of the leaves it can run through: the point's own, then those nearer than what was found, near ones first.
fn nearest(point: vec3<f32>) -> Nearest {
    let trace = octree.trace;
    var out = Nearest(0u, false, 0u, 0.0);
#ifndef TRACES_MIXED
    if octree.scan == 1u {
        let end = octree.end;
        for (var ray = octree.first; ray < end; ray += 1u) {
            out = nearer(out, ray, point, trace);
        }
        return out;
    }
#endif
    var own = LEAF;
    if all(point >= octree.low) && all(point <= octree.high) {
        own = leaf_of(point);
        out = nearest_in(own, out, point, trace);
    }
    var waiting: array<vec2<u32>, WAITING>;
    waiting[0] = vec2(cells[0], 0u);
    var count = 1u;
    while count > 0u {
        count -= 1u;
        let visit = waiting[count];
        if (visit.x & LEAF) != 0u {
            let leaf = visit.x & CELL;
            if leaf != own {
                out = nearest_in(leaf, out, point, trace);
            }
            continue;
        }
        let level = (visit.x >> LEVEL) & 15u;
        let half = 1u << (MAX_DEPTH - level - 1u);
        let corner = vec3(visit.y & 1023u, (visit.y >> 10u) & 1023u, visit.y >> 20u);
        let away = halves(point, corner, half);
        let near = dot(vec3<u32>(away.upper < away.lower), vec3(1u, 2u, 4u));
        // The last pushed is visited first: the part nearest to the point.
        for (var part = 0u; part < 8u; part += 1u) {
            let which = near ^ (7u - part);
            let step = vec3(which & 1u, (which >> 1u) & 1u, which >> 2u);
            let apart = dot(select(away.lower, away.upper, step == vec3(1u)), vec3(1.0));
            if !out.found || apart <= out.distance_squared {
                let cell = cells[(visit.x & CELL) + which];
                let at = visit.y + half * dot(step, vec3(1u, 1u << 10u, 1u << 20u));
                waiting[count] = vec2(cell | ((level + 1u) << LEVEL), at);
                count += 1u;
            }
        }
    }
    return out;
}
#else
// Of the rays in the point's own leaf.
fn nearest(point: vec3<f32>) -> Nearest {
    let trace = octree.trace;
    var out = Nearest(0u, false, 0u, 0.0);
    if any(point < octree.low) || any(point > octree.high) {
        return out;
    }
    let leaf = leaf_of(point);
    let end = starts[leaf + 1u];
    for (var place = starts[leaf]; place < end; place += 1u) {
        out = nearer(out, lists[place], point, trace);
    }
    return out;
}
#endif
