// One mip level: each texel the mean of those of the level before that it covers, in parts where
// sides are odd.
#ifdef FLAT_MAP
@group(0) @binding(0) var finer: texture_2d<f32>;
@group(0) @binding(1) var coarser: texture_storage_2d<rgba16float, write>;
#else
@group(0) @binding(0) var finer: texture_2d_array<f32>;
@group(0) @binding(1) var coarser: texture_storage_2d_array<rgba16float, write>;
#endif

// The level read.
@group(0) @binding(2) var<uniform> level: i32;

fn read(texel: vec2<i32>, layer: i32) -> vec4<f32> {
#ifdef FLAT_MAP
    return textureLoad(finer, texel, level);
#else
    return textureLoad(finer, texel, layer, level);
#endif
}

// Layers stand below one another in the second dimension.
@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = textureDimensions(coarser);
    let texel = vec2(id.x, id.y % size.y);
    let layer = id.y / size.y;
#ifdef FLAT_MAP
    let layers = 1u;
#else
    let layers = textureNumLayers(finer);
#endif
    if id.x >= size.x || layer >= layers {
        return;
    }
    let scale = vec2<f32>(textureDimensions(finer, level)) / vec2<f32>(size);
    let low = vec2<f32>(texel) * scale;
    let high = low + scale;
    var sum = vec4(0.0);
    for (var y = i32(low.y); f32(y) < high.y; y += 1) {
        for (var x = i32(low.x); f32(x) < high.x; x += 1) {
            let at = vec2(f32(x), f32(y));
            let covered = max(min(at + 1.0, high) - max(at, low), vec2(0.0));
            sum += covered.x * covered.y * read(vec2(x, y), i32(layer));
        }
    }
    let mean = sum / (scale.x * scale.y);
#ifdef FLAT_MAP
    textureStore(coarser, texel, mean);
#else
    textureStore(coarser, texel, layer, mean);
#endif
}
