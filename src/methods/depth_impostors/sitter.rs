//! Which objects have depth images, and how these look at them.

use glam::{Quat, Vec2, Vec3};

use crate::geometry::depth_rows::Limits;
use crate::scene::{Impostor, Moment, ObjectId, Scene};
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

/// Ways that a reflector's own images look at it from, in its own space; the first so many. Opposite ones first, so
/// that two have both its sides.
pub const OWN_WAYS: [Vec3; 6] = [Vec3::Z, Vec3::NEG_Z, Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y];

/// What one reflector's depth images are of: an object, or those of a group that move as one.
pub struct Sitter {
    pub objects: Vec<ObjectId>,
    /// Part of the reflector itself.
    pub own: bool,
    /// First layer of its images, and how many it has.
    pub layers: std::ops::Range<u32>,
}

/// How many there may be.
#[derive(Clone, Copy)]
pub struct Most {
    /// Objects other than the reflector.
    pub objects: usize,
    /// Images of each.
    pub views: u32,
    /// Images of the reflector itself.
    pub own: u32,
    /// What the scene calls its backdrop is in a map of what is far away, and not among the objects.
    pub mapped: bool,
}

/// Whatever reflects nothing and is no backdrop, in groups that move as one, those first that look largest from the reflectors'
/// middle; then the mirrors among the reflectors themselves.
pub fn sitters(scene: &Scene, reflectors: &[ObjectId], most: Most) -> Vec<Sitter> {
    let moment = scene.at(0);
    let eye = scene.centre_of(&moment, reflectors);
    let is_far =
        |o: ObjectId| most.mapped && scene.objects[o as usize].impostor == Impostor::Backdrop;
    let diffuse: Vec<ObjectId> = (0..scene.objects.len() as ObjectId)
        .filter(|&o| !scene.is_reflector(o) && !is_far(o))
        .collect();
    let mut others = bodies(scene, &diffuse);
    let nearness = |objects: &Vec<ObjectId>| {
        let (low, high) = scene.bounds_of(&moment, objects);
        (high - low).length() / (0.5 * (low + high) - eye).length().max(1e-6)
    };
    others.sort_by(|a, b| nearness(b).total_cmp(&nearness(a)));
    others.truncate(most.objects);
    let is_mirror = |&object: &ObjectId| scene.material_of(object).mirror.is_some();
    let mirrors: Vec<ObjectId> = reflectors.iter().copied().filter(is_mirror).collect();
    let own = if most.own > 0 { bodies(scene, &mirrors) } else { Vec::new() };
    let all = others.into_iter().map(|objects| (objects, false));
    let mut first = 0;
    let mut sitter = |(objects, own): (Vec<ObjectId>, bool)| {
        let faces_one_way = faced(scene, &objects).is_some();
        let count = match own {
            true => most.own,
            false if faces_one_way || is_flat(scene, &moment, &objects) => 1,
            false => most.views,
        };
        let layers = first..first + count;
        first += count;
        Sitter { objects, own, layers }
    };
    all.chain(own.into_iter().map(|objects| (objects, true))).map(&mut sitter).collect()
}

/// Objects in groups that move as one.
fn bodies(scene: &Scene, objects: &[ObjectId]) -> Vec<Vec<ObjectId>> {
    let motion = |&o: &ObjectId| &scene.objects[o as usize].motion;
    let mut bodies: Vec<Vec<ObjectId>> = Vec::new();
    for (_, members) in scene.groups(objects) {
        let mut parts: Vec<Vec<ObjectId>> = Vec::new();
        for object in members {
            match parts.iter_mut().find(|part| motion(&part[0]) == motion(&object)) {
                Some(part) => part.push(object),
                None => parts.push(vec![object]),
            }
        }
        bodies.append(&mut parts);
    }
    bodies
}

/// Whether the scene has objects that are shown by a map of what is far away.
pub fn has_backdrop(scene: &Scene, most: Most) -> bool {
    most.mapped && scene.objects.iter().any(|object| object.impostor == Impostor::Backdrop)
}

fn is_flat(scene: &Scene, moment: &Moment, objects: &[ObjectId]) -> bool {
    PortraitView::flatness(&own_points(scene, moment, objects)) < FLAT
}

/// The one way that the scene has the impostor of some objects face.
fn faced(scene: &Scene, objects: &[ObjectId]) -> Option<Vec3> {
    match scene.objects[objects[0] as usize].impostor {
        Impostor::Facing(towards) => Some(towards),
        Impostor::Fitted | Impostor::Backdrop => None,
    }
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
        if self.own {
            let from = |&way: &Vec3| from_afar(&points, way);
            return OWN_WAYS[..self.layers.len()].iter().map(from).collect();
        }
        if let Some(towards) = faced(scene, &self.objects) {
            return vec![from_afar(&points, towards)];
        }
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

/// Under parallel rays.
fn from_afar(points: &[Vec3], towards: Vec3) -> PortraitView {
    // So far away that where the points' middle is does not count.
    let eye = 1e4 * towards;
    in_disc(PortraitView::facing(points, eye, Sight::Parallel), points)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn impostors_face_where_the_scene_has_them_face_and_mirrors_have_their_own() {
        let mut scene = crate::scene::load("statue").unwrap();
        let towards = Vec3::new(0.6, 0.0, 0.8);
        let statue = scene.objects.iter().position(|object| object.group == "statue").unwrap();
        scene.objects[statue].impostor = Impostor::Facing(towards);
        let most = Most { objects: 16, views: 2, own: 6, mapped: true };
        let sitters = sitters(&scene, &scene.reflectors(), most);
        let of = |object: usize| {
            let has = |sitter: &&Sitter| sitter.objects.contains(&(object as ObjectId));
            sitters.iter().find(has).unwrap()
        };
        let views =
            |sitter: &Sitter| sitter.views(&scene, &scene.at(0), Vec3::ZERO, Sight::Central);
        let faced = views(of(statue));
        assert_eq!(faced.len(), 1);
        assert!(faced[0].axes[2].abs_diff_eq(towards, 1e-3) && faced[0].eye_distance == 0.0);
        let own = of(scene.reflectors()[0] as usize);
        assert!(own.own && own.layers.len() == 6);
        assert_eq!(own.layers.end, sitters.iter().map(|s| s.layers.len() as u32).sum::<u32>());
        for (view, way) in views(own).iter().zip(OWN_WAYS) {
            assert!(view.axes[2].abs_diff_eq(way, 1e-3), "{way}");
        }
    }
}
