// Walks over a reflector's texels to the one that answers best, at any level of its pyramid.
#define_import_path virtual_objects::walk

#import virtual_objects::reflector::{NOWHERE, OUTSIDE, quality, search, unpacked_texel}

// Of each cell the texel of the reflector nearest to its middle, packed, or `NOWHERE`.
@group(0) @binding(7) var mirror_cells: texture_2d<u32>;

// The crosshair, then the diagonals.
var<private> neighbours: array<vec2<i32>, 8> = array(
    vec2(1, 0), vec2(-1, 0), vec2(0, 1), vec2(0, -1),
    vec2(1, 1), vec2(-1, 1), vec2(1, -1), vec2(-1, -1),
);

struct Walk {
    // A texel at level 0.
    cell: vec2<i32>,
    // Neighbourhoods looked at, the last included.
    steps: u32,
}

// Columns and rows of a level.
fn cells_across(level: i32) -> vec2<i32> {
    return max(vec2<i32>(search.size >> vec2(u32(level))), vec2(1));
}

// The texel that stands for a cell, packed, or `NOWHERE`.
fn texel_in(cell: vec2<i32>, level: i32) -> u32 {
    if any(cell < vec2(0)) || any(cell >= cells_across(level)) {
        return NOWHERE;
    }
    return textureLoad(mirror_cells, cell, level).x;
}

// The cell of a level that a texel lies in.
fn cell_of(texel: vec2<i32>, level: i32) -> vec2<i32> {
    return min(texel >> vec2(u32(level)), cells_across(level) - 1);
}

fn cell_quality(cell: vec2<i32>, level: i32, v: vec3<f32>, inverse: bool) -> f32 {
#ifdef PYRAMID
    if level > 0 {
        let texel = texel_in(cell, level);
        if texel == NOWHERE {
            return OUTSIDE;
        }
        return quality(unpacked_texel(texel), v, inverse);
    }
#endif
    return quality(cell, v, inverse);
}

// From a cell uphill to one without a better neighbour.
fn walk(begin: vec2<i32>, level: i32, v: vec3<f32>, inverse: bool) -> Walk {
    var at = begin;
    var best = cell_quality(at, level, v, inverse);
    var steps = 0u;
    while steps < search.cap && (search.threshold >= 1.0 || best < search.threshold) {
        steps += 1u;
        let centre = at;
#ifdef PATTERN_EIGHT
        let first = 8u;
#else
        let first = 4u;
#endif
        for (var i = 0u; i < 8u; i += 1u) {
            // "The first four samples": whether the others follow, the paper does not say.
#ifdef PATTERN_DIAGONALS
            let look = i < first || all(at == centre);
#else
            let look = i < first;
#endif
            if look {
                let q = cell_quality(centre + neighbours[i], level, v, inverse);
                if q > best {
                    best = q;
                    at = centre + neighbours[i];
                }
            }
        }
        if all(at == centre) {
            break;
        }
    }
    return Walk(at, steps);
}

// The best cell of the pyramid's top, as its texel; `NOWHERE` where no texel shows the reflector.
fn best_at_top(v: vec3<f32>) -> u32 {
    let size = cells_across(search.top);
    var best = 2.0 * OUTSIDE;
    var texel = NOWHERE;
    for (var place = 0; place < size.x * size.y; place += 1) {
        let candidate = texel_in(vec2(place % size.x, place / size.x), search.top);
        if candidate != NOWHERE {
            let q = quality(unpacked_texel(candidate), v, false);
            if q > best {
                best = q;
                texel = candidate;
            }
        }
    }
    return texel;
}

// From a texel through levels, coarse to fine, each walked to its best; the texel, and all steps.
fn descent(begin: vec2<i32>, coarsest: i32, finest: i32, v: vec3<f32>) -> Walk {
    var texel = begin;
    var steps = 0u;
    for (var level = coarsest; level >= finest; level -= 1) {
        let found = walk(cell_of(texel, level), level, v, false);
        steps += found.steps;
        texel = unpacked_texel(texel_in(found.cell, level));
    }
    return Walk(texel, steps);
}
