//! The environment as mirrors show it: what forward methods draw the mirrored scene over.

use std::sync::Arc;

use super::{GpuScene, RecordMode, ReflectionRecord, View};
use crate::error::Result;
use crate::gpu::{ComputePipeline, Device, Frame};

/// Pipeline that fills mirrors' pixels with the environment in the mirrored direction.
pub struct MirroredEnvironment {
    pipeline: ComputePipeline,
}

impl MirroredEnvironment {
    pub fn new(device: &Arc<Device>, mode: RecordMode) -> Result<Self> {
        let file = "stages/mirrored_environment.wgsl";
        Ok(MirroredEnvironment { pipeline: ComputePipeline::new(device, file, &mode.defines())? })
    }

    /// Fill the pixels of the view's reflectors. `name` begins the pass's name.
    pub fn fill(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        name: &str,
        view: &View,
        record: &ReflectionRecord,
    ) -> Result<()> {
        view.list_pixels(frame, scene, view.reflectors)?;
        let pass = frame.pass(&format!("{name}/background")).compute(&self.pipeline);
        record.bind(view.bind(scene.bind(pass))).indirect(&view.footprint.pixels)
    }
}
