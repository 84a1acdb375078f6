// Triangles of the reflected scene, cut until they are drawn where they belong: halved where their edges
// were, opened in their middles, listed where they cross the border of what is hidden, else drawn. One
// generation a pass, after its spans were looked at; the first reads the scene's, where link.wgsl has not made one.
#import bindings::record::count
#import virtual_objects::corner::{BORDER, LOST, SHOWN, status_of}
#import virtual_objects::spans::{
    BROAD, CUT_CORNERS, Cut, GROUP, Generation, NONE, STRAIGHT, Span, corners, corners_within, cuts, draw, ends_of,
    made_spans, owners, parts, room_for_corners, room_to_add, split
}
#ifdef SECOND
#import virtual_objects::reflector::shown_pixels
#endif

// Each triangle's vertices and edges.
@group(0) @binding(14) var<storage, read> source_indices: array<u32>;
@group(0) @binding(15) var<storage, read> triangle_edges: array<u32>;

@group(0) @binding(9) var<storage, read_write> before: Generation;
@group(0) @binding(17) var<storage, read_write> after: Generation;

// What is looked at in a triangle's place: triangles as above, and the spans made for them.
struct Pieces {
    total: u32,
    triangles: array<vec3<u32>, 4>,
    joints: u32,
    spans: array<vec3<u32>, 3>,
}

// The part of an edge from one of its corners to the corner made on it, given its first part.
fn part_from(first: u32, edge: u32, corner: u32) -> u32 {
    return first + select(1u, 0u, ends_of(edge).x == corner);
}

// A triangle halved at the middles of some of its edges; `inner` is the first of as many new spans.
fn halved(edges: vec3<u32>, corners_of: vec3<u32>, cut_at: vec3<u32>, inner: u32) -> Pieces {
    let number = u32(cut_at.x != NONE) + u32(cut_at.y != NONE) + u32(cut_at.z != NONE);
    // Turned so that the first edge is halved, and where one is not, that it is the third.
    var e = edges;
    var t = corners_of;
    var at = cut_at;
    for (var i = 0u; i < 2u && (at.x == NONE || (number == 2u && at.z != NONE)); i += 1u) {
        e = e.yzx;
        t = t.yzx;
        at = at.yzx;
    }
    // Parts of each edge, from its corner on the left and on the right, and the corner between.
    let left = vec3(part_from(at.x, e.x, t.x), part_from(at.y, e.y, t.y), part_from(at.z, e.z, t.z));
    let right = 2u * at + 1u - left;
    let m = vec3(ends_of(at.x).y, ends_of(at.y).y, ends_of(at.z).y);
    var out: Pieces;
    out.total = number + 1u;
    out.joints = number;
    if number == 1u {
        out.spans[0] = vec3(m.x, t.z, NONE);
        out.triangles[0] = vec3(left.x, inner, e.z);
        out.triangles[1] = vec3(right.x, e.y, inner);
        return out;
    }
    out.spans[0] = vec3(m.xy, NONE);
    out.triangles[0] = vec3(right.x, left.y, inner);
    if number == 2u {
        out.spans[1] = vec3(m.x, t.z, NONE);
        out.triangles[1] = vec3(left.x, inner + 1u, e.z);
        out.triangles[2] = vec3(inner, right.y, inner + 1u);
        return out;
    }
    out.spans[1] = vec3(m.yz, NONE);
    out.spans[2] = vec3(m.zx, NONE);
    out.triangles[1] = vec3(left.x, inner + 2u, right.z);
    out.triangles[2] = vec3(inner + 1u, right.y, left.z);
    out.triangles[3] = vec3(inner, inner + 1u, inner + 2u);
    return out;
}

// A triangle cut at its middle, from where three spans lead to its corners.
fn opened(edges: vec3<u32>, first: u32) -> Pieces {
    var out: Pieces;
    out.total = 3u;
    out.triangles[0] = vec3(edges.x, first + 1u, first);
    out.triangles[1] = vec3(edges.y, first + 2u, first + 1u);
    out.triangles[2] = vec3(edges.z, first, first + 2u);
    return out;
}

// The triangle itself, once more after its middle was looked at.
fn looked_within(edges: vec3<u32>, inner: u32) -> Pieces {
    var out: Pieces;
    out.total = 1u;
    out.triangles[0] = vec3(inner, NONE, NONE);
    out.joints = 1u;
    out.spans[0] = edges;
    return out;
}

fn look_again(pieces: Pieces, inner: u32, source: u32) {
    var p = pieces;
    for (var i = 0u; i < p.joints; i += 1u) {
        made_spans[inner + i - split.edges] = Span(p.spans[i].x, p.spans[i].y, p.spans[i].z);
    }
    let place = atomicAdd(&after.total, p.total);
    for (var i = 0u; i < p.total; i += 1u) {
        after.triangles[place + i] = vec4(p.triangles[i], source);
    }
    atomicMax(&after.groups_x, (place + p.total + GROUP - 1u) / GROUP);
    after.groups_y = 1u;
    after.groups_z = 1u;
}

// Have what is left of a triangle drawn.
fn list_cut(t: vec3<u32>, source: u32) {
    let place = room_for_corners(CUT_CORNERS);
    if place == NONE {
        return;
    }
    let number = atomicAdd(&cuts.total, 1u);
    cuts.triangles[number] = Cut(vec4(t, source), place, 0u, 0u, 0u);
    if number % GROUP == 0u {
        atomicAdd(&cuts.groups_x, 1u);
        cuts.groups_y = 1u;
        cuts.groups_z = 1u;
    }
}

// A triangle of this generation.
struct Triangle {
    edges: vec3<u32>,
    corners_of: vec3<u32>,
    source: u32,
    // Within it, if its middle was looked at.
    span: u32,
    is_there: bool,
}

fn triangle_at(index: u32) -> Triangle {
    if split.generation == 0u {
        if index >= split.triangles {
            return Triangle(vec3(0u), vec3(0u), 0u, NONE, false);
        }
        let i = 3u * index;
        let t = vec3(source_indices[i], source_indices[i + 1u], source_indices[i + 2u]);
        let e = vec3(triangle_edges[i], triangle_edges[i + 1u], triangle_edges[i + 2u]);
        // One with two equal corners has no area.
        return Triangle(e, t, index, NONE, owners[t.x] != split.reflector && all(t != t.yzx));
    }
    let found = before.triangles[index];
    let span = select(NONE, found.x, found.y == NONE);
    var e = found.xyz;
    if span != NONE {
        e = ends_of(span);
    }
    return Triangle(e, corners_within(e), found.w, span, index < atomicLoad(&before.total));
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let it = triangle_at(id.x);
    if !it.is_there {
        return;
    }
#ifdef SECOND
    if shown_pixels[split.reflector] == 0u {
        return;
    }
#endif
    let t = it.corners_of;
    let status = vec3(status_of(corners[t.x]), status_of(corners[t.y]), status_of(corners[t.z]));
    let seen = (status == vec3(SHOWN)) | (status == vec3(BORDER));
    if !any(seen) {
        return;
    }
    // The first parts of its edges, and of the span within it.
    var first = vec3(STRAIGHT);
    var first_within = STRAIGHT;
    if split.generation < split.most {
        first = vec3(parts[it.edges.x], parts[it.edges.y], parts[it.edges.z]);
        if it.span != NONE {
            first_within = parts[it.span];
        }
    }
    let halves = first < vec3(BROAD);
    let number = u32(halves.x) + u32(halves.y) + u32(halves.z);
    let opens = first_within < BROAD;
    let looks_within = all(seen) && number == 0u && any(first == vec3(BROAD)) && it.span == NONE
        && split.generation + 1u < split.most;
    let crosses = !all(seen) && number == 0u && !any(status == vec3(LOST));
    // Triangles added, and spans to be made; another one for what is within, so two may follow.
    var added = number;
    if crosses {
        added = CUT_CORNERS - 1u;
    } else if looks_within {
        added = 2u;
    }
    let inner = room_to_add(added, select(number, 1u, looks_within));
    var pieces: Pieces;
    if opens {
        pieces = opened(it.edges, first_within);
    } else if inner != NONE && number > 0u {
        pieces = halved(it.edges, t, select(vec3(NONE), first, halves), inner);
    } else if inner != NONE && looks_within {
        pieces = looked_within(it.edges, inner);
    }
    if pieces.total > 0u {
        look_again(pieces, inner, it.source);
        count(5u, select(1u, 0u, looks_within));
    } else if all(seen) {
        draw(t, it.source);
    } else if crosses && inner != NONE {
        list_cut(t, it.source);
    }
}
