// Where a ray meets the surface that a cube map with distances holds (Szirmay-Kalos, Aszodi, Lazanyi &
// Premecz 2005; Umenhoffer, Patow & Szirmay-Kalos 2007, GPU Gems 3 chapter 17).
//
// With the centre of the map as the origin, the point p(d) = x + d R lies behind the surface where
// g(d) = |p(d)| / D(p(d)/|p(d)|) exceeds 1; the ray meets it where g = 1.
#define_import_path distance_impostor::search

#import common::cube::cube_texel

struct Params {
    // Centre of the map, world.
    centre: vec3<f32>,
    // Texels along a face's side.
    size: u32,
    // Steps from the start of the ray to infinity; 0 starts from the texel in direction R.
    march: u32,
    refine: u32,
    pad_a: u32,
    pad_b: u32,
}
@group(0) @binding(0) var<uniform> params: Params;
// As `distances.wgsl` leaves them.
@group(0) @binding(1) var distances: texture_2d_array<f32>;

// What the search looks up and shows.
struct Met {
    // From the centre of the map towards the texel to show; never zero.
    direction: vec3<f32>,
    // The environment in the ray's own direction, whatever the texel holds.
    sky: bool,
    // The ray was behind a surface somewhere before, or ends there: what the map does not hold.
    doubtful: bool,
}

// How far the surface may lie off the ray where they are said to meet, as a share of its distance.
const OFF_THE_RAY: f32 = 0.05;

// Neighbours whose distances differ by more than this ratio are two surfaces: a march does not
// interpolate between them.
const TWO_SURFACES: f32 = 1.25;

// The published search keeps to this many times the distances at hand: from there on a ray's direction
// seen from the centre no longer changes by a texel.
const FAR: f32 = 1.0e4;

struct SearchWork {
    fetches: u32,
    steps: u32,
}
var<private> search_work: SearchWork;

fn texel_of(uv: vec2<f32>) -> vec2<u32> {
    return min(vec2<u32>(uv * f32(params.size)), vec2(params.size - 1u));
}

// The inverse of the multiple of `q` that reaches the surface: g where `q` is p(d). 0 where the
// environment is. Linear between four texels of one surface, the nearest of them at an edge; a plane
// is linear in 1/z, so the inverse form has it exactly. Up to half a texel beyond the outermost texels'
// centres the same line goes on.
fn nearness(q: vec3<f32>) -> f32 {
    let size = abs(q);
    let major = max(size.x, max(size.y, size.z));
    if major == 0.0 {
        return 0.0;
    }
    let at = cube_texel(q);
    let side = f32(params.size);
    let low = clamp(floor(at.uv * side - 0.5), vec2(0.0), vec2(side - 2.0));
    let part = at.uv * side - 0.5 - low;
    let corner = vec2<u32>(low);
    let a = textureLoad(distances, corner, at.face, 0).x;
    let b = textureLoad(distances, corner + vec2(1u, 0u), at.face, 0).x;
    let c = textureLoad(distances, corner + vec2(0u, 1u), at.face, 0).x;
    let d = textureLoad(distances, corner + vec2(1u, 1u), at.face, 0).x;
    search_work.fetches += 4u;
    let least = min(min(a, b), min(c, d));
    let most = max(max(a, b), max(c, d));
    var stored = mix(mix(a, b, part.x), mix(c, d, part.x), part.y);
    // The line that goes on must stay on the surface's side of the environment.
    stored = clamp(stored, 0.5 * least, 2.0 * most);
    if least == 0.0 || params.march > 0u && most > TWO_SURFACES * least {
        let nearest = part >= vec2(0.5);
        stored = select(select(a, b, nearest.x), select(c, d, nearest.x), nearest.y);
    }
#ifdef RADIAL
    return select(length(q) / stored, 0.0, stored == 0.0);
#else
    return major * stored;
#endif
}

// The ray that starts at `x` (from the centre of the map) along the unit direction `r`.
fn search(x: vec3<f32>, r: vec3<f32>) -> Met {
    if params.march == 0u {
        return published(x, r);
    }
    return bracketed(x, r);
}

// The published search. It starts on the plane across R at the texel in direction R; as long as all
// samples lie on one side, the slope is that of a plane seen along R, 1 / D(R); afterwards the
// secant through the last samples of either side. One step is exact where the scene is one plane.
fn published(x: vec3<f32>, r: vec3<f32>) -> Met {
    let towards = nearness(r);
    if towards == 0.0 {
        return Met(r, false, false);
    }
    let slope = 1.0 / towards;
    let farthest = FAR * (slope + length(x));
    var d = clamp(slope - dot(x, r), 0.0, farthest);
    // The last samples in front of and behind the surface: d and g; d = 0 where there is none.
    var front = vec2(0.0);
    var behind = vec2(0.0);
    for (var i = 0u; i < params.refine; i += 1u) {
        search_work.steps += 1u;
        let g = nearness(x + d * r);
        var other = front;
        if g < 1.0 {
            other = behind;
            front = vec2(d, g);
        } else {
            behind = vec2(d, g);
        }
        var change = slope * (1.0 - g);
        if other.x != 0.0 && other.y != g {
            change = (d - other.x) * (1.0 - g) / (g - other.y);
        }
        d = clamp(d + change, 0.0, farthest);
    }
    let shown = x + d * r;
    return Met(select(shown, r, all(shown == vec3(0.0))), false, false);
}

// A start and a ray in a form without scale: with W = x / |x|, q(s) = (1 - s) W + s R points at
// p(d) for d = |x| s / (1 - s); s = 1 is infinity.
struct Sweep {
    w: vec3<f32>,
    r: vec3<f32>,
    reach: f32,
    // From W to R.
    angle: f32,
}

fn towards(sweep: Sweep, s: f32) -> vec3<f32> {
    return mix(sweep.w, sweep.r, s);
}

// (1 - s) (g - 1): above zero behind the surface, finite at infinity, linear in s on a plane.
fn height(sweep: Sweep, s: f32) -> f32 {
    return sweep.reach * nearness(towards(sweep, s)) - (1.0 - s);
}

// s after a share of the angle from W to R, so that all steps pass about as many texels.
fn after(sweep: Sweep, share: f32) -> f32 {
    let a = sin(share * sweep.angle);
    let b = sin((1.0 - share) * sweep.angle);
    return select(a / (a + b), share, a + b < 1.0e-4 || share == 1.0);
}

// First crossing from front to behind met in steps of equal angle, then regula falsi inside the step
// (its Illinois form, which moves both ends).
//
// A ray can also get behind a surface past its edge. There the map does not know what it meets, so the
// march goes on: the ray may come out again. For one that does not, what was beside the edge is taken
// to go on behind it: the texel there is shown, or the sky. (Taking it to have hit the side of what it
// is behind shows the wrong object three to twelve times as often in `columns`, `lecture`, `patow-room`
// and `clutter-150`.)
fn bracketed(x: vec3<f32>, r: vec3<f32>) -> Met {
    let reach = length(x);
    if reach == 0.0 {
        return Met(r, false, false);
    }
    let w = x / reach;
    let sweep = Sweep(w, r, reach, acos(clamp(dot(w, r), -1.0, 1.0)));
    var low = vec2(0.0, height(sweep, 0.0));
    var met = Met(r, false, low.y > 0.0);
    for (var i = 1u; i <= params.march; i += 1u) {
        search_work.steps += 1u;
        let s = after(sweep, f32(i) / f32(params.march));
        let high = vec2(s, height(sweep, s));
        if low.y <= 0.0 && high.y > 0.0 {
            let crossing = refined(sweep, low, high);
            met.direction = towards(sweep, crossing.s);
            if crossing.on_surface {
                met.sky = false;
                return met;
            }
            met.sky = crossing.beside_sky;
            met.doubtful = true;
        } else if high.y <= 0.0 {
            met.direction = r;
            met.sky = false;
        }
        low = high;
    }
    return met;
}

struct Crossing {
    // Where it is; past an edge, the last place in front of it.
    s: f32,
    // The ray passes through the surface here, not past its edge.
    on_surface: bool,
    // Past an edge, and the environment is beside it.
    beside_sky: bool,
}

// The crossing between two samples (s, height), the first in front of the surface, the other behind.
fn refined(sweep: Sweep, in_front: vec2<f32>, behind: vec2<f32>) -> Crossing {
    var low = in_front;
    var high = behind;
    var shown = high;
    var last_side = 0;
    for (var i = 0u; i < params.refine; i += 1u) {
        search_work.steps += 1u;
        let s = mix(low.x, high.x, low.y / (low.y - high.y));
        shown = vec2(s, height(sweep, s));
        if shown.y > 0.0 {
            high = shown;
            low.y *= select(1.0, 0.5, last_side == 1);
            last_side = 1;
        } else {
            low = shown;
            high.y *= select(1.0, 0.5, last_side == -1);
            last_side = -1;
        }
    }
    let beside_sky = nearness(towards(sweep, low.x)) == 0.0;
    let on_surface = abs(shown.y) <= OFF_THE_RAY * (1.0 - shown.x);
    return Crossing(select(low.x, shown.x, on_surface), on_surface, beside_sky);
}
