// The captured map's distances, one float a texel, in the form in which they are interpolated:
// along the face's axis and inverted (1/z), or from the centre with `RADIAL`. 0: the environment.
@group(0) @binding(0) var capture_point: texture_2d_array<f32>;
@group(0) @binding(1) var distances: texture_storage_2d_array<r32float, write>;
// Centre of the map, world.
@group(0) @binding(2) var<uniform> centre: vec3<f32>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) texel: vec3<u32>) {
    if any(texel.xy >= textureDimensions(distances)) {
        return;
    }
    for (var face = 0u; face < 6u; face += 1u) {
        let point = textureLoad(capture_point, texel.xy, face, 0);
        var stored = 0.0;
        if point.w == 1.0 {
            let away = point.xyz - centre;
#ifdef RADIAL
            stored = length(away);
#else
            let z = abs(away);
            stored = 1.0 / max(z.x, max(z.y, z.z));
#endif
        }
        textureStore(distances, texel.xy, face, vec4(stored));
    }
}
