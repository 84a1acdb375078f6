//! From the binary tree obvhs builds to nodes of eight and leaves of packs of four.

use glam::Vec3;
use obvhs::bvh2::Bvh2;

use super::Bvh;
use super::node::{Child, LEAF_PACKS, Node, WIDTH};
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
/// The best is what random rays meet least, each node or leaf as often as its surface is large: the
/// optimal collapse of H. Ylitie, T. Karras & S. Laine, "Efficient incoherent ray traversal on GPUs
/// through compressed wide BVHs" (HPG 2017), section 3.1.
#[derive(Clone, Copy, Default)]
struct Plan {
    triangles: u32,
    /// Whether a single child is a leaf rather than a node.
    leaf: bool,
    /// Costs of all nodes and leaves below.
    costs: [f32; WIDTH],
    /// How many of the children come from the left half; 0 where a single child is best.
    left: [u8; WIDTH],
}

/// The cost of a leaf by that of a node with the same surface, if it may hold as many `triangles`.
///
/// The first pack costs as much as a node, both being waited for; the next lies beside it.
fn leaf_cost(triangles: u32) -> Option<f32> {
    let packs = triangles.div_ceil(LANES as u32);
    (packs <= LEAF_PACKS as u32).then(|| 1.0 + 0.3 * (packs - 1) as f32)
}

/// Sets the plans of `index` and every node under it.
fn plan(tree: &Bvh2, index: usize, plans: &mut [Plan]) {
    let node = &tree.nodes[index];
    let first = node.first_index as usize;
    let halves = (!node.is_leaf()).then(|| {
        plan(tree, first, plans);
        plan(tree, first + 1, plans);
        [plans[first], plans[first + 1]]
    });
    let triangles = halves.map_or(node.prim_count, |[a, b]| a.triangles + b.triangles);
    let area = node.aabb().half_area();
    plans[index] = match halves {
        Some(halves) if triangles as usize > LANES => Plan::of(halves, triangles, area),
        // One pack is never split: rays meet either half less, but more packs take more memory.
        _ => Plan { triangles, leaf: true, costs: [area; WIDTH], left: [0; WIDTH] },
    };
}

impl Plan {
    /// For the node of the binary tree with these two below.
    fn of([a, b]: [Plan; 2], triangles: u32, area: f32) -> Plan {
        let split = |children: usize| {
            let cost = |&left: &usize| a.costs[left - 1] + b.costs[children - left - 1];
            let best = (1..children).min_by(|x, y| cost(x).total_cmp(&cost(y)));
            let left = best.expect("two or more children");
            (cost(&left), left as u8)
        };
        let node = area + split(WIDTH).0;
        let leaf = leaf_cost(triangles).map(|cost| area * cost).filter(|&leaf| leaf <= node);
        let single = leaf.unwrap_or(node);
        let mut plan = Plan { triangles, leaf: leaf.is_some(), ..Plan::default() };
        plan.costs[0] = single;
        for children in 2..=WIDTH {
            let halves = split(children);
            let best = if halves.0 <= single { halves } else { (single, 0) };
            (plan.costs[children - 1], plan.left[children - 1]) = best;
        }
        plan
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
        for (slot, index) in self.children(index).into_iter().enumerate() {
            let child = if self.plans[index].leaf {
                self.leaf(index)
            } else {
                Child::node(self.node(index))
            };
            let bounds = self.tree.nodes[index].aabb();
            let (low, high) = (bounds.min.to_array(), bounds.max.to_array());
            self.bvh.nodes[place].set(slot, low, high, child);
        }
        place
    }

    /// The nodes of the binary tree that become the children of the node for `index`; a tree that
    /// is a leaf as a whole has itself for a child.
    fn children(&self, index: usize) -> Vec<usize> {
        let mut children = Vec::with_capacity(WIDTH);
        self.gather_children(index, WIDTH, &mut children);
        children
    }

    fn gather_children(&self, index: usize, count: usize, children: &mut Vec<usize>) {
        let left = usize::from(self.plans[index].left[count - 1]);
        if left == 0 {
            children.push(index);
            return;
        }
        let first = self.tree.nodes[index].first_index as usize;
        self.gather_children(first, left, children);
        self.gather_children(first + 1, count - left, children);
    }

    /// Appends the packs of all triangles below a node of the binary tree.
    fn leaf(&mut self, index: usize) -> Child {
        let mut indices = Vec::with_capacity(LANES * LEAF_PACKS);
        self.gather_triangles(index, &mut indices);
        let first = self.bvh.packs.len();
        let packs = indices.chunks(LANES).map(|few| Pack::new(self.triangles, few));
        self.bvh.packs.extend(packs);
        Child::leaf(first..self.bvh.packs.len())
    }

    fn gather_triangles(&self, index: usize, indices: &mut Vec<u32>) {
        let node = &self.tree.nodes[index];
        let first = node.first_index as usize;
        if node.is_leaf() {
            let end = first + node.prim_count as usize;
            indices.extend(&self.tree.primitive_indices[first..end]);
        } else {
            self.gather_triangles(first, indices);
            self.gather_triangles(first + 1, indices);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::iter;

    use super::super::binary;
    use super::super::node::Below;
    use super::*;

    /// Slender triangles that turn as they wind upward, some far larger than others.
    fn spiral(count: u32) -> Vec<[Vec3; 3]> {
        let triangle = |k: u32| {
            let s = k as f32;
            let [sine, cosine] = [s.sin(), s.cos()];
            let corner = Vec3::new(cosine, 0.1 * s, sine);
            let size = 0.1 + 0.9 * (s * 0.37).fract();
            [corner, corner + size * Vec3::new(-sine, 0.2, cosine), corner + 0.1 * Vec3::Y]
        };
        (0..count).map(triangle).collect()
    }

    #[test]
    fn every_triangle_is_in_one_pack_and_every_pack_below_one_node() {
        for count in [1, 3, 4, 5, 8, 9, 40, 1000] {
            let triangles = spiral(count);
            let bvh = fold(&binary(&triangles), &triangles);
            let [mut nodes, mut packs] = [vec![0; bvh.nodes.len()], vec![0; bvh.packs.len()]];
            nodes[0] += 1;
            for child in bvh.nodes.iter().flat_map(Node::children) {
                match child.below() {
                    Below::Node(node) => nodes[node] += 1,
                    Below::Packs(range) => packs[range].iter_mut().for_each(|met| *met += 1),
                }
            }
            assert!(nodes.iter().chain(&packs).all(|&times| times == 1), "{count}");
            let mut met: Vec<u32> = bvh.packs.iter().flat_map(Pack::indices).collect();
            met.sort_unstable();
            assert!(met.into_iter().eq(0..count), "{count}");
        }
    }

    #[test]
    fn no_other_fold_costs_less() {
        for count in [9, 20, 32] {
            let tree = binary(&spiral(count));
            let mut plans = vec![Plan::default(); tree.nodes.len()];
            plan(&tree, 0, &mut plans);
            let [planned, least] = [plans[0].costs[0], cheapest(&tree, 0, &plans)];
            assert!((planned - least).abs() < 1e-5 * least, "{count}: {planned}, least {least}");
        }
    }

    /// The least cost of a node as a single child, found by trying all ways to choose its children.
    fn cheapest(tree: &Bvh2, index: usize, plans: &[Plan]) -> f32 {
        let area = tree.nodes[index].aabb().half_area();
        let leaf = leaf_cost(plans[index].triangles).map(|cost| area * cost);
        if plans[index].triangles as usize <= LANES {
            return area;
        }
        let first = tree.nodes[index].first_index as usize;
        let ways = pairs(&ways(tree, first, plans), &ways(tree, first + 1, plans));
        let cost = |way: Vec<usize>| {
            way.into_iter().map(|child| cheapest(tree, child, plans)).sum::<f32>() + area
        };
        ways.into_iter().map(cost).chain(leaf).reduce(f32::min).unwrap()
    }

    /// All ways to make what lies below a node into at most [`WIDTH`] children.
    fn ways(tree: &Bvh2, index: usize, plans: &[Plan]) -> Vec<Vec<usize>> {
        let whole = iter::once(vec![index]);
        if plans[index].triangles as usize <= LANES {
            return whole.collect();
        }
        let first = tree.nodes[index].first_index as usize;
        whole.chain(pairs(&ways(tree, first, plans), &ways(tree, first + 1, plans))).collect()
    }

    fn pairs(left: &[Vec<usize>], right: &[Vec<usize>]) -> Vec<Vec<usize>> {
        let all = left.iter().flat_map(|a| right.iter().map(move |b| [&a[..], &b[..]].concat()));
        all.filter(|way| way.len() <= WIDTH).collect()
    }
}
