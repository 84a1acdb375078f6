// The plane of a mirrored ray and a map's centre (Patow 1995, section 2). Vectors are relative to
// the centre: W is the reflector point, B the unit mirrored direction.
// Rust twin: geometry/reflection_plane.rs.
#define_import_path common::reflection_plane

// Sine below which B and the line of W count as parallel: a fifth of a texel of 300 x 300 faces.
const PARALLEL_SINE: f32 = 1e-3;

// Equation (1): the direction between B (t = 0) and W (t = 1), not normalised.
fn direction_at(b: vec3<f32>, w: vec3<f32>, t: f32) -> vec3<f32> {
    return (1.0 - t) * b + t * w;
}

// B . [W] = +-1, or W has no direction: they span no plane.
fn is_parallel(b: vec3<f32>, w: vec3<f32>) -> bool {
    let normal = cross(b, w);
    return dot(normal, normal) <= PARALLEL_SINE * PARALLEL_SINE * dot(w, w);
}

// Expression (2), AngleBetween(B, S' - W), as a number that rises with it: the squared sine up to
// a right angle, 2 beyond and where S' is W. `towards` is S' - W in any positive scale.
fn deviation(b: vec3<f32>, towards: vec3<f32>) -> f32 {
    if dot(b, towards) > 0.0 {
        let off = cross(b, towards);
        return dot(off, off) / dot(towards, towards);
    }
    return 2.0;
}

// A direction in the coordinates of a cube face: to the right, down, along its axis.
fn in_face(face: u32, d: vec3<f32>) -> vec3<f32> {
    switch face {
        case 0u: { return vec3(-d.z, -d.y, d.x); }
        case 1u: { return vec3(d.z, -d.y, -d.x); }
        case 2u: { return vec3(d.x, d.z, d.y); }
        case 3u: { return vec3(d.x, -d.z, -d.y); }
        case 4u: { return vec3(d.x, -d.y, d.z); }
        default: { return vec3(-d.x, -d.y, -d.z); }
    }
}

// Part of an arc on one face.
struct FacePart {
    exists: bool,
    // Positions on the face, (0, 0) to (1, 1).
    start: vec2<f32>,
    end: vec2<f32>,
}

fn face_position(d: vec3<f32>) -> vec2<f32> {
    return clamp(0.5 + 0.5 * d.xy / d.z, vec2(0.0), vec2(1.0));
}

// The part of the arc from B to W that lies on a face, both in the face's coordinates.
fn on_face(b: vec3<f32>, w: vec3<f32>) -> FacePart {
    var enter = 0.0;
    var leave = 1.0;
    // On the face a direction is no further off the axis than along it, to either side.
    let at_b = vec4(b.z - b.xy, b.z + b.xy);
    let at_w = vec4(w.z - w.xy, w.z + w.xy);
    let crossing = at_b / (at_b - at_w);
    for (var side = 0u; side < 4u; side += 1u) {
        if at_b[side] < 0.0 && at_w[side] < 0.0 {
            return FacePart(false, vec2(0.0), vec2(0.0));
        }
        if at_b[side] < 0.0 {
            enter = max(enter, crossing[side]);
        } else if at_w[side] < 0.0 {
            leave = min(leave, crossing[side]);
        }
    }
    if enter >= leave {
        return FacePart(false, vec2(0.0), vec2(0.0));
    }
    let start = face_position(direction_at(b, w, enter));
    return FacePart(true, start, face_position(direction_at(b, w, leave)));
}
