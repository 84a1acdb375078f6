//! A binary tree of boxes over triangles, laid out as a GPU reads it: built by obvhs, and what of
//! it to fit again when some triangles move.

use std::time::Duration;

use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use obvhs::BvhBuildParams;
use obvhs::bvh2::builder::build_bvh2_from_tris;
use obvhs::triangle::Triangle;

/// A box with two children, `first` and `first + 1`, or with `count` triangles from `first` on.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Node {
    pub low: [f32; 3],
    /// Triangles of a leaf; 0 in the inside of the tree.
    pub count: u32,
    pub high: [f32; 3],
    pub first: u32,
}

/// A tree; the root is the first node. One without triangles has a root nothing can meet.
#[derive(Clone, Debug)]
pub struct Tree {
    pub nodes: Vec<Node>,
    /// The caller's index of each triangle in the order of the leaves.
    pub order: Vec<u32>,
    /// Nodes on the way from the root to the deepest leaf, both included.
    pub depth: u32,
}

/// No ray meets it, whatever its children.
const NOTHING: Node = Node { low: [f32::MAX; 3], count: 0, high: [f32::MIN; 3], first: 0 };

impl Tree {
    /// Most nodes a tree over so many triangles has.
    pub fn most_nodes(triangles: usize) -> usize {
        (2 * triangles).max(1)
    }

    /// Build over `triangles`, corners in any one space; corners must be finite.
    pub fn new(triangles: &[[Vec3; 3]]) -> Tree {
        if triangles.is_empty() {
            return Tree { nodes: vec![NOTHING], order: Vec::new(), depth: 1 };
        }
        let (list, mut build_time) = (obvhs_triangles(triangles), Duration::ZERO);
        let tree = build_bvh2_from_tris(&list, BvhBuildParams::medium_build(), &mut build_time);
        let nodes: Vec<Node> = tree
            .nodes
            .iter()
            .map(|node| Node {
                low: node.aabb().min.to_array(),
                count: node.prim_count,
                high: node.aabb().max.to_array(),
                first: node.first_index,
            })
            .collect();
        let depth = parents(&nodes).iter().map(|(_, depth)| depth + 1).max().unwrap_or(1);
        Tree { nodes, order: tree.primitive_indices, depth }
    }

    /// The nodes whose boxes hold any of the triangles for which `moves` (by the caller's index),
    /// deepest first, each depth apart: to fit again in that order.
    pub fn touched(&self, moves: impl Fn(u32) -> bool) -> Vec<Vec<u32>> {
        let parents = parents(&self.nodes);
        let mut touched = vec![false; self.nodes.len()];
        for (index, node) in self.nodes.iter().enumerate() {
            let slots = node.first as usize..(node.first + node.count) as usize;
            if node.count == 0 || !self.order[slots].iter().any(|&triangle| moves(triangle)) {
                continue;
            }
            let mut at = index;
            while !touched[at] {
                touched[at] = true;
                at = parents[at].0 as usize;
            }
        }
        let mut levels = vec![Vec::new(); self.depth as usize];
        for (index, _) in touched.iter().enumerate().filter(|(_, touched)| **touched) {
            levels[(self.depth - 1 - parents[index].1) as usize].push(index as u32);
        }
        levels.retain(|level| !level.is_empty());
        levels
    }
}

/// Triangles as obvhs takes them.
pub(super) fn obvhs_triangles(triangles: &[[Vec3; 3]]) -> Vec<Triangle> {
    let triangle =
        |&[v0, v1, v2]: &[Vec3; 3]| Triangle { v0: v0.into(), v1: v1.into(), v2: v2.into() };
    triangles.iter().map(triangle).collect()
}

/// Small triangles strewn over a cube, to build trees over.
#[cfg(test)]
pub(super) fn strewn(n: u32) -> Vec<[Vec3; 3]> {
    let place = |k: u32| {
        let s = k as f32;
        Vec3::new((s * 0.37).fract(), (s * 0.71).fract(), (s * 0.13).fract())
    };
    (0..n).map(|k| [place(k), place(k) + 0.02 * Vec3::X, place(k) + 0.03 * Vec3::Y]).collect()
}

/// Parent and depth of every node; the root is its own parent.
fn parents(nodes: &[Node]) -> Vec<(u32, u32)> {
    let mut parents = vec![(0, 0); nodes.len()];
    let mut open = vec![0u32];
    while let Some(index) = open.pop() {
        let node = &nodes[index as usize];
        let inner = node.count == 0 && node.first > 0;
        let children = if inner { node.first..node.first + 2 } else { 0..0 };
        for child in children {
            parents[child as usize] = (index, parents[index as usize].1 + 1);
            open.push(child);
        }
    }
    parents
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The box of everything below a node, by its triangles.
    fn fitted(tree: &Tree, triangles: &[[Vec3; 3]], index: u32) -> [Vec3; 2] {
        let node = &tree.nodes[index as usize];
        let join = |[a, b]: [Vec3; 2], [c, d]: [Vec3; 2]| [a.min(c), b.max(d)];
        let empty = [Vec3::INFINITY, Vec3::NEG_INFINITY];
        if node.count == 0 {
            let below = [node.first, node.first + 1].map(|child| fitted(tree, triangles, child));
            return join(below[0], below[1]);
        }
        let slots = node.first as usize..(node.first + node.count) as usize;
        let corners = tree.order[slots].iter().flat_map(|&t| triangles[t as usize]);
        corners.fold(empty, |bounds, corner| join(bounds, [corner, corner]))
    }

    #[test]
    fn boxes_hold_their_triangles_and_every_triangle_has_one_leaf() {
        let triangles = strewn(500);
        let tree = Tree::new(&triangles);
        let mut seen = vec![0; triangles.len()];
        for (index, node) in tree.nodes.iter().enumerate() {
            let [low, high] = fitted(&tree, &triangles, index as u32);
            assert!(low.cmpge(Vec3::from(node.low) - 1e-6).all());
            assert!(high.cmple(Vec3::from(node.high) + 1e-6).all());
            for slot in node.first..node.first + node.count {
                seen[tree.order[slot as usize] as usize] += 1;
            }
        }
        assert!(seen.iter().all(|&n| n == 1));
        assert!(tree.nodes.len() <= Tree::most_nodes(triangles.len()));
        assert!((9..40).contains(&tree.depth), "{} deep", tree.depth);
    }

    #[test]
    fn touched_nodes_are_all_above_what_moves_children_first() {
        let mut triangles = strewn(300);
        let mut tree = Tree::new(&triangles);
        let moves = |triangle: u32| triangle.is_multiple_of(50);
        let levels = tree.touched(moves);
        assert_eq!(levels.last(), Some(&vec![0]), "the root comes last");
        for (index, corners) in triangles.iter_mut().enumerate() {
            if moves(index as u32) {
                *corners = corners.map(|corner| corner + Vec3::splat(0.7));
            }
        }
        for &index in levels.iter().flatten() {
            let node = tree.nodes[index as usize];
            let [low, high] = if node.count > 0 {
                fitted(&tree, &triangles, index)
            } else {
                // From the children alone: they must have been fitted before.
                let below = [node.first, node.first + 1].map(|child| tree.nodes[child as usize]);
                let low = below.map(|n| Vec3::from(n.low));
                let high = below.map(|n| Vec3::from(n.high));
                [low[0].min(low[1]), high[0].max(high[1])]
            };
            let (low, high) = (low.to_array(), high.to_array());
            tree.nodes[index as usize] = Node { low, high, ..node };
        }
        for (index, node) in tree.nodes.iter().enumerate() {
            let [low, high] = fitted(&tree, &triangles, index as u32);
            assert!(low.cmpge(Vec3::from(node.low) - 1e-6).all());
            assert!(high.cmple(Vec3::from(node.high) + 1e-6).all());
        }
    }

    #[test]
    fn trees_of_nothing_and_of_one_triangle_are_trees() {
        let none = Tree::new(&[]);
        assert_eq!((none.nodes.len(), none.depth), (1, 1));
        assert!(none.touched(|_| true).is_empty());
        let one = Tree::new(&strewn(1));
        assert_eq!((one.nodes[0].count, one.order.as_slice()), (1, [0].as_slice()));
        assert_eq!(one.touched(|_| true), [[0]]);
    }
}
