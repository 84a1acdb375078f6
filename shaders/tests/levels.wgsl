// Halves an array level by level, to test mip levels and layers.
@group(0) @binding(0) var source: texture_2d_array<u32>;
@group(0) @binding(1) var<uniform> source_level: u32;
@group(0) @binding(2) var halved: texture_storage_2d_array<rg32uint, write>;

@compute @workgroup_size(4, 4)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= textureDimensions(halved)) {
        return;
    }
    for (var layer = 0u; layer < textureNumLayers(source); layer++) {
        var sum = vec4(0u);
        for (var i = 0u; i < 4u; i++) {
            let place = 2u * id.xy + vec2(i & 1u, i >> 1u);
            sum += textureLoad(source, place, layer, source_level);
        }
        textureStore(halved, id.xy, layer, sum + vec4(layer, 0u, 0u, 0u));
    }
}
