//! What a mirror shows of itself, and the pictures that show it ("self-reflections", slide 50, named there as
//! future work).
//!
//! A quad through a thing is met right where its own rays leave, so that one picture with depth does not do
//! either: it has to look at what the rays will see, past the parts that stand before it. Rays sampled over
//! the surface find that; pictures of single parts, seen along 26 directions, are added while one shows much
//! that those before it do not.

use std::f32::consts::TAU;

use glam::Vec3;

use crate::geometry::Ray;
use crate::geometry::bvh::Bvh;
use crate::geometry::optics::{face_forward, reflect};
use crate::geometry::random::SplitMix64;
use crate::scene::{ObjectId, Scene};

/// Points of the surface that rays are mirrored at.
const SAMPLES: usize = 8192;
/// Mirrors a ray is followed over.
const BOUNCES: usize = 3;
/// A ray leaves this share of the thing's size away from its surface.
const LIFT: f32 = 1e-4;
/// Least cosine between a surface and the direction from which a picture still shows it.
const GRAZING: f32 = 0.2;
/// Least share of what a thing sees of itself that one more picture must add.
const WORTH: f32 = 0.02;

/// One picture: of a part, from infinitely far in a direction; own space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OwnView {
    pub part: ObjectId,
    /// Unit.
    pub towards: Vec3,
}

/// A place of the surface that the surface shows.
struct Shown {
    point: Vec3,
    /// Unit, on the side seen.
    normal: Vec3,
    part: ObjectId,
}

/// One of these places on a picture.
struct Seen {
    place: usize,
    /// Between its normal and the direction the picture is taken from.
    cosine: f32,
}

/// At most `most` pictures of the parts of a thing, those that show most of what it shows of itself first; none
/// for what is convex.
pub fn own_views(scene: &Scene, parts: &[ObjectId], most: usize) -> Vec<OwnView> {
    if most == 0 {
        return Vec::new();
    }
    let surface = Surface::new(scene, parts);
    let shown = surface.shown();
    let candidates = surface.candidates(&shown);
    let mut left = vec![true; shown.len()];
    let mut chosen = Vec::new();
    while chosen.len() < most {
        // Of two that show as much, the one that sees it from straighter before has more texels on it.
        let gain = |seen: &[Seen]| -> f32 {
            seen.iter().filter(|of| left[of.place]).map(|of| 1.0 + 1e-3 * of.cosine).sum()
        };
        // The first of the best.
        let gains = candidates.iter().rev().map(|candidate| (candidate, gain(&candidate.1)));
        let best = gains.max_by(|a, b| a.1.total_cmp(&b.1));
        let Some(((view, seen), gain)) = best else { break };
        if gain <= WORTH * shown.len() as f32 {
            break;
        }
        chosen.push(*view);
        seen.iter().for_each(|of| left[of.place] = false);
    }
    chosen
}

/// The triangles of a thing's parts, own space.
struct Surface {
    triangles: Vec<[Vec3; 3]>,
    part_of: Vec<ObjectId>,
    tree: Bvh,
    /// Metres.
    lift: f32,
}

impl Surface {
    fn new(scene: &Scene, parts: &[ObjectId]) -> Surface {
        let mut triangles = Vec::new();
        let mut part_of = Vec::new();
        for &part in parts {
            let mesh = scene.mesh_of(part);
            triangles.extend((0..mesh.triangles.len()).map(|index| mesh.corners(index)));
            part_of.resize(triangles.len(), part);
        }
        let corners = || triangles.iter().flatten();
        let low = corners().fold(Vec3::INFINITY, |a, &b| a.min(b));
        let high = corners().fold(Vec3::NEG_INFINITY, |a, &b| a.max(b));
        let (tree, lift) = (Bvh::new(&triangles), LIFT * (high - low).length());
        Surface { triangles, part_of, tree, lift }
    }

    /// Where rays from all round, mirrored at places all over the surface, meet it again.
    fn shown(&self) -> Vec<Shown> {
        let mut sums = Vec::with_capacity(self.triangles.len());
        let mut sum = 0.0;
        for &[a, b, c] in &self.triangles {
            sum += f64::from((b - a).cross(c - a).length());
            sums.push(sum);
        }
        let mut random = SplitMix64::new(0);
        let mut shown = Vec::new();
        for _ in 0..SAMPLES {
            let aim = f64::from(random.unit()) * sum;
            let [u, v, height, turn] = [(); 4].map(|()| random.unit());
            let Some(&[a, b, c]) = self.triangles.get(sums.partition_point(|&s| s <= aim)) else {
                continue;
            };
            let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            let z = 2.0 * height - 1.0;
            let (sin, cos) = (TAU * turn).sin_cos();
            let across = (1.0 - z * z).max(0.0).sqrt();
            let incident = Vec3::new(across * cos, across * sin, z);
            let Some(normal) = (b - a).cross(c - a).try_normalize() else { continue };
            let point = a + u * (b - a) + v * (c - a);
            // What cannot be seen from afar is inside.
            if self.meets(&self.tree, point, -incident).is_none() {
                self.follow(point, incident, normal, &mut shown);
            }
        }
        shown
    }

    fn follow(&self, from: Vec3, incident: Vec3, normal: Vec3, shown: &mut Vec<Shown>) {
        let mut point = from;
        let mut direction = reflect(incident, face_forward(normal, incident));
        for _ in 0..BOUNCES {
            let Some((triangle, t)) = self.meets(&self.tree, point, direction) else { break };
            let [a, b, c] = self.triangles[triangle];
            let normal = face_forward((b - a).cross(c - a).normalize_or_zero(), direction);
            point += t * direction;
            direction = reflect(direction, normal);
            shown.push(Shown { point, normal, part: self.part_of[triangle] });
        }
    }

    fn meets(&self, tree: &Bvh, origin: Vec3, direction: Vec3) -> Option<(usize, f32)> {
        let range = [self.lift, f32::INFINITY];
        let hit = tree.nearest(&Ray { origin, direction }, range, |_, _| true)?;
        Some((hit.triangle as usize, hit.t))
    }

    /// Each part along each direction, and which of `shown` that picture shows.
    fn candidates(&self, shown: &[Shown]) -> Vec<(OwnView, Vec<Seen>)> {
        let mut parts = self.part_of.clone();
        parts.dedup();
        let mut candidates = Vec::new();
        for part in parts {
            let own = |&(_, &of): &(&[Vec3; 3], &ObjectId)| of == part;
            let triangles = self.triangles.iter().zip(&self.part_of).filter(own);
            let tree = Bvh::new(&triangles.map(|(&corners, _)| corners).collect::<Vec<_>>());
            for towards in directions() {
                let sees = |(place, at): (usize, &Shown)| {
                    let cosine = at.normal.dot(towards);
                    let faces = at.part == part && cosine > GRAZING;
                    let seen = faces && self.meets(&tree, at.point, towards).is_none();
                    seen.then_some(Seen { place, cosine })
                };
                let seen = shown.iter().enumerate().filter_map(sees).collect();
                candidates.push((OwnView { part, towards }, seen));
            }
        }
        candidates
    }
}

/// Those from a cube's middle to the middles of its faces and edges, and to its corners.
fn directions() -> impl Iterator<Item = Vec3> {
    let place = |i: i32| Vec3::new((i % 3 - 1) as f32, (i / 3 % 3 - 1) as f32, (i / 9 - 1) as f32);
    (0..27).map(place).filter_map(Vec3::try_normalize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene;

    fn views(name: &str, pattern: &str, most: usize) -> Vec<(String, Vec3)> {
        let scene = scene::load(name).unwrap();
        let views = own_views(&scene, &scene.select(pattern), most);
        let named = |view: &OwnView| (scene.objects[view.part as usize].name.clone(), view.towards);
        views.iter().map(named).collect()
    }

    #[test]
    fn what_is_convex_needs_no_picture_of_itself() {
        assert!(views("hall-of-mirrors", "sphere-1", 8).is_empty());
    }

    #[test]
    fn a_dish_shows_itself_in_one_picture_along_its_axis() {
        let views = views("hall-of-mirrors", "dish-left", 8);
        assert_eq!(views.len(), 1, "{views:?}");
        assert!(views[0].1.abs_diff_eq(Vec3::Y, 1e-6), "{views:?}");
    }

    #[test]
    fn a_teapot_needs_several_of_its_parts_and_gets_no_more_than_asked_for() {
        let all = views("table", "teapot", 16);
        assert!(all.len() > 4, "{all:?}");
        assert!(all.iter().any(|(part, _)| part.ends_with("body")), "{all:?}");
        assert_eq!(views("table", "teapot", 3), all[..3]);
    }
}
