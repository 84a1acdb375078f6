//! A reflector's triangles and their neighbours.

use std::sync::Arc;

use crate::error::Result;
use crate::gpu::{Buffer, Device};
use crate::scene::{ObjectId, Scene};

/// Beyond a border; `NONE` of `shaders/explosion_map/walk.wgsl`.
const NONE: u32 = u32::MAX;

/// One reflector, or the closed partner it has.
pub struct Reflector {
    pub object: ObjectId,
    /// Three times its triangles.
    pub corners: u32,
    /// Three a triangle: the one beyond the edge opposite to each corner.
    pub neighbours: Buffer,
}

impl Reflector {
    /// # Errors
    /// [`crate::error::Error::Device`] with the numbers when the list is beyond the device's limits.
    pub fn new(device: &Arc<Device>, scene: &Scene, object: ObjectId) -> Result<Reflector> {
        let own = &scene.objects[object as usize];
        let mesh = &scene.meshes[own.closed.unwrap_or(own.mesh)];
        let neighbours: Vec<u32> =
            mesh.neighbours().into_iter().flatten().map(|n| n.unwrap_or(NONE)).collect();
        Ok(Reflector {
            object,
            corners: neighbours.len() as u32,
            neighbours: Buffer::with_data(device, "neighbours of triangles", &neighbours)?,
        })
    }
}
