// Billboards: portraits as quads that rays meet (Popescu et al. 2006, slides 13 to 15).
#define_import_path billboard_impostors::boards

#import bindings::portrait::{
    Portrait, portrait_axes, portrait_own_direction, portrait_own_position, portrait_rotated,
    portrait_to_world,
}

struct Params {
    // Where the environment map was taken from.
    centre: vec3<f32>,
    // K of slide 15.
    bounces: u32,
    // Of the portraits: texels along a side, and the coarsest mip level.
    size: f32,
    coarsest: f32,
    // Of ray morphing, as a share of the billboard's shorter side; 0 without.
    margin: f32,
    // The most a search along a ray takes.
    steps: u32,
}
// Storage, not uniform: loops depend on it, over which lavapipe (Mesa 22.3) crashes.
@group(0) @binding(0) var<storage, read> params: Params;
@group(0) @binding(1) var<storage, read> portraits: array<Portrait>;

// The billboards a reflector sees, its own left out, those of diffuse things first: a range of
// `boards`.
struct Sight {
    first: u32,
    diffuse: u32,
    all: u32,
    pad: u32,
}
// One an object.
@group(0) @binding(2) var<storage, read> sights: array<Sight>;
// A layer of the portraits, and two bits: the billboard is a flat thing itself; it shows the very part
// that rays leave.
@group(0) @binding(3) var<storage, read> boards: array<u32>;
const FLAT: u32 = 0x80000000u;
const OWN: u32 = 0x40000000u;
const LAYER: u32 = 0x3fffffffu;

@group(0) @binding(4) var portrait_radiance: texture_2d_array<f32>;
@group(0) @binding(5) var portrait_albedo: texture_2d_array<f32>;
@group(0) @binding(6) var portrait_point: texture_2d_array<f32>;
@group(0) @binding(7) var portrait_normal: texture_2d_array<f32>;
@group(0) @binding(8) var portrait_ids: texture_2d_array<u32>;
@group(0) @binding(9) var linear_filter: sampler;

struct Ray {
    origin: vec3<f32>,
    // Unit.
    direction: vec3<f32>,
}

// Farther than anything.
const NOWHERE: f32 = 3.0e38;

// Where a ray meets a billboard's plane.
struct Meeting {
    // `NOWHERE` where it meets none.
    distance: f32,
    layer: u32,
    // On the picture, (0, 0) to (1, 1).
    place: vec2<f32>,
    // How far beyond the picture's border, in margins of morphing: 0 inside.
    outside: f32,
    // A flat thing itself.
    flat: bool,
    // Of the surface met, before the picture's plane; metres.
    height: f32,
}

fn no_meeting() -> Meeting {
    return Meeting(NOWHERE, 0u, vec2(0.0), 0.0, false, 0.0);
}

// Where the point that a ray meets at some height before a picture's plane is on that plane, in the
// picture's axes, and the way to it: negative behind.
fn on_plane(portrait: Portrait, ray: Ray, height: f32) -> vec3<f32> {
    let o = portrait_axes(portrait, portrait_own_position(portrait, ray.origin));
    let own = portrait_own_direction(portrait, ray.direction);
    let d = vec3(dot(own, portrait.right), dot(own, portrait.up), dot(own, portrait.towards));
    let along = (height - o.z) / select(d.z, 1.0e-20, abs(d.z) < 1.0e-20);
    let eye = portrait.eye_distance;
    let spread = select(eye / (eye - height), 1.0, eye == 0.0);
    return vec3(spread * (o.xy + along * d.xy), along);
}

// How far a point of the plane is beyond the picture's border, in margins of ray morphing.
fn outside_of(portrait: Portrait, q: vec2<f32>) -> f32 {
    let half = vec2(portrait.half_width, portrait.half_height);
    let beyond = length(max(abs(q) - half, vec2(0.0)));
    return beyond / max(2.0 * params.margin * min(half.x, half.y), 1.0e-20);
}

// Where the environment map is looked up for a ray that passes beside a billboard: at the border in the
// direction of the plane's point as seen from the map's centre, a margin further out in that without a border
// (slides 24 to 28, "ray morphing").
fn morphed(ray: Ray, along: f32, outside: f32, without: vec3<f32>) -> vec3<f32> {
    let seen = normalize(ray.origin + along * ray.direction - params.centre);
    return normalize(mix(seen, without, smoothstep(0.0, 1.0, outside)));
}

fn texel_of(place: vec2<f32>) -> vec2<u32> {
    return vec2<u32>(clamp(place * params.size, vec2(0.0), vec2(params.size - 1.0)));
}

// Of a picture's texels, the longer side, metres.
fn texel_width(layer: u32) -> f32 {
    return 2.0 * max(portraits[layer].half_width, portraits[layer].half_height) / params.size;
}

// Light from a place of a picture at a mip level. Levels mix what is covered with what is not.
fn board_light(met: Meeting, level: f32) -> vec3<f32> {
    let light =
        textureSampleLevel(portrait_radiance, linear_filter, met.place, met.layer, level);
    return light.rgb / max(light.a, 1.0e-3);
}

// What a picture's texel stores, in the world.
struct BoardTexel {
    point: vec3<f32>,
    object: u32,
    triangle: u32,
    front: bool,
}

// That of the nearest texel, never a blend. Of a flat thing every place has its own point, as it is its own picture.
fn board_texel(met: Meeting) -> BoardTexel {
    let portrait = portraits[met.layer];
    let texel = texel_met(met);
    let stored = textureLoad(portrait_point, texel, met.layer, 0);
    var point = stored.xyz;
    if met.flat {
        let q = vec2(2.0, -2.0) * (met.place - 0.5) * vec2(portrait.half_width, portrait.half_height);
        point = portrait.centre + q.x * portrait.right + q.y * portrait.up
            + stored.w * portrait.towards;
    }
    let ids = textureLoad(portrait_ids, texel, met.layer, 0).xy;
    let front = textureLoad(portrait_normal, texel, met.layer, 0).w == 1.0;
    return BoardTexel(portrait_to_world(portrait, point), ids.x, ids.y, front);
}

// The texel that shows what was met at a place: of the four about it the covered one nearest in height, where rays
// meet stored surfaces.
fn texel_met(met: Meeting) -> vec2<u32> {
    var nearest = texel_of(met.place);
#ifdef RELIEF
    if met.flat {
        return nearest;
    }
    let base = floor(met.place * params.size - 0.5);
    var least = NOWHERE;
    for (var i = 0u; i < 4u; i += 1u) {
        let at = base + vec2(f32(i & 1u), f32(i >> 1u));
        let texel = vec2<u32>(clamp(at, vec2(0.0), vec2(params.size - 1.0)));
        let off = abs(textureLoad(portrait_point, texel, met.layer, 0).w - met.height);
        if textureLoad(portrait_albedo, texel, met.layer, 0).a >= 0.5 && off < least {
            least = off;
            nearest = texel;
        }
    }
#endif
    return nearest;
}

struct BoardSurface {
    // Unit; 0 where no texel about the place is covered.
    normal: vec3<f32>,
    point: vec3<f32>,
}

// Texels of one surface differ in height by no more than this many texels' width.
const STEEPEST: f32 = 4.0;

// Normal and point between texels, what is not covered left out, and what belongs to another surface than that
// met: what a mirrored ray leaves by. World.
fn board_surface(met: Meeting) -> BoardSurface {
    let at = met.place * params.size - 0.5;
    let base = floor(at);
    let f = at - base;
    var normal = vec3(0.0);
    var point = vec4(0.0);
    for (var i = 0u; i < 4u; i += 1u) {
        let corner = vec2(f32(i & 1u), f32(i >> 1u));
        let texel = vec2<i32>(clamp(base + corner, vec2(0.0), vec2(params.size - 1.0)));
        let part = mix(1.0 - f, f, corner);
        var covered = textureLoad(portrait_albedo, texel, met.layer, 0).a;
        let stored = textureLoad(portrait_point, texel, met.layer, 0);
#ifdef RELIEF
        if abs(stored.w - met.height) > STEEPEST * texel_width(met.layer) {
            covered *= 1.0e-6;
        }
#endif
        let weight = part.x * part.y * covered;
        normal += weight * textureLoad(portrait_normal, texel, met.layer, 0).xyz;
        point += weight * vec4(stored.xyz, 1.0);
    }
    let portrait = portraits[met.layer];
    let own = point.xyz / max(point.w, 1.0e-20);
    let squared = dot(normal, normal);
    let unit = normal * select(0.0, inverseSqrt(max(squared, 1.0e-20)), squared > 1.0e-20);
    return BoardSurface(portrait_rotated(portrait, unit), portrait_to_world(portrait, own));
}

// Where a ray that met a billboard after `along` metres leaves it again.
fn leaving_point(ray: Ray, along: f32, surface: BoardSurface) -> vec3<f32> {
#ifdef ORIGIN_STORED
    return surface.point;
#else
    return ray.origin + along * ray.direction;
#endif
}
