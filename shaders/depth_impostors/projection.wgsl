// Rays in depth images: where a point or a ray is in one (Popescu et al. 2006, slide 36).
#define_import_path depth_impostors::projection

#import bindings::portrait::{
    Portrait, portrait_axes, portrait_clip, portrait_own_direction, portrait_own_position,
}
#import depth_impostors::rows::{ImageLine, impostors}

// The share of a line, first and last, that satisfies a condition linear in it: a + t b >= 0.
fn kept(range: vec2<f32>, a: f32, b: f32) -> vec2<f32> {
    if b > 0.0 {
        return vec2(max(range.x, -a / b), range.y);
    }
    if b < 0.0 {
        return vec2(range.x, min(range.y, -a / b));
    }
    return select(range, vec2(1.0, 0.0), a < 0.0);
}

struct Projected {
    // Some of the ray is in the image.
    exists: bool,
    line: ImageLine,
}

fn in_image(clip: vec4<f32>) -> vec3<f32> {
    return vec3((0.5 + 0.5 * clip.xy / clip.w) * f32(impostors.size), clip.z / clip.w);
}

// The ray from `origin` along `direction`, world, in a layer's depth image.
fn projected(portrait: Portrait, origin: vec3<f32>, direction: vec3<f32>) -> Projected {
    let q = portrait_axes(portrait, portrait_own_position(portrait, origin));
    let own = portrait_own_direction(portrait, direction);
    let d = vec3(dot(own, portrait.right), dot(own, portrait.up), dot(own, portrait.towards));
    // Linear in the distance along the ray.
    let clip = portrait_clip(portrait, q);
    let change = portrait_clip(portrait, q + d) - clip;
    var range = vec2(0.0, 1.0e30);
    range = kept(range, clip.w - clip.x, change.w - change.x);
    range = kept(range, clip.w + clip.x, change.w + change.x);
    range = kept(range, clip.w - clip.y, change.w - change.y);
    range = kept(range, clip.w + clip.y, change.w + change.y);
    range = kept(range, clip.w - clip.z, change.w - change.z);
    range = kept(range, clip.z, change.z);
    var out: Projected;
    if range.x > range.y {
        return out;
    }
    let start = in_image(clip + range.x * change);
    let end = in_image(clip + range.y * change);
    // The part in the disc that rows cover.
    let middle = 0.5 * f32(impostors.size);
    let from_middle = start.xy - middle;
    let across = end.xy - start.xy;
    let square = dot(across, across);
    let half = dot(from_middle, across);
    let outside = dot(from_middle, from_middle) - middle * middle;
    if square < 1.0e-6 {
        out.exists = outside <= 0.0;
        out.line = ImageLine(start, end);
        return out;
    }
    let under = half * half - square * outside;
    if under <= 0.0 {
        return out;
    }
    let root = sqrt(under);
    let low = max((-half - root) / square, 0.0);
    let high = min((-half + root) / square, 1.0);
    out.exists = low < high;
    out.line = ImageLine(mix(start, end, low), mix(start, end, high));
    return out;
}
