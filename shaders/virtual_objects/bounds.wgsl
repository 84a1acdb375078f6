// The pyramid of bounds over one reflector's patches: of each cell a ball that holds its points and a cone
// that holds its normals. Level 0 are the patches, each from a texel's centre to the next ones'.
//
// Both hold all of a patch, not its corners alone: between them points are sums of the corners' with
// weights that are not negative and add up to 1, so they lie in any ball that holds the corners; normals
// point along such sums of the corners' normals, so they lie in any cone narrower than a half-space that
// holds those, as it is convex. A patch without a neighbour goes on for a texel beyond the side; on that
// rectangle, too, it is bilinear, with corners of its own.
#import virtual_objects::reflector::{mirror_normal, mirror_position}

struct Level {
    // 0: the patches.
    level: i32,
    pad_a: i32,
    pad_b: i32,
    pad_c: i32,
}
@group(0) @binding(3) var<uniform> at: Level;
@group(0) @binding(4) var balls_below: texture_2d<f32>;
@group(0) @binding(5) var cones_below: texture_2d<f32>;
@group(0) @binding(6) var balls: texture_storage_2d<rgba32float, write>;
@group(0) @binding(7) var cones: texture_storage_2d<rgba32float, write>;

// Cosine between a patch's edge and the normals at its ends, both taken together, and between those: beyond,
// the edge leads from one part of the reflector to another behind it, or over a crease. Along an arc the
// former is 0.
const LEAP: f32 = 0.2;
const CREASE: f32 = 0.5;
// For rounding, in proportion and in metres or radians.
const SLACK: f32 = 1e-5;
// The sine of a cone that holds all directions.
const ANY: f32 = 2.0;

fn is_joined(a: vec2<i32>, b: vec2<i32>) -> bool {
    let n_a = textureLoad(mirror_normal, a, 0).xyz;
    let n_b = textureLoad(mirror_normal, b, 0).xyz;
    let edge = textureLoad(mirror_position, b, 0).xyz - textureLoad(mirror_position, a, 0).xyz;
    return abs(dot(n_a + n_b, edge)) <= LEAP * length(edge) && dot(n_a, n_b) > CREASE;
}

// Whether the four texels from this one on are one piece of the reflector.
fn is_piece(corner: vec2<i32>) -> bool {
    let size = vec2<i32>(textureDimensions(mirror_position));
    if any(corner < vec2(0)) || any(corner + 1 >= size) {
        return false;
    }
    let x = corner + vec2(1, 0);
    let y = corner + vec2(0, 1);
    let shown = textureLoad(mirror_position, corner, 0).w * textureLoad(mirror_position, x, 0).w
        * textureLoad(mirror_position, y, 0).w * textureLoad(mirror_position, corner + 1, 0).w;
    return shown == 1.0 && is_joined(corner, x) && is_joined(corner, y)
        && is_joined(x, corner + 1) && is_joined(y, corner + 1);
}

fn bilinear(image: texture_2d<f32>, corner: vec2<i32>, f: vec2<f32>) -> vec3<f32> {
    let low = mix(textureLoad(image, corner, 0).xyz, textureLoad(image, corner + vec2(1, 0), 0).xyz, f.x);
    let high = mix(
        textureLoad(image, corner + vec2(0, 1), 0).xyz, textureLoad(image, corner + 1, 0).xyz, f.x
    );
    return mix(low, high, f.y);
}

struct Bounds {
    // Radius below 0: nothing.
    ball: vec4<f32>,
    // The fourth is the sine of half the opening.
    cone: vec4<f32>,
}

fn of_patch(corner: vec2<i32>) -> Bounds {
    var out = Bounds(vec4(0.0, 0.0, 0.0, -1.0), vec4(0.0));
    if !is_piece(corner) {
        return out;
    }
    // Where it ends.
    var ends = array(vec2(0.0), vec2(1.0));
    for (var i = 0; i < 4; i += 1) {
        let axis = vec2(1 - i / 2, i / 2);
        let side = 2 * (i % 2) - 1;
        if !is_piece(corner + side * axis) {
            ends[i % 2] += f32(side) * vec2<f32>(axis);
        }
    }
    var points: array<vec3<f32>, 4>;
    var normals: array<vec3<f32>, 4>;
    for (var i = 0; i < 4; i += 1) {
        let f = vec2(ends[i % 2].x, ends[i / 2].y);
        points[i] = bilinear(mirror_position, corner, f);
        normals[i] = normalize(bilinear(mirror_normal, corner, f));
    }
    let centre = 0.25 * (points[0] + points[1] + points[2] + points[3]);
    let axis = normalize(normals[0] + normals[1] + normals[2] + normals[3]);
    var radius = 0.0;
    var sine = 0.0;
    for (var i = 0; i < 4; i += 1) {
        radius = max(radius, distance(points[i], centre));
        sine = select(max(sine, length(cross(axis, normals[i]))), ANY, dot(axis, normals[i]) <= 0.0);
    }
    return Bounds(vec4(centre, radius), vec4(axis, sine));
}

// Of four cells of the level below.
fn of_cells(first: vec2<i32>, level: i32) -> Bounds {
    var centre = vec3(0.0);
    var axis = vec3(0.0);
    var present = 0.0;
    for (var i = 0; i < 4; i += 1) {
        let ball = textureLoad(balls_below, first + vec2(i % 2, i / 2), level);
        if ball.w >= 0.0 {
            centre += ball.xyz;
            axis += textureLoad(cones_below, first + vec2(i % 2, i / 2), level).xyz;
            present += 1.0;
        }
    }
    if present == 0.0 {
        return Bounds(vec4(0.0, 0.0, 0.0, -1.0), vec4(0.0));
    }
    centre /= present;
    axis = normalize(axis);
    var radius = 0.0;
    var sine = 0.0;
    for (var i = 0; i < 4; i += 1) {
        let ball = textureLoad(balls_below, first + vec2(i % 2, i / 2), level);
        if ball.w >= 0.0 {
            radius = max(radius, distance(ball.xyz, centre) + ball.w);
            let cone = textureLoad(cones_below, first + vec2(i % 2, i / 2), level);
            // From the new axis to the far side of the cone.
            let turned = length(cross(axis, cone.xyz));
            let cosines = vec2(dot(axis, cone.xyz), sqrt(max(1.0 - cone.w * cone.w, 0.0)));
            let is_wide = cone.w >= 1.0 || cosines.x * cosines.y <= turned * cone.w;
            sine = max(sine, select(turned * cosines.y + cosines.x * cone.w, ANY, is_wide));
        }
    }
    return Bounds(vec4(centre, radius), vec4(axis, sine));
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= textureDimensions(balls)) {
        return;
    }
    var bounds: Bounds;
    if at.level == 0 {
        bounds = of_patch(vec2<i32>(id.xy));
    } else {
        bounds = of_cells(vec2<i32>(2u * id.xy), at.level - 1);
    }
    if bounds.ball.w >= 0.0 {
        bounds.ball.w += SLACK * (bounds.ball.w + 0.1 * length(bounds.ball.xyz));
        bounds.cone.w += SLACK;
    }
    textureStore(balls, id.xy, bounds.ball);
    textureStore(cones, id.xy, bounds.cone);
}
