// One level of the pyramid of bounds from the one below: lowest of the lowest, highest of the highest.
@group(0) @binding(0) var bounds_below: texture_2d_array<f32>;
// The level read.
@group(0) @binding(1) var<uniform> below: u32;
@group(0) @binding(2) var interval_bounds: texture_storage_2d_array<rgba32float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = textureDimensions(interval_bounds).x;
    if id.x >= size || id.y >= 6u * size {
        return;
    }
    let face = id.y / size;
    let place = vec2(id.x, id.y % size);
    var bounds = textureLoad(bounds_below, 2u * place, face, below);
    for (var child = 1u; child < 4u; child++) {
        let other = textureLoad(bounds_below, 2u * place + vec2(child & 1u, child >> 1u), face, below);
        bounds = vec4(
            min(bounds.x, other.x),
            max(bounds.y, other.y),
            min(bounds.z, other.z),
            max(bounds.w, other.w),
        );
    }
    textureStore(interval_bounds, place, face, bounds);
}
