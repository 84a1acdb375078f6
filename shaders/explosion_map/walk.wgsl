// From a triangle of the reflector to the one whose rays hold a point at its own distance, across the edges
// that the point lies beyond: no sphere enters into it.
#define_import_path explosion_map::walk

#import explosion_map::cell::weights_at

// Of each triangle those beyond its edges, each opposite to a corner, or `NONE`.
@group(0) @binding(6) var<storage, read> neighbours: array<u32>;

const NONE: u32 = 0xffffffffu;
// Weights so little below 0 are rounding.
const ROUNDING: f32 = 1e-3;

struct Walk {
    triangle: u32,
    weights: vec3<f32>,
    // Triangles looked at.
    steps: u32,
}

fn walk(begin: u32, v: vec3<f32>, cap: u32) -> Walk {
    var out = Walk(begin, vec3(0.0), 0u);
    var before = NONE;
    while out.steps < cap {
        out.steps += 1u;
        out.weights = weights_at(out.triangle, v);
        var weights = out.weights;
        var least = -ROUNDING;
        var next = NONE;
        for (var corner = 0u; corner < 3u; corner += 1u) {
            let beyond = neighbours[3u * out.triangle + corner];
            if beyond != NONE && weights[corner] < least {
                least = weights[corner];
                next = beyond;
            }
        }
        // The rays are straight and the surfaces between them are not: two cells may each give a point away.
        if next == NONE || next == before {
            break;
        }
        before = out.triangle;
        out.triangle = next;
    }
    // Beyond an open reflector's border: as its nearest point has it.
    let within = max(out.weights, vec3(0.0));
    out.weights = within / dot(within, vec3(1.0));
    return out;
}
