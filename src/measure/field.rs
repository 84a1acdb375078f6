//! The truth's own dense image of mirrored rays, and a pyramid over it.
//!
//! At every pixel centre a chain of mirrors ends in a last segment: an origin and a direction. The
//! pyramid bounds the segments below a node by a sphere of origins and a cone of directions, so
//! that large parts of the image, from which no ray can reach a point, are passed over at once.

use glam::{UVec2, Vec2, Vec3, Vec4};

use crate::truth::Chain;

/// Where a record says the light came from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Target {
    Point(Vec3),
    Direction(Vec3),
}

impl Target {
    /// From the record's form: a point with w = 1, a direction with w = 0.
    pub fn new(point: Vec4) -> Self {
        if point.w == 0.0 {
            Target::Direction(point.truncate().normalize_or_zero())
        } else {
            Target::Point(point.truncate())
        }
    }

    /// Unit direction from `origin` to the target.
    pub fn seen_from(self, origin: Vec3) -> Vec3 {
        match self {
            Target::Point(point) => (point - origin).normalize_or_zero(),
            Target::Direction(direction) => direction,
        }
    }
}

/// The last segment of a chain: a mirrored ray.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Segment {
    pub origin: Vec3,
    pub direction: Vec3,
}

/// Chains of the same mirrors have the same key.
pub(super) type Key = u32;

/// No chain here.
const NONE: Key = u32::MAX;
/// Several chains below a node. No trace looks like these two: a trace's highest byte is a fourth
/// reflector's rank plus one, modulo 256.
const MIXED: Key = u32::MAX - 1;

/// The reflectors of the first `order` bounces of a chain, `order` at least 1.
pub(super) fn key(trace: u32, order: u32) -> Key {
    trace & (u32::MAX >> 32u32.saturating_sub(8 * order))
}

/// Angle between unit vectors, by the chord: an arc cosine would lose small angles.
fn angle(a: Vec3, b: Vec3) -> f32 {
    2.0 * (0.5 * a.distance(b)).min(1.0).asin()
}

/// What is known of all segments below a node.
#[derive(Clone, Copy, Debug)]
struct Node {
    key: Key,
    /// Sphere around the origins; infinite where nothing can be ruled out.
    centre: Vec3,
    radius: f32,
    /// Cone around the directions.
    axis: Vec3,
    angle: f32,
}

const EMPTY: Node =
    Node { key: NONE, centre: Vec3::ZERO, radius: 0.0, axis: Vec3::ZERO, angle: 0.0 };

struct Level {
    size: UVec2,
    nodes: Vec<Node>,
}

/// A square of the image between pixel centres: level 0 holds single cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Cell {
    pub level: u32,
    pub x: u32,
    pub y: u32,
}

/// Corners of a cell: where they are in the image and what lies there.
pub(super) type Corner = (Vec2, Segment);

/// Segments after `order` bounces, over a whole image.
pub(super) struct Field {
    size: UVec2,
    keys: Vec<Key>,
    segments: Vec<Segment>,
    levels: Vec<Level>,
}

/// How far beyond its corners a cell's bounds reach: what lies between pixel centres may bend
/// outwards, and roots are accepted a little outside their cell.
const INFLATION: f32 = 1.6;

impl Field {
    /// From the chain at every pixel of an image.
    pub fn new(size: [u32; 2], chains: &[Option<Chain>], order: u32) -> Self {
        let last = |chain: &Option<Chain>| {
            let chain = chain.as_ref()?;
            let bounce = chain.bounces.get(order as usize - 1)?;
            let segment = Segment { origin: bounce.hit.point, direction: bounce.mirrored };
            Some((key(chain.trace, order), segment))
        };
        let (keys, segments) =
            chains.iter().map(|chain| last(chain).unwrap_or((NONE, Segment::default()))).unzip();
        let mut field = Field { size: size.into(), keys, segments, levels: Vec::new() };
        field.levels = field.pyramid();
        field
    }

    fn pyramid(&self) -> Vec<Level> {
        let size = self.size.saturating_sub(UVec2::ONE);
        let cells = (0..size.y).flat_map(|y| (0..size.x).map(move |x| [x, y]));
        let nodes = cells.map(|[x, y]| self.leaf(x, y)).collect();
        let mut levels = vec![Level { size, nodes }];
        while let Some(below) = levels.last().filter(|level| level.size.max_element() > 1) {
            levels.push(below.above());
        }
        levels
    }

    fn leaf(&self, x: u32, y: u32) -> Node {
        let Some(key) = self.key_of_cell(x, y) else { return EMPTY };
        let segments = self.corners(x, y, key).into_iter().flatten().map(|(_, segment)| segment);
        let count = segments.clone().count() as f32;
        let centre = segments.clone().map(|s| s.origin).sum::<Vec3>() / count;
        let axis = segments.clone().map(|s| s.direction).sum::<Vec3>().normalize_or_zero();
        let radius = segments.clone().map(|s| s.origin.distance(centre)).fold(0.0, f32::max);
        let angle = segments.map(|s| angle(s.direction, axis)).fold(0.0, f32::max);
        // The last digits of directions are noise.
        Node { key, centre, radius: INFLATION * radius, axis, angle: INFLATION * angle + 1e-5 }
    }

    /// The chain that at least three corners of a cell share: enough for a triangle.
    fn key_of_cell(&self, x: u32, y: u32) -> Option<Key> {
        let at = |dx: u32, dy: u32| self.keys[self.index(x + dx, y + dy)];
        let keys = [at(0, 0), at(1, 0), at(0, 1), at(1, 1)];
        let shared = |key: &Key| *key != NONE && keys.iter().filter(|k| *k == key).count() >= 3;
        keys[..2].iter().copied().find(shared)
    }

    fn index(&self, x: u32, y: u32) -> usize {
        (y * self.size.x + x) as usize
    }

    /// Corners of a level-0 cell around its rim, `None` where another chain is.
    pub fn corners(&self, x: u32, y: u32, key: Key) -> [Option<Corner>; 4] {
        [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[dx, dy]| {
            let (x, y) = (x + dx, y + dy);
            let index = self.index(x, y);
            let centre = UVec2::new(x, y).as_vec2() + 0.5;
            (self.keys[index] == key).then(|| (centre, self.segments[index]))
        })
    }

    /// Whether all pixels around the one at `at` continue its chain.
    pub fn is_interior(&self, at: UVec2, key: Key) -> bool {
        let inside = at.cmpge(UVec2::ONE).all() && (at + 1).cmplt(self.size).all();
        inside
            && (at.y - 1..=at.y + 1)
                .all(|y| (at.x - 1..=at.x + 1).all(|x| self.keys[self.index(x, y)] == key))
    }

    /// The node everything hangs below.
    pub fn root(&self) -> Cell {
        Cell { level: self.levels.len() as u32 - 1, x: 0, y: 0 }
    }

    /// The up to four cells below one that is not of level 0.
    pub fn below(&self, cell: Cell) -> impl Iterator<Item = Cell> {
        let level = cell.level - 1;
        let size = self.levels[level as usize].size;
        let children = (0..4).map(move |k| [2 * cell.x + k % 2, 2 * cell.y + k / 2]);
        children.filter(move |&[x, y]| x < size.x && y < size.y).map(move |[x, y]| Cell {
            level,
            x,
            y,
        })
    }

    /// Distance in pixels from a position to the nearest position of a cell.
    pub fn distance(&self, cell: Cell, from: Vec2) -> f32 {
        let low = UVec2::new(cell.x << cell.level, cell.y << cell.level);
        let high = (low + (1 << cell.level)).min(self.size.saturating_sub(UVec2::ONE));
        from.distance(from.clamp(low.as_vec2() + 0.5, high.as_vec2() + 0.5))
    }

    /// Whether a chain of that key in the cell may end at the target.
    pub fn may_reach(&self, cell: Cell, key: Key, target: Target) -> bool {
        let level = &self.levels[cell.level as usize];
        let Some(node) = level.nodes.get((cell.y * level.size.x + cell.x) as usize) else {
            return false;
        };
        if node.key != key && node.key != MIXED {
            return false;
        }
        let (towards, spread) = match target {
            Target::Direction(direction) => (direction, 0.0),
            Target::Point(point) => {
                let away = point - node.centre;
                let distance = away.length();
                if distance <= node.radius {
                    return true;
                }
                (away / distance, (node.radius / distance).asin())
            }
        };
        // Seen from the target, origins lie within `spread` of the centre.
        let reach = node.angle + spread;
        reach >= std::f32::consts::PI || angle(towards, node.axis) <= reach
    }
}

impl Level {
    fn above(&self) -> Level {
        let size = (self.size + 1) / 2;
        let parents = (0..size.y).flat_map(|y| (0..size.x).map(move |x| [x, y]));
        let nodes = parents.map(|[x, y]| self.join(2 * x, 2 * y)).collect();
        Level { size, nodes }
    }

    fn join(&self, x: u32, y: u32) -> Node {
        let children = [[0, 0], [1, 0], [0, 1], [1, 1]]
            .map(|[dx, dy]| [x + dx, y + dy])
            .into_iter()
            .filter(|&[x, y]| x < self.size.x && y < self.size.y)
            .map(|[x, y]| self.nodes[(y * self.size.x + x) as usize])
            .filter(|node| node.key != NONE);
        let count = children.clone().count();
        let Some(first) = children.clone().next() else { return EMPTY };
        let key =
            if children.clone().all(|node| node.key == first.key) { first.key } else { MIXED };
        let centre = children.clone().map(|node| node.centre).sum::<Vec3>() / count as f32;
        let axis = children.clone().map(|node| node.axis).sum::<Vec3>().normalize_or_zero();
        let radius = |node: Node| node.centre.distance(centre) + node.radius;
        let spread = |node: Node| angle(node.axis, axis) + node.angle;
        let angle = children.clone().map(spread).fold(0.0, f32::max);
        let radius = children.map(radius).fold(0.0, f32::max);
        // Axes that cancel bound nothing.
        let angle = if axis == Vec3::ZERO { std::f32::consts::PI } else { angle };
        Node { key, centre, radius, axis, angle }
    }
}
