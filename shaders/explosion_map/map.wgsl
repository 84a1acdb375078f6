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

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Cell {
    let triangle = index / 3u;
    let a = leaves(spheres, layer, rays[3u * triangle]);
    let b = leaves(spheres, layer, rays[3u * triangle + 1u]);
    let c = leaves(spheres, layer, rays[3u * triangle + 2u]);
    // About the singular direction a cell would be drawn across the whole map; there all is hidden.
    let longest = max(distance(a, b), max(distance(b, c), distance(c, a)));
    let opposite = -spheres.axis;
    let nearest = min(distance(a, opposite), min(distance(b, opposite), distance(c, opposite)));
    if nearest < longest {
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
