// Cells list the sheaves that cross them: first how many do, then (`FILL`) which.
#import reflection_morphing::eye_bins::{
    BLOCK, EyeRay, KIND, RAY_NONE, SHEAF, Sheaf, bins, cell_at, corner_of, farthest, half_of, index_of, level_of,
    sheaves_a_side
}

// Sheaves of each cell; when filling, those that are not in its list yet.
@group(0) @binding(42) var<storage, read_write> counts: array<atomic<u32>>;
#ifdef FILL
// Where each cell's list begins, from where its block's lists do.
@group(0) @binding(43) var<storage, read> starts: array<u32>;
@group(0) @binding(44) var<storage, read> blocks: array<u32>;
@group(0) @binding(45) var<storage, read_write> lists: array<u32>;
@group(0) @binding(46) var<storage, read> sheaves: array<Sheaf>;
#else
@group(0) @binding(41) var<storage, read> rays: array<EyeRay>;
@group(0) @binding(46) var<storage, read_write> sheaves: array<Sheaf>;
#endif

// Cells that a piece of a sheaf goes on by, or its own width where that is more.
const STRIDE: f32 = 1.0;
// What a sheaf is wider by, as a share, and metres: points that rounding puts into no bundle are given to the
// one they are next to.
const MARGIN: f32 = 0.01;
const LEAST_MARGIN: f32 = 1e-5;
// Rays that part wider are not followed all the way.
const SHORTEST: f32 = 0.2;

// Cells of a level between two, both among them.
struct Cells {
    low: vec3<i32>,
    high: vec3<i32>,
    level: u32,
}

fn holds(cells: Cells, cell: vec3<i32>, level: u32) -> bool {
    return level == cells.level && all(cell >= cells.low) && all(cell <= cells.high);
}

fn list(cell: u32, sheaf: u32) {
#ifdef FILL
    let place = starts[cell] + blocks[cell / BLOCK] + atomicSub(&counts[cell], 1u) - 1u;
    if place < bins.room {
        lists[place] = sheaf;
    }
#else
    atomicAdd(&counts[cell], 1u);
#endif
}

#ifndef FILL
// The least that a direction between rays can be long, each of which has length 1: what is between them at some
// length is nearer than that.
fn shortest(corner: vec2<u32>, end: vec2<u32>) -> f32 {
    var sum = vec3(0.0);
    for (var y = corner.y; y <= end.y; y += 1u) {
        for (var x = corner.x; x <= end.x; x += 1u) {
            sum += rays[y * bins.size + x].direction;
        }
    }
    let middle = sum / max(length(sum), 1e-9);
    var least = 1.0;
    for (var y = corner.y; y <= end.y; y += 1u) {
        for (var x = corner.x; x <= end.x; x += 1u) {
            let ray = rays[y * bins.size + x];
            if (ray.kind & KIND) != RAY_NONE {
                least = min(least, dot(ray.direction, middle));
            }
        }
    }
    return max(least, SHORTEST);
}

// The sheaf's record, from its rays.
fn sheaf_of(index: u32) -> Sheaf {
    let corner = corner_of(index);
    let end = min(corner + SHEAF, vec2(bins.size - 1u));
    var out = Sheaf(vec3(1e30), 0u, vec3(-1e30), 0.0, vec3(1e30), 0u, vec3(-1e30), 0u);
    for (var y = corner.y; y <= end.y; y += 1u) {
        for (var x = corner.x; x <= end.x; x += 1u) {
            let ray = rays[y * bins.size + x];
            if (ray.kind & KIND) != RAY_NONE {
                out.low = min(out.low, ray.origin);
                out.high = max(out.high, ray.origin);
                out.low_slope = min(out.low_slope, ray.direction);
                out.high_slope = max(out.high_slope, ray.direction);
                out.length = max(out.length, ray.length);
                out.rays += 1u;
            }
        }
    }
    out.length /= shortest(corner, end);
    let margin = MARGIN * (out.high - out.low) + LEAST_MARGIN;
    let margin_slope = MARGIN * (out.high_slope - out.low_slope);
    out.low -= margin;
    out.high += margin;
    out.low_slope -= margin_slope;
    out.high_slope += margin_slope;
    return out;
}
#endif

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let index = id.x;
    let side = sheaves_a_side();
    if index >= side * side {
        return;
    }
#ifdef FILL
    let sheaf = sheaves[index];
#else
    let sheaf = sheaf_of(index);
    sheaves[index] = sheaf;
#endif
    if sheaf.rays < 4u {
        return;
    }
    // What of the piece before is not listed again.
    var last = array(Cells(vec3(1), vec3(0), 0u), Cells(vec3(1), vec3(0), 0u));
    var before_low = sheaf.low - bins.centre;
    var before_high = sheaf.high - bins.centre;
    var length = 0.0;
    while length < sheaf.length {
        let at = level_of(farthest(0.5 * (before_low + before_high)));
        let wide = before_high - before_low;
        let stride = max(STRIDE * 2.0 * half_of(at) / f32(bins.side), max(wide.x, max(wide.y, wide.z)));
        length = min(length + stride, sheaf.length);
        let after_low = sheaf.low + length * sheaf.low_slope - bins.centre;
        let after_high = sheaf.high + length * sheaf.high_slope - bins.centre;
        // Nothing is looked for outside the scene's box.
        let low = max(min(before_low, after_low), bins.low - bins.centre);
        let high = min(max(before_high, after_high), bins.high - bins.centre);
        before_low = after_low;
        before_high = after_high;
        if any(low > high) {
            continue;
        }
        let nearest = max(low, -high);
        let first = level_of(max(max(nearest.x, nearest.y), nearest.z));
        let end = level_of(max(farthest(low), farthest(high)));
        var now = array(Cells(vec3(1), vec3(0), 0u), Cells(vec3(1), vec3(0), 0u));
        for (var level = first; level <= end; level += 1u) {
            let cells = Cells(cell_at(low, level), cell_at(high, level), level);
            // What the next smaller cube holds is listed there.
            let inner = select(i32(bins.side / 4u), i32(bins.side), level == 0u);
            let outer = i32(3u * (bins.side / 4u));
            for (var z = cells.low.z; z <= cells.high.z; z += 1) {
                for (var y = cells.low.y; y <= cells.high.y; y += 1) {
                    for (var x = cells.low.x; x <= cells.high.x; x += 1) {
                        let cell = vec3(x, y, z);
                        let is_inner = all(cell >= vec3(inner)) && all(cell < vec3(outer));
                        if !is_inner && !holds(last[0], cell, level) && !holds(last[1], cell, level) {
                            list(index_of(cell, level), index);
                        }
                    }
                }
            }
            now[min(level - first, 1u)] = cells;
        }
        last = now;
    }
}
