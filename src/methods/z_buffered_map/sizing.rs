//! How large a map has to be, and how many intervals it has to keep: from the view and the scene.

use std::f32::consts::FRAC_PI_2;

use glam::{Vec2, Vec3};

use crate::geometry::bvh::Bvh;
use crate::geometry::{Projection, Ray, cube};
use crate::scene::{Moment, ObjectId, Scene};

/// Texels along a face's side, at least and at most.
const SIZES: [u32; 2] = [128, 2048];
/// Texels a pixel: hits are refined, so this is for what ends inside a texel.
const OVERSAMPLING: f32 = 2.0;
/// Moments of the camera's path looked at.
const MOMENTS: u32 = 8;
/// Directions tried along a face's side for the depth complexity.
const DIRECTIONS: u32 = 16;
/// Share of directions whose intervals are all to be kept.
const KEPT: f32 = 0.98;

/// Texels along a face's side, a power of two, at which neighbouring pixels of the reflectors show
/// points two texels apart or more, in views of `height` pixels.
///
/// A mirror of curvature k at distance d spreads directions that differ by a to a (1 + 2 k d).
pub fn texels(scene: &Scene, reflectors: &[ObjectId], height: u32) -> u32 {
    let bend = reflectors.iter().map(|&object| least_curvature(scene, object));
    let bend = bend.fold(f32::INFINITY, f32::min);
    let frames = (0..MOMENTS).map(|i| i * (scene.frames - 1) / (MOMENTS - 1));
    let spread = frames
        .map(|frame| {
            let moment = scene.at(frame);
            let (low, high) = scene.bounds_of(&moment, reflectors);
            let eye = moment.camera.eye;
            let distance = eye.distance(eye.clamp(low, high));
            let pixel = match moment.camera.projection {
                Projection::Perspective { fov_y } => 2.0 * (0.5 * fov_y).tan() / height as f32,
                // Rays are parallel: only the mirror spreads them, as from that far.
                Projection::Orthographic { height: metres } => {
                    metres / height as f32 / distance.max(metres)
                }
            };
            pixel * (1.0 + 2.0 * bend * distance)
        })
        .fold(f32::INFINITY, f32::min);
    let wanted = OVERSAMPLING * FRAC_PI_2 / spread;
    (wanted.min(SIZES[1] as f32) as u32).next_power_of_two().clamp(SIZES[0], SIZES[1])
}

/// The curvature that all but a tenth of an object's edges reach, 1/m: how fast normals turn away
/// from each other along them. 0 where it is flat or hollow.
fn least_curvature(scene: &Scene, object: ObjectId) -> f32 {
    let mesh = scene.mesh_of(object);
    let bend = |&[a, b, _]: &[u32; 3]| {
        let [a, b] = [a, b].map(|i| i as usize);
        let along = mesh.positions[b] - mesh.positions[a];
        let turn = (mesh.normals[b] - mesh.normals[a]).dot(along);
        (turn / along.length_squared()).max(0.0)
    };
    let mut bends: Vec<f32> = mesh.triangles.iter().map(bend).collect();
    bends.sort_by(f32::total_cmp);
    bends.get(bends.len() / 10).copied().unwrap_or(0.0)
}

/// Intervals to keep, 1 to `most`, so that nearly all directions from `centre` have all of theirs.
pub fn intervals(
    scene: &Scene,
    moment: &Moment,
    centre: Vec3,
    exclude: &[ObjectId],
    most: u32,
) -> u32 {
    let (mut corners, mut closed) = (Vec::new(), Vec::new());
    for object in (0..scene.objects.len() as ObjectId).filter(|object| !exclude.contains(object)) {
        corners.extend(scene.world_triangles(moment, object));
        closed.resize(corners.len(), scene.mesh_of(object).is_closed());
    }
    let tree = Bvh::new(&corners);
    let mut with = vec![0; most as usize + 1];
    for face in 0..6 {
        for i in 0..DIRECTIONS * DIRECTIONS {
            let place = Vec2::new((i % DIRECTIONS) as f32, (i / DIRECTIONS) as f32) + 0.5;
            let direction = cube::direction(face, place / DIRECTIONS as f32).normalize();
            let met = met_along(&tree, &closed, &Ray { origin: centre, direction }, most);
            with[met as usize] += 1;
        }
    }
    let all = (6 * DIRECTIONS * DIRECTIONS) as f32;
    let mut kept = 0;
    let enough = |count: &usize| {
        kept += with[*count];
        kept as f32 >= KEPT * all
    };
    (0..=most as usize).find(enough).map_or(most, |count| (count as u32).max(1))
}

/// Intervals along a ray but for the farthest surface, counted as `shaders/stages/interval_order.wgsl`
/// does, up to `most`.
fn met_along(tree: &Bvh, closed: &[bool], ray: &Ray, most: u32) -> u32 {
    let (mut from, mut depth, mut intervals, mut last_ends) = (1e-3, 0u32, 0, false);
    while let Some(hit) = tree.nearest(ray, [from, f32::INFINITY], |_, _| true) {
        if intervals > most {
            return most;
        }
        let outside = depth == 0;
        if closed[hit.triangle as usize] {
            depth = if hit.front { depth + 1 } else { depth.saturating_sub(1) };
        }
        last_ends = outside && depth == 0;
        intervals += u32::from(depth == 0 && (last_ends || !hit.front));
        from = hit.t * (1.0 + 1e-5);
    }
    // The farthest, where it is a sheet, is kept beside the intervals.
    (intervals - u32::from(last_ends && intervals > 0)).min(most)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene;

    #[test]
    fn cluttered_scenes_need_more_intervals() {
        let needed = ["patow-room", "clutter-60", "clutter-400"].map(|name| {
            let scene = scene::load(name).unwrap();
            let reflectors = scene.reflectors();
            intervals(&scene, &scene.at(0), Vec3::ZERO, &reflectors, 4)
        });
        assert!(needed.is_sorted() && needed[0] == 1 && needed[2] > 1, "{needed:?}");
    }

    #[test]
    fn flat_mirrors_and_large_views_need_larger_maps() {
        let round = scene::load("patow-room").unwrap();
        let flat = scene::load("lecture").unwrap();
        let size = |scene: &Scene, height| texels(scene, &scene.reflectors(), height);
        assert!(size(&round, 300) < size(&round, 1200));
        assert!(size(&round, 300) < size(&flat, 300));
        assert_eq!(size(&flat, 4000), SIZES[1]);
    }
}
