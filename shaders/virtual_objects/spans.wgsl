// What halving knows of the reflected scene: triangles between corners, and the spans that bound them.
// A span is an edge, or the inside of a triangle whose edges are straight; it is looked at once, however
// many triangles share it, so all of them are cut alike.
#define_import_path virtual_objects::spans

#import bindings::record::count
#import common::camera::Camera
#import virtual_objects::corner::{Corner, LOST, is_seen, place_of, status_of}
#import virtual_objects::reflector::point_at

struct Split {
    // Of the scene.
    vertices: u32,
    triangles: u32,
    edges: u32,
    // The reflector itself, which it does not reflect.
    reflector: u32,
    // Corners and spans that there is room for beside the scene's; twice as many triangles as corners can
    // be added.
    corner_room: u32,
    span_room: u32,
    // Generations made so far, and the most.
    generation: u32,
    most: u32,
    // Of the view, pixels.
    size: vec2<u32>,
    // Largest distance between a middle drawn and the true one, pixels.
    tolerance: f32,
    pad: u32,
}
@group(0) @binding(8) var<storage, read> split: Split;
// Whose vertex each is, and the two vertices of each of the scene's edges.
@group(0) @binding(3) var<storage, read> owners: array<u32>;
@group(0) @binding(4) var<storage, read> source_edges: array<vec2<u32>>;
// Those of the scene's vertices, then those made.
@group(0) @binding(5) var<storage, read_write> corners: array<Corner>;
// That of the view; the reflector's textures have their own.
@group(0) @binding(6) var<uniform> view_camera: Camera;

// Between two corners, the third `NONE`; or within three edges.
struct Span {
    first: u32,
    second: u32,
    third: u32,
}
// Those that are not the scene's.
@group(0) @binding(10) var<storage, read_write> made_spans: array<Span>;
// The first of the two or three spans each is cut into, from each of its corners to the one made;
// or `STRAIGHT`, or `BROAD`.
@group(0) @binding(11) var<storage, read_write> parts: array<u32>;

// Triangles of a generation. To halve: three edges, or a span within three and twice `NONE`, and the scene's
// triangle they lie in.
struct Generation {
    groups_x: atomic<u32>,
    groups_y: u32,
    groups_z: u32,
    total: atomic<u32>,
    triangles: array<vec4<u32>>,
}

// Spans to look at in a generation.
struct Looks {
    groups_x: atomic<u32>,
    groups_y: u32,
    groups_z: u32,
    total: atomic<u32>,
    spans: array<u32>,
}
@group(0) @binding(13) var<storage, read_write> looks: Looks;

// What is drawn: arguments of a draw, what was made, then triangles: three corners, and the scene's
// triangle they lie in.
struct Drawn {
    vertices: atomic<u32>,
    instances: u32,
    first_vertex: u32,
    first_instance: u32,
    corners: atomic<u32>,
    spans: atomic<u32>,
    added: atomic<u32>,
    pad: u32,
    triangles: array<vec4<u32>>,
}
@group(0) @binding(18) var<storage, read_write> drawn: Drawn;

// Triangles across the border of what is hidden: corners, the scene's triangle, and the first of the
// corners to be made.
struct Cut {
    triangle: vec4<u32>,
    place: u32,
    pad_a: u32,
    pad_b: u32,
    pad_c: u32,
}
struct Cuts {
    groups_x: atomic<u32>,
    groups_y: u32,
    groups_z: u32,
    total: atomic<u32>,
    triangles: array<Cut>,
}
@group(0) @binding(19) var<storage, read_write> cuts: Cuts;
// Corners that such a cut makes on the border; it leaves as many triangles, or one fewer.
const CUT_CORNERS: u32 = 5u;

// How many groups measure the spans made for a generation, and where those begin: for an even one, and
// for an odd one.
struct Fresh {
    groups_x: atomic<u32>,
    groups_y: u32,
    groups_z: u32,
    even: u32,
    odd: u32,
}
@group(0) @binding(16) var<storage, read_write> fresh: Fresh;

const NONE: u32 = 0xffffffffu;
const STRAIGHT: u32 = 0xffffffffu;
// Straight, and so long that what lies beside it may be somewhere else.
const BROAD: u32 = 0xfffffffeu;
const GROUP: u32 = 64u;

// An edge shorter than this, pixels, is straight enough, where the reflector sees it this small, radians.
const SHORT: f32 = 2.0;
const SMALL: f32 = 0.25;
// Longer than any edge in pixels.
const ENDLESS: f32 = 1e9;

// Where the view shows a world point, pixels.
fn pixel_of(image: vec3<f32>) -> vec2<f32> {
    let clip = view_camera.clip_from_world * vec4(image, 1.0);
    return (0.5 * clip.xy / max(clip.w, 1e-6) + 0.5) * vec2<f32>(split.size);
}

// Whether an edge is drawn beside the view, a quarter of its width or height from it, or further.
fn is_beside_view(a: Corner, b: Corner) -> bool {
    let one = view_camera.clip_from_world * vec4(a.image, 1.0);
    let other = view_camera.clip_from_world * vec4(b.image, 1.0);
    let beyond = (one.xy > vec2(1.5 * one.w)) & (other.xy > vec2(1.5 * other.w));
    let before = (one.xy < vec2(-1.5 * one.w)) & (other.xy < vec2(-1.5 * other.w));
    return any(beyond | before);
}

// Length of an edge in pixels; `ENDLESS` where the reflector sees it under a large angle, and 0 beside the
// view, where pixels are no measure of what is seen.
fn extent(a: Corner, b: Corner) -> f32 {
    if is_beside_view(a, b) {
        return 0.0;
    }
    let seen_from = point_at(vec2<i32>(0.5 * (place_of(a) + place_of(b)))).xyz;
    let away = distance(0.5 * (a.position + b.position), seen_from);
    let is_small = distance(a.position, b.position) < SMALL * away;
    return select(ENDLESS, distance(pixel_of(a.image), pixel_of(b.image)), is_small);
}

// The two corners of an edge, or the three edges of a triangle.
fn ends_of(span: u32) -> vec3<u32> {
    if span < split.edges {
        return vec3(source_edges[span], NONE);
    }
    let made = made_spans[span - split.edges];
    return vec3(made.first, made.second, made.third);
}

// The corners of a triangle within three edges: that of the third and the first, and so on.
fn corners_within(edges: vec3<u32>) -> vec3<u32> {
    let one = ends_of(edges.x).xy;
    let two = ends_of(edges.y).xy;
    let three = ends_of(edges.z).xy;
    return vec3(
        select(one.y, one.x, any(three == one.xx)),
        select(two.y, two.x, any(one == two.xx)),
        select(three.y, three.x, any(two == three.xx)),
    );
}

// Places for spans, from the one returned on; `NONE` where there is no room. Who measures them begins
// with the group of the first, so one group more is needed wherever another is begun.
fn room_for_spans(number: u32) -> u32 {
    let place = atomicAdd(&drawn.spans, number);
    if place / GROUP != (place + number) / GROUP {
        atomicAdd(&fresh.groups_x, 1u);
    }
    let is_full = place + number > split.span_room;
    count(6u, u32(is_full));
    return select(split.edges + place, NONE, is_full);
}

// Likewise for corners.
fn room_for_corners(number: u32) -> u32 {
    let place = atomicAdd(&drawn.corners, number);
    let is_full = place + number > split.corner_room;
    count(6u, u32(is_full));
    return select(split.vertices + place, NONE, is_full);
}

// Room for so many triangles more than there are and for the spans between them, from the place returned
// on; `NONE` where there is no room, or nothing to add.
fn room_to_add(triangles: u32, spans: u32) -> u32 {
    if triangles == 0u {
        return NONE;
    }
    let is_full = atomicAdd(&drawn.added, triangles) + triangles > 2u * split.corner_room;
    count(6u, u32(is_full));
    if is_full || spans == 0u {
        return select(split.edges, NONE, is_full);
    }
    return room_for_spans(spans);
}

fn draw(t: vec3<u32>, source: u32) {
    let place = atomicAdd(&drawn.vertices, 3u) / 3u;
    drawn.instances = 1u;
    drawn.triangles[place] = vec4(t, source);
}
