// The distances that a captured map of one plane has, to test the search in them.
#import common::cube::cube_direction

// Unit normal, and its dot product with the plane's points; the plane is seen from one side.
@group(0) @binding(0) var<uniform> plane: vec4<f32>;
@group(0) @binding(1) var distances: texture_storage_2d_array<r32float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) texel: vec3<u32>) {
    let size = textureDimensions(distances);
    if any(texel.xy >= size) {
        return;
    }
    let uv = (vec2<f32>(texel.xy) + 0.5) / vec2<f32>(size);
    for (var face = 0u; face < 6u; face += 1u) {
        let direction = cube_direction(face, uv);
        let inverse = dot(plane.xyz, direction) / plane.w;
        var stored = max(inverse, 0.0);
#ifdef RADIAL
        stored = select(0.0, length(direction) / inverse, inverse > 0.0);
#endif
        textureStore(distances, texel.xy, face, vec4(stored));
    }
}
