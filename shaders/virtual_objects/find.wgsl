// The reflection point of any world point, without a memory of frames before: what the shadow volume
// hides is told first, then the pyramid is descended, then Gauss-Newton steps find the point.
#define_import_path virtual_objects::find

#import virtual_objects::corner::{BORDER, Corner, HIDDEN, LOST, SHOWN, packed_found}
#import virtual_objects::newton::{ReflectionPoint, newton}
#import virtual_objects::reflector::{
    NOWHERE, arriving_near, image_of, is_out_of_sight, normal_at, point_at, quality, search, unpacked_texel
}
#ifdef SECOND
#import virtual_objects::reflector::first_near
#import virtual_objects::second::texel_of
#else
#import virtual_objects::reflector::texel_of
#endif
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
// the eye, so no search is needed to tell. Where what is refracted is sought: before the surface.
fn is_hidden(v: vec3<f32>) -> bool {
    let texel = vec2<i32>(floor(texel_of(v)));
    let p = point_at(texel);
    return p.w == 1.0 && is_out_of_sight(v, p.xyz, normal_at(texel));
}

#ifdef REFLECTOR_CUBE
// In cube maps every search is the same, wherever its point is likely to be.
fn point_near(place: vec2<f32>, v: vec3<f32>) -> ReflectionPoint {
    let out = cube_point(v);
    steps += out.steps;
    return out;
}

fn point_of(v: vec3<f32>) -> ReflectionPoint {
    return point_near(vec2(0.0), v);
}
#else
// The reflection point near a place, as far as Newton's steps reach; where they fail, it is not found.
fn point_near(place: vec2<f32>, v: vec3<f32>) -> ReflectionPoint {
    var out: ReflectionPoint;
#ifdef POINT_NEWTON
    out = newton(place, v);
    steps += out.steps;
#endif
    return out;
}

// The reflection point from coarse to fine, as far as Newton's steps reach; where they fail, from the best
// texel; else that. One loop, as drivers that inline all calls take long over many.
fn point_of(v: vec3<f32>) -> ReflectionPoint {
    var out: ReflectionPoint;
    let near = min(NEAR_LEVEL, search.top);
    let best = best_at_top(v);
    if best == NOWHERE {
        return out;
    }
    var texel = unpacked_texel(best);
    for (var attempt = 0; attempt < 2; attempt += 1) {
        let coarsest = select(near - 1, search.top, attempt == 0);
        let found = descent(texel, coarsest, select(0, near, attempt == 0), v);
        steps += found.steps;
        texel = found.cell;
        out = point_near(vec2<f32>(texel) + 0.5, v);
        if out.found {
            return out;
        }
    }
    // At the rim between texels the law may hold nowhere: the best texel then. Elsewhere the search left
    // an open reflector by its edge.
    let p = point_at(texel).xyz;
    let n = normal_at(texel);
    let place = vec2<f32>(texel) + 0.5;
#ifdef HIDDEN_CLIP
    let found = -quality(texel, v, false) < EDGE_LAW * EDGE_LAW || grazes(place, p, n);
#else
    // As published: of hidden vertices, too, the best there is.
    let found = true;
#endif
    return ReflectionPoint(place, p, n, 0u, found);
}
#endif

// The eye sees the reflector's rim there.
fn grazes(place: vec2<f32>, p: vec3<f32>, n: vec3<f32>) -> bool {
    return abs(dot(n, arriving_near(place, p))) < RIM;
}

// The corner at a point of the border. There reflected light only grazes the reflector, so the point is
// its own image; in the second of two reflectors, the image that the first has of it.
fn border_corner(v: vec3<f32>) -> Corner {
    let place = texel_of(v);
#ifdef SECOND
    let image = image_of(v, place, first_near(place), vec3(0.0));
#else
    let image = v;
#endif
    return Corner(v, 0u, image, packed_found(place, BORDER));
}

fn corner_of(v: vec3<f32>, point: ReflectionPoint) -> Corner {
    let behind = is_out_of_sight(v, point.position, point.normal);
    if !point.found || (behind && !grazes(point.place, point.position, point.normal)) {
        return Corner(v, 0u, v, packed_found(point.place, LOST));
    }
    let image = image_of(v, point.place, point.position, point.normal);
    return Corner(v, 0u, image, packed_found(point.place, SHOWN));
}

fn hidden_corner(v: vec3<f32>) -> Corner {
    return Corner(v, 0u, v, packed_found(texel_of(v), HIDDEN));
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
