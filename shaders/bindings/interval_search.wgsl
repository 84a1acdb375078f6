// The first surface a ray meets in an interval map: our revision of Patow 1995, sections 2 to 4. Where he takes
// the direction of best angle, this takes the first crossing; where he steps, this walks texels, and over the
// pyramid of bounds skips all those the ray cannot meet anything in.
#define_import_path bindings::interval_search

#import bindings::interval_map::{EMPTY, Patch, SLOTS, height, interval_map, patch_at}
#import bindings::layers::layered_map
#import common::face_ray::{FaceSegment, FaceWalk, face_walk, next_segment}

@group(0) @binding(45) var interval_bounds: texture_2d_array<f32>;
@group(0) @binding(46) var interval_order: texture_2d_array<u32>;
@group(0) @binding(47) var interval_doubt: texture_2d_array<u32>;

// What a search found.
struct MapHit {
    found: bool,
    face: u32,
    texel: vec2<i32>,
    // Of the layered capture.
    layer: u32,
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

// A ray over one texel: from where it enters to where it leaves, relative to the texel's centre.
struct Passage {
    face: u32,
    texel: vec2<i32>,
    enter: vec3<f32>,
    leave: vec3<f32>,
    // Step to the texel it comes from; 0 where it starts here or comes over a seam.
    back: vec2<i32>,
    // It comes over a seam of the cube.
    seam: bool,
    // Step to the texel it goes to; 0 where it ends here or leaves the face.
    forth: vec2<i32>,
}

// Where a ray meets something on its passage over a texel: a share of the passage, above 1 nowhere.
struct Meeting {
    share: f32,
    layer: u32,
    is_sheet: bool,
}

const NOWHERE: Meeting = Meeting(2.0, 0u, false);

// How far an end of a passage is in front of a surface.
fn ahead(surface: Patch, at: vec3<f32>) -> f32 {
    return at.z - height(surface, at.xy);
}

// What is solid lies behind the front and before the back. The ray meets it where the last of both begins to
// hold: at the front, at the back from behind, or where it enters the texel, from the side.
fn meet_solid(front: Patch, back: Patch, layers: vec2<u32>, passage: Passage) -> Meeting {
    let before = vec2(ahead(front, passage.enter), -ahead(back, passage.enter));
    let after = vec2(ahead(front, passage.leave), -ahead(back, passage.leave));
    if any((before > vec2(0.0)) & (after > vec2(0.0))) {
        return NOWHERE;
    }
    let share = before / (before - after);
    let enters = select(vec2(0.0), share, before > vec2(0.0));
    let leaves = select(vec2(1.0), share, after > vec2(0.0));
    let enter = max(enters.x, enters.y);
    if enter > min(leaves.x, leaves.y) {
        return NOWHERE;
    }
    // From the side: the nearer of the two.
    let from_back = select(enters.y > enters.x, before.y > before.x, enter == 0.0);
    return Meeting(enter, select(layers.x, layers.y, from_back), false);
}

// The layer of a column's sheet by its number, the farthest surface after all slots; 255 where there is none.
fn sheet_layer(order: u32, number: u32) -> u32 {
    let layers = (order >> (8u * number)) & 0xffu;
    let in_slot = select(EMPTY, layers & 15u, (layers & 15u) == (layers >> 4u));
    return select(in_slot, interval_map.peeled, number == SLOTS);
}

// Whether a place on the border to a neighbouring texel, relative to both centres, is on the given side of the
// neighbour's part of a sheet. Only where the two parts are one, as in stages/interval_bounds.wgsl.
fn sheet_beyond(passage: Passage, step: vec2<i32>, at: vec3<f32>, surface: Patch, behind: bool) -> bool {
    let place = passage.texel + step;
    let there = at - vec3(vec2<f32>(step), 0.0);
    let order = textureLoad(interval_order, place, passage.face, 0).x;
    for (var number = 0u; number <= SLOTS; number++) {
        let layer = sheet_layer(order, number);
        if layer == EMPTY {
            continue;
        }
        let other = patch_at(passage.face, place, layer);
        let gap = height(other, there.xy) - height(surface, at.xy);
        let joined = other.w > 0.0 && abs(gap) <= 16.0 / f32(layered_map.size) * surface.w;
        if joined && (ahead(other, there) < 0.0) == behind {
            return true;
        }
    }
    return false;
}

// Whether the ray slipped through at the border it enters by, between this sheet and where the texel before
// has it: ahead of one and behind the other.
fn slipped(surface: Patch, passage: Passage) -> bool {
    let here = ahead(surface, passage.enter);
    if passage.seam {
        return here < 0.0 && here > -1.0e-5 * surface.w && ahead(surface, passage.leave) < here;
    }
    if all(passage.back == vec2(0)) {
        return false;
    }
    return sheet_beyond(passage, passage.back, passage.enter, surface, here >= 0.0);
}

// Whether the texel the ray goes to agrees that it has met something. Where it grazes a bent surface, the plane
// of one texel reaches beyond it.
fn confirmed(passage: Passage, first: Meeting) -> bool {
    if all(passage.forth == vec2(0)) {
        return true;
    }
    if first.is_sheet {
        let surface = patch_at(passage.face, passage.texel, first.layer);
        let behind = ahead(surface, passage.leave) < 0.0;
        return sheet_beyond(passage, passage.forth, passage.leave, surface, behind);
    }
    let place = passage.texel + passage.forth;
    let there = passage.leave - vec3(vec2<f32>(passage.forth), 0.0);
    let order = textureLoad(interval_order, place, passage.face, 0).x;
    for (var slot = 0u; slot < SLOTS; slot++) {
        let layers = (order >> (8u * slot)) & 0xffu;
        if layers == EMPTY {
            break;
        }
        let front = patch_at(passage.face, place, layers & 15u);
        let back = patch_at(passage.face, place, layers >> 4u);
        if ahead(front, there) <= 0.0 && ahead(back, there) >= 0.0 {
            return true;
        }
    }
    return false;
}

fn meet_sheet(surface: Patch, layer: u32, passage: Passage, bounds: vec2<f32>) -> Meeting {
    if surface.w <= 0.0 {
        return NOWHERE;
    }
    let before = ahead(surface, passage.enter);
    let after = ahead(surface, passage.leave);
    if (before < 0.0) != (after < 0.0) {
        return Meeting(before / (before - after), layer, true);
    }
    let w = passage.enter.z;
    if w >= bounds.x && w <= bounds.y && slipped(surface, passage) {
        return Meeting(0.0, layer, true);
    }
    return NOWHERE;
}

fn nearer(a: Meeting, b: Meeting) -> Meeting {
    if b.share < a.share {
        return b;
    }
    return a;
}

// What the ray meets first behind one texel.
fn meet_texel(passage: Passage, hit: ptr<function, MapHit>) -> bool {
    map_work.texels += 1u;
    let bounds = textureLoad(interval_bounds, passage.texel, passage.face, 0);
    let order = textureLoad(interval_order, passage.texel, passage.face, 0).x;
    let last = interval_map.peeled;
    var first = meet_sheet(patch_at(passage.face, passage.texel, last), last, passage, bounds.zw);
    for (var slot = 0u; slot < SLOTS; slot++) {
        let layers = (order >> (8u * slot)) & 0xffu;
        if layers == EMPTY {
            break;
        }
        map_work.intervals += 1u;
        let both = vec2(layers & 15u, layers >> 4u);
        let front = patch_at(passage.face, passage.texel, both.x);
        if both.x == both.y {
            first = nearer(first, meet_sheet(front, both.x, passage, bounds.xy));
        } else {
            let back = patch_at(passage.face, passage.texel, both.y);
            first = nearer(first, meet_solid(front, back, both, passage));
        }
    }
    let share = min(first.share, 1.0);
    let end = mix(passage.enter, passage.leave, share);
    let doubt = bitcast<vec2<f32>>(textureLoad(interval_doubt, passage.texel, passage.face, 0).xy);
    let low = min(passage.enter.z, end.z);
    let high = max(passage.enter.z, end.z);
    (*hit).flag |= low <= doubt.y && high >= doubt.x;
    if first.share > 1.0 {
        return false;
    }
    (*hit).found = true;
    (*hit).flag |= !confirmed(passage, first);
    (*hit).face = passage.face;
    (*hit).texel = passage.texel;
    (*hit).layer = first.layer;
    // The ray's own place, kept inside the texel against rounding.
    (*hit).uv = vec2<f32>(passage.texel) + 0.5 + clamp(end.xy, vec2(-0.5), vec2(0.5));
    return true;
}

// Whether the ray, between two values of w, comes near anything in a cell.
fn touches(bounds: vec4<f32>, one: f32, other: f32) -> bool {
    let low = min(one, other);
    let high = max(one, other);
    return (low <= bounds.y && high >= bounds.x) || (low <= bounds.w && high >= bounds.z);
}

// Follow the ray over one face. Cells are whole numbers and the parameters at which the ray crosses their borders
// come from these alone (Amanatides & Woo 1987), never from a position moved on by some small amount. A ray that
// crosses two borders at once crosses the vertical one first; so a cell of any size has one well-defined first
// texel, and the pyramid visits the very texels that a scan meets something in.
fn search_face(segment: FaceSegment, seam: bool, scan: bool, hit: ptr<function, MapHit>) -> bool {
    let size = i32(layered_map.size);
    let begin = segment.begin;
    let way = segment.end - begin;
    let steep = select(way.xy, vec2(1.0e-9), abs(way.xy) < vec2(1.0e-9));
    let inverse = 1.0 / steep;
    let rises = steep > vec2(0.0);
    let forward = select(vec2(-1), vec2(1), rises);
    let down = vec2<i32>(floor(begin.xy));
    let up = vec2<i32>(ceil(begin.xy)) - 1;
    let place = vec2(select(up.x, down.x, rises.x), select(down.y, up.y, rises.y));
    var level = select(min(START_LEVEL, i32(interval_map.levels) - 1), 0, scan);
    var cell = clamp(place, vec2(0), vec2(size - 1)) >> vec2(u32(level));
    var at = 0.0;
    var back = vec2(0);
    // More cells than any ray crosses.
    for (var left = 8 * size; left > 0; left--) {
        let shift = vec2(u32(level));
        let borders = vec2<f32>((cell + select(vec2(0), vec2(1), rises)) << shift);
        let crossings = (borders - begin.xy) * inverse;
        let leave = max(min(min(crossings.x, crossings.y), 1.0), at);
        map_work.visits += 1u;
        var near = scan;
        if !scan {
            let bounds = textureLoad(interval_bounds, cell, segment.face, level);
            near = touches(bounds, begin.z + at * way.z, begin.z + leave * way.z);
        }
        if near && level > 0 {
            level -= 1;
            let middles = vec2<f32>((2 * cell + 1) << vec2(u32(level)));
            let past = (middles - begin.xy) * inverse;
            let crossed = vec2(past.x <= at, past.y < at);
            cell = 2 * cell + select(vec2(0), vec2(1), crossed == rises);
            continue;
        }
        let vertical = crossings.x <= crossings.y;
        let step = select(vec2(0, forward.y), vec2(forward.x, 0), vertical);
        let next = cell + step;
        let stays = all(next >= vec2(0)) && all(next < vec2(size >> u32(level)));
        let ends = leave >= 1.0 || !stays;
        if near {
            let centre = vec3(vec2<f32>(cell) + 0.5, 0.0);
            let enters = begin + at * way - centre;
            let leaves = begin + leave * way - centre;
            let forth = select(step, vec2(0), ends);
            let over_seam = seam && at == 0.0;
            let passage = Passage(segment.face, cell, enters, leaves, back, over_seam, forth);
            if meet_texel(passage, hit) {
                return true;
            }
        }
        if ends {
            return false;
        }
        at = leave;
        let parent = cell >> vec2(1u);
        cell = next;
        back = -step;
        if !scan && level + 1 < i32(interval_map.levels) && any((cell >> vec2(1u)) != parent) {
            cell = cell >> vec2(1u);
            level += 1;
        }
    }
    return false;
}

// Level of the pyramid a search starts at.
const START_LEVEL: i32 = 4;

// The first surface from a point, relative to the map's centre, in a direction. `scan` looks at every texel on
// the way instead of using the pyramid: slow, and the same.
fn search_map(w: vec3<f32>, direction: vec3<f32>, scan: bool) -> MapHit {
    var hit: MapHit;
    var walk = face_walk(w, direction);
    for (var piece = 0u; piece < 6u && !walk.ended; piece++) {
        let segment = next_segment(&walk, f32(layered_map.size));
        if search_face(segment, piece > 0u, scan, &hit) {
            break;
        }
    }
    return hit;
}
