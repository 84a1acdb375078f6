#define TREE_WRITABLE
// Fits the boxes of one depth of the tree to what they hold; those below have been.
#import bindings::tree_data::{Node, corners_at, list, node_at, run, set_node}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= run.count {
        return;
    }
    let index = list[run.first + id.x];
    var node = node_at(index);
    if node.count == 0u {
        let left = node_at(node.first);
        let right = node_at(node.first + 1u);
        node.low = min(left.low, right.low);
        node.high = max(left.high, right.high);
    } else {
        node.low = vec3(3.0e38);
        node.high = vec3(-3.0e38);
        for (var i = 0u; i < node.count; i += 1u) {
            let corners = corners_at(node.first + i);
            node.low = min(node.low, min(corners.first, min(corners.second, corners.third)));
            node.high = max(node.high, max(corners.first, max(corners.second, corners.third)));
        }
    }
    set_node(index, node);
}
