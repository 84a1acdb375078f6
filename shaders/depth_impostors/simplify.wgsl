// Rows of rotated depth maps as a few segments each (Popescu et al. 2006, slide 37: "pre-simplify rows"; on
// the GPU as their slide 50 has it for future work). An invocation has a row and sweeps over it, all rows in
// step: splitting the worst pieces, as on a processor, leaves most lanes of a group waiting for the one that
// still has some to split. Rust twin: geometry/depth_rows/sweep.rs.
#import depth_impostors::build::build

@group(0) @binding(1) var samples: texture_2d_array<u32>;
// Segments in use of each row of all maps of all layers.
@group(0) @binding(2) var<storage, read_write> counts: array<u32>;
// `build.segments` a row.
@group(0) @binding(3) var<storage, read_write> segments: array<vec2<u32>>;
// While a row is being simplified, its pieces from left to right, as many as it has samples: first and last
// sample, 16 bits each.
@group(0) @binding(4) var<storage, read_write> pieces: array<u32>;

// How much more a row may err when it has too many pieces, at least; and of what would do if a piece's error
// went with the square of its length.
const MORE: f32 = 1.3;
const SHARE: f32 = 0.5;
const STEEPEST: f32 = 1.0e30;
// No piece, and none begins or ends at its halves.
const NONE: u32 = 0xffffffffu;

// The row and its map in `samples`, and where it begins in `pieces`.
var<private> row: u32;
var<private> map: u32;
var<private> base: u32;
// Pieces, and the stretches without a silhouette that they make up.
var<private> count: u32;
var<private> runs: u32;
// The piece being made, and the slopes that keep its segment within the tolerance of all that it passes.
var<private> first: f32;
var<private> start: f32;
var<private> low: f32;
var<private> high: f32;

// Two of them a word.
fn eight_at(block: u32) -> vec4<u32> {
    return textureLoad(samples, vec2(block, row), map, 0);
}

fn sample_at(i: u32) -> f32 {
    let words = eight_at(i / 8u);
    let two = select(words.xy, words.zw, (i & 4u) == 4u);
    let pair = unpack2x16unorm(select(two.x, two.y, (i & 2u) == 2u));
    return select(pair.x, pair.y, (i & 1u) == 1u);
}

// Whether the piece can go on to a sample with all before it within the tolerance.
fn fits(x: f32, height: f32) -> bool {
    let run = x - first;
    let rise = height - start;
    return run * low <= rise && rise <= run * high;
}

// The slopes that are left when it has gone on to a sample right of its first.
fn kept(x: f32, height: f32, tolerance: f32) -> vec2<f32> {
    let run = x - first;
    let rise = height - start;
    return vec2(max(low, (rise - tolerance) / run), min(high, (rise + tolerance) / run));
}

// What eight samples bring, a bit each: a piece ends before it; a stretch starts with it.
var<private> ends: u32;
var<private> starts: u32;
// The last sample looked at.
var<private> before: f32;

// Look at the next sample. No branches: software would take both sides of each.
fn sweep(i: u32, height: f32) {
    let goes_on = before > 0.0 && height > 0.0 && abs(height - before) <= build.jump;
    let x = f32(i);
    let joint = goes_on && !fits(x, height);
    let bit = 1u << (i & 7u);
    ends |= select(0u, bit, joint || before > 0.0 && !goes_on);
    starts |= select(0u, bit, height > 0.0 && !goes_on);
    first = select(first, x - 1.0, joint);
    start = select(start, before, joint);
    low = select(low, -STEEPEST, joint);
    high = select(high, STEEPEST, joint);
    let slopes = kept(x, height, build.tolerance);
    first = select(x, first, goes_on);
    start = select(height, start, goes_on);
    low = select(-STEEPEST, slopes.x, goes_on);
    high = select(STEEPEST, slopes.y, goes_on);
    before = height;
}

fn sweep_pair(i: u32, packed: u32) {
    let pair = unpack2x16unorm(packed);
    sweep(i, pair.x);
    sweep(i + 1u, pair.y);
}

// The longest pieces within the tolerance.
fn find_pieces() {
    before = 0.0;
    // Where the piece begins that has not been stored.
    var head = 0u;
    for (var block = 0u; block < build.size / 8u; block += 1u) {
        let words = eight_at(block);
        if before == 0.0 && all(words == vec4(0u)) {
            continue;
        }
        ends = 0u;
        starts = 0u;
        sweep_pair(8u * block, words.x);
        sweep_pair(8u * block + 2u, words.y);
        sweep_pair(8u * block + 4u, words.z);
        sweep_pair(8u * block + 6u, words.w);
        runs += countOneBits(starts);
        // Stored here and not where they end: software takes both sides of all branches, and as long over a
        // store as over ten samples.
        var left = ends | starts;
        while left != 0u {
            let bit = firstTrailingBit(left);
            let i = 8u * block + bit;
            if ((ends >> bit) & 1u) == 1u {
                store(head, i - 1u);
            }
            head = i - 1u + ((starts >> bit) & 1u);
            left &= left - 1u;
        }
    }
    if before > 0.0 {
        store(head, build.size - 1u);
    }
}

fn store(head: u32, tail: u32) {
    pieces[base + count] = head | (tail << 16u);
    count += 1u;
}

// Join neighbouring pieces, where the ends between them are within the tolerance of what joins them.
fn join(tolerance: f32) {
    let all = count;
    count = 0u;
    // Of the piece being made.
    var head = 0u;
    var tail = NONE;
    for (var i = 0u; i < all; i += 1u) {
        let piece = pieces[base + i];
        let x = f32(piece >> 16u);
        let height = sample_at(piece >> 16u);
        if tail != (piece & 0xffffu) || !fits(x, height) {
            if tail != NONE {
                store(head, tail);
            }
            head = piece & 0xffffu;
            first = f32(head);
            start = sample_at(head);
            low = -STEEPEST;
            high = STEEPEST;
        }
        tail = piece >> 16u;
        let slopes = kept(x, height, tolerance);
        low = select(low, slopes.x, tail > head);
        high = select(high, slopes.y, tail > head);
    }
    store(head, tail);
}

// From sample centre to sample centre, on to the texel's border where the next piece does not begin with
// the same sample.
fn segment(before: u32, span: u32, after: u32) -> vec2<u32> {
    let head = span & 0xffffu;
    let tail = span >> 16u;
    let low = select(0.0, 0.5, before >> 16u == head);
    let high = select(1.0, 0.5, (after & 0xffffu) == tail);
    let ends = vec2(f32(head) + low, f32(tail) + high);
    let heights = vec2(sample_at(head), sample_at(tail));
    return vec2(pack2x16unorm(ends / f32(build.size)), pack2x16unorm(heights));
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= build.maps * build.size {
        return;
    }
    row = id.x % build.size;
    map = id.x / build.size;
    base = id.x * build.size;
    find_pieces();
    var tolerance = build.tolerance;
    while count > max(build.segments, runs) {
        let times = f32(count) / f32(build.segments);
        tolerance *= max(SHARE * times * times, MORE);
        join(tolerance);
    }
    if count > build.segments {
        // Silhouettes alone are too many: the last piece runs on over what is left.
        let end = pieces[base + count - 1u] & 0xffff0000u;
        count = build.segments;
        pieces[base + count - 1u] = end | (pieces[base + count - 1u] & 0xffffu);
    }
    let of_all = (build.layer * build.angles + build.first_map) * build.size + id.x;
    counts[of_all] = count;
    var before = NONE;
    for (var i = 0u; i < count; i += 1u) {
        let span = pieces[base + i];
        var after = NONE;
        if i + 1u < count {
            after = pieces[base + i + 1u];
        }
        segments[of_all * build.segments + i] = segment(before, span, after);
        before = span;
    }
}
