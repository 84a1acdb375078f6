// Writes depths and objects given in a buffer into a view's images.
@group(0) @binding(0) var<storage, read> texels: array<vec2<f32>>;
@group(0) @binding(1) var depth: texture_storage_2d<r32float, write>;
@group(0) @binding(2) var object: texture_storage_2d<r32uint, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) pixel: vec3<u32>) {
    let size = textureDimensions(depth);
    if any(pixel.xy >= size) {
        return;
    }
    let texel = texels[pixel.y * size.x + pixel.x];
    textureStore(depth, pixel.xy, vec4(texel.x));
    textureStore(object, pixel.xy, vec4(u32(texel.y)));
}
