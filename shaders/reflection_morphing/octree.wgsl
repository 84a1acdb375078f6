// A ray octree, and the ray that passes nearest to a point (Martin & Popescu 2004, section 4.2). Rust
// twin: geometry/ray_octree.rs.
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
    // The reflector's point, and whether there is any.
    point: vec3<f32>,
    found: bool,
    // Rays whose distance was taken.
    examined: u32,
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

// Of the rays of the trace asked for: those of the point's own leaf, or all (section 1.2).
fn nearest(point: vec3<f32>) -> Nearest {
    var out = Nearest(vec3(0.0), false, 0u);
    var least = 0.0;
#ifdef BRUTE_FORCE
    let first = 0u;
    let last = octree.segments;
#else
    if any(point < octree.low) || any(point > octree.high) {
        return out;
    }
    let leaf = leaf_of(point);
    let first = starts[leaf];
    let last = starts[leaf + 1u];
#endif
    for (var place = first; place < last; place += 1u) {
#ifdef BRUTE_FORCE
        let segment = segments[place];
#else
        let segment = segments[lists[place]];
#endif
        if segment.trace == octree.trace {
            out.examined += 1u;
            let distance = distance_squared(segment, point);
            if !out.found || distance < least {
                out.found = true;
                out.point = segment.start;
                least = distance;
            }
        }
    }
    return out;
}
