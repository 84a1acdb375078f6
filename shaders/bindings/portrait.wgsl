// Portraits: pictures of one object each, in the object's own space. Filled by stages/portrait.rs.
#define_import_path bindings::portrait

// How a picture looks at its object. Its plane goes through `centre`; "own" is the object's own space.
struct Portrait {
    // Rows of world from own space, this frame.
    row_x: vec4<f32>,
    row_y: vec4<f32>,
    row_z: vec4<f32>,
    // Own space, as all below; right, up and towards the picture's eye are unit vectors.
    centre: vec3<f32>,
    half_width: f32,
    right: vec3<f32>,
    half_height: f32,
    up: vec3<f32>,
    // Of the eye before the plane; 0 for parallel rays.
    eye_distance: f32,
    towards: vec3<f32>,
    // What is drawn lies up to this far before and behind the plane.
    reach: f32,
}

fn portrait_rotated(portrait: Portrait, d: vec3<f32>) -> vec3<f32> {
    return vec3(
        dot(portrait.row_x.xyz, d),
        dot(portrait.row_y.xyz, d),
        dot(portrait.row_z.xyz, d),
    );
}

fn portrait_to_world(portrait: Portrait, p: vec3<f32>) -> vec3<f32> {
    return portrait_rotated(portrait, p)
        + vec3(portrait.row_x.w, portrait.row_y.w, portrait.row_z.w);
}

// World directions in own space; poses are rigid.
fn portrait_own_direction(portrait: Portrait, d: vec3<f32>) -> vec3<f32> {
    return d.x * portrait.row_x.xyz + d.y * portrait.row_y.xyz + d.z * portrait.row_z.xyz;
}

fn portrait_own_position(portrait: Portrait, p: vec3<f32>) -> vec3<f32> {
    let origin = vec3(portrait.row_x.w, portrait.row_y.w, portrait.row_z.w);
    return portrait_own_direction(portrait, p - origin);
}

// A point of own space in the picture's axes: right, up, and towards the eye before the plane.
fn portrait_axes(portrait: Portrait, own: vec3<f32>) -> vec3<f32> {
    let q = own - portrait.centre;
    return vec3(dot(q, portrait.right), dot(q, portrait.up), dot(q, portrait.towards));
}

// A point in the picture's axes in clip space: reversed depth, y down.
fn portrait_clip(portrait: Portrait, q: vec3<f32>) -> vec4<f32> {
    let across = vec2(q.x / portrait.half_width, -q.y / portrait.half_height);
    let distance = portrait.eye_distance;
    if distance == 0.0 {
        return vec4(across, 0.5 + 0.5 * q.z / portrait.reach, 1.0);
    }
    let w = distance - q.z;
    // From near to far the depth falls from 1 to 0.
    let near = distance - portrait.reach;
    let far = distance + portrait.reach;
    return vec4(distance * across, near * (far - w) / (far - near), w);
}

// Where a point of the picture's plane, in the picture's axes, is on the picture: (0, 0) to (1, 1),
// row 0 on top.
fn portrait_place(portrait: Portrait, q: vec2<f32>) -> vec2<f32> {
    return vec2(0.5 + 0.5 * q.x / portrait.half_width, 0.5 - 0.5 * q.y / portrait.half_height);
}

// A ray in a picture's clip space: where it leaves, the change a metre, and the metres between which it is in what the
// picture can show; none where the second is the less.
struct PortraitRay {
    clip: vec4<f32>,
    change: vec4<f32>,
    range: vec2<f32>,
    // Over the plane where it leaves, and the change a metre.
    height: f32,
    climb: f32,
    // It comes in by the side that faces the eye.
    from_front: bool,
}

fn portrait_ray(portrait: Portrait, origin: vec3<f32>, direction: vec3<f32>) -> PortraitRay {
    let o = portrait_axes(portrait, portrait_own_position(portrait, origin));
    let own = portrait_own_direction(portrait, direction);
    let d = vec3(dot(own, portrait.right), dot(own, portrait.up), dot(own, portrait.towards));
    let clip = portrait_clip(portrait, o);
    let change = portrait_clip(portrait, o + d) - clip;
    var range = vec2(0.0, 1.0e30);
    range = portrait_kept(range, clip.w - clip.x, change.w - change.x);
    range = portrait_kept(range, clip.w + clip.x, change.w + change.x);
    range = portrait_kept(range, clip.w - clip.y, change.w - change.y);
    range = portrait_kept(range, clip.w + clip.y, change.w + change.y);
    range = portrait_kept(range, clip.z, change.z);
    let before = range.x;
    range = portrait_kept(range, clip.w - clip.z, change.w - change.z);
    return PortraitRay(clip, change, range, o.z, d.z, range.x > before);
}

// The range of a ray where a + t b >= 0 besides.
fn portrait_kept(range: vec2<f32>, a: f32, b: f32) -> vec2<f32> {
    if b > 0.0 {
        return vec2(max(range.x, -a / b), range.y);
    }
    if b < 0.0 {
        return vec2(range.x, min(range.y, -a / b));
    }
    return select(range, vec2(1.0, 0.0), a < 0.0);
}
