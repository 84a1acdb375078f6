// For every vertex V the point of the reflector whose normal bisects eye and vertex best, and V' there:
// by a walk over texels as Estalella et al. 2006, section 4, have it, or from coarse to fine.
#import bindings::record::{count, count_most}
#import bindings::scene::{objects, vertices, world_position}
#import virtual_objects::corner::{Corner, HIDDEN, LOST, SHOWN, packed_found, status_of}
#import virtual_objects::newton::{ReflectionPoint, newton}
#import virtual_objects::reflector::{
    NOWHERE, evaluations, image_of, mirrored, normal_at, packed_texel, point_at, search, unpacked_texel
}
#import virtual_objects::walk::walk
#ifdef SECOND
#import virtual_objects::reflector::shown_pixels
#endif
#ifdef HIDDEN_CLIP
#import virtual_objects::find::{corner_of, hidden_corner, is_hidden}
#endif
#ifdef START_PYRAMID
#import virtual_objects::find::{point_of, steps}
#endif
#ifdef REFLECTOR_CUBE
#import virtual_objects::cube_search::{cube_point, direction_of, fixed_point}
#endif

// Whose vertex each is.
@group(0) @binding(3) var<storage, read> owners: array<u32>;
// One word, see start.wgsl.
@group(0) @binding(4) var<storage, read> start: array<u32>;
// T_SP of section 5.3: where each search of the frame before ended.
@group(0) @binding(5) var<storage, read_write> texels: array<u32>;
@group(0) @binding(6) var<storage, read_write> corners: array<Corner>;

#ifdef REFLECTOR_CUBE
fn reflection_point(index: u32, v: vec3<f32>) -> ReflectionPoint {
    return cube_point(v);
}

// That of the vertex reflected into `v`, from the point found for `v`.
fn inverse_point(found: ReflectionPoint, v: vec3<f32>) -> ReflectionPoint {
    return fixed_point(direction_of(found.position), v, true);
}
#else
#ifndef START_PYRAMID
// Where to begin: last frame's texel, unless there is none or the reflector has left it.
fn first_texel(index: u32) -> u32 {
    if search.cut == 1u {
        return start[0];
    }
    let last = texels[search.history + index];
    if last == NOWHERE || point_at(unpacked_texel(last)).w == 0.0 {
        return start[0];
    }
    return last;
}

#endif

fn walked_to(begin: vec2<i32>, v: vec3<f32>, inverse: bool) -> ReflectionPoint {
    let end = walk(begin, 0, v, inverse);
    let place = vec2<f32>(end.cell) + 0.5;
    return ReflectionPoint(place, point_at(end.cell).xyz, normal_at(end.cell), end.steps, true);
}

fn inverse_point(found: ReflectionPoint, v: vec3<f32>) -> ReflectionPoint {
    return walked_to(vec2<i32>(found.place), v, true);
}

// The reflection point of a vertex; `found` is false where no texel shows the reflector.
fn reflection_point(index: u32, v: vec3<f32>) -> ReflectionPoint {
    var out: ReflectionPoint;
#ifdef START_PYRAMID
    out = point_of(v);
    out.steps = steps;
#else
    let begin = first_texel(index);
    texels[search.history + index] = begin;
    if begin == NOWHERE {
        return out;
    }
    out = walked_to(unpacked_texel(begin), v, false);
    texels[search.history + index] = packed_texel(vec2<i32>(out.place));
#ifdef POINT_NEWTON
    let point = newton(out.place, v);
    if point.found {
        let walked = out.steps;
        out = point;
        out.steps += walked;
    }
#endif
#endif
    return out;
}
#endif

#ifndef HIDDEN_CLIP
// V' as published: what lies behind the plane found is hidden, and mirrored all the same.
fn published_corner(v: vec3<f32>, found: ptr<function, ReflectionPoint>) -> Corner {
    let point = *found;
    if !point.found {
        // All vertices fall into one point, and nothing is drawn.
        return Corner(v, 0u, vec3(0.0), packed_found(vec2(0.0), LOST));
    }
    // "If we detect that this condition does not apply, we can assume that V is in Region C."
    if dot(v - point.position, point.normal) >= 0.0 {
        let image = image_of(v, point.place, point.position, point.normal);
        return Corner(v, 0u, image, packed_found(point.place, SHOWN));
    }
    var p = point.position;
    var n = point.normal;
#ifdef HIDDEN_INVERSE
    let again = inverse_point(point, v);
    (*found).steps += again.steps;
    p = again.position;
    n = again.normal;
#endif
#ifdef EQUATION_PRINTED
    let image = p + 2.0 * dot(v - p, n) * n - (v - p);
#else
    let image = mirrored(v, p, n);
#endif
    return Corner(v, 0u, image, packed_found(point.place, HIDDEN));
}
#endif

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let index = id.x;
    if index >= search.total || owners[index] == search.reflector {
        return;
    }
#ifdef SECOND
    if shown_pixels[search.reflector] == 0u {
        return;
    }
#endif
    let v = world_position(objects[owners[index]], vertices[index].position);
    var found: ReflectionPoint;
#ifdef HIDDEN_CLIP
    var corner: Corner;
    if is_hidden(v) {
        corner = hidden_corner(v);
    } else {
        found = reflection_point(index, v);
        corner = corner_of(v, found);
    }
#else
    found = reflection_point(index, v);
    let corner = published_corner(v, &found);
#endif
    corners[index] = corner;
    // Without a texel of the reflector there is nothing to search.
    count(0u, select(0u, 1u, found.found));
    count(1u, found.steps);
    count(2u, evaluations);
    count_most(3u, found.steps);
    count(4u, select(0u, 1u, status_of(corner) == HIDDEN));
}
