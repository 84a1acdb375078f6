//! One view: what a method is given besides the scene.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use super::{DirectView, Footprint};
use crate::error::Result;
use crate::geometry::{Camera, Projection};
use crate::gpu::{Frame, Pass};
use crate::scene::{Lobe, ObjectId};

/// WGSL `Camera` of `shaders/common/camera.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub struct CameraUniform {
    clip_from_world: [[f32; 4]; 4],
    eye: [f32; 3],
    orthographic: u32,
    forward: [f32; 3],
    pad: u32,
    right: [f32; 3],
    half_width: f32,
    up: [f32; 3],
    half_height: f32,
}

impl CameraUniform {
    /// World position of the eye.
    pub fn eye(&self) -> Vec3 {
        Vec3::from_array(self.eye)
    }

    /// The camera for an image of `size` pixels.
    pub fn new(camera: &Camera, size: [u32; 2]) -> CameraUniform {
        let [right, up, back] = camera.axes();
        let aspect = size[0] as f32 / size[1] as f32;
        let (orthographic, half_height) = match camera.projection {
            Projection::Perspective { fov_y } => (0, (0.5 * fov_y).tan()),
            Projection::Orthographic { height } => (1, 0.5 * height),
        };
        CameraUniform {
            clip_from_world: camera.clip_from_world(size).to_cols_array_2d(),
            eye: camera.eye.to_array(),
            orthographic,
            forward: (-back).to_array(),
            pad: 0,
            right: right.to_array(),
            half_width: aspect * half_height,
            up: up.to_array(),
            half_height,
        }
    }
}

/// The view a method fills the record for.
pub struct View<'a> {
    pub camera: CameraUniform,
    /// Width and height in pixels.
    pub size: [u32; 2],
    pub direct: &'a DirectView,
    pub footprint: &'a Footprint,
    /// The reflectors the method is asked for; it writes their pixels only.
    pub reflectors: &'a [ObjectId],
    /// The lobe of theirs that the record is for.
    pub lobe: Lobe,
    /// The last call was not for the frame before this one: what was learnt from it is void.
    pub cut: bool,
}

impl<'a> View<'a> {
    /// Bind what a shader wants of the camera and the footprint, pixel list included.
    pub fn bind<'f>(&self, pass: Pass<'f>) -> Pass<'f>
    where
        'a: 'f,
    {
        let footprint = self.footprint;
        pass.uniform("camera", &self.camera)
            .optional()
            .sample("reflector_id", &footprint.reflector)
            .optional()
            .sample("reflector_position", &footprint.position)
            .optional()
            .sample("reflector_normal", &footprint.normal)
            .optional()
            .buffer("pixels", &footprint.pixels)
            .optional()
            .uniform("lobe", &(self.lobe as u32))
            .optional()
    }

    /// Make the footprint's pixel list that of these reflectors, as far as they are asked for.
    pub fn list_pixels(
        &self,
        frame: &mut Frame,
        scene: &super::GpuScene,
        reflectors: &[ObjectId],
    ) -> Result<()> {
        self.footprint.list_pixels(frame, scene, &self.asked(reflectors))
    }

    /// Those of these reflectors that the view asks for.
    pub fn asked(&self, reflectors: &[ObjectId]) -> Vec<ObjectId> {
        let asked = reflectors.iter().filter(|object| self.reflectors.contains(object));
        asked.copied().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::assert_layout;

    #[test]
    #[rustfmt::skip]
    fn the_camera_is_laid_out_as_its_wgsl_twin() {
        assert_layout!("stages/direct_view.wgsl", "Camera", CameraUniform,
            clip_from_world, eye, orthographic, forward, pad, right, half_width, up, half_height);
    }
}
