// Where each cell's list begins: sums within blocks of cells, then (`BLOCKS`) over the blocks.
#import bindings::record::count
#import reflection_morphing::eye_bins::{BLOCK, bins, cells_a_level}

@group(0) @binding(43) var<storage, read_write> starts: array<u32>;
@group(0) @binding(44) var<storage, read_write> blocks: array<u32>;
#ifndef BLOCKS
@group(0) @binding(42) var<storage, read> counts: array<u32>;
#endif

const GROUP: u32 = 256u;
// Cells that an invocation adds up.
const OWN: u32 = 4u;
const PAIRS: u32 = 3u;
const NO_ROOM: u32 = 4u;

var<workgroup> sums: array<u32, 256>;

// The sum of what the invocations before this one bring, and of all.
fn sum_before(invocation: u32, own: u32) -> vec2<u32> {
    sums[invocation] = own;
    workgroupBarrier();
    for (var step = 1u; step < GROUP; step *= 2u) {
        var more = 0u;
        if invocation >= step {
            more = sums[invocation - step];
        }
        workgroupBarrier();
        sums[invocation] += more;
        workgroupBarrier();
    }
    return vec2(sums[invocation] - own, sums[GROUP - 1u]);
}

#ifdef BLOCKS
@compute @workgroup_size(256)
fn main(@builtin(local_invocation_index) invocation: u32) {
    // One more than there are cells in whole blocks.
    let number = bins.levels * cells_a_level() / BLOCK + 1u;
    let own = select(0u, blocks[invocation], invocation < number);
    let sum = sum_before(invocation, own);
    blocks[invocation] = sum.x;
    if invocation == 0u {
        count(PAIRS, sum.y);
        count(NO_ROOM, max(sum.y, bins.room) - bins.room);
    }
}
#else
@compute @workgroup_size(256)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) invocation: u32,
) {
    let first = group.x * BLOCK + invocation * OWN;
    var own = vec4(0u);
    for (var i = 0u; i < OWN; i += 1u) {
        own[i] = counts[first + i];
    }
    let sum = sum_before(invocation, own.x + own.y + own.z + own.w);
    var start = sum.x;
    for (var i = 0u; i < OWN; i += 1u) {
        starts[first + i] = start;
        start += own[i];
    }
    if invocation == 0u {
        blocks[group.x] = sum.y;
    }
}
#endif
