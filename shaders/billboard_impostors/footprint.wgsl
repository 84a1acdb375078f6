// How much of a billboard a pixel shows: its ray beside those of the neighbouring pixels, followed along with it.
#define_import_path billboard_impostors::footprint

#import bindings::beside::pixel_beside
#import bindings::view::MirrorPoint
#import billboard_impostors::boards::{
    Meeting, Ray, board_surface, leaving_point, on_plane, outside_of, params, portraits,
}
#ifdef BACKDROP
#import billboard_impostors::far::{backdrop_radiance, far_direction}
#endif
#import bindings::portrait::portrait_place
#import common::camera::seen_normal

// The rays of the pixels to the right and below, or to the left and above.
struct Neighbours {
    rays: array<Ray, 2>,
}

fn neighbours_of(at: MirrorPoint) -> Neighbours {
    var found: Neighbours;
    let right = pixel_beside(at, vec2(1, 0));
    let below = pixel_beside(at, vec2(0, 1));
    found.rays[0] = Ray(right.position, right.outgoing);
    found.rays[1] = Ray(below.position, below.outgoing);
    return found;
}

// Where a ray beside the one that met a billboard is on its picture, at the same height; where the other is, if behind
// it.
fn place_on(met: Meeting, ray: Ray) -> vec2<f32> {
    let q = on_plane(portraits[met.layer], ray, met.height);
    return select(met.place, portrait_place(portraits[met.layer], q.xy), q.z > 0.0);
}

// The mip level whose texels are as large as the footprint: by its area, as the longer side of a slanted one would
// blur far beyond the shorter. Not so large that it reaches beyond the picture, where there is nothing to blur with.
fn level_of(met: Meeting, beside: Neighbours) -> f32 {
    let right = place_on(met, beside.rays[0]) - met.place;
    let below = place_on(met, beside.rays[1]) - met.place;
    let texels = params.size * params.size * abs(right.x * below.y - right.y * below.x);
    let inside = min(met.place, 1.0 - met.place);
    let room = log2(max(params.size * min(inside.x, inside.y), 1.0));
    return clamp(0.5 * log2(max(texels, 1.0)), 0.0, min(room, params.coarsest));
}

// The same for the environment map, looked up along `d` for what is `reach` metres away; a texel at the middle of
// a face spans 2 / size.
#ifdef BACKDROP
fn far_level(d: vec3<f32>, met: Meeting, beside: Neighbours, reach: f32) -> f32 {
    let right = neighbour_direction(met, beside.rays[0], reach) - d;
    let below = neighbour_direction(met, beside.rays[1], reach) - d;
    let size = f32(textureDimensions(backdrop_radiance).x);
    let level = 0.5 * log2(max(0.25 * size * size * length(cross(right, below)), 1.0));
#ifdef BORDER_SHARP
    // A billboard's levels end where they would reach beyond its border, so that it is sharpest there. So is what
    // begins there, or the two would differ by how much each is blurred.
    if met.outside > 0.0 {
        return level * smoothstep(0.0, 1.0, met.outside);
    }
#endif
    return level;
}

// Where a neighbour looks the environment map up, morphed if its pixel's own ray is.
fn neighbour_direction(met: Meeting, ray: Ray, reach: f32) -> vec3<f32> {
    var there = met;
    if met.outside > 0.0 {
        let q = on_plane(portraits[met.layer], ray, 0.0);
        there.outside = select(0.0, min(outside_of(portraits[met.layer], q.xy), 1.0), q.z > 0.0);
        there.distance = q.z;
        if q.z > 0.0 && there.outside == 0.0 {
            // Inside the border the plane's point is what both show.
            return normalize(ray.origin + q.z * ray.direction - params.centre);
        }
    }
    return far_direction(ray, there, reach);
}
#endif

// The neighbours' rays mirrored in a billboard, as its pixel's own ray is; one that leaves the picture
// goes on along the pixel's own, `mirrored`.
fn mirrored_neighbours(met: Meeting, beside: Neighbours, mirrored: Ray) -> Neighbours {
    var on = beside;
    for (var i = 0u; i < 2u; i += 1u) {
        let ray = on.rays[i];
        let q = on_plane(portraits[met.layer], ray, met.height);
        var there = met;
        there.place = portrait_place(portraits[met.layer], q.xy);
        let surface = board_surface(there);
        on.rays[i] = mirrored;
        if q.z > 0.0 && any(surface.normal != vec3(0.0)) {
            let direction = reflect(ray.direction, seen_normal(surface.normal, ray.direction));
            on.rays[i] = Ray(leaving_point(ray, q.z, surface), direction);
        }
    }
    return on;
}
