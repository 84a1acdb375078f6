// Which cells of the pyramid of bounds can hold no reflection point of a vertex.
//
// At a reflection point N points along H, the sum of the unit vectors to the eye and to the vertex. Over a
// ball of radius r about c, seen from d > r away, the direction to a point d off turns from that at c by an
// angle of the sine r / d at most, so the unit vector moves by the chord of that angle at most; H then moves
// from that at c by both chords together, `move`, and turns by an angle of the sine move / |H| at most,
// where move < |H|. So if the angle between H at c and the cone's axis is above the sum of that angle and
// the cone's own, N points along H nowhere in the cell. And N . H = |H| makes N . v = |H| / 2, with v the unit
// vector to the vertex, so where the angle between N and v is a right one or above all over the cell there is
// none either: what lies behind the reflector, where H may be 0, is told by that. All else is kept. A vertex
// may itself be anywhere in a ball: its radius then counts with r.
#define_import_path virtual_objects::reject

#import virtual_objects::reflector::{camera, search}

@group(0) @binding(25) var mirror_balls: texture_2d<f32>;
@group(0) @binding(26) var mirror_cones: texture_2d<f32>;

// For rounding, in proportion and in radians.
const SLACK: f32 = 1e-4;
const LEAST: f32 = 1e-6;

// Cells looked at since the invocation began.
var<private> visits: u32;

// Whether the four texels from this one on are one piece of the reflector.
fn is_patch(corner: vec2<i32>) -> bool {
    if any(corner < vec2(0)) || any(corner >= vec2<i32>(search.size)) {
        return false;
    }
    return textureLoad(mirror_balls, corner, 0).w >= 0.0;
}

// The chord of an angle of this sine, below 1.
fn chord(sine: f32) -> f32 {
    return sine / sqrt(0.5 + 0.5 * sqrt(1.0 - sine * sine));
}

// Whether a cell may hold a reflection point of something within `reach` of `v`.
fn may_hold(cell: vec2<i32>, level: i32, v: vec3<f32>, reach: f32) -> bool {
    visits += 1u;
    let ball = textureLoad(mirror_balls, cell, level);
    let cone = textureLoad(mirror_cones, cell, level);
    if ball.w < 0.0 {
        return false;
    }
    let to_v = v - ball.xyz;
    let to_eye = camera.eye - ball.xyz;
    let parallel = camera.orthographic == 1u;
    let sine_v = (ball.w + reach) / max(length(to_v), 1e-9);
    let sine_eye = select(ball.w / max(length(to_eye), 1e-9), 0.0, parallel);
    if max(sine_v, sine_eye) >= 1.0 || cone.w >= 1.0 {
        return true;
    }
    // The sine of the cone and of what v turns by, together; then that of their distance from a right angle.
    let open = sqrt(vec2(1.0) - vec2(sine_v * sine_v, cone.w * cone.w));
    let widest = sine_v * open.y + cone.w * open.x;
    let is_narrow = open.x * open.y > sine_v * cone.w;
    if is_narrow && dot(cone.xyz, normalize(to_v)) < -(widest * (1.0 + SLACK) + LEAST) {
        return false;
    }
    let h = normalize(to_v) + select(normalize(to_eye), -camera.forward, parallel);
    let long = length(h);
    let turned = (chord(sine_v) + chord(sine_eye)) / max(long, 1e-9);
    if turned >= 1.0 {
        return true;
    }
    let cosines = sqrt(vec2(1.0) - vec2(turned * turned, cone.w * cone.w));
    if cosines.x * cosines.y <= turned * cone.w {
        return true;
    }
    let most = turned * cosines.y + cone.w * cosines.x;
    return dot(cone.xyz, h) > 0.0 && length(cross(cone.xyz, h)) <= long * (most * (1.0 + SLACK) + LEAST);
}

// A cell of the pyramid on a way through it that goes down into what is kept and past what is not.
struct Cursor {
    // Of the top, counted row by row.
    top: i32,
    level: i32,
    // Which of four below, two bits a level.
    code: u32,
    done: bool,
}

// Not asked of the texture: of a level other than the first, lavapipe (Mesa 22.3) answers for one invocation of
// eight, even where that has left the loop.
fn top_size() -> vec2<i32> {
    let top = u32(search.bounds_top);
    return vec2<i32>((search.size + (1u << top) - 1u) >> vec2(top));
}

// Every other bit.
fn gathered(bits: u32) -> u32 {
    var x = bits & 0x55555555u;
    x = (x | (x >> 1u)) & 0x33333333u;
    x = (x | (x >> 2u)) & 0x0f0f0f0fu;
    x = (x | (x >> 4u)) & 0x00ff00ffu;
    return (x | (x >> 8u)) & 0x0000ffffu;
}

fn first_cell() -> Cursor {
    return Cursor(0, search.bounds_top, 0u, false);
}

fn cell_at(at: Cursor) -> vec2<i32> {
    let across = top_size().x;
    let top = vec2(at.top % across, at.top / across);
    let below = vec2<i32>(vec2(gathered(at.code), gathered(at.code >> 1u)));
    return (top << vec2(u32(search.bounds_top - at.level))) + below;
}

// The next cell: below this one, or past it. Needs no memory of the way.
fn next_cell(at: Cursor, down: bool) -> Cursor {
    var out = at;
    if down {
        out.level -= 1;
        out.code = out.code << 2u;
        return out;
    }
    out.code += 1u;
    // Up over those whose four are done, without a loop.
    let up = min(i32(firstTrailingBit(out.code)) / 2, search.bounds_top - out.level);
    out.code = out.code >> u32(2 * up);
    out.level += up;
    if out.level == search.bounds_top {
        out.code = 0u;
        out.top += 1;
        let size = top_size();
        out.done = out.top >= size.x * size.y;
    }
    return out;
}

// A place, in texels, where the reflector may show something within `reach` of a point; below 0 where it
// cannot. Cells finer than that are not asked.
fn place_for(v: vec3<f32>, reach: f32) -> vec2<f32> {
    var at = first_cell();
    while !at.done {
        let cell = cell_at(at);
        let held = may_hold(cell, at.level, v, reach);
        if held && at.level == 0 {
            return vec2<f32>(cell) + 1.0;
        }
        at = next_cell(at, held);
    }
    return vec2(-1.0);
}
