//! What is drawn: meshes, materials, lights, the camera's path, and how they move.
//!
//! A [`Scene`] comes from a TOML file ([`load`]); a [`Moment`] is one frame of it. Neither knows
//! how it will be drawn: [`crate::truth`] traces it, [`crate::stages`] uploads it.

mod departure;
mod file;
mod library;
pub mod material;
mod motion;
pub mod record;
mod select;
pub mod shading;
mod wobble;

use std::collections::BTreeMap;

use glam::{Affine3A, Vec2, Vec3};

use crate::geometry::{Camera, Mesh};
pub use departure::Departure;
pub use library::{SCENES_VARIABLE, list, load, scenes_dir};
pub use material::{Environment, Fade, Glass, Image, Lighting, Material, Mirror, Pattern};
pub use record::{FrameRecord, Ids, Lobe, ReflectionRecord, Source, Status};
pub use select::matches_pattern;
pub use wobble::Wobble;

/// Index into [`Scene::objects`]; also what the images of object ids hold.
pub type ObjectId = u32;

/// The object id that means "no object".
pub const NO_OBJECT: ObjectId = u32::MAX;

/// A scene file, read and checked. Everything is in metres, world y up.
#[derive(Clone, Debug)]
pub struct Scene {
    pub name: String,
    /// One line for `list scenes`.
    pub about: String,
    /// blake3 over the scene text and every asset it names, hexadecimal.
    pub hash: String,
    /// Length of the animation; frame numbers are 0..frames.
    pub frames: u32,
    /// Frames per second of the animation.
    pub rate_hz: f32,
    pub camera: CameraPath,
    pub objects: Vec<Object>,
    /// As modelled; [`Scene::mesh_at`] has them as they are at a moment.
    pub meshes: Vec<Mesh>,
    /// What changes the shape of meshes, by their index.
    pub wobbles: BTreeMap<usize, Wobble>,
    pub materials: Vec<Material>,
    pub images: Vec<Image>,
    pub environment: Environment,
    pub lighting: Lighting,
    /// Longest chain of mirrors the truth follows, at least 1.
    pub bounces: u32,
}

/// One material on one mesh. A file with several materials gives several objects of one group.
#[derive(Clone, Debug)]
pub struct Object {
    /// Unique; parts are called `group.part`.
    pub name: String,
    pub group: String,
    /// Index into [`Scene::meshes`].
    pub mesh: usize,
    /// The watertight mesh of the same pose that stands for an open reflector where methods search it
    /// (Estalella et al. 2006, section 5.1); never drawn.
    pub closed: Option<usize>,
    /// Index into [`Scene::materials`].
    pub material: usize,
    /// The closed form the mesh approximates, in object space, where there is one at all times.
    pub surface: Option<Surface>,
    pub motion: Motion,
    pub impostor: Impostor,
}

/// What stands for an object in methods that replace what is reflected by impostors.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Impostor {
    /// A picture placed from the object's bounds.
    #[default]
    Fitted,
    /// A picture that faces this way, a unit vector of object space.
    Facing(Vec3),
    /// None of its own: it is far away, and shown by the environment map.
    Backdrop,
}

/// Closed forms in object space, centred at the origin, round ones about the y axis. Metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Surface {
    Sphere {
        radius: f32,
    },
    /// Half axes along x, y and z.
    Ellipsoid {
        radii: Vec3,
    },
    /// `capped`: closed by discs at both ends.
    Cylinder {
        radius: f32,
        height: f32,
        capped: bool,
    },
    /// Lengths along x and z; the front is seen from +y.
    Rectangle {
        size: Vec2,
    },
    /// A circle of radius `tube` led round a circle of radius `ring`; `tube < ring`.
    Torus {
        ring: f32,
        tube: f32,
    },
}

impl Surface {
    /// The surface enlarged about the origin, as [`Mesh::scaled`] does it.
    pub fn scaled(self, factor: f32) -> Self {
        match self {
            Surface::Sphere { radius } => Surface::Sphere { radius: factor * radius },
            Surface::Ellipsoid { radii } => Surface::Ellipsoid { radii: factor * radii },
            Surface::Cylinder { radius, height, capped } => {
                Surface::Cylinder { radius: factor * radius, height: factor * height, capped }
            }
            Surface::Rectangle { size } => Surface::Rectangle { size: factor * size },
            Surface::Torus { ring, tube } => {
                Surface::Torus { ring: factor * ring, tube: factor * tube }
            }
        }
    }
}

/// Where an object is over time. Motions are rigid; sizes are in the mesh.
#[derive(Clone, Debug, PartialEq)]
pub enum Motion {
    Still(Affine3A),
    /// Poses at frames in rising order, blended linearly (rotations spherically), held outside.
    Keys(Vec<(f32, Affine3A)>),
    /// `pose` turned about the vertical axis through `centre`, one turn every `period` frames.
    Orbit {
        pose: Affine3A,
        centre: Vec3,
        period: f32,
    },
}

/// Where the camera is over time.
#[derive(Clone, Debug, PartialEq)]
pub enum CameraPath {
    /// Key frames in rising order, positions and targets blended linearly, held outside.
    Keys(Vec<(f32, Camera)>),
    /// `camera` turned about the vertical axis through its target: `start` radians at frame 0, one
    /// turn (or, with `sweep`, a pendulum of that many radians either way) every `period` frames.
    Orbit { camera: Camera, start: f32, period: f32, sweep: Option<f32> },
}

/// One frame of a scene: camera, object poses, and the time that waves on surfaces go by.
#[derive(Clone, Debug, PartialEq)]
pub struct Moment {
    pub frame: u32,
    /// Frames since the start of the animation.
    pub time: f32,
    pub camera: Camera,
    /// World from object space, one an object.
    pub poses: Vec<Affine3A>,
}

impl Scene {
    pub fn material_of(&self, object: ObjectId) -> &Material {
        &self.materials[self.objects[object as usize].material]
    }

    /// An object's mesh as modelled: at rest, where it wobbles.
    pub fn mesh_of(&self, object: ObjectId) -> &Mesh {
        &self.meshes[self.objects[object as usize].mesh]
    }

    /// Whether an object is a mirror or of glass.
    pub fn is_reflector(&self, object: ObjectId) -> bool {
        self.material_of(object).is_reflector()
    }

    /// Whether anything is of glass, so that reflectors have a second lobe.
    pub fn refracts(&self) -> bool {
        self.objects.iter().any(|object| self.materials[object.material].glass.is_some())
    }

    /// Whether any mirror's share depends on the angle.
    pub fn has_fresnel_mirrors(&self) -> bool {
        let mirrors =
            self.objects.iter().filter_map(|object| self.materials[object.material].mirror);
        mirrors.into_iter().any(|mirror| mirror.fresnel)
    }

    /// Whether any mirror's reflection fades with distance.
    pub fn fades(&self) -> bool {
        let mirrors =
            self.objects.iter().filter_map(|object| self.materials[object.material].mirror);
        mirrors.into_iter().any(|mirror| mirror.fade.is_some())
    }

    /// Whether any object moves.
    pub fn moves(&self) -> bool {
        (0..self.objects.len() as ObjectId).any(|object| self.is_moving(object))
    }

    /// Whether an object's pose or surface changes over time.
    pub fn is_moving(&self, object: ObjectId) -> bool {
        !matches!(self.objects[object as usize].motion, Motion::Still(_)) || self.wobbles(object)
    }

    /// The reflectors that light leaves by a lobe, in rising order.
    pub fn with_lobe(&self, lobe: Lobe) -> Vec<ObjectId> {
        let mut reflectors = self.reflectors();
        if lobe == Lobe::Refracted {
            reflectors.retain(|&object| self.material_of(object).glass.is_some());
        }
        reflectors
    }

    /// The mirrors and things of glass, in rising order.
    pub fn reflectors(&self) -> Vec<ObjectId> {
        (0..self.objects.len() as ObjectId).filter(|&o| self.is_reflector(o)).collect()
    }
}
