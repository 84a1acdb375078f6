// The scene as every shader sees it, and the one shading function.
// Rust twins: scene/shading.rs for the functions, stages/scene.rs for the structs.
#define_import_path bindings::scene

#import common::latlong::latlong_place

struct Vertex {
    position: vec3<f32>,
    u: f32,
    normal: vec3<f32>,
    v: f32,
}

struct Object {
    // Rows of world from object space.
    row_x: vec4<f32>,
    row_y: vec4<f32>,
    row_z: vec4<f32>,
    material: u32,
    // Position among the scene's reflectors.
    rank: u32,
    // 1 where the current pass is meant for this reflector.
    selected: u32,
    // Of its mesh, in `indices`.
    first_index: u32,
}

const PATTERN_COLOUR: u32 = 0u;
const PATTERN_CHECKER: u32 = 1u;
const PATTERN_GRID: u32 = 2u;
const PATTERN_IMAGE: u32 = 3u;

struct Material {
    // Colour, even squares, ground.
    first: vec3<f32>,
    pattern: u32,
    // Odd squares, lines.
    second: vec3<f32>,
    line: f32,
    tint: vec3<f32>,
    // Below zero where there is no mirror.
    reflectance: f32,
    size: vec2<f32>,
    image: u32,
    // Refractive index of the inside of glass; 0 elsewhere.
    index: f32,
}

struct ImageInfo {
    // First texel.
    offset: u32,
    width: u32,
    height: u32,
    pad: u32,
}

const ENVIRONMENT_COLOUR: u32 = 0u;
const ENVIRONMENT_GRADIENT: u32 = 1u;
const ENVIRONMENT_LATLONG: u32 = 2u;

struct Light {
    ambient: vec3<f32>,
    environment: u32,
    towards_sun: vec3<f32>,
    image: u32,
    sun: vec3<f32>,
    pad_a: u32,
    zenith: vec3<f32>,
    pad_b: u32,
    // Also the one colour of a plain environment.
    horizon: vec3<f32>,
    pad_c: u32,
    nadir: vec3<f32>,
    pad_d: u32,
}

@group(0) @binding(10) var<storage, read> vertices: array<Vertex>;
@group(0) @binding(11) var<storage, read> objects: array<Object>;
@group(0) @binding(12) var<storage, read> materials: array<Material>;
@group(0) @binding(13) var<storage, read> images: array<ImageInfo>;
// Two words a texel: halves r, g and b, one unused.
@group(0) @binding(14) var<storage, read> texels: array<vec2<u32>>;
@group(0) @binding(15) var<uniform> light: Light;
// Three a triangle, into `vertices`.
@group(0) @binding(16) var<storage, read> indices: array<u32>;

fn world_position(object: Object, p: vec3<f32>) -> vec3<f32> {
    let q = vec4(p, 1.0);
    return vec3(dot(object.row_x, q), dot(object.row_y, q), dot(object.row_z, q));
}

// Poses are rigid, so normals turn as directions do.
fn world_direction(object: Object, d: vec3<f32>) -> vec3<f32> {
    return vec3(dot(object.row_x.xyz, d), dot(object.row_y.xyz, d), dot(object.row_z.xyz, d));
}

fn texel(image: ImageInfo, x: i32, y: i32) -> vec3<f32> {
    let words = texels[image.offset + u32(y) * image.width + u32(x)];
    let rg = unpack2x16float(words.x);
    return vec3(rg, unpack2x16float(words.y).x);
}

fn wrap(i: i32, n: i32) -> i32 {
    let r = i % n;
    return select(r, r + n, r < 0);
}

// Bilinear between texel centres; u wraps, v wraps or clamps.
fn bilinear(image: ImageInfo, uv: vec2<f32>, clamp_v: bool) -> vec3<f32> {
    let p = uv * vec2(f32(image.width), f32(image.height)) - 0.5;
    let base = floor(p);
    let f = p - base;
    let w = i32(image.width);
    let h = i32(image.height);
    let x_a = wrap(i32(base.x), w);
    let x_b = wrap(i32(base.x) + 1, w);
    var y_a = i32(base.y);
    var y_b = y_a + 1;
    if clamp_v {
        y_a = clamp(y_a, 0, h - 1);
        y_b = clamp(y_b, 0, h - 1);
    } else {
        y_a = wrap(y_a, h);
        y_b = wrap(y_b, h);
    }
    let top = mix(texel(image, x_a, y_a), texel(image, x_b, y_a), f.x);
    let bottom = mix(texel(image, x_a, y_b), texel(image, x_b, y_b), f.x);
    return mix(top, bottom, f.y);
}

fn albedo(material: Material, uv: vec2<f32>) -> vec3<f32> {
    switch material.pattern {
        case PATTERN_CHECKER: {
            let square = floor(uv / material.size);
            let odd = (i32(square.x) + i32(square.y)) & 1;
            return select(material.first, material.second, odd == 1);
        }
        case PATTERN_GRID: {
            let nearest = floor(uv / material.size + 0.5);
            let away = abs(uv - nearest * material.size);
            let on_line = min(away.x, away.y) < 0.5 * material.line;
            return select(material.first, material.second, on_line);
        }
        case PATTERN_IMAGE: {
            let at = uv / material.size;
            return bilinear(images[material.image], vec2(at.x, 1.0 - at.y), false);
        }
        default: {
            return material.first;
        }
    }
}

// Ambient and one directional light on a surface; `normal` is a unit vector on the viewer's side.
fn illumination(normal: vec3<f32>) -> vec3<f32> {
    let sun = light.sun * max(0.0, dot(normal, light.towards_sun));
    return light.ambient + sun;
}

// Lambert: what of that light leaves the surface.
fn shade(material: Material, normal: vec3<f32>, uv: vec2<f32>) -> vec3<f32> {
    return albedo(material, uv) * illumination(normal);
}

// Radiance from infinitely far away; `d` is a unit vector.
fn environment(d: vec3<f32>) -> vec3<f32> {
    switch light.environment {
        case ENVIRONMENT_GRADIENT: {
            if d.y >= 0.0 {
                return mix(light.horizon, light.zenith, d.y);
            }
            return mix(light.horizon, light.nadir, -d.y);
        }
        case ENVIRONMENT_LATLONG: {
            return bilinear(images[light.image], latlong_place(d), true);
        }
        default: {
            return light.horizon;
        }
    }
}
