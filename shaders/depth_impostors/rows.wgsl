// Where a ray meets a depth image: by one of its rotated rows, or texel by texel (Popescu et al. 2006, slides
// 36 to 38). Rust twin: geometry/depth_rows/{search,march}.rs.
#define_import_path depth_impostors::rows

// Not a uniform, as loops depend on it.
struct Impostors {
    // Texels along a side of a depth image.
    size: u32,
    // Maps over a half turn.
    angles: u32,
    // Most a row is simplified to.
    segments: u32,
    // Depth images.
    layers: u32,
    // The first of the reflector itself; they are the last.
    own: u32,
    // Most reflections in one mirror, at least 1.
    bounces: u32,
}
@group(0) @binding(0) var<storage, read> impostors: Impostors;
// As `heights.wgsl` and `simplify.wgsl` leave them.
@group(0) @binding(17) var quads: texture_2d_array<u32>;
@group(0) @binding(18) var<storage, read> counts: array<u32>;
@group(0) @binding(19) var<storage, read> segments: array<vec2<u32>>;

const PI: f32 = 3.14159265358979;

// The part of a ray that a depth image can show: where it starts and ends, in texels and height.
struct ImageLine {
    start: vec3<f32>,
    end: vec3<f32>,
}

struct Found {
    hit: bool,
    // It went behind something past a silhouette: what it meets there is not known.
    behind: bool,
    // Whether its row has anything in it.
    row_exists: bool,
    // In texels of the image, and the ray's height there.
    place: vec2<f32>,
    height: f32,
}

// Segments and texels read, for the counters.
var<private> segment_reads: u32;
var<private> texel_reads: u32;

// That of the texel at a place; 0 outside.
fn nearest_height(layer: u32, place: vec2<f32>) -> f32 {
    texel_reads += 1u;
    let texel = vec2<i32>(floor(place));
    if any(texel < vec2(0)) || any(texel >= vec2(i32(impostors.size))) {
        return 0.0;
    }
    return unpack2x16unorm(textureLoad(quads, texel, layer, 0).x).x;
}

#ifdef FINISH
// Texels to either side of a row's hit between which the image is looked at.
const REACH: f32 = 1.5;

// Between four texels of one surface, 0 where they are not.
fn height_between(layer: u32, place: vec2<f32>, jump: f32) -> f32 {
    let low = floor(place - 0.5);
    if any(low < vec2(0.0)) || any(low >= vec2(f32(impostors.size) - 1.0)) {
        return 0.0;
    }
    texel_reads += 1u;
    let part = place - 0.5 - low;
    let quad = textureLoad(quads, vec2<i32>(low), layer, 0);
    let top = unpack2x16unorm(quad.x);
    let bottom = unpack2x16unorm(quad.y);
    let least = min(min(top.x, top.y), min(bottom.x, bottom.y));
    let most = max(max(top.x, top.y), max(bottom.x, bottom.y));
    let pair = mix(top, bottom, part.y);
    return select(0.0, mix(pair.x, pair.y, part.x), least > 0.0 && most - least <= jump);
}

// The share of a line where it meets the image's own surface beside a row's hit; that one's where it does not.
fn finished(line: ImageLine, layer: u32, jump: f32, share: f32) -> f32 {
    let length = distance(line.start.xy, line.end.xy);
    let ends = clamp(share + vec2(-REACH, REACH) / length, vec2(0.0), vec2(1.0));
    let before = mix(line.start, line.end, ends.x);
    let after = mix(line.start, line.end, ends.y);
    let surface = vec2(
        height_between(layer, before.xy, jump),
        height_between(layer, after.xy, jump),
    );
    let over = vec2(before.z, after.z) - surface;
    let one = min(surface.x, surface.y) > 0.0 && abs(surface.y - surface.x) <= 2.0 * REACH * jump;
    let crosses = over.x >= 0.0 && over.y < 0.0;
    let met = mix(ends.x, ends.y, over.x / (over.x - over.y));
    return select(share, met, one && crosses);
}
#endif

// Of the jump that is a silhouette: no farther behind one than this is its rim, which a surface goes on to
// bend round.
const RIM: f32 = 0.5;

fn degenerate(line: ImageLine) -> bool {
    let across = line.end.xy - line.start.xy;
    return dot(across, across) < 1.0;
}

// A line that stays in one texel: that texel alone.
fn texel_test(line: ImageLine, layer: u32) -> Found {
    let surface = nearest_height(layer, 0.5 * (line.start.xy + line.end.xy));
    let above = vec2(line.start.z, line.end.z) - surface;
    let hit = surface > 0.0 && above.x >= 0.0 && above.y < 0.0;
    return Found(hit, false, surface > 0.0, 0.5 * (line.start.xy + line.end.xy), surface);
}

// One texel a step along the line's longer axis.
fn march(line: ImageLine, layer: u32, jump: f32) -> Found {
    let across = abs(line.end.xy - line.start.xy);
    let steps = u32(max(ceil(max(across.x, across.y)), 1.0));
    var found = Found(false, false, true, vec2(0.0), 0.0);
    var share_before = 0.0;
    var surface_before = nearest_height(layer, line.start.xy);
    for (var i = 1u; i <= steps; i += 1u) {
        let share = f32(i) / f32(steps);
        let at = mix(line.start, line.end, share);
        let surface = nearest_height(layer, at.xy);
        let was = mix(line.start.z, line.end.z, share_before) - surface_before;
        let above = at.z - surface;
        let one = surface_before > 0.0 && surface > 0.0
            && abs(surface - surface_before) <= jump;
        var crossed = was >= 0.0 && above < 0.0;
#ifdef SKINS
        crossed = crossed || was < 0.0 && above >= 0.0;
        let hit = crossed;
#else
        let hit = crossed && (one || -above <= RIM * jump);
#endif
        found.behind = found.behind || crossed && !one;
        if hit {
            var part = was / (was - above);
            // A skin shows the side that has something to show.
            part = select(part, 0.0, surface == 0.0);
            part = select(part, 1.0, surface_before == 0.0);
            let met = mix(line.start, line.end, mix(share_before, share, part));
#ifndef SKINS
            found.behind = found.behind && !one;
#endif
            found.hit = true;
            found.place = met.xy;
            found.height = met.z;
            return found;
        }
        share_before = share;
        surface_before = surface;
    }
    return found;
}

// What a row says of a ray.
struct RowHit {
    hit: bool,
    behind: bool,
    x: f32,
}

// Where segments of a row begin in `segments`, and how many there are.
struct Row {
    first: u32,
    count: u32,
}

// The row at y of a map; without any segment where there is none.
fn row_at(layer: u32, map: u32, y: f32) -> Row {
    if y < 0.0 || y >= f32(impostors.size) {
        return Row(0u, 0u);
    }
    let row = (layer * impostors.angles + map) * impostors.size + u32(y);
    return Row(row * impostors.segments, counts[row]);
}

// The first segment, in the ray's order, that ends beyond its start.
fn first_beyond(row: Row, start: f32, forward: bool) -> u32 {
    var low = 0u;
    var high = row.count;
    while low < high {
        let middle = (low + high) / 2u;
        let packed = segments[row.first + select(row.count - 1u - middle, middle, forward)];
        segment_reads += 1u;
        let ends = unpack2x16unorm(packed.x) * f32(impostors.size);
        let end = select(-ends.x, ends.y, forward);
        if end <= start {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return low;
}

// "First sign change" of the ray's height over the segments, from its start on; `x` and `height` are
// those where it starts and ends.
fn intersect(row: Row, x: vec2<f32>, height: vec2<f32>, jump: f32) -> RowHit {
    let forward = x.y > x.x;
    let sign = select(-1.0, 1.0, forward);
    let start = sign * x.x;
    let end = sign * x.y;
    let ray_slope = (height.y - height.x) / (end - start);
    var hit = RowHit(false, false, 0.0);
    // Where the last segment ended, and how high above it the ray was.
    var left = -1.0e30;
    var above = 1.0;
    for (var i = first_beyond(row, start, forward); i < row.count; i += 1u) {
        let packed = segments[row.first + select(row.count - 1u - i, i, forward)];
        segment_reads += 1u;
        let ends = unpack2x16unorm(packed.x) * f32(impostors.size);
        let levels = unpack2x16unorm(packed.y);
        let across = sign * select(ends.yx, ends, forward);
        let level = select(levels.yx, levels, forward);
        if across.x >= end {
            break;
        }
        let s = max(across.x, start);
        let e = min(across.y, end);
        let slope = (level.y - level.x) / (across.y - across.x);
        let at_start = height.x + ray_slope * (s - start) - (level.x + slope * (s - across.x));
        let at_end = height.x + ray_slope * (e - start) - (level.x + slope * (e - across.x));
        // Before the ray's start nothing is known; beside a surface is the ground, below all rays.
        var before = select(above, 1.0, across.x > left);
        before = select(before, at_start, s > across.x || across.x == start);
        var skin = before >= 0.0 && at_start < 0.0;
        var enters = at_start >= 0.0 && at_end < 0.0;
#ifdef SKINS
        skin = skin || before < 0.0 && at_start >= 0.0;
        enters = enters || at_start < 0.0 && at_end >= 0.0;
#endif
        hit.behind = hit.behind || skin;
#ifdef SKINS
        let shown = skin;
#else
        let shown = skin && -at_start <= RIM * jump;
#endif
        if shown {
            // Just inside the texel at the silhouette.
            hit.hit = true;
            hit.x = sign * (s + min(0.25, 0.5 * (e - s)));
            return hit;
        }
        if enters {
            hit.hit = true;
            hit.behind = false;
            hit.x = sign * (s + (e - s) * at_start / (at_start - at_end));
            return hit;
        }
        left = across.y;
        above = at_end;
    }
    return hit;
}

// A place of the image in a map rotated so, and back with the opposite sine.
fn rotated(place: vec2<f32>, cosine: f32, sine: f32) -> vec2<f32> {
    let middle = 0.5 * f32(impostors.size);
    let p = place - middle;
    return middle + vec2(cosine * p.x + sine * p.y, cosine * p.y - sine * p.x);
}

// The row nearest to the ray: of the map rotated the nearest angle, the one through the middle of the ray's
// part in the image. With `RE_ANCHOR` once more, in the row the ray is in where the first was hit.
fn search_rows(line: ImageLine, layer: u32, jump: f32) -> Found {
    let across = line.end.xy - line.start.xy;
    let steps = atan2(across.y, across.x) / PI * f32(impostors.angles);
    let map = u32(i32(round(steps)) + 2 * i32(impostors.angles)) % impostors.angles;
    let angle = f32(map) * PI / f32(impostors.angles);
    let cosine = cos(angle);
    let sine = sin(angle);
    let start = rotated(line.start.xy, cosine, sine);
    let end = rotated(line.end.xy, cosine, sine);
    let x = vec2(start.x, end.x);
    let height = vec2(line.start.z, line.end.z);
    var y = 0.5 * (start.y + end.y);
    var found = Found(false, false, false, vec2(0.0), 0.0);
    let row = row_at(layer, map, y);
    if row.count == 0u {
        return found;
    }
    found.row_exists = true;
    var hit = intersect(row, x, height, jump);
#ifdef RE_ANCHOR
    if hit.hit {
        let at = mix(start.y, end.y, (hit.x - start.x) / (end.x - start.x));
        let again = intersect(row_at(layer, map, at), x, height, jump);
        // Where the ray's own row has nothing, the first was right but for its direction.
        if again.hit {
            hit = again;
        }
        y = mix(start.y, end.y, (hit.x - start.x) / (end.x - start.x));
    }
#endif
    found.hit = hit.hit;
    found.behind = hit.behind;
    found.place = rotated(vec2(hit.x, y), cosine, -sine);
    found.height = mix(height.x, height.y, (hit.x - start.x) / (end.x - start.x));
#ifdef FINISH
    if hit.hit {
        let share = finished(line, layer, jump, (hit.x - start.x) / (end.x - start.x));
        let met = mix(line.start, line.end, share);
        found.place = met.xy;
        found.height = met.z;
    }
#endif
    return found;
}
