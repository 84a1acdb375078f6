// One view: its camera, its reflectors' footprint, and the list of pixels to fill.
#define_import_path bindings::view

#import common::camera::{Camera, arriving}

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

// What a method needs to know of one reflector pixel.
struct MirrorPoint {
    pixel: vec2<u32>,
    reflector: u32,
    // R of the papers.
    position: vec3<f32>,
    // N, unit, on the eye's side.
    normal: vec3<f32>,
    // Unit direction of the eye ray, towards R.
    incident: vec3<f32>,
    // B, unit: the mirrored direction.
    mirrored: vec3<f32>,
}

fn pixel_count() -> u32 {
    return pixels.count;
}

fn mirror_point(index: u32) -> MirrorPoint {
    let packed = pixels.packed[index];
    let pixel = vec2(packed & 0xffffu, packed >> 16u);
    let position = textureLoad(reflector_position, pixel, 0).xyz;
    let normal = textureLoad(reflector_normal, pixel, 0).xyz;
    let incident = arriving(camera, position);
    let reflector = textureLoad(reflector_id, pixel, 0).x;
    return MirrorPoint(pixel, reflector, position, normal, incident, reflect(incident, normal));
}
