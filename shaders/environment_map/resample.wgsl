// A captured cube into a sphere or latitude-longitude map: light filtered, evidence of the nearest texel.
#import common::cube::cube_texel
#import environment_map::flat::{map_size, texel_direction, write_texel}

@group(0) @binding(4) var capture_radiance: texture_cube<f32>;
@group(0) @binding(5) var capture_point: texture_2d_array<f32>;
@group(0) @binding(6) var capture_ids: texture_2d_array<u32>;
@group(0) @binding(7) var linear_filter: sampler;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= map_size()) {
        return;
    }
    let direction = texel_direction(id.xy);
    let radiance = textureSampleLevel(capture_radiance, linear_filter, direction, 0.0).rgb;
    let place = cube_texel(direction);
    let side = textureDimensions(capture_point).x;
    let texel = min(vec2<u32>(place.uv * f32(side)), vec2(side - 1u));
    let point = textureLoad(capture_point, texel, place.face, 0);
    write_texel(id.xy, radiance, point, textureLoad(capture_ids, texel, place.face, 0).xy);
}
