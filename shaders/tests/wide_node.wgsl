#define TREE_WIDE
// Reads a node of the wide tree, for the test that holds its layout against the Rust twin.
#import bindings::tree_data::node_at

@group(0) @binding(0) var<storage, read_write> first: array<u32>;

@compute @workgroup_size(1)
fn main() {
    first[0] = node_at(0u).first_node;
}
