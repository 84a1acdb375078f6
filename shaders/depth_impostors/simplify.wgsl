// Rows of rotated depth maps as a few segments each (Popescu et al. 2006, slide 37: "pre-simplify rows"; on
// the GPU as their slide 50 has it for future work). An invocation has a row: there are thousands, and none
// waits for another. Rust twin: geometry/depth_rows/simplify.rs.
#import depth_impostors::build::build

@group(0) @binding(1) var<storage, read> samples: array<vec4<u32>>;
// Segments in use of each row of all maps of all layers.
@group(0) @binding(2) var<storage, read_write> counts: array<u32>;
// `build.segments` a row.
@group(0) @binding(3) var<storage, read_write> segments: array<vec2<u32>>;

// The error of a piece that has not been measured.
const NEW: f32 = -1.0;

// Pieces from left to right: first and last sample (16 bits each), the largest error of the segment between
// them (0 once within the tolerance), and where that is.
var<private> spans: array<u32, 64>;
var<private> errors: array<f32, 64>;
var<private> worst: array<u32, 64>;
var<private> count: u32;
// Where the row begins in `samples`.
var<private> base: u32;

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
                        spans[count - 1u] = first | (last << 16u);
                    }
                    errors[count] = NEW;
                    first = at;
                    count += 1u;
                }
                last = at;
            }
            before = height;
        }
    }
    if count > 0u {
        spans[count - 1u] = first | (last << 16u);
    }
}

fn measure(piece: u32) {
    let first = spans[piece] & 0xffffu;
    let last = spans[piece] >> 16u;
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
    errors[piece] = select(error, 0.0, at == first);
    worst[piece] = at;
}

// Leave only so many of the largest errors, of equal ones the first.
fn spare_all_but(room: u32) {
    var low = 0u;
    var high = 0u;
    for (var round = 0u; round < room; round += 1u) {
        var best = 0u;
        var error = 0.0;
        for (var i = 0u; i < count; i += 1u) {
            let chosen = select((high >> (i & 31u)) & 1u, (low >> (i & 31u)) & 1u, i < 32u);
            if chosen == 0u && errors[i] > error {
                best = i;
                error = errors[i];
            }
        }
        if best < 32u {
            low |= 1u << (best & 31u);
        } else {
            high |= 1u << (best & 31u);
        }
    }
    for (var i = 0u; i < count; i += 1u) {
        let chosen = select((high >> (i & 31u)) & 1u, (low >> (i & 31u)) & 1u, i < 32u);
        if chosen == 0u {
            errors[i] = 0.0;
        }
    }
}

// Split every piece that errs; false where none does.
fn split() -> bool {
    var erring = 0u;
    for (var i = 0u; i < count; i += 1u) {
        erring += select(0u, 1u, errors[i] > 0.0);
    }
    let room = min(build.segments - count, erring);
    if room < erring {
        spare_all_but(room);
    }
    // From the right, so that each piece goes to its place at once.
    var to = count + room;
    for (var i = count; i > 0u; i -= 1u) {
        let span = spans[i - 1u];
        if errors[i - 1u] == 0.0 {
            to -= 1u;
            spans[to] = span;
            errors[to] = 0.0;
        } else {
            let at = worst[i - 1u];
            to -= 2u;
            spans[to + 1u] = at | (span & 0xffff0000u);
            spans[to] = (span & 0xffffu) | (at << 16u);
            errors[to + 1u] = NEW;
            errors[to] = NEW;
        }
    }
    count += room;
    return room > 0u;
}

// From sample centre to sample centre, on to the texel's border where the next piece does not begin with
// the same sample.
fn segment(piece: u32) -> vec2<u32> {
    let first = spans[piece] & 0xffffu;
    let last = spans[piece] >> 16u;
    var ends = vec2(f32(first), f32(last) + 1.0);
    if piece > 0u && spans[piece - 1u] >> 16u == first {
        ends.x += 0.5;
    }
    if piece + 1u < count && (spans[piece + 1u] & 0xffffu) == last {
        ends.y -= 0.5;
    }
    let heights = vec2(sample_at(first), sample_at(last));
    return vec2(pack2x16unorm(ends / f32(build.size)), pack2x16unorm(heights));
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= build.maps * build.size {
        return;
    }
    base = id.x * (build.size / 8u);
    find_runs();
    while count > 0u && count < build.segments {
        for (var i = 0u; i < count; i += 1u) {
            if errors[i] == NEW {
                measure(i);
            }
        }
        if !split() {
            break;
        }
    }
    let row = (build.layer * build.angles + build.first_map) * build.size + id.x;
    counts[row] = count;
    for (var i = 0u; i < count; i += 1u) {
        segments[row * build.segments + i] = segment(i);
    }
}
