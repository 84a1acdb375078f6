// Cells list the bundles that cross them: first how many do, then (`FILL`) which.
#import reflection_morphing::eye_bins::{
    BLOCK, Bundle, EyeRay, begins, bins, bundle_between, cell_at, cells_a_level, farthest, half_of, index_of,
    level_of
}

@group(0) @binding(41) var<storage, read> rays: array<EyeRay>;
// Bundles of each cell; when filling, those that are not in its list yet.
@group(0) @binding(42) var<storage, read_write> counts: array<atomic<u32>>;
#ifdef FILL
// Where each cell's list begins, from where its block's lists do.
@group(0) @binding(43) var<storage, read> starts: array<u32>;
@group(0) @binding(44) var<storage, read> blocks: array<u32>;
@group(0) @binding(45) var<storage, read_write> lists: array<u32>;
#endif

// Cells that a piece of a bundle goes on by.
const STRIDE: f32 = 1.0;
// What a piece's box is wider by, as a share, and metres: points that rounding puts into no bundle are given to
// the one they are next to.
const MARGIN: f32 = 0.01;
const LEAST_MARGIN: f32 = 1e-5;

// Cells of a level between two, both among them.
struct Cells {
    low: vec3<i32>,
    high: vec3<i32>,
    level: u32,
}

fn holds(cells: Cells, cell: vec3<i32>, level: u32) -> bool {
    return level == cells.level && all(cell >= cells.low) && all(cell <= cells.high);
}

fn list(cell: u32, bundle: u32) {
#ifdef FILL
    let place = starts[cell] + blocks[cell / BLOCK] + atomicSub(&counts[cell], 1u) - 1u;
    if place < bins.room {
        lists[place] = bundle;
    }
#else
    atomicAdd(&counts[cell], 1u);
#endif
}

struct Box {
    low: vec3<f32>,
    high: vec3<f32>,
}

// About a bundle's rays, all of the same length.
fn box_at(bundle: Bundle, length: f32) -> Box {
    let a = bundle.origins[0] + length * bundle.directions[0];
    let b = bundle.origins[1] + length * bundle.directions[1];
    let c = bundle.origins[2] + length * bundle.directions[2];
    let d = bundle.origins[3] + length * bundle.directions[3];
    return Box(min(min(a, b), min(c, d)), max(max(a, b), max(c, d)));
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let texel = id.x;
    if !begins(texel) {
        return;
    }
    let below = texel + bins.size;
    let bundle = bundle_between(rays[texel], rays[texel + 1u], rays[below], rays[below + 1u]);
    if !bundle.is_whole {
        return;
    }
    // What of the piece before is not listed again.
    var last: array<Cells, 2>;
    last[0] = Cells(vec3(1), vec3(0), 0u);
    last[1] = last[0];
    var length = 0.0;
    var before = box_at(bundle, 0.0);
    while length < bundle.length {
        let at = level_of(farthest(0.5 * (before.low + before.high) - bins.centre));
        length = min(length + STRIDE * 2.0 * half_of(at) / f32(bins.side), bundle.length);
        // A bundle's points at one length are between its four rays', as all is linear in each.
        let after = box_at(bundle, length);
        var low = min(before.low, after.low);
        var high = max(before.high, after.high);
        let margin = MARGIN * (high - low) + LEAST_MARGIN;
        low -= margin + bins.centre;
        high += margin - bins.centre;
        before = after;
        let nearest = max(low, -high);
        let first = level_of(max(max(nearest.x, nearest.y), nearest.z));
        let end = level_of(max(farthest(low), farthest(high)));
        var now = last;
        now[0] = Cells(vec3(1), vec3(0), 0u);
        now[1] = now[0];
        for (var level = first; level <= end; level += 1u) {
            let cells = Cells(cell_at(low, level), cell_at(high, level), level);
            // What the next smaller cube holds is listed there.
            let inner = i32(bins.side / 4u);
            let outer = i32(3u * (bins.side / 4u));
            for (var z = cells.low.z; z <= cells.high.z; z += 1) {
                for (var y = cells.low.y; y <= cells.high.y; y += 1) {
                    for (var x = cells.low.x; x <= cells.high.x; x += 1) {
                        let cell = vec3(x, y, z);
                        let is_inner = level > 0u && all(cell >= vec3(inner)) && all(cell < vec3(outer));
                        if !is_inner && !holds(last[0], cell, level) && !holds(last[1], cell, level) {
                            list(index_of(cell, level), texel);
                        }
                    }
                }
            }
            now[min(level - first, 1u)] = cells;
        }
        last = now;
    }
}
