// Rows of rotated depth maps as a few segments each (Popescu et al. 2006, slide 37: "pre-simplify rows"; on
// the GPU as their slide 50 has it for future work). An invocation has a row: there are thousands, and none
// waits for another. Rust twin: geometry/depth_rows/simplify.rs.
#import depth_impostors::build::build

@group(0) @binding(1) var<storage, read> samples: array<vec4<u32>>;
// Segments in use of each row of all maps of all layers.
@group(0) @binding(2) var<storage, read_write> counts: array<u32>;
// `build.segments` a row. While a row is being simplified, its pieces from left to right: first and last
// sample (16 bits each); where the segment between them errs most, and there by how much (0 once that is
// within the tolerance). An array of the invocation's own would do, but lavapipe (Mesa 22.3) takes a
// hundred times as long over those.
@group(0) @binding(3) var<storage, read_write> segments: array<vec2<u32>>;

// The second word of a piece that has not been measured.
const NEW: u32 = 0xffffffffu;

var<private> count: u32;
// Where the row begins in `samples` and in `segments`.
var<private> base: u32;
var<private> slot: u32;

fn sample_at(i: u32) -> f32 {
    let pair = unpack2x16unorm(samples[base + i / 8u][(i / 2u) & 3u]);
    return select(pair.x, pair.y, (i & 1u) == 1u);
}

// Eight samples.
struct Block {
    low: vec4<f32>,
    high: vec4<f32>,
}

fn block_at(block: u32) -> Block {
    let words = samples[base + block];
    return Block(
        vec4(unpack2x16unorm(words.x), unpack2x16unorm(words.y)),
        vec4(unpack2x16unorm(words.z), unpack2x16unorm(words.w)),
    );
}

// Stretches of samples without a silhouette between them; once there are as many as may be, the last runs
// on over what is left.
fn find_runs() {
    count = 0u;
    var before = 0.0;
    // The run being followed.
    var first = 0u;
    var last = 0u;
    for (var block = 0u; block < build.size / 8u; block += 1u) {
        let here = block_at(block);
        let fall = max(
            abs(here.low - vec4(before, here.low.xyz)),
            abs(here.high - vec4(here.low.w, here.high.xyz)),
        );
        let least = min(here.low, here.high);
        let steep = max(max(fall.x, fall.y), max(fall.z, fall.w)) > build.jump;
        let all_there = min(min(least.x, least.y), min(least.z, least.w)) > 0.0;
        if !steep && all_there && before > 0.0 {
            // Most blocks: more of the same surface.
            last = 8u * block + 7u;
            before = here.high.w;
            continue;
        }
        let most = max(here.low, here.high);
        if max(max(most.x, most.y), max(most.z, most.w)) == 0.0 {
            before = 0.0;
            continue;
        }
        for (var i = 0u; i < 8u; i += 1u) {
            let at = 8u * block + i;
            let height = sample_at(at);
            if height > 0.0 {
                let parted = before == 0.0 || abs(height - before) > build.jump;
                if count == 0u || parted && count < build.segments {
                    if count > 0u {
                        segments[slot + count - 1u] = vec2(first | (last << 16u), NEW);
                    }
                    first = at;
                    count += 1u;
                }
                last = at;
            }
            before = height;
        }
    }
    if count > 0u {
        segments[slot + count - 1u] = vec2(first | (last << 16u), NEW);
    }
}

// The second word of the piece with this first one.
fn measured(span: u32) -> u32 {
    let first = span & 0xffffu;
    let last = span >> 16u;
    let start = sample_at(first);
    let slope = (sample_at(last) - start) / f32(max(last - first, 1u));
    let end = f32(last) - f32(first);
    var error = build.tolerance;
    var at = first;
    for (var block = first / 8u; block <= last / 8u; block += 1u) {
        let here = block_at(block);
        // Samples from the piece's first on.
        let low = f32(8u * block) - f32(first) + vec4(0.0, 1.0, 2.0, 3.0);
        let high = low + 4.0;
        let inside_low = low > vec4(0.0) & low < vec4(end);
        let inside_high = high > vec4(0.0) & high < vec4(end);
        let off_low = select(vec4(0.0), abs(here.low - (start + slope * low)), inside_low);
        let off_high = select(vec4(0.0), abs(here.high - (start + slope * high)), inside_high);
        let off = max(off_low, off_high);
        let largest = max(max(off.x, off.y), max(off.z, off.w));
        if largest > error {
            error = largest;
            var which = select(7u, 6u, off_high.z == largest);
            which = select(which, 5u, off_high.y == largest);
            which = select(which, 4u, off_high.x == largest);
            which = select(which, 3u, off_low.w == largest);
            which = select(which, 2u, off_low.z == largest);
            which = select(which, 1u, off_low.y == largest);
            at = 8u * block + select(which, 0u, off_low.x == largest);
        }
    }
    if at == first {
        return 0u;
    }
    return at | (u32(max(65535.0 * error, 1.0)) << 16u);
}

// Measure what is new; the largest error of all.
fn measure() -> u32 {
    var largest = 0u;
    for (var i = 0u; i < count; i += 1u) {
        var piece = segments[slot + i];
        if piece.y == NEW {
            piece.y = measured(piece.x);
            segments[slot + i] = piece;
        }
        largest = max(largest, piece.y >> 16u);
    }
    return largest;
}

// Split the pieces that err at least half as much as the worst, from the left on while there is room.
fn split(largest: u32) {
    var erring = 0u;
    for (var i = 0u; i < count; i += 1u) {
        erring += select(0u, 1u, 2u * (segments[slot + i].y >> 16u) >= largest);
    }
    let room = build.segments - count;
    var spared = max(erring, room) - room;
    // From the right, so that each piece goes to its place at once.
    var to = count + min(erring, room);
    for (var i = count; i > 0u; i -= 1u) {
        let piece = segments[slot + i - 1u];
        let errs = 2u * (piece.y >> 16u) >= largest;
        if errs && spared == 0u {
            let at = piece.y & 0xffffu;
            to -= 2u;
            segments[slot + to + 1u] = vec2(at | (piece.x & 0xffff0000u), NEW);
            segments[slot + to] = vec2((piece.x & 0xffffu) | (at << 16u), NEW);
        } else {
            spared -= select(0u, 1u, errs);
            to -= 1u;
            segments[slot + to] = piece;
        }
    }
    count += min(erring, room);
}

// From sample centre to sample centre, on to the texel's border where the next piece does not begin with
// the same sample.
fn segment(before: u32, span: u32, after: u32) -> vec2<u32> {
    let first = span & 0xffffu;
    let last = span >> 16u;
    let low = select(0.0, 0.5, before >> 16u == first);
    let high = select(1.0, 0.5, (after & 0xffffu) == last);
    let ends = vec2(f32(first) + low, f32(last) + high);
    let heights = vec2(sample_at(first), sample_at(last));
    return vec2(pack2x16unorm(ends / f32(build.size)), pack2x16unorm(heights));
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= build.maps * build.size {
        return;
    }
    let row = (build.layer * build.angles + build.first_map) * build.size + id.x;
    base = id.x * (build.size / 8u);
    slot = row * build.segments;
    find_runs();
    while count > 0u && count < build.segments {
        let largest = measure();
        if largest == 0u {
            break;
        }
        split(largest);
    }
    counts[row] = count;
    // No piece begins or ends there.
    var before = NEW;
    for (var i = 0u; i < count; i += 1u) {
        let span = segments[slot + i].x;
        var after = NEW;
        if i + 1u < count {
            after = segments[slot + i + 1u].x;
        }
        segments[slot + i] = segment(before, span, after);
        before = span;
    }
}
