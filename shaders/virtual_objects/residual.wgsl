// How far a reflected fragment is from where it belongs, by the law of reflection at its own pixel.
#define_import_path virtual_objects::residual

#import common::camera::{Camera, arriving}
#ifdef REFRACTED
#import bindings::departure::{LOBE_REFRACTED, depart}
#import bindings::scene::{materials, objects}
#endif
#ifdef SECOND
#import virtual_objects::twice::{shown_normal, shown_position}
#endif

@group(0) @binding(30) var<uniform> camera: Camera;
@group(0) @binding(31) var reflector_id: texture_2d<u32>;
@group(0) @binding(32) var reflector_position: texture_2d<f32>;
@group(0) @binding(33) var reflector_normal: texture_2d<f32>;

// What the mirrored direction at a pixel misses the direction to `point` by.
fn miss(pixel: vec2<u32>, point: vec3<f32>) -> vec3<f32> {
    let first = textureLoad(reflector_position, pixel, 0).xyz;
#ifdef SECOND
    let bounce = textureLoad(shown_position, pixel, 0).xyz;
    let normal = textureLoad(shown_normal, pixel, 0).xyz;
    let incident = normalize(bounce - first);
#else
    let bounce = first;
    let normal = textureLoad(reflector_normal, pixel, 0).xyz;
    let incident = arriving(camera, bounce);
#endif
#ifdef REFRACTED
    let material = materials[objects[textureLoad(reflector_id, pixel, 0).x].material];
    let leaving = depart(material, LOBE_REFRACTED, incident, normal, true).direction;
#else
    let leaving = reflect(incident, normal);
#endif
    return leaving - normalize(point - bounce);
}

// Whether two pixels show the same reflectors.
fn alike(pixel: vec2<u32>, other: vec2<u32>) -> bool {
    let first = textureLoad(reflector_id, pixel, 0).x == textureLoad(reflector_id, other, 0).x;
#ifdef SECOND
    return first && textureLoad(shown_position, pixel, 0).w == textureLoad(shown_position, other, 0).w;
#else
    return first;
#endif
}

// How the miss changes from a pixel to its neighbour along an axis; nothing where neither neighbour
// shows the reflector.
fn change(pixel: vec2<u32>, axis: vec2<i32>, point: vec3<f32>, here: vec3<f32>) -> vec3<f32> {
    for (var side = 1; side >= -1; side -= 2) {
        let other = vec2<i32>(pixel) + side * axis;
        let size = vec2<i32>(textureDimensions(reflector_id));
        if all(other >= vec2(0)) && all(other < size) && alike(pixel, vec2<u32>(other)) {
            return f32(side) * (miss(vec2<u32>(other), point) - here);
        }
    }
    return vec3(0.0);
}

// Pixels from here to where the reflector mirrors `point`: one Newton step.
fn displacement(pixel: vec2<u32>, point: vec3<f32>) -> f32 {
    let here = miss(pixel, point);
    let x = change(pixel, vec2(1, 0), point, here);
    let y = change(pixel, vec2(0, 1), point, here);
    let a = dot(x, x);
    let b = dot(x, y);
    let c = dot(y, y);
    let g = vec2(dot(x, here), dot(y, here));
    let determinant = a * c - b * b;
    // Lone pixels and folds tell nothing, so they are doubted.
    if determinant <= 1e-6 * a * c {
        return 1e9;
    }
    return length(vec2(c * g.x - b * g.y, a * g.y - b * g.x)) / determinant;
}
