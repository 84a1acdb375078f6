//! From the binary tree obvhs builds to nodes of eight and packs of four.

use glam::Vec3;
use obvhs::bvh2::Bvh2;

use super::Bvh;
use super::node::{Child, Node, WIDTH};
use super::pack::{LANES, Pack};

/// Folds a binary tree over `triangles`, with at most [`LANES`] of them in a leaf.
pub(super) fn fold(tree: &Bvh2, triangles: &[[Vec3; 3]]) -> Bvh {
    let mut plans = vec![Plan::default(); tree.nodes.len()];
    plan(tree, 0, &mut plans);
    let bvh = Bvh { nodes: Vec::new(), packs: Vec::new() };
    let mut fold = Fold { tree, triangles, plans, bvh };
    fold.node(0);
    fold.bvh
}

/// How best to make what lies below a node of the binary tree into children of one wide node, when
/// those may be at most 1, 2, ... [`WIDTH`].
///
/// The best is what random rays meet least, each node or pack as often as its surface is large: the
/// optimal collapse of H. Ylitie, T. Karras & S. Laine, "Efficient incoherent ray traversal on GPUs
/// through compressed wide BVHs" (HPG 2017), section 3.1.
#[derive(Clone, Copy, Default)]
struct Plan {
    triangles: u32,
    /// Surface of all nodes and packs below.
    costs: [f32; WIDTH],
    /// How many of the children come from the left half; 0 where the node stays whole.
    left: [u8; WIDTH],
}

/// Sets the plans of `index` and every node under it.
fn plan(tree: &Bvh2, index: usize, plans: &mut [Plan]) {
    let node = &tree.nodes[index];
    let area = node.aabb().half_area();
    if node.is_leaf() {
        plans[index] = Plan { triangles: node.prim_count, costs: [area; WIDTH], left: [0; WIDTH] };
        return;
    }
    let first = node.first_index as usize;
    plan(tree, first, plans);
    plan(tree, first + 1, plans);
    let [a, b] = [plans[first], plans[first + 1]];
    let split = |children: usize| {
        let cost = |&left: &usize| a.costs[left - 1] + b.costs[children - left - 1];
        let left = (1..children).min_by(|x, y| cost(x).total_cmp(&cost(y))).expect("two or more");
        (cost(&left), left as u8)
    };
    let mut plan = Plan { triangles: a.triangles + b.triangles, ..Plan::default() };
    // A pack costs as much as a node.
    let below = if plan.is_pack() { 0.0 } else { split(WIDTH).0 };
    plan.costs[0] = area + below;
    for children in 2..=WIDTH {
        let whole = (plan.costs[0], 0);
        let halves = split(children);
        let best = if halves.0 <= whole.0 { halves } else { whole };
        (plan.costs[children - 1], plan.left[children - 1]) = best;
    }
    plans[index] = plan;
}

impl Plan {
    /// Whether everything below fits in a pack.
    fn is_pack(&self) -> bool {
        self.triangles as usize <= LANES
    }
}

struct Fold<'a> {
    tree: &'a Bvh2,
    triangles: &'a [[Vec3; 3]],
    /// For each node of the binary tree.
    plans: Vec<Plan>,
    bvh: Bvh,
}

impl Fold<'_> {
    /// Appends the node for one of the binary tree; returns its place.
    fn node(&mut self, index: usize) -> usize {
        let place = self.bvh.nodes.len();
        self.bvh.nodes.push(Node::EMPTY);
        let mut below = Vec::with_capacity(WIDTH);
        self.children(index, WIDTH, &mut below);
        for (slot, &index) in below.iter().enumerate() {
            let child = if self.plans[index].is_pack() {
                self.pack(index)
            } else {
                Child::node(self.node(index))
            };
            let bounds = self.tree.nodes[index].aabb();
            let (low, high) = (bounds.min.to_array(), bounds.max.to_array());
            self.bvh.nodes[place].set(slot, low, high, child);
        }
        place
    }

    /// Adds the nodes of the binary tree that become at most `count` children.
    fn children(&self, index: usize, count: usize, below: &mut Vec<usize>) {
        let left = usize::from(self.plans[index].left[count - 1]);
        if left == 0 {
            below.push(index);
            return;
        }
        let first = self.tree.nodes[index].first_index as usize;
        self.children(first, left, below);
        self.children(first + 1, count - left, below);
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
