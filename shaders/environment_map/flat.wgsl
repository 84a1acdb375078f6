// The texels of a sphere or latitude-longitude map.
#define_import_path environment_map::flat

#import common::latlong::latlong_direction
#import common::sphere_map::{disc_place, sphere_direction}

@group(0) @binding(1) var map_radiance: texture_storage_2d<rgba16float, write>;
@group(0) @binding(2) var map_point: texture_storage_2d<rgba32float, write>;
@group(0) @binding(3) var map_ids: texture_storage_2d<rgba32uint, write>;

fn map_size() -> vec2<u32> {
    return textureDimensions(map_radiance);
}

// 0 to 1, of a texel's centre.
fn texel_uv(texel: vec2<u32>) -> vec2<f32> {
    return (vec2<f32>(texel) + 0.5) / vec2<f32>(map_size());
}

// The unit direction a texel shows. Beyond the rim of a sphere map the rim goes on, so that a
// filter at the rim finds nothing else.
fn texel_direction(texel: vec2<u32>) -> vec3<f32> {
#ifdef PROJECTION_SPHERE
    return sphere_direction(disc_place(texel_uv(texel)));
#else
    return latlong_direction(texel_uv(texel));
#endif
}

// point: w = 1 for a surface point, 0 for a direction; ids: object, triangle.
fn write_texel(texel: vec2<u32>, radiance: vec3<f32>, point: vec4<f32>, ids: vec2<u32>) {
    textureStore(map_radiance, texel, vec4(radiance, 1.0));
    textureStore(map_point, texel, point);
    textureStore(map_ids, texel, vec4(ids, 0u, 0u));
}
