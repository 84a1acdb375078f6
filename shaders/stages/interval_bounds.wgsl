// Bounds of what lies behind each texel, and all that a search wants to know of it, in one place.
//
// Across each border of a texel every surface should go on. Two surfaces do where their planes meet between the
// two texels' centres: on a smooth surface tangents do, at a corner the two faces do. A surface that does not go
// on ends somewhere between the two centres, and neither sample says where.
#import bindings::interval_map::{
    BACK, HALF_LEAST, HALF_MOST, HALF_ROOM, LAYER_BITS, Patch, SLOTS, halves_around, height, in_fours, interval_map,
    joint, patch_at, patch_of, place_in_pyramid,
}
#import bindings::layers::{layer_surface, layered_map}
#import common::cube::{cube_direction, cube_texel}
#import common::face_ray::on_face

@group(0) @binding(0) var interval_order: texture_2d_array<u32>;
// Intervals' lowest and highest w, the farthest surface's; the lowest above the highest where there is none.
@group(0) @binding(1) var interval_bounds: texture_storage_2d_array<rg32uint, write>;
// See `write_texel`.
@group(0) @binding(2) var interval_texels: texture_storage_2d_array<rgba32uint, write>;

const NOTHING: vec2<f32> = vec2(3.0e38, -3.0e38);

const FRONT: u32 = 0u;
const REAR: u32 = 1u;
const SHEET: u32 = 2u;
const ABSENT: u32 = 3u;

// All surfaces kept behind a texel.
struct Column {
    face: u32,
    place: vec2<i32>,
    order: u32,
}

struct Listed {
    surface: Patch,
    role: u32,
}

fn column_at(face: u32, place: vec2<i32>) -> Column {
    return Column(face, place, textureLoad(interval_order, place, face, 0).x);
}

// How many numbers a column's surfaces have: two a slot in use, and the farthest.
fn numbers(column: Column) -> u32 {
    return 2u * (SLOTS - countLeadingZeros(~column.order) / 8u) + 1u;
}

// Layers of a slot's front and back.
fn layers_of(order: u32, slot: u32) -> vec2<u32> {
    let layers = order >> (8u * slot);
    return vec2(layers, layers >> 4u) & vec2(15u);
}

fn is_farthest(column: Column, number: u32) -> bool {
    return number + 1u == numbers(column);
}

fn listed(column: Column, number: u32) -> Listed {
    var layer = interval_map.peeled;
    var role = SHEET;
    if !is_farthest(column, number) {
        let layers = layers_of(column.order, number / 2u);
        let front = layers.x;
        let back = layers.y;
        let second = (number & 1u) == 1u;
        if second && front == back {
            return Listed(Patch(0.0, vec2(0.0)), ABSENT);
        }
        layer = select(front, back, second);
        role = select(select(FRONT, REAR, second), SHEET, front == back);
    }
    let surface = patch_at(column.face, column.place, layer);
    return Listed(surface, select(ABSENT, role, surface.w > 0.0));
}

// The surface's w at a place given in texels of a face next to it, or of its own.
fn height_at(column: Column, surface: Patch, face: u32, uv: vec2<f32>) -> f32 {
    let centre = vec2<f32>(column.place) + 0.5;
    if column.face == face {
        return height(surface, uv - centre);
    }
    let size = f32(layered_map.size);
    let p = on_face(column.face, cube_direction(face, uv / size));
    return p.z * height(surface, 0.5 * size * (p.xy / p.z + 1.0) - centre);
}

// The texel across a border, on the next face where the cube ends.
fn column_beyond(face: u32, centre: vec2<f32>) -> Column {
    let size = f32(layered_map.size);
    if all(centre > vec2(0.0)) && all(centre < vec2(size)) {
        return column_at(face, vec2<i32>(centre));
    }
    let next = cube_texel(cube_direction(face, centre / size));
    return column_at(next.face, vec2<i32>(min(next.uv * size, vec2(size - 1.0))));
}

// Whether two surfaces that differ by so much at the two centres are one that goes on. Planes that meet a little
// beyond a centre are let pass: meshes bend between texels too. A surface too steep for a `joint` is not: it ends.
fn goes_on(here: f32, there: f32, w: f32) -> bool {
    let most = max(abs(here), abs(there));
    let least = min(abs(here), abs(there));
    let bend = here * there <= 0.0 || 3.0 * least <= most || most <= 1.0e-4 * w;
    return bend && most <= joint(w);
}

fn hull(range: vec2<f32>, w: f32) -> vec2<f32> {
    return vec2(min(range.x, w), max(range.y, w));
}

// Lowest and highest w found so far.
struct Bounds {
    near: vec2<f32>,
    far: vec2<f32>,
    doubt: vec2<f32>,
    // The most by which a sheet differs from its part in a neighbouring texel.
    gap: f32,
}

// Of a search's heights of a surface over a texel.
fn rounding(surface: Patch) -> f32 {
    return 1.0e-5 * (surface.w + abs(surface.gradient.x) + abs(surface.gradient.y));
}

// What one border adds to a texel's bounds.
fn across(bounds: Bounds, own: Column, side: u32) -> Bounds {
    var out = bounds;
    let centre = vec2<f32>(own.place) + 0.5;
    let sign = select(-1.0, 1.0, (side & 1u) == 1u);
    let step = select(vec2(sign, 0.0), vec2(0.0, sign), side >= 2u);
    let beyond = centre + step;
    let border = centre + 0.5 * step;
    let other = column_beyond(own.face, beyond);
    // Of the other's surfaces those that go on.
    var matched = 0u;
    for (var i = 0u; i < numbers(own); i++) {
        let mine = listed(own, i);
        if mine.role == ABSENT {
            continue;
        }
        let w = mine.surface.w;
        let w_beyond = height(mine.surface, step);
        var goes = false;
        for (var j = 0u; j < numbers(other); j++) {
            let theirs = listed(other, j);
            if theirs.role != mine.role {
                continue;
            }
            if mine.role == SHEET {
                // Where a ray may slip through between the two; see bindings/interval_texel.wgsl.
                let along = 0.5 * step.yx;
                let one = height_at(other, theirs.surface, own.face, border + along);
                let two = height_at(other, theirs.surface, own.face, border - along);
                let gap_one = one - height(mine.surface, 0.5 * step + along);
                let gap_two = two - height(mine.surface, 0.5 * step - along);
                let gap = select(min(abs(gap_one), abs(gap_two)), 0.0, gap_one * gap_two < 0.0);
                if gap <= joint(w) {
                    out.gap = max(out.gap, min(max(abs(gap_one), abs(gap_two)), joint(w)) + rounding(mine.surface));
                    let both = hull(hull(NOTHING, one), two);
                    if is_farthest(own, i) {
                        out.far = hull(hull(out.far, both.x), both.y);
                    } else {
                        out.near = hull(hull(out.near, both.x), both.y);
                    }
                }
            }
            let differs_here = w - height_at(other, theirs.surface, own.face, centre);
            let differs_there = w_beyond - height_at(other, theirs.surface, own.face, beyond);
            if goes_on(differs_here, differs_there, w) {
                goes = true;
                matched |= 1u << j;
            }
        }
#ifdef EDGES
        if !goes {
            out.doubt = hull(hull(out.doubt, w), height(mine.surface, 0.5 * step));
        }
#endif
    }
#ifdef EDGES
    for (var j = 0u; j < numbers(other); j++) {
        let theirs = listed(other, j);
        if theirs.role != ABSENT && (matched & (1u << j)) == 0u {
            let w = height_at(other, theirs.surface, own.face, beyond);
            let w_border = height_at(other, theirs.surface, own.face, border);
            out.doubt = hull(hull(out.doubt, w), w_border);
        }
    }
#endif
    return out;
}

#ifdef EDGES
// Two things that reach into each other are one interval, and where their surfaces cross inside a texel the other's
// may be the interval's. `doubt` with what an interval's front and back span where that is so.
fn with_crossings(doubt: vec2<f32>, own: Column) -> vec2<f32> {
    var out = doubt;
    for (var slot = 0u; slot < numbers(own) / 2u; slot++) {
        let layers = layers_of(own.order, slot);
        for (var inner = layers.x + 1u; inner < layers.y; inner++) {
            let words = textureLoad(layer_surface, own.place, 6u * inner + own.face, 0).xy;
            let surface = patch_of(words);
            let outer = patch_at(own.face, own.place, select(layers.x, layers.y, (words.y & BACK) != 0u));
            let differ = outer.gradient - surface.gradient;
            let reach = 0.5 * (abs(outer.gradient.x) + abs(outer.gradient.y));
            if surface.w > 0.0 && abs(outer.w - surface.w) <= 0.5 * (abs(differ.x) + abs(differ.y)) {
                out = hull(hull(out, outer.w - reach), outer.w + reach);
            }
        }
    }
    return out;
}
#endif

// What the texel's own surfaces span.
fn within(own: Column) -> Bounds {
    var out = Bounds(NOTHING, NOTHING, NOTHING, 0.0);
    for (var i = 0u; i < numbers(own); i++) {
        let mine = listed(own, i);
        if mine.role == ABSENT {
            continue;
        }
        let reach = 0.5 * (abs(mine.surface.gradient.x) + abs(mine.surface.gradient.y));
        let low = mine.surface.w - reach;
        let high = mine.surface.w + reach;
        if is_farthest(own, i) {
            out.far = hull(hull(out.far, low), high);
        } else {
            out.near = hull(hull(out.near, low), high);
        }
    }
    return out;
}

// A surface as the capture holds it, with its layer in the last bits of w.
fn patch_words(column: Column, layer: u32) -> vec2<u32> {
    let words = textureLoad(layer_surface, column.place, 6u * layer + column.face, 0).xy;
    return vec2((words.x & ~LAYER_BITS) | layer, words.y);
}

// See bindings/interval_texel.wgsl.
fn write_texel(own: Column, bounds: Bounds) {
    let slots = numbers(own) / 2u;
    let gap = min((1.0 + HALF_ROOM) * bounds.gap + HALF_LEAST, HALF_MOST);
    let farthest = textureLoad(layer_surface, own.place, 6u * interval_map.peeled + own.face, 0).xy;
    let rest = vec2(halves_around(bounds.doubt), pack2x16float(vec2(gap, 0.0)) | (slots << 16u));
    textureStore(interval_texels, in_fours(own.place), own.face, vec4(farthest, rest));
    for (var slot = 0u; slot < slots; slot++) {
        let layers = layers_of(own.order, slot);
        let words = vec4(patch_words(own, layers.x), patch_words(own, layers.y));
        textureStore(interval_texels, in_fours(own.place), 6u * (slot + 1u) + own.face, words);
    }
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = layered_map.size;
    if id.x >= size || id.y >= 6u * size {
        return;
    }
    let face = id.y / size;
    let place = vec2<i32>(vec2(id.x, id.y % size));
    let own = column_at(face, place);
    var bounds = within(own);
    let unstored = bitcast<f32>(textureLoad(interval_order, place, face, 0).y);
    if unstored > 0.0 {
        bounds.doubt = hull(vec2(unstored), patch_at(face, place, interval_map.peeled).w);
    }
    for (var side = 0u; side < 4u; side++) {
        bounds = across(bounds, own, side);
    }
#ifdef EDGES
    bounds.doubt = with_crossings(bounds.doubt, own);
#endif
    write_texel(own, bounds);
    // A ray that meets what is doubtful has to be told, so it is part of the bounds.
    let doubtful = unpack2x16float(halves_around(bounds.doubt));
    let near = vec2(min(bounds.near.x, doubtful.x), max(bounds.near.y, doubtful.y));
    // Half floats leave room for the rounding of the search.
    let words = vec4(halves_around(near), halves_around(bounds.far), 0u, 0u);
    textureStore(interval_bounds, place_in_pyramid(place, 0u), face, words);
}
