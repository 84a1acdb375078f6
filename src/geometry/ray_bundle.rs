//! Bundles of rays: a point is projected between the rays of a map, not onto the nearest (after Martin &
//! Popescu 2004, who take that).
//!
//! Four neighbouring rays of one trace span a bundle: at every place between them a ray starts and leads
//! where the four do, bilinearly. The place whose ray runs through the point is found by Newton's steps, from
//! the quad beside the nearest ray on. WGSL twin: `shaders/reflection_morphing/bundle.wgsl`.

use glam::{IVec2, Vec2, Vec3};

use super::cube;
use super::ray_octree::RaySegment;

/// What a ray map is besides its rays: "layered cube maps that instead of storing color samples, store pointers
/// to rays" (section 4.1).
#[derive(Clone, Debug)]
pub struct RayTable {
    /// Texels along a side of a face.
    pub size: u32,
    /// For each texel, layer after layer, the place of its segment, or [`RayTable::NONE`].
    pub places: Vec<u32>,
}

/// Where a point is seen through one ray, or between four.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// Of the first reflector.
    pub point: Vec3,
    /// Metres from there to the point seen, along the trace.
    pub way: f32,
    /// The point lies within a bundle, not only so near to one, at the rim, that the next ray may run there.
    pub within: bool,
}

/// How far beyond its four rays a bundle is trusted at the rim, in texels: as far as the next would be.
const RIM: f32 = 1.0;
/// Rounding, in texels.
const SLACK: f32 = 1e-3;
/// Quads walked over, and Newton's steps in each.
const QUADS: u32 = 6;
const STEPS: u32 = 4;

impl RayTable {
    pub const NONE: u32 = u32::MAX;

    /// Of a map of `layers` with faces of `size` x `size` texels.
    pub fn new(segments: &[RaySegment], size: u32, layers: u32) -> RayTable {
        let mut places = vec![Self::NONE; (layers * 6 * size * size) as usize];
        for (segment, place) in segments.iter().zip(0..) {
            places[segment.texel as usize] = place;
        }
        RayTable { size, places }
    }

    fn texels(&self) -> u32 {
        6 * self.size * self.size
    }

    /// The texel at a place of a face, or of the next face where the place is beside it.
    fn texel_at(&self, face: u32, at: IVec2) -> u32 {
        let size = self.size as i32;
        let (mut face, mut at) = (face, at);
        if at.min_element() < 0 || at.max_element() >= size {
            let beside = cube::direction(face, (at.as_vec2() + 0.5) / size as f32);
            let (other, uv) = cube::face_uv(beside);
            (face, at) = (other, (uv * size as f32).as_ivec2().min(IVec2::splat(size - 1)));
        }
        (face * self.size + at.y as u32) * self.size + at.x as u32
    }

    /// The four rays from a place of a face on, where all four have the trace.
    fn quad(
        &self,
        rays: &[RaySegment],
        like: &RaySegment,
        face: u32,
        at: IVec2,
    ) -> Option<[u32; 4]> {
        let layer = like.texel / self.texels() * self.texels();
        let mut quad = [0; 4];
        for (corner, ray) in (0..).zip(&mut quad) {
            let texel = self.texel_at(face, at + IVec2::new(corner & 1, corner >> 1));
            *ray = self.places[(layer + texel) as usize];
            if *ray == Self::NONE || rays[*ray as usize].trace != like.trace {
                return None;
            }
        }
        Some(quad)
    }

    /// The ray's first reflector's point, and the metres from there to the last one's.
    fn before(&self, rays: &[RaySegment], ray: u32) -> (Vec3, f32) {
        let last = &rays[ray as usize];
        let texel = last.texel % self.texels();
        let start =
            |layer: u32| rays[self.places[(layer * self.texels() + texel) as usize] as usize].start;
        let layers = last.texel / self.texels();
        let way = (0..layers).map(|layer| start(layer).distance(start(layer + 1))).sum();
        (start(0), way)
    }

    /// Through one ray, the nearest.
    pub fn seen_by_ray(&self, rays: &[RaySegment], point: Vec3, nearest: u32) -> Seen {
        let (first, way) = self.before(rays, nearest);
        let on = rays[nearest as usize].start.distance(point);
        Seen { point: first, way: way + on, within: true }
    }

    /// Between four rays, beginning beside the nearest.
    pub fn seen(&self, rays: &[RaySegment], point: Vec3, nearest: u32) -> Option<Seen> {
        let (quad, place, within) = self.bundle(rays, point, nearest)?;
        let mut seen = Seen { point: Vec3::ZERO, way: 0.0, within };
        let mut last = Vec3::ZERO;
        for (ray, weight) in quad.into_iter().zip(bilinear(place)) {
            let (first, way) = self.before(rays, ray);
            seen.point += weight * first;
            seen.way += weight * way;
            last += weight * rays[ray as usize].start;
        }
        seen.way += last.distance(point);
        Some(seen)
    }

    /// The quad a point lies in, or is nearest to at the rim; where, and which of both.
    fn bundle(
        &self,
        rays: &[RaySegment],
        point: Vec3,
        nearest: u32,
    ) -> Option<([u32; 4], Vec2, bool)> {
        let like = &rays[nearest as usize];
        let texel = like.texel % self.texels();
        let face = texel / (self.size * self.size);
        let home = IVec2::new((texel % self.size) as i32, (texel / self.size % self.size) as i32);
        let beside = (0..4).map(|side| home - IVec2::new(side & 1, side >> 1));
        let quad_at = |at: IVec2| self.quad(rays, like, face, at);
        let (mut at, mut quad) = beside.filter_map(|at| Some((at, quad_at(at)?))).next()?;
        for _ in 0..QUADS {
            let place = place_in(quad.map(|ray| &rays[ray as usize]), point)?;
            let beyond = (place - place.clamp(Vec2::ZERO, Vec2::ONE)).abs().max_element();
            if beyond <= SLACK {
                return Some((quad, place, true));
            }
            at += place.floor().clamp(Vec2::splat(-2.0), Vec2::splat(2.0)).as_ivec2();
            let Some(next) = quad_at(at) else {
                return (beyond <= RIM).then_some((quad, place, false));
            };
            quad = next;
        }
        None
    }
}

/// Weights of four corners.
fn bilinear(place: Vec2) -> [f32; 4] {
    let (a, b) = (place, 1.0 - place);
    [b.x * b.y, a.x * b.y, b.x * a.y, a.x * a.y]
}

/// Where between four rays one runs through a point: `d x (point - p)` is 0, for the start `p` and the way `d`
/// there. `None` where there is no such place or the point lies before the start.
fn place_in(rays: [&RaySegment; 4], point: Vec3) -> Option<Vec2> {
    let starts = rays.map(|ray| ray.start);
    let ways = rays.map(|ray| (ray.end - ray.start).normalize_or_zero());
    let at = |corners: &[Vec3; 4], place: Vec2| {
        let [a, b, c, d] = *corners;
        let (x, y) = ((b - a).lerp(d - c, place.y), (c - a).lerp(d - b, place.x));
        (a.lerp(b, place.x).lerp(c.lerp(d, place.x), place.y), x, y)
    };
    let mut place = Vec2::splat(0.5);
    for _ in 0..STEPS {
        let ((p, p_x, p_y), (way, way_x, way_y)) = (at(&starts, place), at(&ways, place));
        let towards = point - p;
        let law = way.cross(towards);
        let x = way_x.cross(towards) - way.cross(p_x);
        let y = way_y.cross(towards) - way.cross(p_y);
        // The least squares of law + x * dx + y * dy.
        let (xx, xy, yy) = (x.dot(x), x.dot(y), y.dot(y));
        let determinant = xx * yy - xy * xy;
        if determinant <= 1e-6 * xx * yy {
            return None;
        }
        let (lx, ly) = (x.dot(law), y.dot(law));
        place -= Vec2::new(yy * lx - xy * ly, xx * ly - xy * lx) / determinant;
        place = place.clamp(Vec2::splat(-8.0), Vec2::splat(9.0));
    }
    let ((p, ..), (way, ..)) = (at(&starts, place), at(&ways, place));
    (way.dot(point - p) > 0.0).then_some(place)
}
