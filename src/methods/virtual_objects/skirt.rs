//! A skirt about an open reflector, for searches that leave it by its edge, in place of a closed partner
//! (Estalella et al. 2006, section 5.1).

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};

use crate::error::Result;
use crate::gpu::{ComputePipeline, Device, Format, Frame};
use crate::scene::ObjectId;
use crate::stages::{CameraUniform, GBuffer, GpuScene};

/// Of a skirt's width: between the samples that a surface is carried on from, so that its bend stands out from the
/// noise of facets; and between the first looks for the edge.
const STRIDE: f32 = 0.2;
const STEP: f32 = 0.25;

/// WGSL `Skirt` of `shaders/virtual_objects/skirt.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct SkirtStruct {
    steps: i32,
    step: i32,
    stride: i32,
    pad: i32,
    size: [i32; 2],
}

/// Pipeline and images of a skirt.
pub struct Skirt {
    pipeline: ComputePipeline,
    /// What the textures show, before the skirt.
    bare: GBuffer,
    /// Beyond the edge, as a share of the textures' smaller side.
    share: f32,
}

impl Skirt {
    /// For textures of `size` texels; `format` as of [`GBuffer::new`].
    ///
    /// # Errors
    /// As of pipelines and images.
    pub fn new(device: &Arc<Device>, size: [u32; 2], format: Format, share: f32) -> Result<Skirt> {
        Ok(Skirt {
            pipeline: ComputePipeline::new(device, "virtual_objects/skirt.wgsl", &[])?,
            bare: GBuffer::new(device, size, format)?,
            share,
        })
    }

    /// What shows a reflector and its skirt, where the camera shows the reflector.
    pub fn camera(&self, camera: CameraUniform) -> CameraUniform {
        camera.widened(1.0 / (1.0 - 2.0 * self.share))
    }

    /// Draw one reflector, no closed partner, and carry it on, into a G-buffer of 32-bit floats.
    pub fn draw(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        reflector: ObjectId,
        camera: &CameraUniform,
        gbuffer: &GBuffer,
    ) -> Result<()> {
        let bare = &self.bare;
        bare.draw_open(frame, scene, "virtual-objects", reflector, camera)?;
        let width = self.share * bare.size[0].min(bare.size[1]) as f32;
        let [stride, step] = [STRIDE, STEP].map(|part| (part * width).round().max(1.0));
        let skirt = SkirtStruct {
            steps: (width / step).ceil() as i32,
            step: step as i32,
            stride: stride as i32,
            pad: 0,
            size: bare.size.map(|side| side as i32),
        };
        frame
            .pass("virtual-objects/skirt")
            .compute(&self.pipeline)
            .storage_struct("skirt", &skirt)
            .sample("mirror_position", &bare.position)
            .sample("mirror_normal", &bare.normal)
            .store("position", &gbuffer.position)
            .store("normal", &gbuffer.normal)
            .uniform("camera", camera)
            .over_pixels(bare.size)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::assert_layout;

    #[test]
    #[rustfmt::skip]
    fn the_struct_is_laid_out_as_its_wgsl_twin() {
        assert_layout!("virtual_objects/skirt.wgsl", "Skirt", SkirtStruct,
            steps, step, stride, pad, size);
    }
}
