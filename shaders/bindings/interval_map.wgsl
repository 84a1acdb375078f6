// A layered capture seen as intervals: behind each texel what is solid from a front to a back, sheets, and the
// farthest surface; over them a pyramid of bounds. Filled by stages/interval_map.rs.
#define_import_path bindings::interval_map

#import bindings::layers::{layer_surface, layered_map}

struct IntervalMap {
    // Layers peeled; the one after them holds the farthest surface.
    peeled: u32,
    // Most intervals kept behind a texel.
    intervals: u32,
    // Levels of the pyramid.
    levels: u32,
    pad: u32,
}
@group(0) @binding(44) var<uniform> interval_map: IntervalMap;

// Slots of an order word, nearest first: the layer of the front in four bits, of the back in four.
const SLOTS: u32 = 4u;
const EMPTY: u32 = 0xffu;

// What the lowest bits of a gradient's two halves say of a surface.
const BACK: u32 = 1u;
const OPEN: u32 = 0x10000u;

// A surface over one texel: the plane its centre sees, w = 1/z at a distance from the centre, in texels.
struct Patch {
    w: f32,
    gradient: vec2<f32>,
}

fn patch_of(words: vec2<u32>) -> Patch {
    return Patch(bitcast<f32>(words.x), unpack2x16float(words.y));
}

fn patch_at(face: u32, place: vec2<i32>, layer: u32) -> Patch {
    return patch_of(textureLoad(layer_surface, place, 6u * layer + face, 0).xy);
}

fn height(surface: Patch, from_centre: vec2<f32>) -> f32 {
    return surface.w + dot(surface.gradient, from_centre);
}

// The most by which two neighbouring texels' planes of one surface with this w may differ where they meet. A
// surface that changes by more in a texel falls away eight times as fast as it goes sideways.
fn joint(w: f32) -> f32 {
    return 16.0 / f32(layered_map.size) * w;
}
