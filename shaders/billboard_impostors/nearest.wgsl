// Which billboard a ray meets first: as a quad, or as the surface whose depth is stored with its picture.
#define_import_path billboard_impostors::nearest

#import bindings::portrait::{portrait_place, portrait_ray}
#import billboard_impostors::boards::{
    FLAT, LAYER, Meeting, NOWHERE, OWN, Ray, boards, no_meeting, on_plane, outside_of, params,
    portrait_albedo, portrait_point, portraits, sights, texel_of, texel_width,
}

// The nearest billboard that a ray meets, of those seen by the reflector it leaves (slide 15:
// "intersect with (D + R - 1) billboards").
fn nearest_board(ray: Ray, reflector: u32, diffuse_only: bool) -> Meeting {
    let sight = sights[reflector];
    let end = sight.first + select(sight.all, sight.diffuse, diffuse_only);
    var nearest = no_meeting();
    for (var i = sight.first; i < end; i += 1u) {
        let word = boards[i];
        let flat = (word & FLAT) != 0u;
        let layer = word & LAYER;
#ifdef RELIEF
        if !flat {
            let met = on_relief(layer, ray, (word & OWN) != 0u);
            if met.distance < nearest.distance {
                nearest = met;
            }
            continue;
        }
#endif
        let portrait = portraits[layer];
        let q = on_plane(portrait, ray, 0.0);
        if !(q.z > 0.0 && q.z < nearest.distance) {
            continue;
        }
        let place = portrait_place(portrait, q.xy);
        let outside = outside_of(portrait, q.xy);
        if outside > 0.0 {
#ifdef MORPH
            if flat && i < sight.first + sight.diffuse && outside < 1.0 {
                nearest = Meeting(q.z, layer, place, outside, flat, 0.0);
            }
#endif
            continue;
        }
        if textureLoad(portrait_albedo, texel_of(place), layer, 0).a >= 0.5 {
            nearest = Meeting(q.z, layer, place, 0.0, flat, 0.0);
        }
    }
    return nearest;
}

fn boards_tested(reflector: u32, diffuse_only: bool) -> u32 {
    let sight = sights[reflector];
    return select(sight.all, sight.diffuse, diffuse_only);
}

#ifdef RELIEF
// A ray over a picture: what of it the picture shows. Straight on the picture, as both sights keep lines.
struct Track {
    layer: u32,
    // Places where it enters and ends.
    start: vec2<f32>,
    end: vec2<f32>,
    // Distances there, and what they are divided by in perspective.
    along: vec2<f32>,
    w: vec2<f32>,
    // Height over the plane where the ray leaves, and its change a metre.
    height: f32,
    climb: f32,
    // It comes in by the side that faces the eye.
    from_front: bool,
    exists: bool,
}

fn track_of(layer: u32, ray: Ray) -> Track {
    let there = portrait_ray(portraits[layer], ray.origin, ray.direction);
    let first = there.clip + there.range.x * there.change;
    let last = there.clip + there.range.y * there.change;
    var track: Track;
    track.exists = there.range.x < there.range.y;
    track.from_front = there.from_front;
    track.layer = layer;
    track.start = 0.5 + 0.5 * first.xy / first.w;
    track.end = 0.5 + 0.5 * last.xy / last.w;
    track.along = there.range;
    track.w = vec2(first.w, last.w);
    track.height = there.height;
    track.climb = there.climb;
    return track;
}

// Distance along the ray at a share of its track.
fn along_at(track: Track, share: f32) -> f32 {
    let parts = vec2(1.0 - share, share) / track.w;
    return dot(parts, track.along) / (parts.x + parts.y);
}

fn height_at(track: Track, share: f32) -> f32 {
    return track.height + along_at(track, share) * track.climb;
}

// How far the ray is before the surface of the nearest texel, metres.
fn before_texel(track: Track, share: f32) -> f32 {
    let texel = texel_of(mix(track.start, track.end, share));
    let stored = textureLoad(portrait_point, texel, track.layer, 0).w;
    let covered = textureLoad(portrait_albedo, texel, track.layer, 0).a >= 0.5;
    return select(NOWHERE, height_at(track, share) - stored, covered);
}

// The same of the surface between texels.
fn before_surface(track: Track, share: f32) -> f32 {
    let at = mix(track.start, track.end, share) * params.size - 0.5;
    let base = floor(at);
    var sum = vec2(0.0);
    for (var i = 0u; i < 4u; i += 1u) {
        let corner = vec2(f32(i & 1u), f32(i >> 1u));
        let texel = vec2<i32>(clamp(base + corner, vec2(0.0), vec2(params.size - 1.0)));
        let part = mix(1.0 - (at - base), at - base, corner);
        let covered = textureLoad(portrait_albedo, texel, track.layer, 0).a;
        let stored = textureLoad(portrait_point, texel, track.layer, 0).w;
        sum += part.x * part.y * covered * vec2(stored, 1.0);
    }
    return select(NOWHERE, height_at(track, share) - sum.x / sum.y, sum.y > 1.0e-3);
}

// A ray that passes a silhouette is as far behind the surface as it falls there: in texels, more than this
// is no meeting.
const THICKEST: f32 = 1.0;
// Texels a ray has to rise over the picture that also shows where it leaves, before it can meet it.
const RISE: f32 = 4.0;
const HALVINGS: u32 = 7u;

// Where a ray first goes from before the stored surface to behind it.
fn on_relief(layer: u32, ray: Ray, own: bool) -> Meeting {
    let track = track_of(layer, ray);
    if !track.exists {
        return no_meeting();
    }
    let texel = texel_width(layer);
    let rise = select(0.0, RISE * texel, own);
    let texels = ceil(length((track.end - track.start) * params.size));
    let steps = u32(clamp(texels, 1.0, f32(params.steps)));
    var before = track.from_front;
    var i = 0u;
    // Halved outside the march: lanes that have found something wait for one another, not in every step.
    while i <= steps {
        var crosses = false;
        while i <= steps && !crosses {
            let gap = before_texel(track, f32(i) / f32(steps));
            crosses = before && gap <= 0.0;
            before = gap > 0.0 && (before || gap > rise);
            i += 1u;
        }
        if crosses {
            let last = f32(max(i, 2u) - 2u) / f32(steps);
            let met = refined(track, last, f32(i - 1u) / f32(steps), texel);
            if met.distance != NOWHERE {
                return met;
            }
        }
    }
    return no_meeting();
}

fn refined(track: Track, from_share: f32, to_share: f32, texel: f32) -> Meeting {
    var low = from_share;
    var high = to_share;
    for (var i = 0u; i < HALVINGS; i += 1u) {
        let middle = 0.5 * (low + high);
        if before_surface(track, middle) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    if abs(before_surface(track, high)) > THICKEST * texel {
        return no_meeting();
    }
    let place = mix(track.start, track.end, high);
    return Meeting(along_at(track, high), track.layer, place, 0.0, false, height_at(track, high));
}
#endif
