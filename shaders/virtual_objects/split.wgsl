// Triangles of the reflected scene, cut until they are drawn where they belong: those whose edges'
// middles are not reflected where the drawn middle would be are halved there, and what lies behind the
// reflector is cut off along its shadow volume. One generation a pass; the first reads the scene's.
#import bindings::record::count
#import common::camera::Camera
#import virtual_objects::corner::{
    Corner, HIDDEN, LOST, is_seen, place_of, status_of
}
#import virtual_objects::find::{
    border_between, border_corner, corner_near, hidden_corner, steps
}
#import virtual_objects::reflector::{evaluations, point_at}
#ifdef SECOND
#import virtual_objects::reflector::shown_pixels
#endif

struct Split {
    // Vertices and triangles of the scene.
    vertices: u32,
    triangles: u32,
    // Corners that there is room for, those of the scene's vertices included.
    room: u32,
    // Generations made so far, and the most.
    generation: u32,
    most: u32,
    // The reflector itself, which it does not reflect.
    reflector: u32,
    // Of the view, pixels.
    size: vec2<u32>,
    // Largest distance between a middle drawn and the true one, pixels; 0: cut, but never halve.
    tolerance: f32,
    pad_a: u32,
    pad_b: u32,
    pad_c: u32,
}
@group(0) @binding(8) var<storage, read> split: Split;
// Whose vertex each is, and each triangle's vertices.
@group(0) @binding(3) var<storage, read> owners: array<u32>;
@group(0) @binding(4) var<storage, read> source_indices: array<u32>;
// Those of the scene's vertices, then those made here.
@group(0) @binding(5) var<storage, read_write> corners: array<Corner>;
// That of the view; the reflector's textures have their own.
@group(0) @binding(6) var<uniform> view_camera: Camera;

// Three corners and the scene's triangle they lie in.
struct Generation {
    groups_x: atomic<u32>,
    groups_y: u32,
    groups_z: u32,
    number: atomic<u32>,
    triangles: array<vec4<u32>>,
}
@group(0) @binding(9) var<storage, read_write> before: Generation;
@group(0) @binding(17) var<storage, read_write> after: Generation;

// What is drawn: arguments of a draw, corners made, then triangles as above.
struct Drawn {
    vertices: atomic<u32>,
    instances: u32,
    first_vertex: u32,
    first_instance: u32,
    made: atomic<u32>,
    pad_a: u32,
    pad_b: u32,
    pad_c: u32,
    triangles: array<vec4<u32>>,
}
@group(0) @binding(18) var<storage, read_write> drawn: Drawn;

const GROUP: u32 = 64u;
// Largest error of the distance to what a pixel shows, as a share: half of what counts as another depth.
const DEPTH_TOLERANCE: f32 = 0.025;
// An edge shorter than this, pixels, is straight enough, where the reflector sees it this small, radians.
const SHORT: f32 = 2.0;
const SMALL: f32 = 0.25;
// Only triangles with an edge longer than this, pixels, may be drawn all round a reflector's shadow unseen.
const BROAD: f32 = 8.0;
// Edges that end where there is no reflection point, as beyond an open reflector, are halved so often.
const LOST_GENERATIONS: u32 = 5u;
// Weights of corners are in 2^-15.
const ONE: u32 = 32768u;

// Where the view shows a world point, pixels.
fn pixel_of(image: vec3<f32>) -> vec2<f32> {
    let clip = view_camera.clip_from_world * vec4(image, 1.0);
    return (0.5 * clip.xy / max(clip.w, 1e-6) + 0.5) * vec2<f32>(split.size);
}

// The second and third weights of a corner in a triangle of the scene.
fn weights_in(corner: u32, source: u32) -> u32 {
    if corner >= split.vertices {
        return corners[corner].weights;
    }
    let second = select(0u, ONE, source_indices[3u * source + 1u] == corner);
    let third = select(0u, ONE, source_indices[3u * source + 2u] == corner);
    return second | (third << 16u);
}

fn unpacked_weights(packed: u32) -> vec2<f32> {
    return vec2<f32>(vec2(packed & 0xffffu, packed >> 16u));
}

fn packed_weights(weights: vec2<f32>) -> u32 {
    let rounded = vec2<u32>(round(weights));
    return rounded.x | (rounded.y << 16u);
}

fn draw(a: u32, b: u32, c: u32, source: u32) {
    let place = atomicAdd(&drawn.vertices, 3u) / 3u;
    drawn.instances = 1u;
    drawn.triangles[place] = vec4(a, b, c, source);
}

fn look_again(a: u32, b: u32, c: u32, source: u32) {
    let place = atomicAdd(&after.number, 1u);
    after.triangles[place] = vec4(a, b, c, source);
    if place % GROUP == 0u {
        atomicAdd(&after.groups_x, 1u);
        after.groups_y = 1u;
        after.groups_z = 1u;
    }
}

// Room for so many corners, from the place returned on; beyond `split.room` where there is none.
fn room_for(number: u32) -> u32 {
    let place = split.vertices + atomicAdd(&drawn.made, number);
    let is_full = place + number > split.room;
    count(6u, select(0u, 1u, is_full));
    return select(place, split.room, is_full);
}

// The part of an edge that is reflected.
struct Edge {
    // Whether any of it is: an end that is reflected is `near`.
    counts: bool,
    near: Corner,
    // The other end, or, where that is hidden, where the edge leaves the reflector's shadow.
    far: Corner,
    // Share of the edge that lies between the two.
    border: f32,
}

struct Middle {
    corner: Corner,
    halve: bool,
}

// An edge from a corner that is reflected to another, or to the border of what is hidden. Both triangles
// of an edge decide alike: all that is computed is the same either way round.
fn edge_of(a: Corner, b: Corner) -> Edge {
    var out = Edge(is_seen(a) || is_seen(b), a, b, 1.0);
    if !is_seen(a) {
        out.near = b;
        out.far = a;
    }
    if out.counts && status_of(out.far) == HIDDEN {
        out.border = border_between(out.near.position, out.far.position);
        out.far = border_corner(mix(out.near.position, out.far.position, out.border));
    }
    return out;
}

// Metres by which the distance to what is shown changes in a pixel, from one corner's image to another's.
fn slope_between(a: Corner, b: Corner) -> f32 {
    let pixels = max(distance(pixel_of(a.image), pixel_of(b.image)), 1.0);
    let eye = view_camera.eye;
    return abs(distance(eye, a.image) - distance(eye, b.image)) / pixels;
}

// Whether a corner between two others is drawn too far from where it belongs when drawn as they have it:
// in pixels, or so that what a pixel shows is at another distance.
fn errs(corner: Corner, drawn_at: vec3<f32>, near: Corner, far: Corner) -> bool {
    let error = distance(pixel_of(corner.image), pixel_of(drawn_at));
    let slope = max(slope_between(near, corner), slope_between(corner, far));
    let bounce = point_at(vec2<i32>(place_of(corner))).xyz;
    return error > split.tolerance
        || error * slope > DEPTH_TOLERANCE * distance(corner.position, bounce);
}

// The middles of a triangle's edges, and whether they are to be halved there; the fourth is the
// triangle's own middle, looked at where all edges are straight.
fn middles_of(a: Corner, b: Corner, c: Corner) -> array<Middle, 4> {
    var ends = array(a, b, c);
    var out: array<Middle, 4>;
    var straight = true;
    var large = false;
    for (var i = 0u; i < 4u; i += 1u) {
        let third = 1.0 / 3.0;
        var v = third * (a.position + b.position + c.position);
        var place = third * (place_of(a) + place_of(b) + place_of(c));
        var drawn_at = third * (a.image + b.image + c.image);
        var middle = v;
        var looks = straight && large;
        var lost = false;
        var near = a;
        var far = b;
        if i < 3u {
            let one = ends[i];
            let other = ends[(i + 1u) % 3u];
            middle = 0.5 * (one.position + other.position);
            let edge = edge_of(one, other);
            // The middle of the whole edge; of the part up to the border, where that is less than half.
            let share = select(0.5 / edge.border, 0.5, edge.border <= 0.5);
            v = select(middle, mix(edge.near.position, edge.far.position, 0.5), edge.border <= 0.5);
            place = mix(place_of(edge.near), place_of(edge.far), share);
            drawn_at = mix(edge.near.image, edge.far.image, share);
            let length = distance(pixel_of(edge.near.image), pixel_of(edge.far.image));
            let seen_from = point_at(vec2<i32>(mix(place_of(edge.near), place_of(edge.far), 0.5))).xyz;
            let away = distance(mix(edge.near.position, edge.far.position, 0.5), seen_from);
            let is_small = distance(edge.near.position, edge.far.position) < SMALL * away;
            looks = edge.counts && (length >= SHORT || !is_small);
            large = large || (looks && (length >= BROAD || !is_small));
            near = edge.near;
            far = edge.far;
            lost = status_of(edge.far) == LOST;
            if lost {
                looks = edge.counts && split.generation < LOST_GENERATIONS;
            }
        } else {
            looks = looks && is_seen(a) && is_seen(b) && is_seen(c);
        }
        if looks {
            let corner = corner_near(v, place);
            out[i].halve = lost || !is_seen(corner) || errs(corner, drawn_at, near, far);
            out[i].corner = corner;
            if any(v != middle) {
                out[i].corner = hidden_corner(middle);
            }
        }
        straight = straight && !out[i].halve;
    }
    return out;
}

fn halved(a: u32, b: u32, source: u32, middle: Corner, place: u32) {
    var made = middle;
    let sum = unpacked_weights(weights_in(a, source)) + unpacked_weights(weights_in(b, source));
    made.weights = packed_weights(0.5 * sum);
    corners[place] = made;
}

// Cut a triangle at those edges' middles; false where there is no room.
fn halve(t: vec4<u32>, m: array<Middle, 4>) -> bool {
    var middles = m;
    var number = 0u;
    for (var i = 0u; i < 3u; i += 1u) {
        number += select(0u, 1u, middles[i].halve);
    }
    var place = room_for(number);
    if place == split.room {
        return false;
    }
    var old = array(t.x, t.y, t.z);
    var new_corner: array<u32, 3>;
    for (var i = 0u; i < 3u; i += 1u) {
        if middles[i].halve {
            new_corner[i] = place;
            halved(old[i], old[(i + 1u) % 3u], t.w, middles[i].corner, place);
            place += 1u;
        }
    }
    if number == 3u {
        look_again(old[0], new_corner[0], new_corner[2], t.w);
        look_again(new_corner[0], old[1], new_corner[1], t.w);
        look_again(new_corner[2], new_corner[1], old[2], t.w);
        look_again(new_corner[0], new_corner[1], new_corner[2], t.w);
        return true;
    }
    // Turned so that the first edge is halved, and where one is not, that it is the third.
    var turn = 0u;
    for (var i = 0u; i < 3u; i += 1u) {
        let before_it = middles[(i + 2u) % 3u].halve;
        if middles[i].halve && !before_it {
            turn = i;
        }
    }
    let a = old[turn];
    let b = old[(turn + 1u) % 3u];
    let c = old[(turn + 2u) % 3u];
    let ab = new_corner[turn];
    if number == 1u {
        look_again(a, ab, c, t.w);
        look_again(ab, b, c, t.w);
        return true;
    }
    let bc = new_corner[(turn + 1u) % 3u];
    look_again(ab, b, bc, t.w);
    look_again(a, ab, c, t.w);
    look_again(ab, bc, c, t.w);
    return true;
}

// Cut a triangle with straight edges at its middle, as one round the reflector's shadow.
fn open_middle(t: vec4<u32>, middle: Corner) -> bool {
    let place = room_for(1u);
    if place == split.room {
        return false;
    }
    var made = middle;
    var sum = unpacked_weights(weights_in(t.x, t.w)) + unpacked_weights(weights_in(t.y, t.w));
    sum += unpacked_weights(weights_in(t.z, t.w));
    made.weights = packed_weights(sum / 3.0);
    corners[place] = made;
    look_again(t.x, t.y, place, t.w);
    look_again(t.y, t.z, place, t.w);
    look_again(t.z, t.x, place, t.w);
    return true;
}

// Corners on the border of what is hidden, in one go along it.
const ALONG: u32 = 5u;

// What is left of a triangle with one or two hidden corners. The border is sought from the one seen
// corner towards the edge of the hidden two, or from the edge of the seen two towards the hidden one.
fn cut(t: vec4<u32>) {
    var old = array(t.x, t.y, t.z);
    var seen = 0u;
    for (var i = 0u; i < 3u; i += 1u) {
        seen += select(0u, 1u, is_seen(corners[old[i]]));
    }
    // `odd` is the corner unlike the other two.
    var odd = 0u;
    for (var i = 0u; i < 3u; i += 1u) {
        if is_seen(corners[old[i]]) == (seen == 1u) {
            odd = i;
        }
    }
    let apex = old[odd];
    let left = old[(odd + 1u) % 3u];
    let right = old[(odd + 2u) % 3u];
    let first = room_for(ALONG);
    if first == split.room {
        return;
    }
    let at_apex = corners[apex].position;
    let at_left = corners[left].position;
    let at_right = corners[right].position;
    let w_apex = unpacked_weights(weights_in(apex, t.w));
    let w_left = unpacked_weights(weights_in(left, t.w));
    let w_right = unpacked_weights(weights_in(right, t.w));
    for (var i = 0u; i < ALONG; i += 1u) {
        let along = f32(i) / f32(ALONG - 1u);
        let base = mix(at_left, at_right, along);
        let outside = select(base, at_apex, seen == 1u);
        let share = border_between(outside, select(at_apex, base, seen == 1u));
        // Of the way from the apex to the base.
        let to_base = select(1.0 - share, share, seen == 1u);
        var corner = border_corner(mix(at_apex, base, to_base));
        corner.weights = packed_weights(mix(w_apex, mix(w_left, w_right, along), to_base));
        corners[first + i] = corner;
    }
    if seen == 1u {
        for (var i = 0u; i + 1u < ALONG; i += 1u) {
            draw(apex, first + i, first + i + 1u, t.w);
        }
        return;
    }
    let half = ALONG / 2u;
    for (var i = 0u; i + 1u < ALONG; i += 1u) {
        draw(select(left, right, i >= half), first + i + 1u, first + i, t.w);
    }
    draw(left, right, first + half, t.w);
}

fn triangle_at(index: u32) -> vec4<u32> {
    if split.generation > 0u {
        return before.triangles[index];
    }
    let first = 3u * index;
    return vec4(source_indices[first], source_indices[first + 1u], source_indices[first + 2u], index);
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let total = select(split.triangles, atomicLoad(&before.number), split.generation > 0u);
    if id.x >= total {
        return;
    }
#ifdef SECOND
    if shown_pixels[split.reflector] == 0u {
        return;
    }
#endif
    let t = triangle_at(id.x);
    if owners[source_indices[3u * t.w]] == split.reflector {
        return;
    }
    let a = corners[t.x];
    let b = corners[t.y];
    let c = corners[t.z];
    let seen = array(is_seen(a), is_seen(b), is_seen(c));
    if !seen[0] && !seen[1] && !seen[2] {
        return;
    }
    let whole = seen[0] && seen[1] && seen[2];
    if split.tolerance > 0.0 && split.generation < split.most {
        let m = middles_of(a, b, c);
        var done = false;
        if m[0].halve || m[1].halve || m[2].halve {
            done = halve(t, m);
        } else if m[3].halve {
            done = open_middle(t, m[3].corner);
        }
        count(1u, steps);
        count(2u, evaluations);
        count(5u, select(0u, 1u, done));
        if done {
            return;
        }
    }
    if whole {
        draw(t.x, t.y, t.z, t.w);
    } else if status_of(a) != LOST && status_of(b) != LOST && status_of(c) != LOST {
        cut(t);
    }
}
