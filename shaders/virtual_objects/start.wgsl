// Where searches start: the texel in the middle of the reflector's projected bounding box (Estalella
// et al. 2006, section 4) or, where the reflector has a hole there, its nearest texel on a square ring.

struct Middle {
    texel: vec2<i32>,
    pad: vec2<i32>,
}
@group(0) @binding(0) var<uniform> middle: Middle;
@group(0) @binding(1) var mirror_position: texture_2d<f32>;
// One word: x | y << 16, or `NOWHERE`.
@group(0) @binding(2) var<storage, read_write> start: array<u32>;

const NOWHERE: u32 = 0xffffffffu;
const GROUP: u32 = 64u;

// The least place on the ring where the reflector is.
var<workgroup> nearest: atomic<u32>;
var<workgroup> found: u32;

// Texels of the square ring of this radius, in order round it.
fn on_ring(radius: i32, place: i32) -> vec2<i32> {
    if radius == 0 {
        return middle.texel;
    }
    let side = 2 * radius;
    let along = place % side - radius;
    switch place / side {
        case 0: { return middle.texel + vec2(along, -radius); }
        case 1: { return middle.texel + vec2(radius, along); }
        case 2: { return middle.texel + vec2(-along, radius); }
        default: { return middle.texel + vec2(-radius, -along); }
    }
}

fn is_mirror(texel: vec2<i32>) -> bool {
    let size = vec2<i32>(textureDimensions(mirror_position));
    if any(texel < vec2(0)) || any(texel >= size) {
        return false;
    }
    return textureLoad(mirror_position, texel, 0).w == 1.0;
}

@compute @workgroup_size(64)
fn main(@builtin(local_invocation_index) invocation: u32) {
    let size = vec2<i32>(textureDimensions(mirror_position));
    if invocation == 0u {
        atomicStore(&nearest, NOWHERE);
    }
    workgroupBarrier();
    var answer = NOWHERE;
    for (var radius = 0; radius < max(size.x, size.y); radius += 1) {
        let places = max(8u * u32(radius), 1u);
        for (var place = invocation; place < places; place += GROUP) {
            if is_mirror(on_ring(radius, i32(place))) {
                atomicMin(&nearest, place);
            }
        }
        workgroupBarrier();
        if invocation == 0u {
            found = atomicLoad(&nearest);
        }
        let place = workgroupUniformLoad(&found);
        if place != NOWHERE {
            let texel = vec2<u32>(on_ring(radius, i32(place)));
            answer = texel.x | (texel.y << 16u);
            break;
        }
    }
    if invocation == 0u {
        start[0] = answer;
    }
}
