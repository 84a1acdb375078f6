//! Trees of bounds over mirrored rays.
//!
//! A node bounds the rays below it by a sphere of origins and a cone of directions, so that large
//! parts of the image, from which no ray can reach a point, are passed over at once. Rays next to
//! each other in the image are next to each other in the tree.

use std::f32::consts::PI;

use glam::{UVec2, Vec2, Vec3};

use super::field::Target;

/// Children of a node.
const FAN: usize = 4;

/// What the cosine of an angle may be off by; culling must not lose a root over it.
const COSINE_NOISE: f32 = 5e-7;

/// What coordinates may be off by, of their size.
const ORIGIN_NOISE: f32 = 5e-7;

/// Bounds of a bundle of mirrored rays.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bundle {
    /// Sphere around the origins.
    pub centre: Vec3,
    pub radius: f32,
    /// Cone around the directions: a unit axis (zero when the cone is everything), radians.
    pub axis: Vec3,
    pub angle: f32,
}

/// A bundle and the part of the image it comes from.
#[derive(Clone, Copy, Debug)]
struct Node {
    low: Vec2,
    high: Vec2,
    centre: Vec3,
    radius: f32,
    axis: Vec3,
    cos: f32,
    sin: f32,
}

/// A leaf to be: what it stands for is up to whoever builds the tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leaf {
    /// The pixel it belongs to; leaves are ordered by these.
    pub pixel: UVec2,
    /// The positions it speaks of.
    pub low: Vec2,
    pub high: Vec2,
    pub bundle: Bundle,
}

/// A node's place in its tree: level 0 holds the leaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Place {
    pub level: u32,
    pub index: u32,
}

#[derive(Default)]
pub(super) struct Tree {
    /// Of the leaves, in order.
    pixels: Vec<UVec2>,
    /// From the leaves to a single node; none in an empty tree.
    levels: Vec<Vec<Node>>,
}

/// Angle between unit vectors, by the chord: an arc cosine would lose small angles.
pub(super) fn angle(a: Vec3, b: Vec3) -> f32 {
    2.0 * (0.5 * a.distance(b)).min(1.0).asin()
}

impl Bundle {
    /// Bounds of all of `bundles`, of which there is at least one.
    pub fn around(bundles: impl Iterator<Item = Bundle> + Clone) -> Bundle {
        let centres = || bundles.clone().map(|bundle| bundle.centre);
        let low = centres().fold(Vec3::INFINITY, Vec3::min);
        let high = centres().fold(Vec3::NEG_INFINITY, Vec3::max);
        let centre = 0.5 * (low + high);
        let axis = bundles.clone().map(|bundle| bundle.axis).sum::<Vec3>().normalize_or_zero();
        let reach = |bundle: Bundle| bundle.centre.distance(centre) + bundle.radius;
        let spread = |bundle: Bundle| angle(bundle.axis, axis) + bundle.angle;
        let radius = bundles.clone().map(reach).fold(0.0, f32::max);
        // Axes that cancel bound nothing.
        let angle = if axis == Vec3::ZERO { PI } else { bundles.map(spread).fold(0.0, f32::max) };
        Bundle { centre, radius, axis, angle }
    }

    /// Whether a ray of the bundle may reach the target.
    pub fn may_reach(&self, target: Target) -> bool {
        Node::new(Vec2::ZERO, Vec2::ZERO, *self).may_reach(target)
    }
}

impl Node {
    fn new(low: Vec2, high: Vec2, bundle: Bundle) -> Node {
        let Bundle { centre, radius, axis, angle } = bundle;
        let (sin, cos) = angle.min(PI).sin_cos();
        let radius = radius + ORIGIN_NOISE * centre.abs().max_element();
        Node { low, high, centre, radius, axis, cos, sin }
    }

    fn around(leaves: &[Leaf]) -> Node {
        let low = leaves.iter().map(|leaf| leaf.low).fold(Vec2::INFINITY, Vec2::min);
        let high = leaves.iter().map(|leaf| leaf.high).fold(Vec2::NEG_INFINITY, Vec2::max);
        Node::new(low, high, Bundle::around(leaves.iter().map(|leaf| leaf.bundle)))
    }

    fn may_reach(&self, target: Target) -> bool {
        let (sin, cos, towards) = match target {
            Target::Direction(direction) => (self.sin, self.cos, direction),
            Target::Point(point) => {
                let away = point - self.centre;
                let distance = away.length();
                if distance <= self.radius {
                    return true;
                }
                // Seen from the target, origins lie within this of the centre: the angles add.
                let sin = self.radius / distance;
                let cos = (1.0 - sin * sin).sqrt();
                let sum = (self.sin * cos + self.cos * sin, self.cos * cos - self.sin * sin);
                (sum.0, sum.1, away / distance)
            }
        };
        sin <= 0.0 && cos < 0.0 || towards.dot(self.axis) >= cos - COSINE_NOISE
    }
}

impl Tree {
    /// Over `leaves`, whose order does not matter.
    pub fn new(mut leaves: Vec<Leaf>) -> Tree {
        leaves.sort_unstable_by_key(|leaf| morton(leaf.pixel));
        let pixels = leaves.iter().map(|leaf| leaf.pixel).collect();
        let mut levels = Vec::new();
        let mut width = 1;
        while levels.last().is_none_or(|level: &Vec<Node>| level.len() > 1) && !leaves.is_empty() {
            // From the leaves each time: bounds of bounds would grow with every level.
            levels.push(leaves.chunks(width).map(Node::around).collect());
            width *= FAN;
        }
        Tree { pixels, levels }
    }

    /// The node everything hangs below.
    pub fn root(&self) -> Option<Place> {
        let level = self.levels.len().checked_sub(1)? as u32;
        Some(Place { level, index: 0 })
    }

    /// The nodes below one that is not a leaf.
    pub fn below(&self, place: Place) -> impl Iterator<Item = Place> {
        let level = place.level - 1;
        let first = place.index * FAN as u32;
        let end = (first + FAN as u32).min(self.levels[level as usize].len() as u32);
        (first..end).map(move |index| Place { level, index })
    }

    /// The pixel a leaf belongs to.
    pub fn pixel(&self, leaf: Place) -> UVec2 {
        self.pixels[leaf.index as usize]
    }

    /// Squared distance in pixels from a position to the nearest position a node speaks of.
    pub fn distance_squared(&self, place: Place, from: Vec2) -> f32 {
        let node = self.node(place);
        from.distance_squared(from.max(node.low).min(node.high))
    }

    /// Whether a ray below a node may reach the target.
    pub fn may_reach(&self, place: Place, target: Target) -> bool {
        self.node(place).may_reach(target)
    }

    fn node(&self, place: Place) -> &Node {
        &self.levels[place.level as usize][place.index as usize]
    }
}

#[cfg(test)]
impl Tree {
    /// Every leaf's pixel.
    pub fn pixels(&self) -> &[UVec2] {
        &self.pixels
    }
}

/// The bits of x and y interleaved: places next to each other stay close.
fn morton(UVec2 { x, y }: UVec2) -> u64 {
    let spread = |value: u32| {
        let masks = [
            (16, 0x0000_ffff_0000_ffff),
            (8, 0x00ff_00ff_00ff_00ff),
            (4, 0x0f0f_0f0f_0f0f_0f0f),
            (2, 0x3333_3333_3333_3333),
            (1, 0x5555_5555_5555_5555),
        ];
        masks
            .into_iter()
            .fold(u64::from(value), |bits, (shift, mask)| (bits | bits << shift) & mask)
    };
    spread(x) | spread(y) << 1
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pseudo-random numbers in [0, 1), by a linear congruential generator.
    struct Dice(u64);

    impl Dice {
        fn next(&mut self) -> f32 {
            self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (self.0 >> 40) as f32 / (1u64 << 24) as f32
        }

        fn vector(&mut self) -> Vec3 {
            2.0 * Vec3::new(self.next(), self.next(), self.next()) - 1.0
        }

        fn direction(&mut self) -> Vec3 {
            self.vector().try_normalize().unwrap_or(Vec3::X)
        }

        /// A ray of a bundle.
        fn ray(&mut self, bundle: &Bundle) -> [Vec3; 2] {
            let origin = bundle.centre + bundle.radius * self.next() * self.direction();
            let across = bundle.axis.cross(self.direction()).normalize();
            let (sin, cos) = (bundle.angle * self.next()).sin_cos();
            [origin, cos * bundle.axis + sin * across]
        }
    }

    /// Leaves of all sizes: from single rays to bundles that point everywhere.
    fn leaves(dice: &mut Dice) -> Vec<Leaf> {
        let count = 1 + (90.0 * dice.next()) as usize;
        let (spread, scale) = (dice.next().powi(3), dice.next().powi(4));
        let axis = dice.direction();
        (0..count)
            .map(|_| {
                let pixel = UVec2::new((64.0 * dice.next()) as u32, (40.0 * dice.next()) as u32);
                let low = pixel.as_vec2() - dice.next();
                let bundle = Bundle {
                    centre: dice.vector(),
                    radius: scale * dice.next(),
                    axis: (axis + spread * dice.vector()).normalize(),
                    angle: PI * scale * dice.next(),
                };
                Leaf { pixel, low, high: low + 2.0 * dice.next(), bundle }
            })
            .collect()
    }

    #[test]
    fn culling_never_loses_a_ray() {
        let mut dice = Dice(7);
        let (mut kept, mut culled) = (0, 0);
        for _ in 0..400 {
            let leaves = leaves(&mut dice);
            let tree = Tree::new(leaves.clone());
            for leaf in &leaves {
                let [origin, direction] = dice.ray(&leaf.bundle);
                let point = Target::Point(origin + 10.0 * dice.next().powi(4) * direction);
                for target in [point, Target::Direction(direction)] {
                    let reached = reached(&tree, target);
                    assert!(reached.contains(&leaf.pixel), "{leaf:?} {target:?}");
                    kept += reached.len();
                    culled += leaves.len() - reached.len();
                }
            }
        }
        assert!(culled > kept / 4, "{culled} leaves culled, {kept} kept");
    }

    /// The pixels of the leaves that culling leaves.
    fn reached(tree: &Tree, target: Target) -> Vec<UVec2> {
        let (mut open, mut reached): (Vec<Place>, _) = (tree.root().into_iter().collect(), vec![]);
        while let Some(place) = open.pop() {
            if !tree.may_reach(place, target) {
                continue;
            }
            if place.level > 0 {
                open.extend(tree.below(place));
            } else {
                reached.push(tree.pixel(place));
            }
        }
        reached
    }

    #[test]
    fn no_node_is_farther_than_what_is_below_it() {
        let mut dice = Dice(11);
        for _ in 0..100 {
            let tree = Tree::new(leaves(&mut dice));
            let from = 64.0 * Vec2::new(dice.next(), dice.next());
            let mut open = vec![tree.root().unwrap()];
            while let Some(place) = open.pop().filter(|place| place.level > 0) {
                for below in tree.below(place) {
                    let distances = [below, place].map(|node| tree.distance_squared(node, from));
                    assert!(distances[0] >= distances[1]);
                    open.push(below);
                }
            }
        }
        assert_eq!(Tree::new(Vec::new()).root(), None);
    }
}
