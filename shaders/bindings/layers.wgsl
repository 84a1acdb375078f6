// A layered capture: what lies behind each texel of a cube map, nearest first.
// Filled by stages/layered_capture.rs.
#define_import_path bindings::layers

#import common::cube::cube_direction

struct LayeredMap {
    // Where it was taken from, world.
    centre: vec3<f32>,
    // Texels along a face's side.
    size: u32,
}
@group(0) @binding(40) var<uniform> layered_map: LayeredMap;
// Layer 6 * surface layer + face of each.
@group(0) @binding(41) var layer_surface: texture_2d_array<u32>;
@group(0) @binding(42) var layer_radiance: texture_2d_array<f32>;
@group(0) @binding(43) var layer_ids: texture_2d_array<u32>;

// A texel of one face.
struct MapTexel {
    face: u32,
    // Column and row, below `layered_map.size`.
    place: vec2<i32>,
}

// w = 1/z, z the depth along the face's axis in metres; 0 where nothing is left behind the texel,
// and then nothing is in later layers either.
fn layer_inverse_depth(texel: MapTexel, layer: u32) -> f32 {
    return bitcast<f32>(textureLoad(layer_surface, texel.place, 6u * layer + texel.face, 0).x);
}

// (dw/du, dw/dv) a texel, as half floats; u to the right, v down.
fn layer_gradient(texel: MapTexel, layer: u32) -> vec2<f32> {
    return unpack2x16float(textureLoad(layer_surface, texel.place, 6u * layer + texel.face, 0).y);
}

// Light from the surface, or from the environment where there is none.
fn layer_colour(texel: MapTexel, layer: u32) -> vec3<f32> {
    return textureLoad(layer_radiance, texel.place, 6u * layer + texel.face, 0).rgb;
}

// Object and triangle.
fn layer_identity(texel: MapTexel, layer: u32) -> vec2<u32> {
    return textureLoad(layer_ids, texel.place, 6u * layer + texel.face, 0).xy;
}

// The direction through a texel's centre, of length 1 along the face's axis: divided by w it is the
// surface point, relative to the map's centre.
fn texel_direction(texel: MapTexel) -> vec3<f32> {
    let uv = (vec2<f32>(texel.place) + 0.5) / f32(layered_map.size);
    return cube_direction(texel.face, uv);
}
