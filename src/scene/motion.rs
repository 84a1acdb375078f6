//! A scene at one moment: the camera, every object's pose, and what has moved since another.

use glam::{Affine3A, Quat, Vec3};

use super::{CameraPath, Moment, Motion, ObjectId, Scene};
use crate::geometry::{Camera, Mesh};

impl Scene {
    /// The scene at a frame. Orbits go on beyond the last frame, key frames hold.
    pub fn at(&self, frame: u32) -> Moment {
        self.at_time(frame, frame as f32)
    }

    /// The scene at a time between frames, which counts as frame number `frame`.
    pub fn at_time(&self, frame: u32, time: f32) -> Moment {
        Moment {
            frame,
            time,
            camera: self.camera.at(time),
            poses: self.objects.iter().map(|object| object.motion.at(time)).collect(),
        }
    }

    /// Whether an object's pose or surface is another at `now` than at `before`.
    pub fn has_moved(&self, object: ObjectId, before: &Moment, now: &Moment) -> bool {
        let pose = |moment: &Moment| moment.poses[object as usize];
        pose(before) != pose(now) || before.time != now.time && self.wobbles(object)
    }

    /// The box around all objects at a moment: smallest and largest world coordinates. A scene
    /// without objects has the origin.
    pub fn bounds(&self, moment: &Moment) -> (Vec3, Vec3) {
        let all: Vec<_> = (0..self.objects.len() as ObjectId).collect();
        self.bounds_of(moment, &all)
    }

    /// The box around some objects, as [`Scene::bounds`].
    pub fn bounds_of(&self, moment: &Moment, objects: &[ObjectId]) -> (Vec3, Vec3) {
        let boxes = objects.iter().map(|&object| self.object_bounds(moment, object));
        boxes.reduce(|(a, b), (c, d)| (a.min(c), b.max(d))).unwrap_or((Vec3::ZERO, Vec3::ZERO))
    }

    /// The middle of the box around some objects: where a map for them is taken from, as a map is
    /// "rendered from the centroid of the reflector" (Martin & Popescu 2004, section 2.1).
    pub fn centre_of(&self, moment: &Moment, objects: &[ObjectId]) -> Vec3 {
        let (low, high) = self.bounds_of(moment, objects);
        0.5 * (low + high)
    }

    /// The corners of an object's triangles in the world at a moment, in the mesh's order.
    pub fn world_triangles(
        &self,
        moment: &Moment,
        object: ObjectId,
    ) -> impl Iterator<Item = [Vec3; 3]> {
        let (mesh, pose) = (self.mesh_at(moment, object), moment.poses[object as usize]);
        (0..mesh.triangles.len())
            .map(move |index| mesh.corners(index).map(|corner| pose.transform_point3(corner)))
    }

    /// The world positions of an object's vertices at a moment, or of the closed partner it has.
    pub fn closed_points_of(&self, moment: &Moment, object: ObjectId) -> Vec<Vec3> {
        let own = &self.objects[object as usize];
        let mesh = self.shape_at(moment, own.closed.unwrap_or(own.mesh));
        posed(&mesh, moment, object)
    }

    /// The vertices of an object itself in the world at a moment.
    pub fn points_of(&self, moment: &Moment, object: ObjectId) -> Vec<Vec3> {
        posed(&self.mesh_at(moment, object), moment, object)
    }

    /// The centroid of the surface whose points [`Scene::closed_points_of`] gives, in object space.
    pub fn closed_centroid_of(&self, moment: &Moment, object: ObjectId) -> Vec3 {
        let own = &self.objects[object as usize];
        self.shape_at(moment, own.closed.unwrap_or(own.mesh)).centroid()
    }

    /// The world box of one object at a moment.
    pub fn object_bounds(&self, moment: &Moment, object: ObjectId) -> (Vec3, Vec3) {
        let pose = moment.poses[object as usize];
        let mesh = self.mesh_at(moment, object);
        let world = mesh.positions.iter().map(|&p| pose.transform_point3(p));
        let empty = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        world.fold(empty, |(low, high), p| (low.min(p), high.max(p)))
    }
}

impl Motion {
    /// World from object space at `frame`.
    pub fn at(&self, frame: f32) -> Affine3A {
        match self {
            Motion::Still(pose) => *pose,
            Motion::Keys(keys) => between(keys, frame, blend_poses),
            Motion::Orbit { pose, centre, period } => {
                let turn = Affine3A::from_rotation_y(turned(frame, *period));
                let to_centre = Affine3A::from_translation(*centre);
                to_centre * turn * to_centre.inverse() * *pose
            }
        }
    }
}

/// A mesh's vertices where its object is, world.
fn posed(mesh: &Mesh, moment: &Moment, object: ObjectId) -> Vec<Vec3> {
    let pose = moment.poses[object as usize];
    mesh.positions.iter().map(|&p| pose.transform_point3(p)).collect()
}

impl CameraPath {
    /// The camera at `frame`.
    pub fn at(&self, frame: f32) -> Camera {
        match self {
            CameraPath::Keys(keys) => between(keys, frame, blend_cameras),
            CameraPath::Orbit { camera, start, period, sweep } => {
                let turn = turned(frame, *period);
                let angle = start + sweep.map_or(turn, |sweep| sweep * turn.sin());
                let arm = Quat::from_rotation_y(angle) * (camera.eye - camera.target);
                Camera { eye: camera.target + arm, ..*camera }
            }
        }
    }
}

/// Radians after `frame` of `period` frames a turn.
fn turned(frame: f32, period: f32) -> f32 {
    std::f32::consts::TAU * (frame / period).fract()
}

/// The value at `frame` between the keys around it; the first or last key outside. Not empty.
fn between<T: Copy>(keys: &[(f32, T)], frame: f32, blend: fn(T, T, f32) -> T) -> T {
    let after = keys.partition_point(|(time, _)| *time <= frame);
    match (after.checked_sub(1).map(|before| keys[before]), keys.get(after)) {
        (Some((start, a)), Some(&(end, b))) => blend(a, b, (frame - start) / (end - start)),
        (Some((_, a)), None) => a,
        (None, _) => keys[0].1,
    }
}

fn blend_poses(a: Affine3A, b: Affine3A, t: f32) -> Affine3A {
    let (_, rotation_a, from) = a.to_scale_rotation_translation();
    let (_, rotation_b, to) = b.to_scale_rotation_translation();
    Affine3A::from_rotation_translation(rotation_a.slerp(rotation_b, t), from.lerp(to, t))
}

fn blend_cameras(a: Camera, b: Camera, t: f32) -> Camera {
    Camera { eye: a.eye.lerp(b.eye, t), target: a.target.lerp(b.target, t), ..a }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Projection;

    fn camera(eye: Vec3) -> Camera {
        let projection = Projection::Perspective { fov_y: 1.0 };
        Camera { eye, target: Vec3::Y, up: Vec3::Y, projection, near: 0.1, far: 10.0 }
    }

    #[test]
    fn keys_are_blended_between_and_held_outside() {
        let pose = |x: f32, turn: f32| {
            Affine3A::from_rotation_translation(Quat::from_rotation_y(turn), Vec3::X * x)
        };
        let motion = Motion::Keys(vec![(10.0, pose(0.0, 0.0)), (20.0, pose(2.0, 1.0))]);
        for (frame, expected) in [
            (0.0, pose(0.0, 0.0)),
            (15.0, pose(1.0, 0.5)),
            (20.0, pose(2.0, 1.0)),
            (99.0, pose(2.0, 1.0)),
        ] {
            assert!(motion.at(frame).abs_diff_eq(expected, 1e-5), "at frame {frame}");
        }
    }

    #[test]
    fn an_orbit_turns_counter_clockwise_seen_from_above() {
        let pose = Affine3A::from_translation(Vec3::new(2.0, 1.0, 0.0));
        let motion = Motion::Orbit { pose, centre: Vec3::X, period: 8.0 };
        let at = |frame| Vec3::from(motion.at(frame).translation);
        assert!(at(0.0).abs_diff_eq(Vec3::new(2.0, 1.0, 0.0), 1e-6));
        assert!(at(2.0).abs_diff_eq(Vec3::new(1.0, 1.0, -1.0), 1e-6));
        assert!(at(8.0).abs_diff_eq(at(0.0), 1e-6));
    }

    #[test]
    fn a_camera_circles_or_swings() {
        let camera = camera(Vec3::new(0.0, 2.0, 4.0));
        let circle = CameraPath::Orbit { camera, start: 0.0, period: 4.0, sweep: None };
        assert!(circle.at(1.0).eye.abs_diff_eq(Vec3::new(4.0, 2.0, 0.0), 1e-5));
        assert_eq!(circle.at(0.0), camera);

        let sweep = Some(0.5);
        let swing = CameraPath::Orbit { camera, start: 0.1, period: 4.0, sweep };
        for (frame, angle) in [(0.0, 0.1f32), (1.0, 0.6), (2.0, 0.1), (3.0, -0.4)] {
            let expected = Vec3::new(4.0 * angle.sin(), 2.0, 4.0 * angle.cos());
            assert!(swing.at(frame).eye.abs_diff_eq(expected, 1e-5), "at frame {frame}");
        }
    }
}
