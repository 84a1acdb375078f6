//! Records into the picture.

use std::sync::Arc;

use super::{DirectView, Footprint, GpuScene, ReflectionRecord};
use crate::error::Result;
use crate::gpu::{ComputePipeline, Device, Format, Frame, Image, Shape};

/// Pipeline and image of the finished picture.
pub struct Composite {
    pipeline: ComputePipeline,
    /// Linear colour.
    pub picture: Image,
}

impl Composite {
    pub fn new(device: &Arc<Device>, size: [u32; 2]) -> Result<Composite> {
        Ok(Composite {
            pipeline: ComputePipeline::new(device, "stages/composite.wgsl", &[])?,
            picture: Image::new(device, "picture", Format::Rgba16Float, size, Shape::Flat)?,
        })
    }

    pub fn run(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        direct: &DirectView,
        footprint: &Footprint,
        record: &ReflectionRecord,
    ) -> Result<()> {
        let pass = frame.pass("composite").compute(&self.pipeline);
        scene
            .bind(pass)
            .sample("direct", &direct.colour)
            .sample("radiance", &record.radiance)
            .sample("reflector_id", &footprint.reflector)
            .store("picture", &self.picture)
            .over_pixels(self.picture.size)
    }
}
