// Spans that are new in a generation, measured: which are worth a look. First the scene's edges, then
// what was made in the generation before.
#import virtual_objects::corner::{Corner, LOST, is_seen, status_of}
#import virtual_objects::spans::{
    BROAD, GROUP, NONE, SHORT, STRAIGHT, corners, drawn, ends_of, extent, fresh, looks, owners, parts,
    split
}
#ifdef SECOND
#import virtual_objects::reflector::shown_pixels
#endif

// Only triangles with an edge longer than this, pixels, may be drawn all round a reflector's shadow unseen.
const LONG: f32 = 8.0;
// Edges that end where there is no reflection point, as beyond an open reflector, are halved so often.
const LOST_GENERATIONS: u32 = 5u;

fn look_at(span: u32) {
    let place = atomicAdd(&looks.total, 1u);
    looks.spans[place] = span;
    if place % GROUP == 0u {
        atomicAdd(&looks.groups_x, 1u);
        looks.groups_y = 1u;
        looks.groups_z = 1u;
    }
}

// Length of an edge in pixels, as far as it matters whether to look at it.
fn pixels_of(a: Corner, b: Corner) -> f32 {
    if is_seen(a) && is_seen(b) {
        return extent(a, b);
    }
    let is_lost = status_of(a) == LOST || status_of(b) == LOST;
    let counts = (is_seen(a) || is_seen(b)) && !(is_lost && split.generation >= LOST_GENERATIONS);
    // How much of it is reflected is still to be found.
    return select(0.0, SHORT, counts);
}

// Which span is an invocation's; `NONE` for none.
fn span_of(invocation: u32) -> u32 {
    if split.generation == 0u {
        return select(NONE, invocation, invocation < split.edges);
    }
    let begin = select(fresh.even, fresh.odd, split.generation % 2u == 1u);
    let end = min(atomicLoad(&drawn.spans), split.span_room);
    let place = begin / GROUP * GROUP + invocation;
    return select(NONE, split.edges + place, place >= begin && place < end);
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x == 0u {
        // Of the next generation.
        atomicStore(&fresh.groups_x, 1u);
        fresh.groups_y = 1u;
        fresh.groups_z = 1u;
        if split.generation % 2u == 0u {
            fresh.odd = atomicLoad(&drawn.spans);
        } else {
            fresh.even = atomicLoad(&drawn.spans);
        }
    }
    let span = span_of(id.x);
    if span == NONE {
        return;
    }
#ifdef SECOND
    if shown_pixels[split.reflector] == 0u {
        return;
    }
#endif
    let ends = ends_of(span);
    let is_edge = ends.z == NONE;
    // What had no room was never written.
    let room = select(split.edges + split.span_room, split.vertices + split.corner_room, is_edge);
    var pixels = select(0.0, SHORT, max(ends.x, ends.y) < room);
    if is_edge && pixels > 0.0 {
        pixels = pixels_of(corners[ends.x], corners[ends.y]);
    }
    if split.generation == 0u && owners[ends.x] == split.reflector {
        pixels = 0.0;
    }
    parts[span] = select(STRAIGHT, BROAD, pixels >= LONG);
    if pixels >= SHORT {
        look_at(span);
    }
}
