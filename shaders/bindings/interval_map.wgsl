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

// A search's words of an interval's surface hold in the last bits of w the layer of the capture it is from: w is off
// by a millionth, less than half floats' gradients make of it.
const LAYER_BITS: u32 = 15u;

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

// Half floats: the largest, somewhat above the least that is not flushed to 0, and a share from one to beyond the
// next.
const HALF_MOST: f32 = 65504.0;
const HALF_LEAST: f32 = 6.2e-5;
const HALF_ROOM: f32 = 1.0e-3;

// Two half floats, the first no greater and the second no less than those given, up to the largest.
fn halves_around(range: vec2<f32>) -> u32 {
    let room = HALF_ROOM * abs(range) + HALF_LEAST;
    return pack2x16float(clamp(range + vec2(-room.x, room.y), vec2(-HALF_MOST), vec2(HALF_MOST)));
}

// Where a texel lies in an image: four that touch are neighbours in memory, so that a line of a processor's cache
// holds them, and rays up and down cost what those to the left and right do. The search waits for memory most.
fn in_fours(texel: vec2<i32>) -> vec2<i32> {
    return vec2((2 * texel.x & ~3) | (2 * texel.y & 2) | (texel.x & 1), texel.y >> 1u);
}

// Where a cell of the pyramid lies in its image, which holds all levels: level 0 at the left, to its right the others
// below one another.
fn place_in_pyramid(cell: vec2<i32>, level: u32) -> vec2<i32> {
    let size = i32(layered_map.size);
    return in_fours(cell + select(vec2(0), vec2(size, size - ((2 * size) >> level)), level > 0u));
}
