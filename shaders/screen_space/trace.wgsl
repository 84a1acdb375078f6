// A ray followed through the depth of the direct view, over a pyramid of depth bounds ("Hi-Z").
//
// On the screen a ray is a straight line, along which 1/z changes linearly (z itself under parallel
// rays). The line is walked from cell to cell of the pyramid: into the finer ones where the ray's depths
// may meet the cell's, past the others. Cells are integers, and every border has one time at which the ray
// crosses it, whichever level asks: so the pyramid meets the very pixel that a walk over all
// pixels meets, and no step is ever nudged by an epsilon.
#define_import_path screen_space::trace

#import common::camera::Camera
#import common::record::NO_OBJECT

struct Limits {
    // How far behind its front a surface still stops a ray, as a share of its depth.
    thickness: f32,
    // Cells a ray may visit.
    steps: u32,
    // Of the pyramid, to be used.
    levels: u32,
    pad: u32,
}
@group(0) @binding(0) var<uniform> limits: Limits;
// Nearest and farthest depth of each cell's surfaces, as bits; see `pyramid.wgsl`.
@group(0) @binding(1) var pyramid: texture_2d<u32>;
@group(0) @binding(2) var direct_object: texture_2d<u32>;

// Nearest depth searched, metres.
const NEAR: f32 = 1.0e-3;
// Farthest depth searched under parallel rays, metres.
const FAR: f32 = 1.0e6;
const NEVER: f32 = 3.0e38;

// The part of a ray that is on the screen.
struct ScreenRay {
    // x and y in pixels; then 1/z in perspective, z under parallel rays. All linear in time, 0 to 1.
    start: vec3<f32>,
    change: vec3<f32>,
    inverted: bool,
}

struct Seen {
    found: bool,
    pixel: vec2<u32>,
    object: u32,
    visits: u32,
}

// The ray from a point on the screen along a unit direction, on an image of `size` pixels.
fn screen_ray(camera: Camera, size: vec2<f32>, origin: vec3<f32>, direction: vec3<f32>) -> ScreenRay {
    let away = origin - camera.eye;
    let scale = vec3(1.0 / camera.half_width, -1.0 / camera.half_height, 1.0);
    let a = scale * vec3(dot(away, camera.right), dot(away, camera.up), dot(away, camera.forward));
    let b = scale
        * vec3(dot(direction, camera.right), dot(direction, camera.up), dot(direction, camera.forward));
    let parallel = camera.orthographic == 1u;
    // The image's half side at a depth: z in perspective. How long until the ray leaves by each border?
    let half_a = select(a.z, 1.0, parallel);
    let half_b = select(b.z, 0.0, parallel);
    var length = until(a.z - NEAR, b.z);
    length = min(length, until(half_a - a.x, half_b - b.x));
    length = min(length, until(half_a + a.x, half_b + b.x));
    length = min(length, until(half_a - a.y, half_b - b.y));
    length = min(length, until(half_a + a.y, half_b + b.y));
    var start = a;
    var end = a + min(length, FAR) * b;
    if !parallel {
        start = vec3(a.xy, 1.0) / max(a.z, NEAR);
        // A ray that never leaves the screen ends in its vanishing point.
        let beyond = vec4(end.xy, 1.0, max(end.z, NEAR));
        let last = select(beyond, vec4(b.xy, 0.0, b.z), length == NEVER);
        end = last.xyz / last.w;
    }
    let pixels = vec3(0.5 * size, 1.0);
    let middle = vec3(0.5 * size, 0.0);
    start = start * pixels + middle;
    return ScreenRay(start, end * pixels + middle - start, !parallel);
}

// When something that changes so fast falls to zero.
fn until(now: f32, rate: f32) -> f32 {
    return select(NEVER, max(now, 0.0) / -min(rate, -1.0e-37), rate < 0.0);
}

fn depth_at(ray: ScreenRay, time: f32) -> f32 {
    let z = ray.start.z + time * ray.change.z;
    return select(z, 1.0 / max(z, 1.0e-37), ray.inverted);
}

// When the ray crosses a border between pixels, on one axis.
fn time_of(start: f32, change: f32, border: i32) -> f32 {
    return select((f32(border) - start) / change, NEVER, change == 0.0);
}

// When it leaves a cell on one axis.
fn leaves(start: f32, change: f32, cell: i32, level: u32) -> f32 {
    return time_of(start, change, (cell + select(0, 1, change > 0.0)) << level);
}

// The pixel it is in on one axis once all borders up to a time are crossed; it was in `before`.
fn pixel_after(start: f32, change: f32, time: f32, before: i32) -> i32 {
    if change == 0.0 {
        return before;
    }
    // Rounding may put this one pixel off: the borders' own times decide.
    var pixel = i32(floor(start + time * change));
    if change > 0.0 {
        pixel -= select(0, 1, time_of(start, change, pixel) > time);
        pixel += select(0, 1, time_of(start, change, pixel + 1) <= time);
        return max(pixel, before);
    }
    pixel += select(0, 1, time_of(start, change, pixel + 1) > time);
    pixel -= select(0, 1, time_of(start, change, pixel) <= time);
    return min(pixel, before);
}

// The first pixel whose surface the ray meets, the pixel it starts in and the object `own` left out.
fn seen_along(ray: ScreenRay, own: u32) -> Seen {
    let size = vec2<i32>(textureDimensions(pyramid));
    var pixel = clamp(vec2<i32>(floor(ray.start.xy)), vec2(0), size - 1);
    var seen = Seen(false, vec2(0u), NO_OBJECT, 0u);
    var level = 0u;
    var time = 0.0;
    var inside = false;
    while seen.visits < limits.steps {
        let cell = pixel >> vec2(level);
        let out = min(
            leaves(ray.start.x, ray.change.x, cell.x, level),
            leaves(ray.start.y, ray.change.y, cell.y, level),
        );
        if inside {
            seen.visits += 1u;
            let here = min(cell, vec2<i32>(textureDimensions(pyramid, level)) - 1);
            let surfaces = bitcast<vec2<f32>>(textureLoad(pyramid, here, level).xy);
            let a = depth_at(ray, time);
            let b = depth_at(ray, min(out, 1.0));
            if max(a, b) >= surfaces.x && min(a, b) <= surfaces.y * (1.0 + limits.thickness) {
                if level > 0u {
                    level -= 1u;
                    continue;
                }
                let object = textureLoad(direct_object, pixel, 0).x;
                if object != own {
                    seen.found = true;
                    seen.pixel = vec2<u32>(pixel);
                    seen.object = object;
                    return seen;
                }
            }
            level = min(level + 1u, limits.levels - 1u);
        }
        inside = true;
        time = out;
        pixel = vec2(
            pixel_after(ray.start.x, ray.change.x, time, pixel.x),
            pixel_after(ray.start.y, ray.change.y, time, pixel.y),
        );
        if time >= 1.0 || any(pixel < vec2(0)) || any(pixel >= size) {
            return seen;
        }
    }
    return seen;
}
