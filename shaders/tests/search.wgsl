// Random rays searched for twice, over the pyramid and texel by texel, to count where the two differ.
#import bindings::interval_search::{map_work, search_map}

struct Rays {
    // Starts lie in the box of these half sides about the map's centre.
    reach: vec3<f32>,
    seed: u32,
}
@group(0) @binding(0) var<uniform> rays: Rays;

struct Counts {
    rays: atomic<u32>,
    found: atomic<u32>,
    flagged: atomic<u32>,
    different: atomic<u32>,
    visits: atomic<u32>,
    texels: atomic<u32>,
    // Cells visited by the pyramid's search, rays that visited so many.
    visited: array<atomic<u32>, 256>,
}
@group(0) @binding(1) var<storage, read_write> counts: Counts;

// O'Neill's permuted congruential generator, one step of it.
fn hashed(word: u32) -> u32 {
    let state = word * 747796405u + 2891336453u;
    let mixed = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (mixed >> 22u) ^ mixed;
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    var state = hashed(id.x ^ hashed(rays.seed));
    var numbers: array<f32, 6>;
    for (var i = 0u; i < 6u; i++) {
        state = hashed(state);
        numbers[i] = f32(state >> 8u) / 8388608.0 - 1.0;
    }
    let start = rays.reach * vec3(numbers[0], numbers[1], numbers[2]);
    let way = vec3(numbers[3], numbers[4], numbers[5]);
    if dot(way, way) < 1.0e-4 {
        return;
    }
    let direction = normalize(way);
    let quick = search_map(start, direction, false);
    let visits = map_work.visits;
    atomicAdd(&counts.visited[min(visits, 255u)], 1u);
    atomicAdd(&counts.visits, visits);
    atomicAdd(&counts.texels, map_work.texels);
    let slow = search_map(start, direction, true);
    var same = quick.found == slow.found && quick.flag == slow.flag;
    if quick.found {
        same &= quick.face == slow.face && all(quick.texel == slow.texel) && quick.layer == slow.layer
            && all(quick.uv == slow.uv);
        atomicAdd(&counts.found, 1u);
    }
    atomicAdd(&counts.rays, 1u);
    atomicAdd(&counts.flagged, select(0u, 1u, quick.flag));
    atomicAdd(&counts.different, select(1u, 0u, same));
}
