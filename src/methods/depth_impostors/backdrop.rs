//! What is shown beyond all impostors: a map of what is far away, taken from a mirror's middle.

use std::sync::Arc;

use glam::Vec3;

use super::NAME;
use super::sitter::Sitter;
use crate::error::Result;
use crate::gpu::{Device, Frame, Pass};
use crate::scene::{ObjectId, Scene};
use crate::stages::{Capture, CaptureStage, GpuScene};

/// Texels along a face's side.
const SIZE: u32 = 512;

/// A map of all that has no impostor and reflects nothing.
pub struct Backdrop {
    map: Capture,
    /// Whether it has to be taken in every frame.
    moves: bool,
    left_out: Vec<ObjectId>,
}

impl Backdrop {
    pub fn new(
        device: &Arc<Device>,
        name: &str,
        scene: &Scene,
        sitters: &[Sitter],
    ) -> Result<Backdrop> {
        let has_impostor = |object| sitters.iter().any(|sitter| sitter.objects.contains(&object));
        let objects = 0..scene.objects.len() as ObjectId;
        let (left_out, shown): (Vec<_>, Vec<_>) =
            objects.partition(|&object| scene.is_reflector(object) || has_impostor(object));
        let moves = shown.into_iter().any(|object| scene.is_moving(object));
        let mut map = Capture::new(device, name, SIZE)?;
        // Nowhere yet.
        map.centre = Vec3::NAN;
        Ok(Backdrop { map, moves, left_out })
    }

    /// Take it from the reflectors' middle, where it is not as it was.
    pub fn take(
        &mut self,
        frame: &mut Frame,
        scene: &GpuScene,
        stage: &CaptureStage,
        reflectors: &[ObjectId],
        shading: bool,
    ) -> Result<()> {
        let centre = scene.scene.centre_of(scene.moment(), reflectors);
        if shading || self.moves || self.map.centre != centre {
            stage.capture(frame, scene, NAME, &mut self.map, centre, &self.left_out)?;
        }
        Ok(())
    }

    pub fn bind<'f>(&'f self, pass: Pass<'f>) -> Pass<'f> {
        pass.sample("map_radiance", &self.map.radiance)
            .sample("map_point", &self.map.point)
            .optional()
            .sample("map_ids", &self.map.ids)
            .optional()
    }
}
