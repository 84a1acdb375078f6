// The words of the reflection record. Rust twin: scene/record.rs.
#define_import_path common::record

const NO_OBJECT: u32 = 0xffffffffu;

const STATUS_MISSING: u32 = 0u;
const STATUS_FOUND: u32 = 1u;
const STATUS_ENVIRONMENT: u32 = 2u;

const SOURCE_METHOD: u32 = 0u;
const SOURCE_FALLBACK_ENVIRONMENT: u32 = 1u;
const SOURCE_FALLBACK_RAY: u32 = 2u;

// What the fourth channel of the radiance image holds.
const ANSWER_MISSING: f32 = 0.0;
const ANSWER_GIVEN: f32 = 1.0;
const ANSWER_FLAGGED: f32 = 2.0;

// One pixel's answer.
struct Chain {
    // Light arriving at the reflector point along the chain.
    radiance: vec3<f32>,
    // The scene point shown, w = 1; or a unit direction, w = 0.
    point: vec4<f32>,
    // Where the last bounce happened; w is the path length from R to the point.
    last: vec4<f32>,
    object: u32,
    triangle: u32,
    trace: u32,
    order: u32,
    // How it leaves the reflector: 0 mirrored, 1 refracted.
    lobe: u32,
    status: u32,
    source: u32,
    flag: bool,
}

fn packed_bits(chain: Chain) -> u32 {
    return chain.order | (chain.lobe << 8u) | (chain.status << 12u) | (chain.source << 16u)
        | (select(0u, 1u, chain.flag) << 20u);
}

fn packed_ids(chain: Chain) -> vec4<u32> {
    return vec4(chain.object, chain.triangle, chain.trace, packed_bits(chain));
}

// Radiance with the answer in its fourth channel.
fn packed_radiance(chain: Chain) -> vec4<f32> {
    let answered = select(ANSWER_GIVEN, ANSWER_FLAGGED, chain.flag);
    return vec4(chain.radiance, select(answered, ANSWER_MISSING, chain.status == STATUS_MISSING));
}

// A chain of one bounce off the reflector of this rank.
fn trace_of(rank: u32) -> u32 {
    return (rank + 1u) & 0xffu;
}

// How many bounces a trace can tell apart.
const TRACE_BOUNCES: u32 = 4u;

// The trace of a chain of that order with one more reflector.
fn extended_trace(trace: u32, order: u32, rank: u32) -> u32 {
    if order >= TRACE_BOUNCES {
        return trace;
    }
    return trace | (((rank + 1u) & 0xffu) << (8u * order));
}

// One bounce at `bounce`, off the reflector of this rank, towards the environment in `direction`.
fn environment_chain(
    radiance: vec3<f32>,
    direction: vec3<f32>,
    bounce: vec3<f32>,
    rank: u32,
) -> Chain {
    var chain: Chain;
    chain.radiance = radiance;
    chain.point = vec4(direction, 0.0);
    // Infinitely far.
    chain.last = vec4(bounce, bitcast<f32>(0x7f800000u));
    chain.object = NO_OBJECT;
    chain.trace = trace_of(rank);
    chain.order = 1u;
    chain.status = STATUS_ENVIRONMENT;
    return chain;
}

// One bounce at `bounce`, off the reflector of this rank, to a point on a triangle of an object.
fn found_chain(
    radiance: vec3<f32>,
    point: vec3<f32>,
    bounce: vec3<f32>,
    object: u32,
    triangle: u32,
    rank: u32,
) -> Chain {
    var chain: Chain;
    chain.radiance = radiance;
    chain.point = vec4(point, 1.0);
    chain.last = vec4(bounce, distance(bounce, point));
    chain.object = object;
    chain.triangle = triangle;
    chain.trace = trace_of(rank);
    chain.order = 1u;
    chain.status = STATUS_FOUND;
    return chain;
}
