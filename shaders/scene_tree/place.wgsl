#define TREE_WRITABLE
// Puts the triangles that move where they are now.
#import bindings::scene::{indices, objects, vertices, world_position}
#import bindings::tree_data::{corners_at, set_corner}

struct Run {
    // Entries of the list, from `first` on.
    first: u32,
    count: u32,
    pad_a: u32,
    pad_b: u32,
}
@group(0) @binding(0) var<uniform> run: Run;
// Places in the leaves' order.
@group(0) @binding(1) var<storage, read> list: array<u32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= run.count {
        return;
    }
    let slot = list[run.first + id.x];
    let before = corners_at(slot);
    let object = objects[before.object];
    let start = object.first_index + 3u * before.triangle;
    for (var i = 0u; i < 3u; i += 1u) {
        let vertex = vertices[indices[start + i]];
        set_corner(slot, i, world_position(object, vertex.position));
    }
}
