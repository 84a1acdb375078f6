// The record, as a compute pass writes it or a fragment shader. `RECORD_FULL` adds the evidence to
// the radiance.
#define_import_path bindings::record

#import common::record::{Chain, packed_ids, packed_radiance}

@group(0) @binding(20) var record_radiance: texture_storage_2d<rgba16float, write>;
#ifdef RECORD_FULL
@group(0) @binding(21) var record_point: texture_storage_2d<rgba32float, write>;
@group(0) @binding(22) var record_last: texture_storage_2d<rgba32float, write>;
@group(0) @binding(23) var record_ids: texture_storage_2d<rgba32uint, write>;
@group(0) @binding(24) var<storage, read_write> counters: array<atomic<u32>>;
#endif

fn write_record(pixel: vec2<u32>, chain: Chain) {
    textureStore(record_radiance, pixel, packed_radiance(chain));
#ifdef RECORD_FULL
    textureStore(record_point, pixel, chain.point);
    textureStore(record_last, pixel, chain.last);
    textureStore(record_ids, pixel, packed_ids(chain));
#endif
}

// The record's images as what a fragment shader draws.
struct RecordTargets {
    @location(0) radiance: vec4<f32>,
#ifdef RECORD_FULL
    @location(1) point: vec4<f32>,
    @location(2) last: vec4<f32>,
    @location(3) ids: vec4<u32>,
#endif
}

fn record_targets(chain: Chain) -> RecordTargets {
    var out: RecordTargets;
    out.radiance = packed_radiance(chain);
#ifdef RECORD_FULL
    out.point = chain.point;
    out.last = chain.last;
    out.ids = packed_ids(chain);
#endif
    return out;
}

// Count device-independent work in the method's counter of this rank.
fn count(rank: u32, amount: u32) {
#ifdef RECORD_FULL
    atomicAdd(&counters[rank], amount);
#endif
}

// Keep the most seen in the method's counter of this rank.
fn count_most(rank: u32, amount: u32) {
#ifdef RECORD_FULL
    atomicMax(&counters[rank], amount);
#endif
}
