//! Where a ray meets a depth image, by one of its rotated rows.

use std::f32::consts::PI;

use glam::{Vec2, Vec3, Vec3Swizzles};

use super::{DepthRows, Heights, Packed, RIM, RowShape, Segment};

/// The part of a ray that a depth image can show: where it starts and ends, in texels and height. Between
/// them it is straight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageLine {
    pub start: Vec3,
    pub end: Vec3,
}

impl ImageLine {
    /// At a share of its length in the image.
    pub fn at(&self, share: f32) -> Vec3 {
        self.start.lerp(self.end, share)
    }
}

/// What is a hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rule {
    /// A surface goes on across silhouettes, as skins; otherwise a ray passes through there, but for their rim.
    pub skins: bool,
    /// The step of heights that is a silhouette, see [`super::Limits`].
    pub jump: f32,
    /// Look again in the row that the ray is in where the first one was hit.
    pub re_anchor: bool,
}

/// A ray in a row: x and height where it starts and ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RowLine {
    pub x: [f32; 2],
    pub height: [f32; 2],
}

impl RowLine {
    pub fn height_at(&self, x: f32) -> f32 {
        let slope = (self.height[1] - self.height[0]) / (self.x[1] - self.x[0]);
        self.height[0] + slope * (x - self.x[0])
    }
}

/// What a row says of a ray.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RowHit {
    /// Where the ray meets the row's surface, or a skin of it.
    pub x: Option<f32>,
    /// It went behind something past a silhouette: what it meets there is not known.
    pub behind: bool,
    /// Segments read.
    pub reads: u32,
}

/// Where a ray meets the image.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Found {
    /// In texels of the image.
    pub place: Option<Vec2>,
    /// As a share of the line.
    pub share: f32,
    pub behind: bool,
    /// Whether the ray's row has anything in it.
    pub row_exists: bool,
    pub reads: u32,
}

/// A line that stays in one texel has no direction to choose a map by.
pub fn degenerate(line: &ImageLine) -> bool {
    (line.end - line.start).xy().length_squared() < 1.0
}

/// Search the row nearest to the ray: of the map rotated the nearest angle, the one through the middle of
/// the ray's part in the image.
pub fn search(rows: &DepthRows, line: &ImageLine, rule: Rule) -> Found {
    let shape = rows.shape;
    let across = (line.end - line.start).xy();
    let step = PI / shape.angles as f32;
    let map = (across.to_angle().rem_euclid(PI) / step).round() as u32 % shape.angles;
    let angle = shape.angle(map);
    let [start, end] = [line.start, line.end].map(|p| shape.rotated(p.xy(), angle));
    let row = RowLine { x: [start.x, end.x], height: [line.start.z, line.end.z] };
    let share = |x: f32| (x - start.x) / (end.x - start.x);
    let mut y = 0.5 * (start.y + end.y);
    let mut found = Found::default();
    let Some(first) = row_at(rows, map, y) else { return found };
    found.row_exists = true;
    let mut hit = intersect(first, &row, shape, rule);
    found.reads = hit.reads;
    if let (Some(x), true) = (hit.x, rule.re_anchor) {
        y = start.y + share(x) * (end.y - start.y);
        let again = row_at(rows, map, y).map(|second| intersect(second, &row, shape, rule));
        if let Some(again) = again {
            found.reads += again.reads;
            // Where the ray's own row has nothing, the first was right but for its direction.
            if let Some(x) = again.x {
                y = start.y + share(x) * (end.y - start.y);
                hit = again;
            }
        }
    }
    found.behind = hit.behind;
    if let Some(x) = hit.x {
        found.share = share(x);
        found.place = Some(shape.rotated(Vec2::new(x, y), -angle));
    }
    found
}

/// Texels to either side of a row's hit between which the image is looked at.
const REACH: f32 = 1.5;

/// Where a line meets the image's own surface beside the share at which it hit a row; that share where it does not.
pub fn finish(heights: Heights, line: &ImageLine, jump: f32, share: f32) -> f32 {
    let reach = REACH / (line.end - line.start).xy().length();
    let ends = [share - reach, share + reach].map(|share| share.clamp(0.0, 1.0));
    let surface = ends.map(|share| heights.between(line.at(share).xy(), jump));
    let [before, after] = [0, 1].map(|i| line.at(ends[i]).z - surface[i]);
    let one = surface.iter().all(|&height| height > 0.0)
        && (surface[1] - surface[0]).abs() <= 2.0 * REACH * jump;
    if !one || before < 0.0 || after >= 0.0 {
        return share;
    }
    ends[0] + (ends[1] - ends[0]) * before / (before - after)
}

/// The segments of the row at y of a map, where it has any.
fn row_at(rows: &DepthRows, map: u32, y: f32) -> Option<&[Packed]> {
    let inside = y >= 0.0 && y < rows.shape.size as f32;
    let row = inside.then(|| rows.row(map, y as u32))?;
    (!row.is_empty()).then_some(row)
}

/// "First sign change" of the ray's height over the segments, from its start on.
pub fn intersect(row: &[Packed], line: &RowLine, shape: RowShape, rule: Rule) -> RowHit {
    let skins = rule.skins;
    let forward = line.x[1] > line.x[0];
    let sign = if forward { 1.0 } else { -1.0 };
    let [from, to] = line.x.map(|x| sign * x);
    let in_order = |i: usize| {
        let packed = row[if forward { i } else { row.len() - 1 - i }];
        let segment = Segment::unpacked(packed, shape.size);
        let order = if forward { [0, 1] } else { [1, 0] };
        (order.map(|end| sign * segment.x[end]), order.map(|end| segment.height[end]))
    };
    let mut hit = RowHit::default();
    // The first that ends beyond the ray's start.
    let (mut low, mut high) = (0, row.len());
    while low < high {
        let middle = (low + high) / 2;
        hit.reads += 1;
        if in_order(middle).0[1] <= from {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    // Where the last segment ended, and how high above it the ray was.
    let (mut left, mut above) = (f32::NEG_INFINITY, 1.0f32);
    for i in low..row.len() {
        let (x, height) = in_order(i);
        hit.reads += 1;
        if x[0] >= to {
            break;
        }
        let [s, e] = [x[0].max(from), x[1].min(to)];
        let slope = (height[1] - height[0]) / (x[1] - x[0]);
        let over = |x_at: f32| line.height_at(sign * x_at) - (height[0] + slope * (x_at - x[0]));
        let [at_start, at_end] = [over(s), over(e)];
        // Before the ray's start nothing is known; beside a surface is the ground, which is below all rays.
        let before = if s > x[0] || x[0] == from {
            at_start
        } else if x[0] > left {
            1.0
        } else {
            above
        };
        if before >= 0.0 && at_start < 0.0 || skins && before < 0.0 && at_start >= 0.0 {
            hit.behind = true;
            if skins || -at_start <= RIM * rule.jump {
                // Just inside the texel at the silhouette.
                hit.x = Some(sign * (s + 0.25f32.min(0.5 * (e - s))));
                return hit;
            }
        }
        let enters = at_start >= 0.0 && at_end < 0.0;
        if enters || skins && at_start < 0.0 && at_end >= 0.0 {
            hit.x = Some(sign * (s + (e - s) * at_start / (at_start - at_end)));
            hit.behind = false;
            return hit;
        }
        (left, above) = (x[1], at_end);
    }
    hit
}
