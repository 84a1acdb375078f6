// What a ray meets behind one texel of an interval map, and whether the texels beside it agree. Some drivers run
// both sides of every branch (lavapipe's, Mesa 22): what is long and seldom needed is left to the caller's outer loops.
#define_import_path bindings::interval_texel

#import bindings::interval_map::{LAYER_BITS, Patch, height, in_fours, interval_map, joint, patch_of}
#import bindings::layers::layered_map

// Four words a texel, see `in_fours`: in layer `face` what is in `Column`, in layer 6 * (slot + 1) + face what is in
// `Slot`.
@group(0) @binding(46) var interval_texels: texture_2d_array<u32>;

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
    surface: Patch,
    // Of the layered capture.
    layer: u32,
    is_sheet: bool,
    // At the back of what is solid.
    from_back: bool,
}

const NOWHERE: Meeting = Meeting(2.0, Patch(0.0, vec2(0.0)), 0u, false, false);

// What is behind a texel but for its intervals.
struct Column {
    farthest: Patch,
    // Lowest and highest w of what is doubtful.
    doubt: vec2<f32>,
    // The most by which a sheet differs, where it goes on in a neighbouring texel, from its part there.
    gap: f32,
    slots: u32,
}

fn column_at(face: u32, texel: vec2<i32>) -> Column {
    let words = textureLoad(interval_texels, in_fours(texel), face, 0);
    return Column(patch_of(words.xy), unpack2x16float(words.z), unpack2x16float(words.w).x, words.w >> 16u);
}

// An interval; both surfaces are one where it is a sheet.
struct Slot {
    front: Patch,
    back: Patch,
    // Layers of the capture that hold them.
    layers: vec2<u32>,
    is_sheet: bool,
}

// The slot of a texel that has so many. Where it has not this one, the words are those of a texel that is at hand.
fn slot_at(face: u32, texel: vec2<i32>, slot: u32, slots: u32) -> Slot {
    let has = slot < slots;
    let place = select(vec2(0), in_fours(texel), has);
    let words = textureLoad(interval_texels, place, select(6u, 6u * (slot + 1u) + face, has), 0);
    let layers = words.xz & vec2(LAYER_BITS);
    return Slot(patch_of(words.xy), patch_of(words.zw), layers, layers.x == layers.y);
}

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

// What is solid lies behind the front and before the back. The ray meets it where the last of both begins to
// hold: at the front, at the back from behind, or where it enters the texel, from the side.
fn meet_solid(solid: Slot, passage: Passage) -> Meeting {
    let before = vec2(ahead(solid.front, passage.enter), -ahead(solid.back, passage.enter));
    let after = vec2(ahead(solid.front, passage.leave), -ahead(solid.back, passage.leave));
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
    let surface = Patch(
        select(solid.front.w, solid.back.w, from_back),
        select(solid.front.gradient, solid.back.gradient, from_back),
    );
    let layer = select(solid.layers.x, solid.layers.y, from_back);
    return Meeting(enter, surface, layer, false, from_back);
}

fn meet_sheet(surface: Patch, layer: u32, passage: Passage) -> Meeting {
    let before = ahead(surface, passage.enter);
    let after = ahead(surface, passage.leave);
    let crosses = surface.w > 0.0 && (before < 0.0) != (after < 0.0);
    return Meeting(select(2.0, before / (before - after), crosses), surface, layer, true, false);
}

// What a texel holds for a ray.
struct Met {
    first: Meeting,
    // Of the sheets that the ray has not crossed, the one it passes nearest to where it enters: it may have slipped
    // through there, between this texel's part of it and the part of the texel before. As if it were met there.
    slip: Meeting,
    // So near that `slips` has to tell.
    may_slip: bool,
    // The ray passed something doubtful.
    doubted: bool,
    intervals: u32,
}

// The nearer of a slip and a sheet's, as above.
fn narrower(slip: Meeting, sheet: Meeting, at: vec3<f32>) -> Meeting {
    let crossed = sheet.share <= 1.0 || sheet.surface.w <= 0.0;
    if crossed || abs(ahead(sheet.surface, at)) >= abs(ahead(slip.surface, at)) {
        return slip;
    }
    return Meeting(0.0, sheet.surface, sheet.layer, true, false);
}

const FAR_FROM_ALL: Patch = Patch(-3.0e38, vec2(0.0));

// What the ray meets first behind one texel.
fn meet_texel(passage: Passage) -> Met {
    let own = column_at(passage.face, passage.texel);
    var first = meet_sheet(own.farthest, interval_map.peeled, passage);
    var slip = narrower(Meeting(0.0, FAR_FROM_ALL, 0u, true, false), first, passage.enter);
    for (var slot = 0u; slot < own.slots; slot++) {
        let both = slot_at(passage.face, passage.texel, slot, own.slots);
        if both.is_sheet {
            let sheet = meet_sheet(both.front, both.layers.x, passage);
            first = nearer(first, sheet);
            slip = narrower(slip, sheet, passage.enter);
        } else {
            first = nearer(first, meet_solid(both, passage));
        }
    }
    let here = ahead(slip.surface, passage.enter);
    let departs = ahead(slip.surface, passage.leave) < here;
    if passage.seam && here < 0.0 && -here < 1.0e-5 * slip.surface.w && departs {
        first = slip;
    }
    let end = mix(passage.enter.z, passage.leave.z, min(first.share, 1.0));
    let doubted = min(passage.enter.z, end) <= own.doubt.y && max(passage.enter.z, end) >= own.doubt.x;
    let may_slip = abs(here) <= own.gap && any(passage.back != vec2(0));
    return Met(first, slip, may_slip, doubted, own.slots);
}

// Whether another part of a sheet goes on from this one at a place, relative to the other's texel, and has that
// place behind it, or not. Only where the two parts are one, as in stages/interval_bounds.wgsl.
fn sheet_goes_on(other: Patch, there: vec3<f32>, surface: Patch, at: vec3<f32>, behind: bool) -> bool {
    let gap = height(other, there.xy) - height(surface, at.xy);
    return other.w > 0.0 && abs(gap) <= joint(surface.w) && (ahead(other, there) < 0.0) == behind;
}

// Whether the ray slipped through a sheet: is behind it in the texel before and not here, or the reverse.
fn slips(passage: Passage, surface: Patch) -> bool {
    let at = passage.enter;
    let behind = ahead(surface, at) >= 0.0;
    let place = passage.texel + passage.back;
    let there = at - vec3(vec2<f32>(passage.back), 0.0);
    let before = column_at(passage.face, place);
    var is_so = sheet_goes_on(before.farthest, there, surface, at, behind);
    for (var slot = 0u; slot < before.slots; slot++) {
        let both = slot_at(passage.face, place, slot, before.slots);
        is_so |= both.is_sheet && sheet_goes_on(both.front, there, surface, at, behind);
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

// Whether a neighbouring texel has the ray inside, or behind, the surface it met, where it leaves this one.
fn agrees(passage: Passage, step: vec2<i32>, first: Meeting) -> bool {
    let place = passage.texel + step;
    if any(place < vec2(0)) || any(place >= vec2(i32(layered_map.size))) {
        return true;
    }
    let surface = first.surface;
    let away = vec2<f32>(step);
    let at = passage.leave;
    let there = at - vec3(away, 0.0);
    let behind = ahead(surface, at) < 0.0;
    // Gradients are half floats.
    let rounding = 1.0e-5 * surface.w + 1.0e-3 * dot(abs(surface.gradient), vec2(1.0));
    let beside = column_at(passage.face, place);
    var is_so = first.is_sheet && sheet_goes_on(beside.farthest, there, surface, at, behind);
    for (var slot = 0u; slot < beside.slots; slot++) {
        let both = slot_at(passage.face, place, slot, beside.slots);
        let goes_on = both.is_sheet && sheet_goes_on(both.front, there, surface, at, behind);
        let past_front = ahead_of_chord(surface, both.front, at, away) <= rounding;
        let past_back = ahead_of_chord(surface, both.back, at, away) >= -rounding;
        let inside = select(
            past_front && ahead(both.back, there) >= 0.0,
            past_back && ahead(both.front, there) <= 0.0,
            first.from_back,
        );
        is_so |= select(inside, goes_on, first.is_sheet);
    }
    return is_so;
}

// Whether the texel the ray goes to, and the nearest beside its way, agree that it has met something. Where it
// grazes a bent surface, the plane of one texel reaches beyond it.
fn confirmed(passage: Passage, first: Meeting) -> bool {
    let sideways = select(vec2(-1), vec2(1), passage.leave.xy > vec2(0.0));
    let beside = select(vec2(0, sideways.y), vec2(sideways.x, 0), passage.forth.x == 0);
    let goes_on = all(passage.forth == vec2(0)) || agrees(passage, passage.forth, first);
    return goes_on && agrees(passage, beside, first);
}
