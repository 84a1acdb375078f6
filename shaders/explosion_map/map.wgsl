// The explosion map: the reflector's triangles where their corners' rays leave the sphere, each drawn with
// its number.
#import explosion_map::sphere::{Ray, Spheres, leaves, map_place}

@group(0) @binding(0) var<storage, read> spheres: Spheres;
@group(0) @binding(1) var<storage, read> rays: array<Ray>;
var<immediate> layer: u32;

struct Cell {
    @builtin(position) clip: vec4<f32>,
    @location(0) @interpolate(flat) triangle: u32,
}

// A hidden cell nearer to the singular direction than so many times its longest edge is left out, any other
// nearer than that edge: drawn straight, cells about that direction would lie across others.
const CLEARANCE: f32 = 4.0;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Cell {
    let triangle = index / 3u;
    let first = rays[3u * triangle];
    let second = rays[3u * triangle + 1u];
    let third = rays[3u * triangle + 2u];
    let a = leaves(spheres, layer, first);
    let b = leaves(spheres, layer, second);
    let c = leaves(spheres, layer, third);
    let longest = max(distance(a, b), max(distance(b, c), distance(c, a)));
    let opposite = -spheres.axis;
    let nearest = min(distance(a, opposite), min(distance(b, opposite), distance(c, opposite)));
    let is_hidden = first.away + second.away + third.away == 3u;
    if nearest < longest * select(1.0, CLEARANCE, is_hidden) {
        return Cell(vec4(2.0, 2.0, 0.0, 1.0), 0u);
    }
    var corners = array(a, b, c);
    let place = map_place(spheres, corners[index % 3u]);
    return Cell(vec4(2.0 * place / f32(spheres.side) - 1.0, 0.0, 1.0), triangle);
}

// 0 is left for where no triangle is.
@fragment
fn fragment(in: Cell) -> @location(0) u32 {
    return in.triangle + 1u;
}
