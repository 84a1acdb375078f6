// The captured map, however it is laid out, and how a direction is looked up in it.
#define_import_path environment_map::map

#import common::cube::{CubeTexel, cube_face_plane, cube_texel}
#import common::latlong::latlong_place
#import common::sphere_map::{disc_uv, sphere_place}

#ifdef FLAT_MAP
@group(0) @binding(1) var map_radiance: texture_2d<f32>;
@group(0) @binding(2) var map_point: texture_2d<f32>;
@group(0) @binding(3) var map_ids: texture_2d<u32>;
#else
#ifdef FILTER_NEAREST
@group(0) @binding(1) var map_radiance: texture_2d_array<f32>;
#else
@group(0) @binding(1) var map_radiance: texture_cube<f32>;
@group(0) @binding(4) var linear_filter: sampler;
#endif
@group(0) @binding(2) var map_point: texture_2d_array<f32>;
@group(0) @binding(3) var map_ids: texture_2d_array<u32>;
#endif

// Where a unit direction is shown: the face, 0 in a flat map, and 0 to 1 over it.
fn place_of(direction: vec3<f32>) -> CubeTexel {
#ifdef PROJECTION_SPHERE
    return CubeTexel(0u, disc_uv(sphere_place(direction)));
#else ifdef PROJECTION_LATLONG
    return CubeTexel(0u, latlong_place(direction));
#else
    return cube_texel(direction);
#endif
}

// The texel whose area holds a place; the lecture remaps [-1, 1] to [0, N).
fn texel_of(place: CubeTexel) -> vec2<u32> {
    let size = textureDimensions(map_radiance, 0);
    return min(vec2<u32>(place.uv * vec2<f32>(size)), size - 1u);
}

fn point_at(direction: vec3<f32>) -> vec4<f32> {
    let place = place_of(direction);
#ifdef FLAT_MAP
    return textureLoad(map_point, texel_of(place), 0);
#else
    return textureLoad(map_point, texel_of(place), place.face, 0);
#endif
}

// Object and triangle.
fn ids_at(direction: vec3<f32>) -> vec2<u32> {
    let place = place_of(direction);
#ifdef FLAT_MAP
    return textureLoad(map_ids, texel_of(place), 0).xy;
#else
    return textureLoad(map_ids, texel_of(place), place.face, 0).xy;
#endif
}

#ifdef FLAT_MAP
// Columns of a latitude-longitude map wrap, all else ends at the border.
fn flat_texel(at: vec2<i32>, level: i32) -> vec3<f32> {
    let size = vec2<i32>(textureDimensions(map_radiance, level));
    var column = clamp(at.x, 0, size.x - 1);
#ifdef PROJECTION_LATLONG
    column = (at.x + size.x) % size.x;
#endif
    return textureLoad(map_radiance, vec2(column, clamp(at.y, 0, size.y - 1)), level).rgb;
}

fn flat_bilinear(uv: vec2<f32>, level: i32) -> vec3<f32> {
    let p = uv * vec2<f32>(textureDimensions(map_radiance, level)) - 0.5;
    let base = vec2<i32>(floor(p));
    let f = p - floor(p);
    let top = mix(flat_texel(base, level), flat_texel(base + vec2(1, 0), level), f.x);
    let low = mix(flat_texel(base + vec2(0, 1), level), flat_texel(base + 1, level), f.x);
    return mix(top, low, f.y);
}
#endif

// Light from a unit direction; `level` counts only with mip maps.
fn radiance_at(direction: vec3<f32>, level: f32) -> vec3<f32> {
#ifdef FLAT_MAP
    let uv = place_of(direction).uv;
#ifdef FILTER_NEAREST
    return textureLoad(map_radiance, texel_of(place_of(direction)), 0).rgb;
#else ifdef FILTER_MIP
    let coarsest = f32(textureNumLevels(map_radiance) - 1u);
    let finer = floor(min(level, coarsest));
    let coarser = min(finer + 1.0, coarsest);
    let blend = clamp(level - finer, 0.0, 1.0);
    return mix(flat_bilinear(uv, i32(finer)), flat_bilinear(uv, i32(coarser)), blend);
#else
    return flat_bilinear(uv, 0);
#endif
#else
#ifdef FILTER_NEAREST
    let place = place_of(direction);
    return textureLoad(map_radiance, texel_of(place), place.face, 0).rgb;
#else
    return textureSampleLevel(map_radiance, linear_filter, direction, level).rgb;
#endif
#endif
}

// How many texels of level 0 lie between the places of two unit directions.
fn texels_between(a: vec3<f32>, b: vec3<f32>) -> f32 {
    let size = vec2<f32>(textureDimensions(map_radiance, 0));
    let place = place_of(a);
#ifdef FLAT_MAP
    var step = place_of(b).uv - place.uv;
#ifdef PROJECTION_LATLONG
    step.x -= round(step.x);
#endif
    return length(step * size);
#else
    // Both on the plane of the first's face. What lies behind it is a whole face away.
    let on_face = cube_face_plane(place.face, b);
    if on_face.z < 0.25 {
        return size.x;
    }
    return length((0.5 * (on_face.xy / on_face.z + 1.0) - place.uv) * size);
#endif
}
