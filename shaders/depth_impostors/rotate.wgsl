// Rotated depth maps (Popescu et al. 2006, slide 37: "pre-rotate depth map"), eight samples an invocation.
// Rust twin: geometry/depth_rows.rs.
#import depth_impostors::build::build

@group(0) @binding(1) var quads: texture_2d_array<u32>;
// The pass's maps, a layer each; eight heights of 16 bits a texel.
@group(0) @binding(2) var samples: texture_storage_2d_array<rgba32uint, write>;

const PI: f32 = 3.14159265358979;

// Heights in 65535ths, two of a word.
fn two(packed: u32) -> vec2<f32> {
    return vec2<f32>(vec2<i32>(vec2(packed & 0xffffu, packed >> 16u)));
}

// Between four texels of one surface; that of the nearest at a silhouette. In 65535ths.
fn height(place: vec2<f32>, jump: f32) -> f32 {
    let low = floor(place - 0.5);
    let part = place - 0.5 - low;
    let last = f32(build.size) - 1.0;
    let corner = vec2<i32>(clamp(low, vec2(0.0), vec2(last)));
    let quad = textureLoad(quads, corner, build.layer, 0);
    let top = two(quad.x);
    let bottom = two(quad.y);
    let least = min(min(top.x, top.y), min(bottom.x, bottom.y));
    let most = max(max(top.x, top.y), max(bottom.x, bottom.y));
    let one = least > 0.0 && most - least <= jump;
    let weight = select(select(vec2(0.0), vec2(1.0), part >= vec2(0.5)), part, one);
    let pair = mix(top, bottom, weight.y);
    return mix(pair.x, pair.y, weight.x);
}

// Two samples of a row, packed; `at` is the first one's place, from the middle on.
fn pair(origin: vec2<f32>, along: vec2<f32>, across: f32, at: f32) -> u32 {
    let x = vec2(at, at + 1.0);
    let middle = 0.5 * f32(build.size);
    let jump = 65535.0 * build.jump;
    let heights = vec2(height(origin + x.x * along, jump), height(origin + x.y * along, jump));
    // Beyond the disc there is nothing.
    let inside = x * x + across * across <= vec2(middle * middle);
    let words = vec2<i32>(select(vec2(0.0), heights + 0.5, inside));
    return u32(words.x | (words.y << 16u));
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= build.size / 8u || id.y >= build.maps * build.size {
        return;
    }
    let map = id.y / build.size;
    let row = id.y - map * build.size;
    let angle = f32(build.first_map + map) * PI / f32(build.angles);
    let along = vec2(cos(angle), sin(angle));
    let middle = 0.5 * f32(build.size);
    let across = f32(row) + 0.5 - middle;
    let origin = middle + across * vec2(-along.y, along.x);
    let x = f32(8u * id.x) + 0.5 - middle;
    let eight = vec4(
        pair(origin, along, across, x),
        pair(origin, along, across, x + 2.0),
        pair(origin, along, across, x + 4.0),
        pair(origin, along, across, x + 6.0),
    );
    textureStore(samples, vec2(id.x, row), map, eight);
}
