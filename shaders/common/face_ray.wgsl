// A ray over the faces of a cube map. In a face's own coordinates, u and v over the face and w = 1/z, z the
// depth along the face's axis, a ray is a straight line and a plane is linear: the map is projective.
// Rust twin: geometry/face_ray.rs.
#define_import_path common::face_ray

#import common::cube::{cube_direction, cube_texel}

// A piece of a ray over one face: (u, v, w), u and v in texels, w in 1/m, linear in between.
struct FaceSegment {
    face: u32,
    begin: vec3<f32>,
    end: vec3<f32>,
}

// A ray being followed from face to face. Patow's theorem (1995, section 2): all directions it is seen in lie
// between [W] and B, at (1 - t) B + t [W]; `along` is his 1 - t.
struct FaceWalk {
    // [W], unit, as seen from the map's centre.
    start: vec3<f32>,
    // B.
    direction: vec3<f32>,
    // 1 / |W|.
    nearness: f32,
    face: u32,
    along: f32,
    ended: bool,
}

// Coordinates of a vector on a face: to the right, down, and along the face's axis.
fn on_face(face: u32, p: vec3<f32>) -> vec3<f32> {
    switch face {
        case 0u: { return vec3(-p.z, -p.y, p.x); }
        case 1u: { return vec3(p.z, -p.y, -p.x); }
        case 2u: { return vec3(p.x, p.z, p.y); }
        case 3u: { return vec3(p.x, -p.z, -p.y); }
        case 4u: { return vec3(p.x, -p.y, p.z); }
        default: { return vec3(-p.x, -p.y, -p.z); }
    }
}

// The face across the border to the left (0), right (1), top (2) or bottom (3).
fn face_across(face: u32, side: u32) -> u32 {
    let step = select(-2.0, 2.0, (side & 1u) == 1u);
    let beyond = select(vec2(step, 0.0), vec2(0.0, step), side >= 2u);
    return cube_texel(cube_direction(face, 0.5 + beyond)).face;
}

// `w` is the ray's start relative to the map's centre; `direction` has unit length.
fn face_walk(w: vec3<f32>, direction: vec3<f32>) -> FaceWalk {
    let far = length(w);
    // From the centre itself every point is seen in the same direction.
    let start = select(direction, w / far, far > 1.0e-20);
    return FaceWalk(start, direction, 1.0 / max(far, 1.0e-20), cube_texel(start).face, 0.0, false);
}

// The next piece, over a map with `size` texels a side.
fn next_segment(walk: ptr<function, FaceWalk>, size: f32) -> FaceSegment {
    let a = on_face((*walk).face, (*walk).start);
    let b = on_face((*walk).face, (*walk).direction);
    // Signed distances from the four borders' planes, at both ends of the ray.
    let before = vec4(a.z + a.x, a.z - a.x, a.z + a.y, a.z - a.y);
    let after = vec4(b.z + b.x, b.z - b.x, b.z + b.y, b.z - b.y);
    var leave = 1.0;
    var side = 4u;
    for (var i = 0u; i < 4u; i++) {
        if after[i] < 0.0 {
            let at = max(before[i] / (before[i] - after[i]), (*walk).along);
            if at < leave {
                leave = at;
                side = i;
            }
        }
    }
    var segment: FaceSegment;
    segment.face = (*walk).face;
    segment.begin = face_point(*walk, a, b, (*walk).along, size);
    segment.end = face_point(*walk, a, b, leave, size);
    (*walk).along = leave;
    if side == 4u {
        (*walk).ended = true;
    } else {
        (*walk).face = face_across((*walk).face, side);
    }
    return segment;
}

// (u, v, w) where the ray has come `along`, its ends' coordinates on the face given.
fn face_point(walk: FaceWalk, a: vec3<f32>, b: vec3<f32>, along: f32, size: f32) -> vec3<f32> {
    let p = mix(a, b, along);
    let depth = max(p.z, 1.0e-20);
    let uv = clamp(0.5 * (p.xy / depth + 1.0), vec2(0.0), vec2(1.0));
    return vec3(size * uv, (1.0 - along) * walk.nearness / depth);
}
