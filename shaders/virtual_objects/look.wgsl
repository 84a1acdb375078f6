// Spans looked at: where the middle of one is not reflected where the drawn middle would be, it is cut
// there. Searches begin where the drawn middle has its point; those that do not end from there begin anew
// in a pass of their own (`FAR`), as few do, and drivers that run both sides of a branch would pay for all.
#import bindings::record::count
#import virtual_objects::corner::{Corner, HIDDEN, LOST, is_seen, place_of, status_of}
#ifdef ROOTS_ALL
#import virtual_objects::branch::corner_on
#endif
#import virtual_objects::find::{
    border_between, border_corner, corner_of, hidden_corner, is_hidden, point_near, point_of, steps
}
#import virtual_objects::reflector::{evaluations, point_at}
#import virtual_objects::spans::{
    GROUP, Looks, NONE, SHORT, Span, corners, corners_within, ends_of, extent, looks, made_spans, parts,
    pixel_of, room_for_corners, room_for_spans, split, view_camera
}

#ifndef FAR
@group(0) @binding(12) var<storage, read_write> far_looks: Looks;
#endif

// Largest error of the distance to what a pixel shows, as a share, by how fast that changes along an edge:
// an eighth of what counts as another depth, as it changes faster across.
const DEPTH_TOLERANCE: f32 = 0.00625;

// What is looked at, and what is drawn there if it is not cut.
struct Middle {
    // Where the span is cut; the point looked at, the same but where only a part is reflected; and a place
    // likely to be near its reflection point.
    cut: vec3<f32>,
    v: vec3<f32>,
    place: vec2<f32>,
    // Where it would be drawn, between these.
    drawn_at: vec3<f32>,
    near: Corner,
    far: Corner,
    is_long: bool,
    lost: bool,
}

// Of the edge from a corner that is reflected to another, or to the border of what is hidden. Edges
// between equal corners decide alike: all that is computed is the same either way round.
fn edge_middle(a: Corner, b: Corner) -> Middle {
    var near = a;
    var far = b;
    if !is_seen(a) {
        near = b;
        far = a;
    }
    let cut = 0.5 * (a.position + b.position);
    var out = Middle(cut, cut, vec2(0.0), vec3(0.0), near, far, true, status_of(far) == LOST);
    var share = 0.5;
    if status_of(far) == HIDDEN {
        // Share of the edge that is reflected.
        let border = border_between(near.position, far.position);
        out.far = border_corner(mix(near.position, far.position, border));
        out.is_long = extent(near, out.far) >= SHORT;
        // The middle of the whole edge; of the part up to the border, where that is less than half.
        if border <= 0.5 {
            out.v = 0.5 * (near.position + out.far.position);
        } else {
            share = 0.5 / border;
        }
    }
    out.place = (1.0 - share) * place_of(near) + share * place_of(out.far);
    out.drawn_at = (1.0 - share) * near.image + share * out.far.image;
    return out;
}

fn triangle_middle(a: Corner, b: Corner, c: Corner) -> Middle {
    let v = (a.position + b.position + c.position) / 3.0;
    let place = (place_of(a) + place_of(b) + place_of(c)) / 3.0;
    return Middle(v, v, place, (a.image + b.image + c.image) / 3.0, a, b, true, false);
}

// Metres by which the distance to what is shown changes in a pixel, from one corner's image to another's.
fn slope_between(a: Corner, b: Corner) -> f32 {
    let pixels = max(distance(pixel_of(a.image), pixel_of(b.image)), 1.0);
    let eye = view_camera.eye;
    return abs(distance(eye, a.image) - distance(eye, b.image)) / pixels;
}

// Whether a corner is drawn too far from where it belongs when drawn as the span has it: in pixels, or so
// that what a pixel shows is at another distance.
fn errs(corner: Corner, m: Middle) -> bool {
    let error = distance(pixel_of(corner.image), pixel_of(m.drawn_at));
    let slope = max(slope_between(m.near, corner), slope_between(corner, m.far));
    let bounce = point_at(vec2<i32>(place_of(corner))).xyz;
    return error > split.tolerance
        || error * slope > DEPTH_TOLERANCE * distance(corner.position, bounce);
}

// Cut a span at a corner, into parts from each of its own to that.
fn cut(span: u32, ends: vec3<u32>, is_edge: bool, corner: Corner) {
    let number = select(3u, 2u, is_edge);
    let place = room_for_corners(1u);
    let first = room_for_spans(number);
    if place == NONE || first == NONE {
        return;
    }
    corners[place] = corner;
    parts[span] = first;
    for (var i = 0u; i < number; i += 1u) {
        made_spans[first + i - split.edges] = Span(ends[i], place, NONE);
    }
}

// What a span's middle is, given its corners.
fn middle_of(ends: vec3<u32>, is_edge: bool) -> Middle {
    let a = corners[ends.x];
    let b = corners[ends.y];
    if is_edge {
        return edge_middle(a, b);
    }
    return triangle_middle(a, b, corners[ends.z]);
}

#ifdef ROOTS_ALL
// In the branch of the span's corners.
fn is_found(span: u32, m: Middle, corner: ptr<function, Corner>) -> bool {
    *corner = corner_on(m.v, m.place, m.near);
    return true;
}

fn is_to_cut(corner: Corner, m: Middle) -> bool {
    // What ends between two corners of a branch has been cut before.
    return is_seen(corner) && errs(corner, m);
}
#else
fn is_to_cut(corner: Corner, m: Middle) -> bool {
    return m.lost || !is_seen(corner) || errs(corner, m);
}

#ifdef FAR
fn is_found(span: u32, m: Middle, corner: ptr<function, Corner>) -> bool {
    *corner = corner_of(m.v, point_of(m.v));
    return true;
}
#else
// False where the search is to begin anew.
fn is_found(span: u32, m: Middle, corner: ptr<function, Corner>) -> bool {
    if is_hidden(m.v) {
        *corner = hidden_corner(m.v);
        return true;
    }
    let point = point_near(m.place, m.v);
    *corner = corner_of(m.v, point);
    if point.found {
        return true;
    }
    let place = atomicAdd(&far_looks.total, 1u);
    far_looks.spans[place] = span;
    if place % GROUP == 0u {
        atomicAdd(&far_looks.groups_x, 1u);
        far_looks.groups_y = 1u;
        far_looks.groups_z = 1u;
    }
    return false;
}
#endif
#endif

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= atomicLoad(&looks.total) {
        return;
    }
    let span = looks.spans[id.x];
    var ends = ends_of(span);
    let is_edge = ends.z == NONE;
    if !is_edge {
        ends = corners_within(ends);
    }
    let m = middle_of(ends, is_edge);
    if !m.is_long {
        return;
    }
    var corner: Corner;
    let found = is_found(span, m, &corner);
    count(1u, steps);
    count(2u, evaluations);
    if found && is_to_cut(corner, m) {
        if any(m.v != m.cut) {
            corner = hidden_corner(m.cut);
        }
        cut(span, ends, is_edge, corner);
    }
}
