//! Surfaces that change their shape over time.

use std::borrow::Cow;

use super::{Moment, ObjectId, Scene};
use crate::geometry::Mesh;
use crate::geometry::wave::{Relief, Wave};

/// A wave that travels over a mesh.
#[derive(Clone, Debug)]
pub struct Wobble {
    wave: Wave,
    /// Frames a crest takes from one place to that of the next.
    period: f32,
    relief: Relief,
}

impl Wobble {
    /// For the mesh at rest; `period` in frames.
    pub fn new(mesh: &Mesh, wave: Wave, period: f32) -> Self {
        Wobble { wave, period, relief: Relief::new(mesh) }
    }

    /// The mesh, given at rest, at a time in frames.
    pub fn at(&self, mesh: &Mesh, time: f32) -> Mesh {
        self.relief.displaced(mesh, &self.wave, (time / self.period).fract())
    }
}

impl Scene {
    /// Whether an object's surface changes its shape.
    pub fn wobbles(&self, object: ObjectId) -> bool {
        self.wobbles.contains_key(&self.objects[object as usize].mesh)
    }

    /// An object's mesh at a moment, object space: what the truth traces, the measures follow and the
    /// GPU draws.
    pub fn mesh_at(&self, moment: &Moment, object: ObjectId) -> Cow<'_, Mesh> {
        self.shape_at(moment, self.objects[object as usize].mesh)
    }

    /// All of [`Scene::meshes`] at a moment.
    pub fn meshes_at(&self, moment: &Moment) -> Vec<Cow<'_, Mesh>> {
        (0..self.meshes.len()).map(|mesh| self.shape_at(moment, mesh)).collect()
    }

    pub(super) fn shape_at(&self, moment: &Moment, mesh: usize) -> Cow<'_, Mesh> {
        let rest = &self.meshes[mesh];
        match self.wobbles.get(&mesh) {
            None => Cow::Borrowed(rest),
            Some(wobble) => Cow::Owned(wobble.at(rest, moment.time)),
        }
    }
}
