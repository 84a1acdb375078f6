//! Four triangles at once.

use glam::{BVec4A, Vec2, Vec3, Vec4};

use super::BvhHit;
use super::splat::SplatRay;

/// Triangles a pack has at most.
pub(super) const LANES: usize = 4;

/// Four triangles side by side. Unused lanes hold a triangle without area, which nothing meets.
#[derive(Clone, Copy)]
pub(super) struct Pack {
    /// By corner, then axis.
    corners: [[Vec4; 3]; 3],
    triangles: [u32; LANES],
}

impl Pack {
    /// Up to four of `triangles`, by index.
    pub fn new(triangles: &[[Vec3; 3]], indices: &[u32]) -> Self {
        let mut pack = Pack { corners: [[Vec4::ZERO; 3]; 3], triangles: [0; LANES] };
        for (lane, &index) in indices.iter().enumerate() {
            pack.triangles[lane] = index;
            for (corner, place) in pack.corners.iter_mut().zip(triangles[index as usize]) {
                for axis in 0..3 {
                    corner[axis][lane] = place[axis];
                }
            }
        }
        pack
    }

    /// The triangles of the lanes in use.
    #[cfg(test)]
    pub fn indices(&self) -> impl Iterator<Item = u32> {
        let used = |&lane: &usize| {
            let corner = |corner: usize| self.corners[corner].map(|axis| axis[lane]);
            corner(0) != corner(1)
        };
        (0..LANES).filter(used).map(|lane| self.triangles[lane])
    }

    /// Ray against triangles by signed volumes, in the form Embree calls robust: an edge's volume is
    /// made from the difference and the sum of its corners, so two triangles that share the edge
    /// compute the same number with opposite signs and a ray between them cannot slip through.
    #[inline]
    pub fn meet(&self, ray: &SplatRay, t_min: f32, t_max: f32) -> Met<'_> {
        let [a, b, c] = self.corners.map(|corner| minus(corner, ray.origin));
        // Each weight is the volume of the edge opposite to its corner.
        let volume = |from, to| dot(cross(minus(to, from), plus(to, from)), ray.direction);
        let weights = [volume(b, c), volume(c, a), volume(a, b)];
        let lowest = weights[0].min(weights[1]).min(weights[2]);
        let highest = weights[0].max(weights[1]).max(weights[2]);
        let inside: BVec4A = lowest.cmpge(Vec4::ZERO) | highest.cmple(Vec4::ZERO);
        let mut met = Met { pack: self, mask: 0, weights, slope: Vec4::ZERO, t: Vec4::ZERO };
        if inside.any() {
            let normal = cross(minus(b, a), minus(c, a));
            met.slope = dot(normal, ray.direction);
            met.t = dot(normal, a) / met.slope;
            // A triangle met edge on has neither slope nor t, one without area no weights either.
            let flat = met.slope.cmpeq(Vec4::ZERO)
                | (weights[0] + weights[1] + weights[2]).cmpeq(Vec4::ZERO);
            let within = met.t.cmpge(Vec4::splat(t_min)) & met.t.cmplt(Vec4::splat(t_max));
            met.mask = (inside & within & !flat).bitmask();
        }
        met
    }
}

/// The triangles of a pack that a ray meets, in no order.
pub(super) struct Met<'a> {
    pack: &'a Pack,
    mask: u32,
    weights: [Vec4; 3],
    slope: Vec4,
    t: Vec4,
}

impl Iterator for Met<'_> {
    type Item = BvhHit;

    #[inline]
    fn next(&mut self) -> Option<BvhHit> {
        if self.mask == 0 {
            return None;
        }
        // The remainder only tells the compiler what is true anyway.
        let lane = self.mask.trailing_zeros() as usize % LANES;
        self.mask &= self.mask - 1;
        let [a, b, c] = self.weights.map(|weight| weight[lane]);
        Some(BvhHit {
            triangle: self.pack.triangles[lane],
            t: self.t[lane],
            barycentrics: Vec2::new(b, c) / (a + b + c),
            front: self.slope[lane] < 0.0,
        })
    }
}

/// Four vectors, by axis.
type Vectors = [Vec4; 3];

#[inline]
fn minus(p: Vectors, q: Vectors) -> Vectors {
    [p[0] - q[0], p[1] - q[1], p[2] - q[2]]
}

#[inline]
fn plus(p: Vectors, q: Vectors) -> Vectors {
    [p[0] + q[0], p[1] + q[1], p[2] + q[2]]
}

#[inline]
fn cross(p: Vectors, q: Vectors) -> Vectors {
    [p[1] * q[2] - q[1] * p[2], p[2] * q[0] - q[2] * p[0], p[0] * q[1] - q[0] * p[1]]
}

#[inline]
fn dot(p: Vectors, q: Vectors) -> Vec4 {
    p[0] * q[0] + p[1] * q[1] + p[2] * q[2]
}
