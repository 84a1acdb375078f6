// From peeled surfaces to intervals: between the front and the back of a closed object all is solid, nested and
// intersecting ones are one solid; surfaces of open objects are sheets.
#import bindings::interval_map::{BACK, EMPTY, OPEN, interval_map}
#import bindings::layers::{layer_surface, layered_map}

// x: slots; y: where what was not stored begins, as w, 0 where all is stored.
@group(0) @binding(0) var interval_order: texture_storage_2d_array<rg32uint, write>;

// Two surfaces whose w differ by less than this share are one.
const SAME: f32 = 1.0e-6;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = layered_map.size;
    if id.x >= size || id.y >= 6u * size {
        return;
    }
    let face = id.y / size;
    let place = vec2(id.x, id.y % size);
    let last = interval_map.peeled;
    let far = bitcast<f32>(textureLoad(layer_surface, place, 6u * last + face, 0).x);
    var order = 0xffffffffu;
    var count = 0u;
    // Closed objects the texel's ray is inside of.
    var depth = 0u;
    var front = 0u;
    var before = 0.0;
    var unstored = 0.0;
    for (var layer = 0u; layer < last; layer++) {
        let words = textureLoad(layer_surface, place, 6u * layer + face, 0);
        let w = bitcast<f32>(words.x);
        if w <= far * (1.0 + SAME) {
            // All that is left is the farthest surface: it closes what is open.
            if depth > 0u && count < interval_map.intervals {
                order = with_slot(order, count, front, last);
            }
            unstored = 0.0;
            break;
        }
        if count == interval_map.intervals {
            unstored = w;
            break;
        }
        var back = layer;
        var ends = false;
        if (words.y & OPEN) != 0u {
            front = select(front, layer, depth == 0u);
            ends = depth == 0u;
        } else if (words.y & BACK) == 0u {
            front = select(front, layer, depth == 0u);
            depth += 1u;
        } else {
            // A back without a front: the centre is inside.
            front = select(front, layer, depth == 0u);
            depth = max(depth, 1u) - 1u;
            ends = depth == 0u;
        }
        let last_peeled = layer + 1u == last;
        if ends || (last_peeled && depth > 0u) {
            order = with_slot(order, count, front, back);
            count += 1u;
        }
        unstored = select(0.0, w, last_peeled);
    }
    textureStore(interval_order, place, face, vec4(order, bitcast<u32>(unstored), 0u, 0u));
}

fn with_slot(order: u32, slot: u32, front: u32, back: u32) -> u32 {
    return (order & ~(EMPTY << (8u * slot))) | ((front | (back << 4u)) << (8u * slot));
}
