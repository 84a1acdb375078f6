//! A compressed wide tree of boxes over triangles (Ylitie, Karras & Laine 2017), laid out as a GPU
//! reads it: built by obvhs, never fitted again, as its boxes are cut to steps.

use std::time::Duration;

use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use obvhs::BvhBuildParams;
use obvhs::cwbvh::builder::build_cwbvh_from_tris;

use super::tree::obvhs_triangles;

/// A box with eight boxes in it; obvhs's `CwBvhNode` in the words that shaders see.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct WideNode {
    pub low: [f32; 3],
    /// Exponent of the step along each axis, a byte each; then which of the eight are nodes.
    pub steps: u32,
    pub first_node: u32,
    pub first_triangle: u32,
    /// A byte for each of the eight: its place among nodes, or its triangles; 0 where there is none.
    pub kinds: [u32; 2],
    /// Along each axis where each of the eight begins, then where it ends: a byte each.
    pub x: [u32; 4],
    pub y: [u32; 4],
    pub z: [u32; 4],
}

/// A tree; the root is the first node. One without triangles has a root with nothing in it.
#[derive(Clone, Debug)]
pub struct WideTree {
    pub nodes: Vec<WideNode>,
    /// The caller's index of each triangle in the order of the leaves.
    pub order: Vec<u32>,
    /// Nodes on the way from the root to the deepest one, both included.
    pub depth: u32,
}

impl WideTree {
    /// Most nodes a tree over so many triangles has: each but a lone root holds two things or more.
    pub fn most_nodes(triangles: usize) -> usize {
        triangles.max(1)
    }

    /// Build over `triangles`, corners in any one space; corners must be finite.
    pub fn new(triangles: &[[Vec3; 3]]) -> WideTree {
        if triangles.is_empty() {
            return WideTree { nodes: vec![WideNode::zeroed()], order: Vec::new(), depth: 1 };
        }
        let (list, mut build_time) = (obvhs_triangles(triangles), Duration::ZERO);
        let tree = build_cwbvh_from_tris(&list, BvhBuildParams::medium_build(), &mut build_time);
        let nodes: Vec<WideNode> = tree.nodes.iter().map(|node| bytemuck::cast(*node)).collect();
        WideTree { depth: depth(&nodes), nodes, order: tree.primitive_indices }
    }
}

/// Nodes down to the deepest one. Parents come before their children.
fn depth(nodes: &[WideNode]) -> u32 {
    let mut depths = vec![1; nodes.len()];
    for (index, node) in nodes.iter().enumerate() {
        let children = (node.steps >> 24).count_ones();
        for child in node.first_node..node.first_node + children {
            depths[child as usize] = depths[index] + 1;
        }
    }
    depths.into_iter().max().unwrap_or(1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::tree::strewn;

    /// Marks the triangles below a node, which must lie in `bounds`.
    fn visit(
        tree: &WideTree,
        triangles: &[[Vec3; 3]],
        (at, bounds): (u32, [Vec3; 2]),
        seen: &mut [u32],
    ) {
        let node = &tree.nodes[at as usize];
        let steps = node.steps.to_le_bytes();
        let mut next = node.first_node;
        for i in 0..8 {
            let kind = bytemuck::cast::<_, [u8; 8]>(node.kinds)[i];
            if kind == 0 {
                continue;
            }
            let plane = |axis: usize, side: usize| {
                let bytes: [u8; 16] = bytemuck::cast([node.x, node.y, node.z][axis]);
                let step = f32::from_bits(u32::from(steps[axis]) << 23);
                node.low[axis] + step * f32::from(bytes[8 * side + i])
            };
            let [low, high] =
                [0, 1].map(|side| Vec3::from([0, 1, 2].map(|axis| plane(axis, side))));
            let inside = [low.max(bounds[0]), high.min(bounds[1])];
            if steps[3] >> i & 1 == 1 {
                visit(tree, triangles, (next, inside), seen);
                next += 1;
                continue;
            }
            let first = node.first_triangle + u32::from(kind & 31);
            for slot in first..first + (kind >> 5).count_ones() {
                let triangle = tree.order[slot as usize] as usize;
                seen[triangle] += 1;
                for corner in triangles[triangle] {
                    assert!(corner.cmpge(inside[0] - 1e-6).all());
                    assert!(corner.cmple(inside[1] + 1e-6).all());
                }
            }
        }
    }

    #[test]
    fn boxes_hold_their_triangles_and_every_triangle_has_one_leaf() {
        let triangles = strewn(500);
        let tree = WideTree::new(&triangles);
        let mut seen = vec![0; triangles.len()];
        visit(&tree, &triangles, (0, [Vec3::NEG_INFINITY, Vec3::INFINITY]), &mut seen);
        assert!(seen.iter().all(|&n| n == 1));
        assert!(tree.nodes.len() <= WideTree::most_nodes(triangles.len()));
        assert!((3..10).contains(&tree.depth), "{} deep", tree.depth);
    }

    #[test]
    fn trees_of_nothing_and_of_one_triangle_are_trees() {
        let none = WideTree::new(&[]);
        assert_eq!((none.nodes[0].kinds, none.depth), ([0; 2], 1));
        let one = WideTree::new(&strewn(1));
        assert_eq!((one.nodes.len(), one.order.as_slice(), one.depth), (1, [0].as_slice(), 1));
    }
}
