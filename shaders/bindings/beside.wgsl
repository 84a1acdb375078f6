// The pixels beside a mirror's: how much its ray stands for (ray differentials, Igehy 1999, by differences).
#define_import_path bindings::beside

#import bindings::view::{MirrorPoint, mirror_point_at, reflector_id}

// The pixel a step on, to the right or below, or where that shows another reflector the one before it; where both do the
// pixel itself: a footprint without width.
fn pixel_beside(at: MirrorPoint, step: vec2<i32>) -> MirrorPoint {
    let size = vec2<i32>(textureDimensions(reflector_id));
    for (var side = 0; side < 2; side += 1) {
        let pixel = vec2<i32>(at.pixel) + (1 - 2 * side) * step;
        if any(pixel < vec2(0)) || any(pixel >= size) {
            continue;
        }
        if textureLoad(reflector_id, vec2<u32>(pixel), 0).x != at.reflector {
            continue;
        }
        let other = mirror_point_at(vec2<u32>(pixel));
        if other.departs {
            return other;
        }
    }
    return at;
}
