// Rays in depth images: where a point or a ray is in one (Popescu et al. 2006, slide 36).
#define_import_path depth_impostors::projection

#import bindings::portrait::{Portrait, portrait_ray}
#import depth_impostors::rows::{ImageLine, impostors}

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
    let there = portrait_ray(portrait, origin, direction);
    var out: Projected;
    if there.range.x > there.range.y {
        return out;
    }
    let start = in_image(there.clip + there.range.x * there.change);
    let end = in_image(there.clip + there.range.y * there.change);
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
