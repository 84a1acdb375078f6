// The reflection point of any world point, without a memory of frames before: what the shadow volume
// hides is told first, then the pyramid is descended, then Gauss-Newton steps find the point.
#define_import_path virtual_objects::find

#import common::camera::arriving
#import virtual_objects::corner::{BORDER, Corner, HIDDEN, LOST, SHOWN, packed_found}
#import virtual_objects::newton::{ReflectionPoint, newton}
#import virtual_objects::reflector::{
    NOWHERE, camera, image_of, normal_at, point_at, quality, search, texel_of, unpacked_texel
}
#import virtual_objects::walk::{best_at_top, descent}
#ifdef REFLECTOR_CUBE
#import virtual_objects::cube_search::cube_point
#endif

// Cosine between normal and eye at a closed reflector's rim, at most.
const RIM: f32 = 0.25;
// Sine of the largest angle between N and B at the best texel of all.
const EDGE_LAW: f32 = 0.05;
// Cells of this level are near enough for Newton's steps.
const NEAR_LEVEL: i32 = 3;

// Neighbourhoods and steps since the invocation began.
var<private> steps: u32;

// Behind the reflector: of a closed convex one the region without reflection is the solid it hides from
// the eye, so no search is needed to tell.
fn is_hidden(v: vec3<f32>) -> bool {
    let texel = vec2<i32>(floor(texel_of(v)));
    let p = point_at(texel);
    return p.w == 1.0 && dot(v - p.xyz, normal_at(texel)) < 0.0;
}

#ifdef REFLECTOR_CUBE
fn point_from(place: vec2<f32>, is_known: bool, v: vec3<f32>) -> ReflectionPoint {
    let out = cube_point(v);
    steps += out.steps;
    return out;
}
#else
// The reflection point: from a place likely to be near it, if one is known; else, or where that fails,
// from coarse to fine, as far as Newton's steps reach; else to the best texel and from there.
// One loop, as drivers that inline all calls take long over many.
fn point_from(place: vec2<f32>, is_known: bool, v: vec3<f32>) -> ReflectionPoint {
    var out: ReflectionPoint;
    let near = min(NEAR_LEVEL, search.top);
    var texel = vec2<i32>(place);
    var begin = place;
    for (var attempt = select(1, 0, is_known); attempt < 3; attempt += 1) {
        if attempt == 1 {
            let best = best_at_top(v);
            if best == NOWHERE {
                return out;
            }
            texel = unpacked_texel(best);
        }
        if attempt > 0 {
            let coarsest = select(near - 1, search.top, attempt == 1);
            let found = descent(texel, coarsest, select(0, near, attempt == 1), v);
            steps += found.steps;
            texel = found.cell;
            begin = vec2<f32>(texel) + 0.5;
        }
#ifdef POINT_NEWTON
        out = newton(begin, v);
        steps += out.steps;
        if out.found {
            return out;
        }
#endif
    }
    // At the rim between texels the law may hold nowhere: the best texel then. Elsewhere the search left
    // an open reflector by its edge.
    let p = point_at(texel).xyz;
    let n = normal_at(texel);
#ifdef HIDDEN_CLIP
    let found = -quality(texel, v, false) < EDGE_LAW * EDGE_LAW || grazes(p, n);
#else
    // As published: of hidden vertices, too, the best there is.
    let found = true;
#endif
    return ReflectionPoint(begin, p, n, 0u, found);
}
#endif

// The eye sees the reflector's rim there.
fn grazes(p: vec3<f32>, n: vec3<f32>) -> bool {
    return abs(dot(n, arriving(camera, p))) < RIM;
}

// The corner at a point of the border. There reflected light only grazes the reflector, so the point is
// its own image.
fn border_corner(v: vec3<f32>) -> Corner {
    return Corner(v, 0u, v, packed_found(texel_of(v), BORDER));
}

fn corner_of(v: vec3<f32>, point: ReflectionPoint) -> Corner {
    let behind = dot(v - point.position, point.normal) < 0.0;
    if !point.found || (behind && !grazes(point.position, point.normal)) {
        return Corner(v, 0u, v, packed_found(point.place, LOST));
    }
    let image = image_of(v, point.position, point.normal);
    return Corner(v, 0u, image, packed_found(point.place, SHOWN));
}

fn hidden_corner(v: vec3<f32>) -> Corner {
    return Corner(v, 0u, v, packed_found(texel_of(v), HIDDEN));
}

// The corner at a world point whose reflection point is likely to be near a place.
fn corner_near(v: vec3<f32>, place: vec2<f32>) -> Corner {
    if is_hidden(v) {
        return hidden_corner(v);
    }
    return corner_of(v, point_from(place, true, v));
}

// Halvings of an edge in search of the border: a thousandth of it.
const HALVINGS: u32 = 10u;

// Where what is hidden begins between a point that is not and one that is, as a share of the way.
fn border_between(outside: vec3<f32>, inside: vec3<f32>) -> f32 {
    var near = 0.0;
    var far = 1.0;
    for (var i = 0u; i < HALVINGS; i += 1u) {
        let middle = 0.5 * (near + far);
        if is_hidden(mix(outside, inside, middle)) {
            far = middle;
        } else {
            near = middle;
        }
    }
    return near;
}
