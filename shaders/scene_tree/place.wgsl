#define TREE_WRITABLE
// Puts the triangles that move where they are now.
#import bindings::scene::{indices, objects, vertices, world_position}
#import bindings::tree_data::{corners_at, list, run, set_corner}

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
