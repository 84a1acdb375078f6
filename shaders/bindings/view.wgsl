// One view: its camera, its reflectors' footprint, and the list of pixels to fill.
#define_import_path bindings::view

#import bindings::departure::depart
#import bindings::scene::{materials, objects}
#import common::camera::{Camera, arriving}
#import common::record::NO_OBJECT

@group(0) @binding(30) var<uniform> camera: Camera;
@group(0) @binding(31) var reflector_id: texture_2d<u32>;
@group(0) @binding(32) var reflector_position: texture_2d<f32>;
@group(0) @binding(33) var reflector_normal: texture_2d<f32>;

// Words 0 to 2: workgroups to dispatch; word 3: the number of pixels; then x | y << 16 each.
struct PixelList {
    groups: vec3<u32>,
    count: u32,
    packed: array<u32>,
}
@group(0) @binding(34) var<storage, read> pixels: PixelList;

// Which lobe's record is filled: `LOBE_REFLECTED` or `LOBE_REFRACTED`.
@group(0) @binding(35) var<uniform> lobe: u32;

// What a method needs to know of one reflector pixel.
struct MirrorPoint {
    pixel: vec2<u32>,
    reflector: u32,
    // Of the reflector's mesh.
    triangle: u32,
    // R of the papers.
    position: vec3<f32>,
    // N, unit, on the eye's side.
    normal: vec3<f32>,
    // The eye sees the outside.
    front: bool,
    // Unit direction of the eye ray, towards R.
    incident: vec3<f32>,
    // False where light does not leave by this lobe; then there is nothing to fill.
    departs: bool,
    // Unit: B, the mirrored direction; T for the refracted lobe.
    outgoing: vec3<f32>,
    lobe: u32,
}

fn pixel_count() -> u32 {
    return pixels.count;
}

// That of a place in the list.
fn mirror_point(index: u32) -> MirrorPoint {
    let packed = pixels.packed[index];
    return mirror_point_at(vec2(packed & 0xffffu, packed >> 16u));
}

// Whether a pixel shows a reflector that the pass is meant for.
fn is_asked(pixel: vec2<u32>) -> bool {
    let object = textureLoad(reflector_id, pixel, 0).x;
    return object != NO_OBJECT && objects[object].selected == 1u;
}

// That of a reflector's pixel.
fn mirror_point_at(pixel: vec2<u32>) -> MirrorPoint {
    let position = textureLoad(reflector_position, pixel, 0);
    let normal = textureLoad(reflector_normal, pixel, 0);
    var at: MirrorPoint;
    at.pixel = pixel;
    at.reflector = textureLoad(reflector_id, pixel, 0).x;
    at.triangle = u32(position.w);
    at.position = position.xyz;
    at.normal = normal.xyz;
    at.front = normal.w == 1.0;
    at.incident = arriving(camera, at.position);
    at.lobe = lobe;
    let material = materials[objects[at.reflector].material];
    let way = depart(material, lobe, at.incident, at.normal, at.front);
    at.departs = way.exists;
    at.outgoing = way.direction;
    return at;
}
