//! The scene as the device's own ray queries search it, where the device has them.

use std::sync::Arc;

use glam::Affine3A;

use super::GpuScene;
use crate::error::Result;
use crate::gpu::{Acceleration, Device, Frame, Pass, Placement};
use crate::scene::ObjectId;

/// One structure a mesh, built once or whenever its shape changes, and one over the objects, built anew
/// when they move.
pub struct SceneStructure {
    device: Arc<Device>,
    built: Option<Acceleration>,
}

impl SceneStructure {
    /// # Errors
    /// [`crate::error::Error::Device`] where the device has no ray queries.
    pub fn new(device: &Arc<Device>) -> Result<Self> {
        device.require_ray_query()?;
        Ok(SceneStructure { device: device.clone(), built: None })
    }

    /// Make it that of the frame's moment. Passes are named under `owner`.
    ///
    /// # Errors
    /// [`crate::error::Error::Device`] where the scene is beyond the device's limits.
    pub fn prepare(&mut self, frame: &mut Frame, scene: &GpuScene, owner: &str) -> Result<()> {
        let place = |(object, pose): (ObjectId, &Affine3A)| Placement {
            mesh: scene.scene.objects[object as usize].mesh,
            pose: *pose,
            index: object,
            mask: 1,
            // Rays start on reflectors alone, and have their rule for those.
            opaque: !scene.scene.is_reflector(object),
        };
        let placements: Vec<_> = (0..).zip(&scene.moment().poses).map(place).collect();
        let structure = match &mut self.built {
            Some(structure) => {
                let wobbling: Vec<usize> = scene.scene.wobbles.keys().copied().collect();
                if !wobbling.is_empty() {
                    frame.pass(&format!("{owner}/build")).rebuild(structure, &wobbling)?;
                }
                structure
            }
            built => {
                let meshes = scene.meshes();
                let most = placements.len() as u32;
                let mut structure = Acceleration::new(&self.device, "scene", &meshes, most)?;
                frame.pass(&format!("{owner}/build")).build(&mut structure)?;
                built.insert(structure)
            }
        };
        frame.pass(&format!("{owner}/place")).place(structure, &placements)
    }

    /// Bind it to a pass whose shader imports `bindings::structure`.
    pub fn bind<'f>(&self, pass: Pass<'f>) -> Pass<'f> {
        match &self.built {
            Some(structure) => pass.acceleration("scene_structure", structure),
            None => pass,
        }
    }
}
