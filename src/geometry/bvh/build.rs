//! From the binary tree obvhs builds to nodes of eight and packs of four.

use glam::Vec3;
use obvhs::bvh2::Bvh2;

use super::Bvh;
use super::node::{Child, Node, WIDTH};
use super::pack::{LANES, Pack};

/// Folds a binary tree over `triangles`, with at most [`LANES`] of them in a leaf.
pub(super) fn fold(tree: &Bvh2, triangles: &[[Vec3; 3]]) -> Bvh {
    let mut counts = vec![0; tree.nodes.len()];
    count(tree, 0, &mut counts);
    let bvh = Bvh { nodes: Vec::new(), packs: Vec::new(), stack: 0 };
    let mut fold = Fold { tree, triangles, counts, bvh };
    fold.bvh.stack = fold.node(0).1;
    fold.bvh
}

/// Sets the number of triangles below `index` and every node under it.
fn count(tree: &Bvh2, index: usize, counts: &mut [u32]) -> u32 {
    let node = &tree.nodes[index];
    let first = node.first_index as usize;
    counts[index] = match node.prim_count {
        0 => count(tree, first, counts) + count(tree, first + 1, counts),
        triangles => triangles,
    };
    counts[index]
}

struct Fold<'a> {
    tree: &'a Bvh2,
    triangles: &'a [[Vec3; 3]],
    /// Triangles below each node of the binary tree.
    counts: Vec<u32>,
    bvh: Bvh,
}

impl Fold<'_> {
    /// Whether what lies below a node of the binary tree fits in a pack.
    fn is_leaf(&self, index: usize) -> bool {
        self.counts[index] as usize <= LANES
    }

    /// Appends the node for one of the binary tree; returns its place and how many visits can be
    /// waiting at once while a ray is below it.
    fn node(&mut self, index: usize) -> (usize, usize) {
        let place = self.bvh.nodes.len();
        self.bvh.nodes.push(Node::EMPTY);
        let below = self.children(index);
        let mut waiting = 0;
        for (slot, &index) in below.iter().enumerate() {
            let child = if self.is_leaf(index) {
                self.pack(index)
            } else {
                let (place, deeper) = self.node(index);
                waiting = waiting.max(deeper);
                Child::node(place)
            };
            let bounds = self.tree.nodes[index].aabb();
            let (low, high) = (bounds.min.to_array(), bounds.max.to_array());
            self.bvh.nodes[place].set(slot, low, high, child);
        }
        (place, waiting + below.len() - 1)
    }

    /// The nodes of the binary tree that become the children: the one with the largest surface,
    /// which most rays meet, is replaced by its own two until there are eight or all are leaves.
    fn children(&self, index: usize) -> Vec<usize> {
        let mut open = vec![index];
        while open.len() < WIDTH {
            let area = |&index: &usize| self.tree.nodes[index].aabb().half_area();
            let inner = (0..open.len()).filter(|&slot| !self.is_leaf(open[slot]));
            let Some(slot) = inner.max_by(|&a, &b| area(&open[a]).total_cmp(&area(&open[b])))
            else {
                break;
            };
            let first = self.tree.nodes[open[slot]].first_index as usize;
            open[slot] = first;
            open.push(first + 1);
        }
        open
    }

    /// Appends the pack of all triangles below a node of the binary tree.
    fn pack(&mut self, index: usize) -> Child {
        let mut indices = Vec::with_capacity(LANES);
        self.gather(index, &mut indices);
        self.bvh.packs.push(Pack::new(self.triangles, &indices));
        Child::pack(self.bvh.packs.len() - 1)
    }

    fn gather(&self, index: usize, indices: &mut Vec<u32>) {
        let node = &self.tree.nodes[index];
        let first = node.first_index as usize;
        if node.is_leaf() {
            let end = first + node.prim_count as usize;
            indices.extend(&self.tree.primitive_indices[first..end]);
        } else {
            self.gather(first, indices);
            self.gather(first + 1, indices);
        }
    }
}
