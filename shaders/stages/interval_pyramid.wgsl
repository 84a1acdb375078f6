// One level of the pyramid of bounds from the one below: lowest of the lowest, highest of the highest.
#import bindings::interval_map::place_in_pyramid
#import bindings::layers::layered_map

// The same image; no texel of it is both read and written.
@group(0) @binding(0) var bounds_below: texture_2d_array<u32>;
// The level written.
@group(0) @binding(1) var<uniform> level: u32;
@group(0) @binding(2) var interval_bounds: texture_storage_2d_array<rg32uint, write>;

fn bounds_of(cell: vec2<u32>, face: u32) -> vec4<f32> {
    let words = textureLoad(bounds_below, place_in_pyramid(vec2<i32>(cell), level - 1u), face, 0);
    return vec4(unpack2x16float(words.x), unpack2x16float(words.y));
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = layered_map.size >> level;
    if id.x >= size || id.y >= 6u * size {
        return;
    }
    let face = id.y / size;
    let cell = vec2(id.x, id.y % size);
    var bounds = bounds_of(2u * cell, face);
    for (var child = 1u; child < 4u; child++) {
        let other = bounds_of(2u * cell + vec2(child & 1u, child >> 1u), face);
        bounds = vec4(
            min(bounds.x, other.x),
            max(bounds.y, other.y),
            min(bounds.z, other.z),
            max(bounds.w, other.w),
        );
    }
    // Half floats already: nothing is rounded.
    let words = vec4(pack2x16float(bounds.xy), pack2x16float(bounds.zw), 0u, 0u);
    textureStore(interval_bounds, place_in_pyramid(vec2<i32>(cell), level), face, words);
}
