// The first surface a ray meets in an interval map: our revision of Patow 1995, sections 2 to 4. Where he takes
// the direction of best angle, this takes the first crossing; where he steps, this walks texels, and over the
// pyramid of bounds skips all those the ray cannot meet anything in.
#define_import_path bindings::interval_search

#import bindings::interval_map::{Patch, interval_map, place_in_pyramid}
#import bindings::interval_texel::{Met, Passage, confirmed, meet_texel, slips}
#import bindings::layers::layered_map
#import common::face_ray::{FaceSegment, FaceWalk, face_walk, next_segment}

// Half floats, see `place_in_pyramid`.
@group(0) @binding(45) var interval_bounds: texture_2d_array<u32>;

// What a search found.
struct MapHit {
    found: bool,
    face: u32,
    texel: vec2<i32>,
    // Of the layered capture.
    layer: u32,
    surface: Patch,
    // Where on the face, in texels.
    uv: vec2<f32>,
    // The ray came through something that the map does not know.
    flag: bool,
}

// What searching took.
struct MapWork {
    // Cells of the pyramid looked at, texels included.
    visits: u32,
    texels: u32,
    intervals: u32,
}

var<private> map_work: MapWork;

// Whether the ray, between two values of w, comes near anything in a cell.
fn touches(words: vec2<u32>, one: f32, other: f32) -> bool {
    let bounds = vec4(unpack2x16float(words.x), unpack2x16float(words.y));
    let low = min(one, other);
    let high = max(one, other);
    return (low <= bounds.y && high >= bounds.x) || (low <= bounds.w && high >= bounds.z);
}

// The ray over one face.
struct FaceRay {
    face: u32,
    begin: vec3<f32>,
    way: vec3<f32>,
    inverse: vec2<f32>,
    rises: vec2<bool>,
}

// Where a search has come to on a face.
struct Cursor {
    // How far along the ray, 0 to 1.
    at: f32,
    level: i32,
    // A cell of that level of the pyramid.
    cell: vec2<i32>,
}

// A search starts on each face at the level of the pyramid that has eight cells a side, or fewer.
const LEVELS_LEFT_OUT: i32 = 4;

fn face_ray(segment: FaceSegment) -> FaceRay {
    let way = segment.end - segment.begin;
    let steep = select(way.xy, vec2(1.0e-9), abs(way.xy) < vec2(1.0e-9));
    return FaceRay(segment.face, segment.begin, way, 1.0 / steep, steep > vec2(0.0));
}

fn start_of(ray: FaceRay, scan: bool) -> Cursor {
    let size = i32(layered_map.size);
    // On a border the ray counts as past it where it is vertical, see `child`.
    let down = vec2<i32>(floor(ray.begin.xy));
    let up = vec2<i32>(ceil(ray.begin.xy)) - 1;
    let place = vec2(select(up.x, down.x, ray.rises.x), select(down.y, up.y, ray.rises.y));
    let level = select(max(i32(interval_map.levels) - LEVELS_LEFT_OUT, 0), 0, scan);
    return Cursor(0.0, level, clamp(place, vec2(0), vec2(size - 1)) >> vec2(u32(level)));
}

// How a ray leaves a cell.
struct Exit {
    at: f32,
    // To the cell after.
    step: vec2<i32>,
    // Nothing is left of the ray on this face.
    ends: bool,
}

// Cells are whole numbers and the parameters at which the ray crosses their borders come from these alone
// (Amanatides & Woo 1987), never from a position moved on by some small amount.
fn crossings(ray: FaceRay, borders: vec2<i32>) -> vec2<f32> {
    return (vec2<f32>(borders) - ray.begin.xy) * ray.inverse;
}

fn exit_of(ray: FaceRay, cursor: Cursor) -> Exit {
    let shift = u32(cursor.level);
    let past = crossings(ray, (cursor.cell + vec2<i32>(ray.rises)) << vec2(shift));
    let leave = max(min(min(past.x, past.y), 1.0), cursor.at);
    let forward = 2 * vec2<i32>(ray.rises) - 1;
    let step = select(vec2(0, forward.y), vec2(forward.x, 0), past.x <= past.y);
    // Below 0 is beyond all as well.
    let outside = vec2<u32>(cursor.cell + step) >= vec2(layered_map.size >> shift);
    return Exit(leave, step, leave >= 1.0 || any(outside));
}

// The first of a cell's four that the ray is in. A ray that crosses two borders at once crosses the vertical one
// first, so a cell of any size has one well-defined first texel, the same for every search.
fn child(ray: FaceRay, cursor: Cursor) -> vec2<i32> {
    let past = crossings(ray, (2 * cursor.cell + 1) << vec2(u32(cursor.level - 1)));
    let crossed = vec2(past.x <= cursor.at, past.y < cursor.at);
    return 2 * cursor.cell + vec2<i32>(crossed == ray.rises);
}

// The cell after, and one level up where that begins a new larger cell.
fn after(cursor: Cursor, exit: Exit, scan: bool) -> Cursor {
    let next = cursor.cell + exit.step;
    let changed = next ^ cursor.cell;
    let rises = !scan && cursor.level + 1 < i32(interval_map.levels) && (changed.x | changed.y) > 1;
    let up = select(0u, 1u, rises);
    return Cursor(exit.at, cursor.level + i32(up), next >> vec2(up));
}

fn w_at(ray: FaceRay, at: f32) -> f32 {
    return ray.begin.z + at * ray.way.z;
}

// To the next texel that may hold something the ray meets; false where the face has none.
fn find_texel(ray: FaceRay, cursor: ptr<function, Cursor>, scan: bool) -> bool {
    var found = false;
    // More cells than any ray crosses.
    for (var left = 8u * layered_map.size; left > 0u; left--) {
        let old = *cursor;
        let exit = exit_of(ray, old);
        map_work.visits += 1u;
        var near = scan;
        if !scan {
            let place = place_in_pyramid(old.cell, u32(old.level));
            let bounds = textureLoad(interval_bounds, place, ray.face, 0).xy;
            near = touches(bounds, w_at(ray, old.at), w_at(ray, exit.at));
        }
        found = near && old.level == 0;
        if found || (!near && exit.ends) {
            break;
        }
        let next = after(old, exit, scan);
        (*cursor).at = select(next.at, old.at, near);
        (*cursor).level = select(next.level, old.level - 1, near);
        (*cursor).cell = select(next.cell, child(ray, old), near);
    }
    return found;
}

fn passage_of(ray: FaceRay, cursor: Cursor, exit: Exit, seam: bool) -> Passage {
    let centre = vec3(vec2<f32>(cursor.cell) + 0.5, 0.0);
    let enter = ray.begin + cursor.at * ray.way - centre;
    let leave = ray.begin + exit.at * ray.way - centre;
    // It came over the border it crossed last.
    let past = crossings(ray, cursor.cell + vec2<i32>(!ray.rises));
    let backward = 1 - 2 * vec2<i32>(ray.rises);
    let step = select(vec2(0, backward.y), vec2(backward.x, 0), past.x > past.y);
    let back = select(vec2(0), step, cursor.at > 0.0);
    let forth = select(exit.step, vec2(0), exit.ends);
    return Passage(ray.face, cursor.cell, enter, leave, back, forth, seam && cursor.at == 0.0);
}

// The first surface from a point, relative to the map's centre, in a direction. `scan` looks at every texel on
// the way instead of using the pyramid: slow, and the same.
fn search_map(w: vec3<f32>, direction: vec3<f32>, scan: bool) -> MapHit {
    var hit: MapHit;
    var walk = face_walk(w, direction);
    var ray = face_ray(next_segment(&walk, f32(layered_map.size)));
    var cursor = start_of(ray, scan);
    var met: Met;
    var passage: Passage;
    var pieces = 0u;
    // Processors run the lanes of a group in step, and some both sides of every branch. So what is done most often
    // is innermost, without the rest: steps from cell to cell, then texels, then faces and slips.
    loop {
        var goes_on = false;
        loop {
            let found = find_texel(ray, &cursor, scan);
            let exit = exit_of(ray, cursor);
            goes_on = false;
            met.may_slip = false;
            if found {
                passage = passage_of(ray, cursor, exit, pieces > 0u);
                met = meet_texel(passage);
                map_work.texels += 1u;
                map_work.intervals += met.intervals;
                hit.flag |= met.doubted;
                hit.found = met.first.share <= 1.0;
                goes_on = !exit.ends && !hit.found;
            }
            if goes_on {
                cursor = after(cursor, exit, scan);
            }
            if !goes_on || met.may_slip {
                break;
            }
        }
        if met.may_slip && slips(passage, met.slip.surface) {
            met.first = met.slip;
            hit.found = true;
        }
        if hit.found || (!goes_on && (walk.ended || pieces > 5u)) {
            break;
        }
        if !goes_on {
            pieces += 1u;
            ray = face_ray(next_segment(&walk, f32(layered_map.size)));
            cursor = start_of(ray, scan);
        }
    }
    if hit.found {
        hit.face = passage.face;
        hit.texel = passage.texel;
        hit.layer = met.first.layer;
        hit.surface = met.first.surface;
        hit.flag |= !confirmed(passage, met.first);
        // The ray's own place, kept inside the texel against rounding.
        let end = mix(passage.enter.xy, passage.leave.xy, met.first.share);
        hit.uv = vec2<f32>(passage.texel) + 0.5 + clamp(end, vec2(-0.5), vec2(0.5));
    }
    return hit;
}
