// Lists the pixels of the selected reflectors, with the workgroup count for passes over them.
#import bindings::scene::objects
#import common::record::NO_OBJECT

@group(0) @binding(31) var reflector_id: texture_2d<u32>;

struct PixelList {
    groups_x: atomic<u32>,
    groups_y: u32,
    groups_z: u32,
    count: atomic<u32>,
    packed: array<u32>,
}
@group(0) @binding(34) var<storage, read_write> pixels: PixelList;

// Invocations a workgroup has in passes over the list.
const GROUP: u32 = 64u;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) pixel: vec3<u32>) {
    let size = textureDimensions(reflector_id);
    if any(pixel.xy >= size) {
        return;
    }
    let object = textureLoad(reflector_id, pixel.xy, 0).x;
    if object == NO_OBJECT || objects[object].selected == 0u {
        return;
    }
    // The order of the list differs from run to run; each pixel's answer does not depend on it.
    let place = atomicAdd(&pixels.count, 1u);
    pixels.packed[place] = pixel.x | (pixel.y << 16u);
    if place % GROUP == 0u {
        atomicAdd(&pixels.groups_x, 1u);
        pixels.groups_y = 1u;
        pixels.groups_z = 1u;
    }
}
