//! Which objects have depth images, and how these look at them.

use glam::{Quat, Vec2, Vec3};

use crate::geometry::depth_rows::Limits;
use crate::scene::{Moment, ObjectId, Scene};
use crate::stages::{PortraitView, Sight, own_from_world, own_points};

/// Thinner than this share of its next side, a thing is flat: one picture along that side has all of it.
const FLAT: f32 = 0.05;
/// Metres a surface may fall per metre across before it is two surfaces with a silhouette between them.
const STEEPEST: f32 = 10.0;
/// A texel is at most so many times as long as wide, or the other way round: limits are those of its narrower
/// side.
const LONGEST: f32 = 3.0;
/// Of a texel: what rows may err by.
const TOLERANCE: f32 = 0.25;

/// What one reflector's depth images are of: an object, or those of a group that move as one.
pub struct Sitter {
    pub objects: Vec<ObjectId>,
    /// First layer of its images, and how many it has.
    pub layers: std::ops::Range<u32>,
}

/// Whatever reflects nothing, in groups that move as one; at most `most` that look largest from `eye`.
pub fn sitters(scene: &Scene, eye: Vec3, most: usize, views: u32) -> Vec<Sitter> {
    let moment = scene.at(0);
    let diffuse: Vec<ObjectId> =
        (0..scene.objects.len() as ObjectId).filter(|&o| !scene.is_reflector(o)).collect();
    let mut bodies: Vec<Vec<ObjectId>> = Vec::new();
    for (_, members) in scene.groups(&diffuse) {
        let motion = |&o: &ObjectId| &scene.objects[o as usize].motion;
        let mut parts: Vec<Vec<ObjectId>> = Vec::new();
        for object in members {
            match parts.iter_mut().find(|part| motion(&part[0]) == motion(&object)) {
                Some(part) => part.push(object),
                None => parts.push(vec![object]),
            }
        }
        bodies.append(&mut parts);
    }
    let nearness = |objects: &Vec<ObjectId>| {
        let (low, high) = scene.bounds_of(&moment, objects);
        (high - low).length() / (0.5 * (low + high) - eye).length().max(1e-6)
    };
    bodies.sort_by(|a, b| nearness(b).total_cmp(&nearness(a)));
    bodies.truncate(most);
    let mut first = 0;
    bodies
        .into_iter()
        .map(|objects| {
            let points = own_points(scene, &moment, &objects);
            let count = if PortraitView::flatness(&points) < FLAT { 1 } else { views };
            let layers = first..first + count;
            first += count;
            Sitter { objects, layers }
        })
        .collect()
}

impl Sitter {
    /// How each of its images looks at it at a moment, from `eye` in the world on round it.
    pub fn views(
        &self,
        scene: &Scene,
        moment: &Moment,
        eye: Vec3,
        sight: Sight,
    ) -> Vec<PortraitView> {
        let points = own_points(scene, moment, &self.objects);
        let from_world = own_from_world(moment, self.objects[0]);
        let own_eye = from_world.transform_point3(eye);
        if PortraitView::flatness(&points) < FLAT {
            return vec![in_disc(PortraitView::flat(&points, own_eye), &points)];
        }
        let (low, high) = points
            .iter()
            .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(a, b), &p| (a.min(p), b.max(p)));
        let centre = 0.5 * (low + high);
        let up = from_world.transform_vector3(Vec3::Y);
        let count = self.layers.len();
        let from = |view: usize| {
            let turn = std::f32::consts::TAU * view as f32 / count as f32;
            let eye = centre + Quat::from_axis_angle(up, turn) * (own_eye - centre);
            in_disc(PortraitView::facing(&points, eye, sight), &points)
        };
        (0..count).map(from).collect()
    }
}

/// The view widened until what it shows lies in the disc inscribed in the image, which rotation keeps.
fn in_disc(mut view: PortraitView, points: &[Vec3]) -> PortraitView {
    view.half = view.half.max(Vec2::splat(view.half.max_element() / LONGEST));
    let [right, up, towards] = view.axes;
    let reach = |&point: &Vec3| {
        let q = point - view.centre;
        let shrunk = match view.eye_distance {
            0.0 => 1.0,
            distance => distance / (distance - q.dot(towards)),
        };
        (shrunk * Vec2::new(q.dot(right), q.dot(up)) / view.half).length()
    };
    let farthest = points.iter().map(reach).fold(1.0, f32::max);
    // A texel or so for what is drawn at its border.
    view.half *= 1.01 * farthest;
    view
}

/// Lengths of a texel's narrower and wider side in the plane of a view, metres.
pub fn texel(view: &PortraitView, size: u32) -> [f32; 2] {
    [view.half.min_element(), view.half.max_element()].map(|half| 2.0 * half / size as f32)
}

/// What counts as one surface in a view's heights.
pub fn limits(view: &PortraitView, size: u32) -> Limits {
    let height = texel(view, size)[0] / (2.0 * view.reach);
    Limits { tolerance: TOLERANCE * height, jump: STEEPEST * height }
}
