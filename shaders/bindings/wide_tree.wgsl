// Rays through the compressed wide tree over all triangles of the scene (Ylitie, Karras & Laine 2017).
// Rust twin: geometry/bvh.rs for what is met; geometry/wide_tree.rs for the nodes.
#define_import_path bindings::wide_tree

#import bindings::rays::{FAR, RayHit, Start, inverse_of, ray_work}
#import bindings::tree_data::{Node, node_at}
#import bindings::triangle::with_triangle

// Nodes on the way down from the root, at most; the host checks.
const WIDE_DEEPEST: u32 = 32u;
// Groups of nodes still to be visited, at most one a depth: the first child of a node; in the highest
// byte those met, the nearest octant highest, and in the lowest which of the children are nodes.
var<private> open_groups: array<vec2<u32>, WIDE_DEEPEST>;

const NODES_MET: u32 = 0xff000000u;
const TRIANGLES_MET: u32 = 0x00ffffffu;

struct WideRay {
    origin: vec3<f32>,
    inverse: vec3<f32>,
    backward: vec3<bool>,
    // What turns a child's place into its turn, four times over: 7 less the ray's octant.
    turns: u32,
}

// The four bytes of a word, the lowest first; WGSL's own would ask the device for 8-bit integers.
fn bytes_of(word: u32) -> vec4<u32> {
    return (vec4(word) >> vec4(0u, 8u, 16u, 24u)) & vec4(255u);
}

// Where four boxes begin and end along one axis, in bytes.
struct Sides {
    near: vec4<f32>,
    far: vec4<f32>,
}

fn sides(low: u32, high: u32, backward: bool) -> Sides {
    let near = bytes_of(select(low, high, backward));
    let far = bytes_of(select(high, low, backward));
    return Sides(vec4<f32>(near), vec4<f32>(far));
}

// Of four children the nodes met, in the highest byte by their turn, and the triangles of the leaves
// met, by their place. Follows the paper's Algorithm 2, four bytes at once.
fn met_of(
    kinds: u32,
    x: Sides,
    y: Sides,
    z: Sides,
    scale: vec3<f32>,
    begin: vec3<f32>,
    end: vec3<f32>,
    turns: u32,
    distance: f32,
) -> u32 {
    let near_x = x.near * scale.x + begin.x;
    let near_y = y.near * scale.y + begin.y;
    let near_z = z.near * scale.z + begin.z;
    let far_x = x.far * scale.x + end.x;
    let far_y = y.far * scale.y + end.y;
    let far_z = z.far * scale.z + end.z;
    let near = max(max(near_x, near_y), max(near_z, vec4(0.0)));
    let far = min(min(far_x, far_y), min(far_z, vec4(distance)));
    // Only nodes have both bits.
    let inner = ((kinds & (kinds << 1u)) & 0x10101010u) >> 4u;
    let places = (kinds ^ (turns & (inner * 0xffu))) & 0x1f1f1f1fu;
    let bits = bytes_of((kinds >> 5u) & 0x07070707u) << bytes_of(places);
    let met = select(vec4(0u), bits, near <= far);
    return met.x | met.y | met.z | met.w;
}

// Which of the eight children a ray meets nearer than `distance`.
fn met_in(node: Node, ray: WideRay, distance: f32) -> u32 {
    let exponents = bytes_of(node.steps).xyz;
    let scale = bitcast<vec3<f32>>(exponents << vec3(23u)) * ray.inverse;
    let start = (node.low - ray.origin) * ray.inverse;
    // Boxes are drawn out by a few roundings of the largest number on the way, so that no ray slips
    // between those that touch (Ize 2013).
    let slack = 5.0e-7 * (abs(start) + 255.0 * abs(scale));
    let begin = start - slack;
    let end = start + slack;
    let x_a = sides(node.x.x, node.x.z, ray.backward.x);
    let y_a = sides(node.y.x, node.y.z, ray.backward.y);
    let z_a = sides(node.z.x, node.z.z, ray.backward.z);
    let x_b = sides(node.x.y, node.x.w, ray.backward.x);
    let y_b = sides(node.y.y, node.y.w, ray.backward.y);
    let z_b = sides(node.z.y, node.z.w, ray.backward.z);
    return met_of(node.kinds.x, x_a, y_a, z_a, scale, begin, end, ray.turns, distance)
        | met_of(node.kinds.y, x_b, y_b, z_b, scale, begin, end, ray.turns, distance);
}

// The nearest triangle a ray meets. The direction has unit length.
fn trace(origin: vec3<f32>, direction: vec3<f32>, start: Start) -> RayHit {
    var nearest = RayHit(FAR, 0u, 0u, vec2(0.0), false);
    let backward = direction < vec3(0.0);
    let octant = select(vec3(0x04040404u, 0x02020202u, 0x01010101u), vec3(0u), backward);
    let ray = WideRay(origin, inverse_of(direction), backward, octant.x | octant.y | octant.z);
    ray_work.rays += 1u;
    // The root alone.
    var group = vec2(0u, 0x80000000u);
    var open = 0u;
    loop {
        // Of the group the node whose turn is next; the others wait.
        let turn = firstLeadingBit(group.y);
        let place = (turn - 24u) ^ (ray.turns & 7u);
        let before = countOneBits(group.y & ((1u << place) - 1u));
        let node = node_at(group.x + before);
        group.y &= ~(1u << turn);
        if (group.y & NODES_MET) != 0u {
            open_groups[open] = group;
            open += 1u;
        }
        ray_work.nodes += 1u;
        let met = met_in(node, ray, nearest.distance);
        var triangles = met & TRIANGLES_MET;
        ray_work.triangles += countOneBits(triangles);
        while triangles != 0u {
            let slot = firstTrailingBit(triangles);
            triangles &= triangles - 1u;
            nearest = with_triangle(nearest, node.first_triangle + slot, origin, direction, start);
        }
        group = vec2(node.first_node, (met & NODES_MET) | (node.steps >> 24u));
        if (met & NODES_MET) == 0u {
            if open == 0u {
                return nearest;
            }
            open -= 1u;
            group = open_groups[open];
        }
    }
    return nearest;
}
