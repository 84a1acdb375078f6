// The first surface a ray meets in an interval map: our revision of Patow 1995, sections 2 to 4. Where he takes
// the direction of best angle, this takes the first crossing; where he steps, this walks texels, and over the
// pyramid of bounds skips all those the ray cannot meet anything in.
#define_import_path bindings::interval_search

#import bindings::interval_map::{Patch, SLOTS, height, interval_map, joint, patch_at}
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
    // Step to the texel it goes to; 0 where it ends here or leaves the face.
    forth: vec2<i32>,
    // It comes over a seam of the cube.
    seam: bool,
}

// Where a ray meets something on its passage over a texel: a share of the passage, above 1 nowhere.
struct Meeting {
    share: f32,
    layer: u32,
    is_sheet: bool,
    // At the back of what is solid.
    from_back: bool,
}

const NOWHERE: Meeting = Meeting(2.0, 0u, false, false);

fn nearer(a: Meeting, b: Meeting) -> Meeting {
    if b.share < a.share {
        return b;
    }
    return a;
}

// How far an end of a passage is in front of a surface.
fn ahead(surface: Patch, at: vec3<f32>) -> f32 {
    return at.z - height(surface, at.xy);
}

fn order_at(face: u32, texel: vec2<i32>) -> u32 {
    return textureLoad(interval_order, texel, face, 0).x;
}

fn slots_of(order: u32) -> u32 {
    return SLOTS - countLeadingZeros(~order) / 8u;
}

// Layers of a slot's front and back.
fn layers_of(order: u32, slot: u32) -> vec2<u32> {
    let layers = order >> (8u * slot);
    return vec2(layers & 15u, (layers >> 4u) & 15u);
}

// What is solid lies behind the front and before the back. The ray meets it where the last of both begins to
// hold: at the front, at the back from behind, or where it enters the texel, from the side.
fn meet_solid(front: Patch, back: Patch, layers: vec2<u32>, passage: Passage) -> Meeting {
    let before = vec2(ahead(front, passage.enter), -ahead(back, passage.enter));
    let after = vec2(ahead(front, passage.leave), -ahead(back, passage.leave));
    let share = before / (before - after);
    let enters = select(vec2(0.0), share, before > vec2(0.0));
    let leaves = select(vec2(1.0), share, after > vec2(0.0));
    let enter = max(enters.x, enters.y);
    let outside = any((before > vec2(0.0)) & (after > vec2(0.0)));
    if outside || enter > min(leaves.x, leaves.y) {
        return NOWHERE;
    }
    // From the side: the nearer of the two.
    let from_back = select(enters.y > enters.x, before.y > before.x, enter == 0.0);
    return Meeting(enter, select(layers.x, layers.y, from_back), false, from_back);
}

fn meet_sheet(surface: Patch, layer: u32, passage: Passage) -> Meeting {
    let before = ahead(surface, passage.enter);
    let after = ahead(surface, passage.leave);
    let crosses = surface.w > 0.0 && (before < 0.0) != (after < 0.0);
    return Meeting(select(2.0, before / (before - after), crosses), layer, true, false);
}

// Whether a place on the border to a neighbouring texel, relative to this one's centre, is on the given side of
// the neighbour's part of a sheet. Only where the two parts are one, as in stages/interval_bounds.wgsl.
fn sheet_beyond(passage: Passage, step: vec2<i32>, at: vec3<f32>, surface: Patch, behind: bool) -> bool {
    let place = passage.texel + step;
    let there = at - vec3(vec2<f32>(step), 0.0);
    let order = order_at(passage.face, place);
    let slots = slots_of(order);
    var is_so = false;
    for (var number = 0u; number <= slots; number++) {
        let both = layers_of(order, number);
        let layer = select(both.x, interval_map.peeled, number == slots);
        let other = patch_at(passage.face, place, layer);
        let gap = height(other, there.xy) - height(surface, at.xy);
        let joined = other.w > 0.0 && abs(gap) <= joint(surface.w);
        let is_sheet = number == slots || both.x == both.y;
        is_so |= is_sheet && joined && (ahead(other, there) < 0.0) == behind;
    }
    return is_so;
}

// How far a place between two texels' centres is in front of the chord of their parts of one surface. What bulges
// lies between the chord and both planes, whatever its facets are.
fn ahead_of_chord(here: Patch, there: Patch, at: vec3<f32>, step: vec2<f32>) -> f32 {
    let share = dot(at.xy, step);
    let along = at.xy - share * step;
    return at.z - mix(height(here, along), height(there, along), share);
}

// Whether a neighbouring texel has the ray inside, or behind, what it met, where it leaves this one.
fn agrees(passage: Passage, step: vec2<i32>, first: Meeting) -> bool {
    let place = passage.texel + step;
    if any(place < vec2(0)) || any(place >= vec2(i32(layered_map.size))) {
        return true;
    }
    let surface = patch_at(passage.face, passage.texel, first.layer);
    if first.is_sheet {
        return sheet_beyond(passage, step, passage.leave, surface, ahead(surface, passage.leave) < 0.0);
    }
    let away = vec2<f32>(step);
    let there = passage.leave - vec3(away, 0.0);
    // Gradients are half floats.
    let rounding = 1.0e-5 * surface.w + 1.0e-3 * dot(abs(surface.gradient), vec2(1.0));
    let order = order_at(passage.face, place);
    var inside = false;
    for (var slot = 0u; slot < slots_of(order); slot++) {
        let both = layers_of(order, slot);
        let front = patch_at(passage.face, place, both.x);
        let back = patch_at(passage.face, place, both.y);
        if first.from_back {
            let past = ahead_of_chord(surface, back, passage.leave, away);
            inside |= past >= -rounding && ahead(front, there) <= 0.0;
        } else {
            let past = ahead_of_chord(surface, front, passage.leave, away);
            inside |= past <= rounding && ahead(back, there) >= 0.0;
        }
    }
    return inside;
}

// Whether the texel the ray goes to, and the nearest beside its way, agree that it has met something. Where it
// grazes a bent surface, the plane of one texel reaches beyond it.
fn confirmed(passage: Passage, first: Meeting) -> bool {
    let sideways = select(vec2(-1), vec2(1), passage.leave.xy > vec2(0.0));
    let beside = select(vec2(0, sideways.y), vec2(sideways.x, 0), passage.forth.x == 0);
    let goes_on = all(passage.forth == vec2(0)) || agrees(passage, passage.forth, first);
    return goes_on && agrees(passage, beside, first);
}

// What the ray meets first behind one texel.
fn meet_texel(passage: Passage) -> Meeting {
    let order = order_at(passage.face, passage.texel);
    let slots = slots_of(order);
    // A sheet the ray has not crossed but may have slipped through, at the border it enters by, between this
    // texel's part of it and the part of the texel before.
    var narrow = 3.0e38;
    var skipped = Patch(0.0, vec2(0.0));
    var skipped_layer = 0u;
    var first = NOWHERE;
    for (var number = 0u; number <= slots; number++) {
        let is_far = number == slots;
        var both = layers_of(order, number);
        both = select(both, vec2(interval_map.peeled), is_far);
        let front = patch_at(passage.face, passage.texel, both.x);
        let back = patch_at(passage.face, passage.texel, both.y);
        let is_sheet = both.x == both.y;
        let sheet = meet_sheet(front, both.x, passage);
        let solid = meet_solid(front, back, both, passage);
        let miss = abs(ahead(front, passage.enter));
        if is_sheet && front.w > 0.0 && sheet.share > 1.0 && miss < narrow {
            narrow = miss;
            skipped = front;
            skipped_layer = both.x;
        }
        if is_sheet {
            first = nearer(first, sheet);
        } else {
            first = nearer(first, solid);
        }
    }
    map_work.texels += 1u;
    map_work.intervals += slots;
    let here = ahead(skipped, passage.enter);
    let inside = narrow <= joint(skipped.w);
    if inside && any(passage.back != vec2(0)) {
        if sheet_beyond(passage, passage.back, passage.enter, skipped, here >= 0.0) {
            return Meeting(0.0, skipped_layer, true, false);
        }
    }
    let departs = ahead(skipped, passage.leave) < here;
    if passage.seam && here < 0.0 && narrow < 1.0e-5 * skipped.w && departs {
        return Meeting(0.0, skipped_layer, true, false);
    }
    return first;
}

// Whether the ray, between two values of w, comes near anything in a cell.
fn touches(bounds: vec4<f32>, one: f32, other: f32) -> bool {
    let low = min(one, other);
    let high = max(one, other);
    return (low <= bounds.y && high >= bounds.x) || (low <= bounds.w && high >= bounds.z);
}

// Where a search has come to on one face.
struct Cursor {
    face: u32,
    // The ray over the face.
    begin: vec3<f32>,
    way: vec3<f32>,
    inverse: vec2<f32>,
    rises: vec2<bool>,
    // How far along it, 0 to 1.
    at: f32,
    leave: f32,
    level: i32,
    // A cell of that level of the pyramid.
    cell: vec2<i32>,
    back: vec2<i32>,
    next: vec2<i32>,
    // Nothing is left of the ray on this face after the cell.
    ends: bool,
}

// A search starts on each face at the level of the pyramid that has eight cells a side, or fewer.
const LEVELS_LEFT_OUT: i32 = 4;

fn enter_face(segment: FaceSegment, scan: bool) -> Cursor {
    let size = i32(layered_map.size);
    var cursor: Cursor;
    cursor.face = segment.face;
    cursor.begin = segment.begin;
    cursor.way = segment.end - segment.begin;
    let way = cursor.way.xy;
    let steep = select(way, vec2(1.0e-9), abs(way) < vec2(1.0e-9));
    cursor.inverse = 1.0 / steep;
    cursor.rises = steep > vec2(0.0);
    // On a border the ray counts as past it where it is vertical, see `enter_cell`.
    let down = vec2<i32>(floor(cursor.begin.xy));
    let up = vec2<i32>(ceil(cursor.begin.xy)) - 1;
    let place = vec2(select(up.x, down.x, cursor.rises.x), select(down.y, up.y, cursor.rises.y));
    cursor.level = select(max(i32(interval_map.levels) - LEVELS_LEFT_OUT, 0), 0, scan);
    cursor.cell = clamp(place, vec2(0), vec2(size - 1)) >> vec2(u32(cursor.level));
    return cursor;
}

// Where the ray leaves the cell, and what comes then. Cells are whole numbers and the parameters at which the ray
// crosses their borders come from these alone (Amanatides & Woo 1987), never from a position moved on by some
// small amount.
fn look_ahead(cursor: ptr<function, Cursor>) {
    let shift = u32((*cursor).level);
    let rises = (*cursor).rises;
    let borders = vec2<f32>(((*cursor).cell + select(vec2(0), vec2(1), rises)) << vec2(shift));
    let crossings = (borders - (*cursor).begin.xy) * (*cursor).inverse;
    (*cursor).leave = max(min(min(crossings.x, crossings.y), 1.0), (*cursor).at);
    let forward = select(vec2(-1), vec2(1), rises);
    let step = select(vec2(0, forward.y), vec2(forward.x, 0), crossings.x <= crossings.y);
    (*cursor).next = (*cursor).cell + step;
    let size = vec2(i32(layered_map.size >> shift));
    let stays = all((*cursor).next >= vec2(0)) && all((*cursor).next < size);
    (*cursor).ends = (*cursor).leave >= 1.0 || !stays;
}

// To the first of the cell's four that the ray is in. A ray that crosses two borders at once crosses the vertical
// one first, so a cell of any size has one well-defined first texel, the same for every search.
fn enter_cell(cursor: ptr<function, Cursor>) {
    (*cursor).level -= 1;
    let middles = vec2<f32>((2 * (*cursor).cell + 1) << vec2(u32((*cursor).level)));
    let past = (middles - (*cursor).begin.xy) * (*cursor).inverse;
    let crossed = vec2(past.x <= (*cursor).at, past.y < (*cursor).at);
    (*cursor).cell = 2 * (*cursor).cell + select(vec2(0), vec2(1), crossed == (*cursor).rises);
}

// To the cell after, and one level up where that begins a new larger cell.
fn step_on(cursor: ptr<function, Cursor>, scan: bool) {
    let old = (*cursor).cell;
    let next = (*cursor).next;
    (*cursor).at = (*cursor).leave;
    (*cursor).back = old - next;
    let rises = !scan && (*cursor).level + 1 < i32(interval_map.levels)
        && any((next >> vec2(1u)) != (old >> vec2(1u)));
    (*cursor).cell = select(next, next >> vec2(1u), rises);
    (*cursor).level += select(0, 1, rises);
}

fn w_at(cursor: Cursor, at: f32) -> f32 {
    return cursor.begin.z + at * cursor.way.z;
}

// To the next texel that may hold something the ray meets; false where the face has none.
fn find_texel(cursor: ptr<function, Cursor>, scan: bool) -> bool {
    var found = false;
    // More cells than any ray crosses.
    for (var left = 8u * layered_map.size; left > 0u; left--) {
        look_ahead(cursor);
        map_work.visits += 1u;
        var near = scan;
        if !scan {
            let bounds = textureLoad(interval_bounds, (*cursor).cell, (*cursor).face, (*cursor).level);
            near = touches(bounds, w_at(*cursor, (*cursor).at), w_at(*cursor, (*cursor).leave));
        }
        found = near && (*cursor).level == 0;
        if found || (!near && (*cursor).ends) {
            break;
        }
        if near {
            enter_cell(cursor);
        } else {
            step_on(cursor, scan);
        }
    }
    return found;
}

fn passage_of(cursor: Cursor, seam: bool) -> Passage {
    let centre = vec3(vec2<f32>(cursor.cell) + 0.5, 0.0);
    let enter = cursor.begin + cursor.at * cursor.way - centre;
    let leave = cursor.begin + cursor.leave * cursor.way - centre;
    let forth = select(cursor.next - cursor.cell, vec2(0), cursor.ends);
    // Steps between larger cells are steps between texels too.
    return Passage(cursor.face, cursor.cell, enter, leave, cursor.back, forth, seam && cursor.at == 0.0);
}

// The first surface from a point, relative to the map's centre, in a direction. `scan` looks at every texel on
// the way instead of using the pyramid: slow, and the same.
fn search_map(w: vec3<f32>, direction: vec3<f32>, scan: bool) -> MapHit {
    var hit: MapHit;
    var walk = face_walk(w, direction);
    var cursor = enter_face(next_segment(&walk, f32(layered_map.size)), scan);
    var first = NOWHERE;
    var passage: Passage;
    var pieces = 0u;
    // Processors run the lanes of a group in step: the steps from cell to cell, of which there are many, are a
    // loop of their own, without the rest.
    loop {
        let found = find_texel(&cursor, scan);
        if found {
            passage = passage_of(cursor, pieces > 0u);
            first = meet_texel(passage);
            let end = mix(passage.enter.z, passage.leave.z, min(first.share, 1.0));
            let doubt = bitcast<vec2<f32>>(textureLoad(interval_doubt, passage.texel, passage.face, 0).xy);
            hit.flag |= min(passage.enter.z, end) <= doubt.y && max(passage.enter.z, end) >= doubt.x;
            hit.found = first.share <= 1.0;
        }
        if hit.found {
            break;
        }
        if found && !cursor.ends {
            step_on(&cursor, scan);
            continue;
        }
        pieces += 1u;
        if walk.ended || pieces > 6u {
            break;
        }
        cursor = enter_face(next_segment(&walk, f32(layered_map.size)), scan);
    }
    if hit.found {
        hit.flag |= !confirmed(passage, first);
        hit.face = passage.face;
        hit.texel = passage.texel;
        hit.layer = first.layer;
        // The ray's own place, kept inside the texel against rounding.
        let end = mix(passage.enter.xy, passage.leave.xy, first.share);
        hit.uv = vec2<f32>(passage.texel) + 0.5 + clamp(end, vec2(-0.5), vec2(0.5));
    }
    return hit;
}
