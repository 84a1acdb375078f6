// Rotated depth maps (Popescu et al. 2006, slide 37: "pre-rotate depth map"), eight samples an invocation.
// Rust twin: geometry/depth_rows.rs.
#import depth_impostors::build::build

@group(0) @binding(1) var<storage, read> quads: array<vec2<u32>>;
// Rows of the pass's maps; eight heights of 16 bits each a word of four.
@group(0) @binding(2) var<storage, read_write> samples: array<vec4<u32>>;

const PI: f32 = 3.14159265358979;

// Between four texels of one surface; that of the nearest at a silhouette.
fn height(place: vec2<f32>) -> f32 {
    let low = floor(place - 0.5);
    let part = place - 0.5 - low;
    let last = f32(build.size) - 1.0;
    let corner = vec2<u32>(clamp(low, vec2(0.0), vec2(last)));
    let quad = quads[(build.layer * build.size + corner.y) * build.size + corner.x];
    let top = unpack2x16unorm(quad.x);
    let bottom = unpack2x16unorm(quad.y);
    let least = min(min(top.x, top.y), min(bottom.x, bottom.y));
    let most = max(max(top.x, top.y), max(bottom.x, bottom.y));
    let one = least > 0.0 && most - least <= build.jump;
    let weight = select(select(vec2(0.0), vec2(1.0), part >= vec2(0.5)), part, one);
    let pair = mix(top, bottom, weight.y);
    return mix(pair.x, pair.y, weight.x);
}

// Two samples of a row, packed; `at` is the first one's place, from the middle on.
fn pair(origin: vec2<f32>, along: vec2<f32>, across: f32, at: f32) -> u32 {
    let x = vec2(at, at + 1.0);
    let middle = 0.5 * f32(build.size);
    let heights = vec2(height(origin + x.x * along), height(origin + x.y * along));
    // Beyond the disc there is nothing.
    let inside = x * x + across * across <= vec2(middle * middle);
    return pack2x16unorm(select(vec2(0.0), heights, inside));
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let blocks = build.size / 8u;
    if id.x >= build.maps * build.size * blocks {
        return;
    }
    let block = id.x % blocks;
    let row = id.x / blocks % build.size;
    let angle = f32(build.first_map + id.x / (blocks * build.size)) * PI / f32(build.angles);
    let along = vec2(cos(angle), sin(angle));
    let middle = 0.5 * f32(build.size);
    let across = f32(row) + 0.5 - middle;
    let origin = middle + across * vec2(-along.y, along.x);
    let x = f32(8u * block) + 0.5 - middle;
    samples[id.x] = vec4(
        pair(origin, along, across, x),
        pair(origin, along, across, x + 2.0),
        pair(origin, along, across, x + 4.0),
        pair(origin, along, across, x + 6.0),
    );
}
