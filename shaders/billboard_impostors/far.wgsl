// What is behind all billboards: the environment, or what the environment map has of the backdrop.
#define_import_path billboard_impostors::far

#import bindings::scene::environment
#import billboard_impostors::boards::{Meeting, NOWHERE, Ray, linear_filter, morphed, params}
#import common::cube::cube_texel
#import common::record::{Chain, NO_OBJECT, STATUS_ENVIRONMENT, STATUS_FOUND}

#ifdef BACKDROP
@group(0) @binding(50) var backdrop_radiance: texture_cube<f32>;
@group(0) @binding(51) var backdrop_point: texture_2d_array<f32>;
@group(0) @binding(52) var backdrop_ids: texture_2d_array<u32>;

struct Place {
    texel: vec2<u32>,
    face: u32,
}

fn backdrop_place(d: vec3<f32>) -> Place {
    let texel = cube_texel(d);
    let size = textureDimensions(backdrop_point);
    return Place(min(vec2<u32>(texel.uv * vec2<f32>(size)), size - 1u), texel.face);
}
#endif

// EM(d): in a direction as the environment map has it.
fn far_light(d: vec3<f32>, level: f32) -> vec3<f32> {
#ifdef BACKDROP
    return textureSampleLevel(backdrop_radiance, linear_filter, d, level).rgb;
#else
    return environment(d);
#endif
}

// How many metres along a ray what it shows of the map is taken to be: infinitely many for the environment map as
// it is; with FAR_DISTANCE where the ray first gets farther from the map's centre than the surface stored in that
// direction, at places as the centre sees them evenly spread, and halved from there (as a distance impostor is
// searched, Szirmay-Kalos et al. 2005).
fn far_reach(ray: Ray) -> f32 {
#ifdef FAR_DISTANCE
    let offset = max(length(ray.origin - params.centre), 1.0e-3);
    var near = 0.0;
    for (var i = 1u; i < FAR_STEPS; i += 1u) {
        var far = offset * f32(i) / f32(FAR_STEPS - i);
        if is_beyond(ray, far) {
            for (var j = 0u; j < FAR_HALVINGS; j += 1u) {
                let middle = 0.5 * (near + far);
                if is_beyond(ray, middle) {
                    far = middle;
                } else {
                    near = middle;
                }
            }
            return far;
        }
        near = far;
    }
    // What is left of its way is a point to the centre, nearly: the one stored there.
    let stored = backdrop_stored(ray.direction);
    if stored.w == 1.0 {
        return max(dot(stored.xyz - ray.origin, ray.direction), near);
    }
#endif
    return NOWHERE;
}

#ifdef FAR_DISTANCE
const FAR_STEPS: u32 = 64u;
const FAR_HALVINGS: u32 = 10u;

fn backdrop_stored(d: vec3<f32>) -> vec4<f32> {
    let place = backdrop_place(d);
    return textureLoad(backdrop_point, place.texel, place.face, 0);
}

fn is_beyond(ray: Ray, along: f32) -> bool {
    let from_centre = ray.origin + along * ray.direction - params.centre;
    let stored = backdrop_stored(from_centre);
    return stored.w == 1.0 && length(from_centre) > distance(stored.xyz, params.centre);
}
#endif

// Where the map is looked up for a ray whose answer is `reach` metres away; beside a flat thing's border, morphed.
fn far_direction(ray: Ray, met: Meeting, reach: f32) -> vec3<f32> {
    var d = ray.direction;
    if reach < NOWHERE {
        d = normalize(ray.origin + reach * ray.direction - params.centre);
    }
    if met.outside > 0.0 {
        return morphed(ray, met.distance, met.outside, d);
    }
    return d;
}

// The evidence for it, of a ray that left `origin` after `path` metres.
fn far_chain(start: Chain, d: vec3<f32>, origin: vec3<f32>, path: f32) -> Chain {
    var chain = start;
    chain.point = vec4(d, 0.0);
    // Infinitely far.
    chain.last = vec4(origin, bitcast<f32>(0x7f800000u));
    chain.object = NO_OBJECT;
    chain.status = STATUS_ENVIRONMENT;
#ifdef BACKDROP
#ifdef RECORD_FULL
    let place = backdrop_place(d);
    let point = textureLoad(backdrop_point, place.texel, place.face, 0);
    chain.point = point;
    if point.w == 1.0 {
        let ids = textureLoad(backdrop_ids, place.texel, place.face, 0);
        chain.last.w = path + distance(origin, point.xyz);
        chain.object = ids.x;
        chain.triangle = ids.y;
        chain.status = STATUS_FOUND;
    }
#endif
#endif
    return chain;
}
