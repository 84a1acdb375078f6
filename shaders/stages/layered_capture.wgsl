enable primitive_index;
// One layer of surfaces into the six faces of a cube: of what lies behind the layer before, the
// nearest. Every layer is drawn by this one shader, so depths of the same surface are equal to the
// last bit and comparing them is exact.
#ifdef MARK_SIDES
#import bindings::scene::objects
#endif
#import bindings::faces::{cube, face_vertex}
#import bindings::surface::{Surface, surface_colour}

// Depths of the layer before, as rasterised: infinite before the first, 0 where it has nothing.
@group(0) @binding(1) var depth_before: texture_2d_array<f32>;

// The face drawn into.
var<immediate> face: u32;

// A surface this many units in the last place behind another still counts as the same: two
// triangles that share an edge may both, on other devices, cover a texel on it.
const SAME_ULPS: u32 = 2u;
// The largest half float.
const LARGEST_HALF: f32 = 65504.0;

@vertex
fn vertex(
    @builtin(vertex_index) index: u32,
    @builtin(instance_index) object: u32,
) -> Surface {
    return face_vertex(index, object, face);
}

struct Texel {
    @location(0) surface: vec4<u32>,
    @location(1) radiance: vec4<f32>,
#ifdef RECORD_FULL
    // Object, triangle.
    @location(2) ids: vec4<u32>,
    @location(3) depth: vec4<f32>,
#else
    @location(2) depth: vec4<f32>,
#endif
}

@fragment
fn fragment(
    in: Surface,
    @builtin(primitive_index) triangle: u32,
    @builtin(front_facing) turned: bool,
) -> Texel {
    let depth = in.clip.z;
    // 1 / z is affine over a face for a plane, so these are exact for the triangle's own.
    let gradient = vec2(dpdx(depth), dpdy(depth)) / cube.near;
    let before = textureLoad(depth_before, vec2<u32>(in.clip.xy), face, 0).x;
    // Positive floats are in the order of their bits.
    if bitcast<u32>(depth) + SAME_ULPS >= bitcast<u32>(before) {
        discard;
    }
#ifdef FACING_ONLY
    // A cube's faces are mirrored views, so what faces the centre runs clockwise.
    if turned {
        discard;
    }
#endif
    var out: Texel;
    var packed = pack2x16float(clamp(gradient, vec2(-LARGEST_HALF), vec2(LARGEST_HALF)));
#ifdef MARK_SIDES
    // The lowest bits of the two halves say that it is a back, and that its object has no inside; see
    // bindings/interval_map.wgsl. Objects with an inside are those selected.
    let closed = objects[in.object].selected == 1u;
    packed = (packed & 0xfffefffeu) | select(0u, 1u, turned) | select(0x10000u, 0u, closed);
#endif
    out.surface = vec4(bitcast<u32>(depth / cube.near), packed, 0u, 0u);
    out.radiance = vec4(surface_colour(in, in.position - cube.centre), 1.0);
#ifdef RECORD_FULL
    out.ids = vec4(in.object, triangle, 0u, 0u);
#endif
    out.depth = vec4(depth, 0.0, 0.0, 0.0);
    return out;
}
