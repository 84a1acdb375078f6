// A generation of triangles of nodes: the scene's, or those halved in the one before.
#define_import_path virtual_objects::generation

#import virtual_objects::linked::{Linked, it, link, nodes}
#import virtual_objects::node::OWN

const GROUP: u32 = 64u;

struct Generation {
    groups_x: atomic<u32>,
    groups_y: u32,
    groups_z: u32,
    total: atomic<u32>,
    triangles: array<vec4<u32>>,
}
@group(0) @binding(9) var<storage, read_write> before: Generation;
@group(0) @binding(14) var<storage, read> source_indices: array<u32>;
// Six words a triangle, see `Linked`.
@group(0) @binding(15) var<storage, read_write> joined: array<u32>;

// Have a triangle at hand; false where there is none, or the reflector's own.
fn take(index: u32) -> bool {
    let total = select(link.triangles, atomicLoad(&before.total), link.generation > 0u);
    if index >= total {
        return false;
    }
    if link.generation > 0u {
        it.t = before.triangles[index];
    } else {
        let first = 3u * index;
        it.t = vec4(source_indices[first], source_indices[first + 1u], source_indices[first + 2u], index);
    }
    for (var i = 0u; i < 6u; i += 1u) {
        it.joined[i] = joined[6u * index + i];
    }
    return nodes[it.t.x].number != OWN;
}
