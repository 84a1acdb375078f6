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
    pad_a: u32,
    pad_b: u32,
    pad_c: u32,
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
fn is_asked_for(segment: RaySegment) -> bool {
#ifdef TRACES_MIXED
    return (segment.trace & 0xffu) == (octree.trace & 0xffu);
#else
    return segment.trace == octree.trace;
#endif
}

// The nearer of what was found and a ray; of two as near the first in the map.
fn nearer(nearest: Nearest, ray: u32, point: vec3<f32>) -> Nearest {
    let segment = segments[ray];
    if !is_asked_for(segment) {
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
    var out = Nearest(0u, false, 0u, 0.0);
    for (var ray = 0u; ray < octree.segments; ray += 1u) {
        out = nearer(out, ray, point);
    }
    return out;
}
#else ifdef LEAVES_NEIGHBOURS
const MAX_DEPTH: u32 = 10u;
// Of each level seven cells wait while one is open.
const WAITING: u32 = 71u;

// A cell to be visited: its word, its corner in cells of `MAX_DEPTH`, and how often its box was halved.
struct Visit {
    cell: u32,
    level: u32,
    corner: vec3<u32>,
}

// Where a corner of cells is, world.
fn cell_corner(corner: vec3<u32>) -> vec3<f32> {
    return octree.low + vec3<f32>(corner) / f32(1u << MAX_DEPTH) * (octree.high - octree.low);
}

// The square of a point's distance from a cell.
fn distance_to(visit: Visit, point: vec3<f32>) -> f32 {
    let low = cell_corner(visit.corner);
    let high = cell_corner(visit.corner + (1u << (MAX_DEPTH - visit.level)));
    let apart = point - clamp(point, low, high);
    return dot(apart, apart);
}

// Of the leaves it can run through, near ones first.
fn nearest(point: vec3<f32>) -> Nearest {
    var out = Nearest(0u, false, 0u, 0.0);
    var waiting: array<Visit, WAITING>;
    waiting[0] = Visit(cells[0], 0u, vec3(0u));
    var count = 1u;
    while count > 0u {
        count -= 1u;
        let visit = waiting[count];
        if out.found && distance_to(visit, point) > out.distance_squared {
            continue;
        }
        if (visit.cell & LEAF) != 0u {
            let leaf = visit.cell & ~LEAF;
            for (var place = starts[leaf]; place < starts[leaf + 1u]; place += 1u) {
                out = nearer(out, lists[place], point);
            }
            continue;
        }
        let half = 1u << (MAX_DEPTH - visit.level - 1u);
        let upper = point >= cell_corner(visit.corner + half);
        let near = dot(vec3<u32>(upper), vec3(1u, 2u, 4u));
        // The last pushed is visited first: the part nearest to the point.
        for (var part = 0u; part < 8u; part += 1u) {
            let which = near ^ (7u - part);
            let step = vec3(which & 1u, (which >> 1u) & 1u, which >> 2u);
            let cell = cells[visit.cell + which];
            waiting[count] = Visit(cell, visit.level + 1u, visit.corner + half * step);
            count += 1u;
        }
    }
    return out;
}
#else
// Of the rays in the point's own leaf.
fn nearest(point: vec3<f32>) -> Nearest {
    var out = Nearest(0u, false, 0u, 0.0);
    if any(point < octree.low) || any(point > octree.high) {
        return out;
    }
    let leaf = leaf_of(point);
    for (var place = starts[leaf]; place < starts[leaf + 1u]; place += 1u) {
        out = nearer(out, lists[place], point);
    }
    return out;
}
#endif
