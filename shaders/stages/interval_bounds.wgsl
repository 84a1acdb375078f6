// Bounds of what lies behind each texel, and of what is doubtful there.
//
// Across each border of a texel every surface should go on. Two surfaces do where their planes meet between the
// two texels' centres: on a smooth surface tangents do, at a corner the two faces do. A surface that does not go
// on ends somewhere between the two centres, and neither sample says where.
#import bindings::interval_map::{EMPTY, Patch, SLOTS, height, interval_map, patch_at}
#import bindings::layers::layered_map
#import common::cube::{cube_direction, cube_texel}
#import common::face_ray::on_face

@group(0) @binding(0) var interval_order: texture_2d_array<u32>;
// Intervals' lowest and highest w, the farthest surface's; the lowest above the highest where there is none.
@group(0) @binding(1) var interval_bounds: texture_storage_2d_array<rgba32float, write>;
// Lowest and highest w of what is doubtful.
@group(0) @binding(2) var interval_doubt: texture_storage_2d_array<rg32uint, write>;

const NOTHING: vec2<f32> = vec2(3.0e38, -3.0e38);

const FRONT: u32 = 0u;
const BACK: u32 = 1u;
const SHEET: u32 = 2u;

// Fronts and backs of all slots, and the farthest.
const MOST: u32 = 2u * SLOTS + 1u;

// All surfaces kept behind a texel.
struct Column {
    face: u32,
    // Of the texel's centre, in texels.
    centre: vec2<f32>,
    count: u32,
    surfaces: array<Patch, MOST>,
    roles: array<u32, MOST>,
}

fn column_of(face: u32, place: vec2<i32>) -> Column {
    var column: Column;
    column.face = face;
    column.centre = vec2<f32>(place) + 0.5;
    let order = textureLoad(interval_order, place, face, 0).x;
    for (var slot = 0u; slot < SLOTS; slot++) {
        let layers = (order >> (8u * slot)) & 0xffu;
        if layers == EMPTY {
            break;
        }
        let front = layers & 15u;
        let back = layers >> 4u;
        if front == back {
            add(&column, patch_at(face, place, front), SHEET);
        } else {
            add(&column, patch_at(face, place, front), FRONT);
            add(&column, patch_at(face, place, back), BACK);
        }
    }
    let far = patch_at(face, place, interval_map.peeled);
    if far.w > 0.0 {
        add(&column, far, SHEET);
    }
    return column;
}

fn add(column: ptr<function, Column>, surface: Patch, role: u32) {
    (*column).surfaces[(*column).count] = surface;
    (*column).roles[(*column).count] = role;
    (*column).count += 1u;
}

// The surface's w in a direction of length 1 along some face's axis, as that face has it.
fn height_along(column: ptr<function, Column>, surface: u32, direction: vec3<f32>) -> f32 {
    let p = on_face((*column).face, direction);
    let uv = 0.5 * (p.xy / p.z + 1.0) * f32(layered_map.size);
    return p.z * height((*column).surfaces[surface], uv - (*column).centre);
}

// Whether two surfaces that differ by so much at the two centres are one that goes on. Planes that meet a little
// beyond a centre are let pass: meshes bend between texels too. A surface so steep that it would fall by more than
// eight times a texel's width is not: it ends.
fn goes_on(here: f32, there: f32, w: f32) -> bool {
    let most = max(abs(here), abs(there));
    let least = min(abs(here), abs(there));
    let bend = here * there <= 0.0 || 3.0 * least <= most || most <= 1.0e-4 * w;
    return bend && most <= 16.0 / f32(layered_map.size) * w;
}

fn hull(range: vec2<f32>, w: f32) -> vec2<f32> {
    return vec2(min(range.x, w), max(range.y, w));
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = layered_map.size;
    if id.x >= size || id.y >= 6u * size {
        return;
    }
    let face = id.y / size;
    let place = vec2<i32>(vec2(id.x, id.y % size));
    var own = column_of(face, place);
    let texel = 1.0 / f32(size);
    var near = NOTHING;
    var far = NOTHING;
    let far_w = patch_at(face, place, interval_map.peeled).w;
    for (var i = 0u; i < own.count; i++) {
        let is_far = far_w > 0.0 && i + 1u == own.count;
        for (var corner = 0u; corner < 4u; corner++) {
            let away = vec2(f32(corner & 1u), f32(corner >> 1u)) - 0.5;
            let w = max(height(own.surfaces[i], away), 0.0);
            if is_far { far = hull(far, w); } else { near = hull(near, w); }
        }
    }
    var doubt = NOTHING;
    let unstored = bitcast<f32>(textureLoad(interval_order, place, face, 0).y);
    if unstored > 0.0 {
        doubt = hull(hull(doubt, far_w), unstored);
    }
    for (var side = 0u; side < 4u; side++) {
        let step = select(-1.0, 1.0, (side & 1u) == 1u);
        let across = select(vec2(step, 0.0), vec2(0.0, step), side >= 2u);
        let along = across.yx;
        let beyond = cube_direction(face, (own.centre + across) * texel);
        let border = own.centre + 0.5 * across;
        let ends = array<vec3<f32>, 2>(
            cube_direction(face, (border - 0.5 * along) * texel),
            cube_direction(face, (border + 0.5 * along) * texel),
        );
        let middle = cube_direction(face, border * texel);
        let here = cube_direction(face, own.centre * texel);
        let next = cube_texel(beyond);
        let next_place = vec2<i32>(min(vec2<u32>(next.uv * f32(size)), vec2(size - 1u)));
        var other = column_of(next.face, next_place);
        var matched = 0u;
        for (var i = 0u; i < own.count; i++) {
            let w = own.surfaces[i].w;
            let w_beyond = height_along(&own, i, beyond);
            var goes = false;
            for (var j = 0u; j < other.count; j++) {
                if own.roles[i] != other.roles[j] {
                    continue;
                }
                let differs_here = w - height_along(&other, j, here);
                let differs_there = w_beyond - height_along(&other, j, beyond);
                if !goes_on(differs_here, differs_there, w) {
                    continue;
                }
                goes = true;
                matched |= 1u << j;
                if own.roles[i] == SHEET {
                    // A ray may slip through between the two at the border; see the search.
                    for (var end = 0u; end < 2u; end++) {
                        let w_end = max(height_along(&other, j, ends[end]), 0.0);
                        if far_w > 0.0 && i + 1u == own.count {
                            far = hull(far, w_end);
                        } else {
                            near = hull(near, w_end);
                        }
                    }
                }
            }
#ifdef EDGES
            if !goes {
                doubt = hull(hull(doubt, w), height_along(&own, i, middle));
            }
#endif
        }
#ifdef EDGES
        for (var j = 0u; j < other.count; j++) {
            if (matched & (1u << j)) == 0u {
                let w = height_along(&other, j, beyond);
                doubt = hull(hull(doubt, w), height_along(&other, j, middle));
            }
        }
#endif
    }
    doubt = max(doubt, vec2(0.0, -3.0e38));
    // A ray that meets what is doubtful has to be told, so it is part of the bounds.
    near = vec2(min(near.x, doubt.x), max(near.y, doubt.y));
    // Room for the rounding of the search.
    let slack = vec4(1.0 - 1.0e-5, 1.0 + 1.0e-5, 1.0 - 1.0e-5, 1.0 + 1.0e-5);
    textureStore(interval_bounds, place, face, clamp(vec4(near, far) * slack, vec4(-3.0e38), vec4(3.0e38)));
    textureStore(interval_doubt, place, face, vec4(bitcast<vec2<u32>>(doubt), 0u, 0u));
}
