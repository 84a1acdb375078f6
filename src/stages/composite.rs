//! The records of all lobes into the picture.

use std::sync::Arc;

use super::{GpuScene, ReflectionRecord, View};
use crate::error::Result;
use crate::gpu::{ComputePipeline, Device, Format, Frame, Image, Shape};

/// Pipeline and image of the finished picture.
pub struct Composite {
    pipeline: ComputePipeline,
    /// Linear colour.
    pub picture: Image,
}

impl Composite {
    pub fn new(device: &Arc<Device>, scene: &GpuScene, size: [u32; 2]) -> Result<Composite> {
        let file = "stages/composite.wgsl";
        let mut defines = scene.defines();
        if scene.scene.refracts() || scene.scene.has_fresnel_mirrors() {
            defines.push(("BY_ANGLE", 1));
        }
        if scene.scene.fades() {
            defines.push(("FADES", 1));
        }
        Ok(Composite {
            pipeline: ComputePipeline::new(device, file, &defines)?,
            picture: Image::new(device, "picture", Format::Rgba16Float, size, Shape::Flat)?,
        })
    }

    pub fn run(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        view: &View,
        record: &ReflectionRecord,
        refracted: Option<&ReflectionRecord>,
    ) -> Result<()> {
        let pass = frame.pass("composite").compute(&self.pipeline);
        let mut pass = view.bind(scene.bind(pass));
        if let Some(refracted) = refracted {
            pass = pass.sample("refracted", &refracted.radiance);
        }
        record
            .bind_last(pass)
            .sample("direct", &view.direct.colour)
            .sample("radiance", &record.radiance)
            .store("picture", &self.picture)
            .over_pixels(self.picture.size)
    }
}
