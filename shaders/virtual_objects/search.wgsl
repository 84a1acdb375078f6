// For every vertex V, walks over the reflector's points P and normals N, uphill in N.B, to the texel
// whose normal bisects eye and vertex best, and mirrors V in the plane there (Estalella et al. 2006,
// section 4).
#import bindings::record::{count, count_most}
#import bindings::scene::{objects, vertices, world_position}
#import common::camera::{Camera, arriving}

struct Search {
    // Vertices to reflect.
    total: u32,
    // Where this reflector's texels of the frame before begin.
    history: u32,
    // 1 where those are void.
    cut: u32,
    // Most neighbourhoods looked at.
    cap: u32,
    // N.B from which on a texel is good enough; 1 for none.
    threshold: f32,
    // The reflector itself, which it does not reflect.
    reflector: u32,
    pad_a: u32,
    pad_b: u32,
}
@group(0) @binding(0) var<uniform> search: Search;
@group(0) @binding(1) var mirror_position: texture_2d<f32>;
@group(0) @binding(2) var mirror_normal: texture_2d<f32>;
// Whose vertex each is.
@group(0) @binding(3) var<storage, read> owners: array<u32>;
// One word, see start.wgsl.
@group(0) @binding(4) var<storage, read> start: array<u32>;
// T_SP of section 5.3: where each search of the frame before ended.
@group(0) @binding(5) var<storage, read_write> texels: array<u32>;
// V' in the world; the fourth is 1 where the vertex is hidden.
@group(0) @binding(6) var<storage, read_write> virtual_vertices: array<vec4<f32>>;
@group(0) @binding(30) var<uniform> camera: Camera;

const NOWHERE: u32 = 0xffffffffu;
// Below every N.B: no texel of the reflector.
const OUTSIDE: f32 = -2.0;

// The crosshair, then the diagonals.
var<private> neighbours: array<vec2<i32>, 8> = array(
    vec2(1, 0), vec2(-1, 0), vec2(0, 1), vec2(0, -1),
    vec2(1, 1), vec2(-1, 1), vec2(1, -1), vec2(-1, -1),
);

var<private> evaluations: u32;

// V in the tangent plane at P: equation 1 with the sign its text means.
fn mirrored(v: vec3<f32>, p: vec3<f32>, n: vec3<f32>) -> vec3<f32> {
    return v - 2.0 * dot(v - p, n) * n;
}

// N.B at a texel. Inverse: for the vertex that is reflected into `v` there (section 5.1).
fn quality(texel: vec2<i32>, v: vec3<f32>, inverse: bool) -> f32 {
    let size = vec2<i32>(textureDimensions(mirror_position));
    if any(texel < vec2(0)) || any(texel >= size) {
        return OUTSIDE;
    }
    let p = textureLoad(mirror_position, texel, 0);
    if p.w == 0.0 {
        return OUTSIDE;
    }
    evaluations += 1u;
    let n = textureLoad(mirror_normal, texel, 0).xyz;
    let seen = select(v, mirrored(v, p.xyz, n), inverse);
    let bisector = normalize(normalize(seen - p.xyz) - arriving(camera, p.xyz));
    return dot(n, bisector);
}

struct Walk {
    texel: vec2<i32>,
    // Neighbourhoods looked at, the last included.
    steps: u32,
}

fn walk(begin: vec2<i32>, v: vec3<f32>, inverse: bool) -> Walk {
    var at = begin;
    var best = quality(at, v, inverse);
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
                let q = quality(centre + neighbours[i], v, inverse);
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

// Where to begin: last frame's texel, unless there is none or the reflector has left it.
fn first_texel(index: u32) -> u32 {
    if search.cut == 1u {
        return start[0];
    }
    let last = texels[search.history + index];
    if last == NOWHERE {
        return start[0];
    }
    let p = textureLoad(mirror_position, unpacked(last), 0);
    return select(start[0], last, p.w == 1.0);
}

fn unpacked(texel: u32) -> vec2<i32> {
    return vec2<i32>(vec2(texel & 0xffffu, texel >> 16u));
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let index = id.x;
    if index >= search.total || owners[index] == search.reflector {
        return;
    }
    let begin = first_texel(index);
    if begin == NOWHERE {
        // No texel shows the reflector: all vertices fall into one, and nothing is drawn.
        texels[search.history + index] = NOWHERE;
        virtual_vertices[index] = vec4(0.0);
        return;
    }
    let v = world_position(objects[owners[index]], vertices[index].position);
    var found = walk(unpacked(begin), v, false);
    texels[search.history + index] = u32(found.texel.x) | (u32(found.texel.y) << 16u);
    var p = textureLoad(mirror_position, found.texel, 0).xyz;
    var n = textureLoad(mirror_normal, found.texel, 0).xyz;
    var image = mirrored(v, p, n);
    // "If we detect that this condition does not apply, we can assume that V is in Region C."
    let hidden = dot(v - p, n) < 0.0;
    var steps = found.steps;
    if hidden {
#ifdef HIDDEN_INVERSE
        found = walk(found.texel, v, true);
        steps += found.steps;
        p = textureLoad(mirror_position, found.texel, 0).xyz;
        n = textureLoad(mirror_normal, found.texel, 0).xyz;
#endif
#ifdef EQUATION_PRINTED
        image = p + 2.0 * dot(v - p, n) * n - (v - p);
#else
        image = mirrored(v, p, n);
#endif
    }
    virtual_vertices[index] = vec4(image, select(0.0, 1.0, hidden));
    count(0u, 1u);
    count(1u, steps);
    count(2u, evaluations);
    count_most(3u, steps);
    count(4u, select(0u, 1u, hidden));
}
