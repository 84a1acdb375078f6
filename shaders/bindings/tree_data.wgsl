// The tree over all triangles of the scene, in world space, as it lies in buffers.
// Rust twin: stages/scene_tree.rs.
#define_import_path bindings::tree_data

#ifdef TREE_WIDE
// Eight boxes in steps from a corner (Ylitie et al. 2017, Fig. 2, as obvhs lays it out).
// Rust twin: geometry/wide_tree.rs.
struct Node {
    low: vec3<f32>,
    // Exponent of the step along each axis, a byte each; then which of the eight are nodes.
    steps: u32,
    first_node: u32,
    first_triangle: u32,
    // A byte for each of the eight: its place among nodes, or its triangles; 0 where there is none.
    kinds: vec2<u32>,
    // Where each of the eight begins and, in the last two words, where it ends: a byte each.
    x: vec4<u32>,
    y: vec4<u32>,
    z: vec4<u32>,
}
#else
struct Node {
    low: vec3<f32>,
    // Triangles of a leaf; 0 in the inside of the tree.
    count: u32,
    high: vec3<f32>,
    // First triangle of a leaf; first of two children.
    first: u32,
}
#endif

// With `TREE_PARTS` every array is cut into four buffers, each below what a binding may hold. Passes
// that fit the tree to what has moved see it `TREE_WRITABLE`.
#ifdef TREE_PARTS
#ifdef TREE_WRITABLE
@group(0) @binding(40) var<storage, read_write> nodes_a: array<Node>;
@group(0) @binding(41) var<storage, read_write> nodes_b: array<Node>;
@group(0) @binding(42) var<storage, read_write> nodes_c: array<Node>;
@group(0) @binding(43) var<storage, read_write> nodes_d: array<Node>;
@group(0) @binding(44) var<storage, read_write> corners_a: array<vec4<u32>>;
@group(0) @binding(45) var<storage, read_write> corners_b: array<vec4<u32>>;
@group(0) @binding(46) var<storage, read_write> corners_c: array<vec4<u32>>;
@group(0) @binding(47) var<storage, read_write> corners_d: array<vec4<u32>>;
#else
@group(0) @binding(40) var<storage, read> nodes_a: array<Node>;
@group(0) @binding(41) var<storage, read> nodes_b: array<Node>;
@group(0) @binding(42) var<storage, read> nodes_c: array<Node>;
@group(0) @binding(43) var<storage, read> nodes_d: array<Node>;
@group(0) @binding(44) var<storage, read> corners_a: array<vec4<u32>>;
@group(0) @binding(45) var<storage, read> corners_b: array<vec4<u32>>;
@group(0) @binding(46) var<storage, read> corners_c: array<vec4<u32>>;
@group(0) @binding(47) var<storage, read> corners_d: array<vec4<u32>>;
#endif
#else
#ifdef TREE_WRITABLE
@group(0) @binding(40) var<storage, read_write> nodes_a: array<Node>;
@group(0) @binding(44) var<storage, read_write> corners_a: array<vec4<u32>>;
#else
@group(0) @binding(40) var<storage, read> nodes_a: array<Node>;
@group(0) @binding(44) var<storage, read> corners_a: array<vec4<u32>>;
#endif
#endif

fn node_at(index: u32) -> Node {
#ifdef TREE_PARTS
    let place = index % #{NODES_OF_PART}u;
    switch index / #{NODES_OF_PART}u {
        case 0u: { return nodes_a[place]; }
        case 1u: { return nodes_b[place]; }
        case 2u: { return nodes_c[place]; }
        default: { return nodes_d[place]; }
    }
#else
    return nodes_a[index];
#endif
}

// The triangle in a place of the leaves' order.
struct Corners {
    first: vec3<f32>,
    second: vec3<f32>,
    third: vec3<f32>,
    object: u32,
    // Its number in the object's mesh.
    triangle: u32,
}

// From its words: each corner's coordinates, and a fourth for object, triangle and nothing.
fn unpacked(a: vec4<u32>, b: vec4<u32>, c: vec4<u32>) -> Corners {
    let first = bitcast<vec3<f32>>(a.xyz);
    let second = bitcast<vec3<f32>>(b.xyz);
    return Corners(first, second, bitcast<vec3<f32>>(c.xyz), a.w, b.w);
}

fn corners_at(slot: u32) -> Corners {
#ifdef TREE_PARTS
    let i = 3u * (slot % #{SLOTS_OF_PART}u);
    switch slot / #{SLOTS_OF_PART}u {
        case 0u: { return unpacked(corners_a[i], corners_a[i + 1u], corners_a[i + 2u]); }
        case 1u: { return unpacked(corners_b[i], corners_b[i + 1u], corners_b[i + 2u]); }
        case 2u: { return unpacked(corners_c[i], corners_c[i + 1u], corners_c[i + 2u]); }
        default: { return unpacked(corners_d[i], corners_d[i + 1u], corners_d[i + 2u]); }
    }
#else
    let i = 3u * slot;
    return unpacked(corners_a[i], corners_a[i + 1u], corners_a[i + 2u]);
#endif
}

#ifdef TREE_WRITABLE
// What a pass that fits the tree works on: entries of the list, from `first` on.
struct Run {
    first: u32,
    count: u32,
    pad_a: u32,
    pad_b: u32,
}
@group(0) @binding(0) var<uniform> run: Run;
// Places in the leaves' order, then nodes.
@group(0) @binding(1) var<storage, read> list: array<u32>;

fn set_node(index: u32, node: Node) {
#ifdef TREE_PARTS
    let place = index % #{NODES_OF_PART}u;
    switch index / #{NODES_OF_PART}u {
        case 0u: { nodes_a[place] = node; }
        case 1u: { nodes_b[place] = node; }
        case 2u: { nodes_c[place] = node; }
        default: { nodes_d[place] = node; }
    }
#else
    nodes_a[index] = node;
#endif
}

// Moves one corner, from 0 to 2.
fn set_corner(slot: u32, corner: u32, position: vec3<f32>) {
    let words = bitcast<vec3<u32>>(position);
#ifdef TREE_PARTS
    let i = 3u * (slot % #{SLOTS_OF_PART}u) + corner;
    switch slot / #{SLOTS_OF_PART}u {
        case 0u: { corners_a[i] = vec4(words, corners_a[i].w); }
        case 1u: { corners_b[i] = vec4(words, corners_b[i].w); }
        case 2u: { corners_c[i] = vec4(words, corners_c[i].w); }
        default: { corners_d[i] = vec4(words, corners_d[i].w); }
    }
#else
    let i = 3u * slot + corner;
    corners_a[i] = vec4(words, corners_a[i].w);
#endif
}
#endif
