//! What fills the pixels a method left missing or flagged.

use std::sync::Arc;

use super::{GpuScene, RecordMode, ReflectionRecord, View};
use crate::error::Result;
use crate::gpu::{ComputePipeline, Device, Frame};

/// Fills them with the environment in the mirrored direction.
pub struct EnvironmentFallback {
    pipeline: ComputePipeline,
}

impl EnvironmentFallback {
    pub fn new(device: &Arc<Device>, mode: RecordMode) -> Result<Self> {
        let file = "stages/fallback.wgsl";
        Ok(EnvironmentFallback { pipeline: ComputePipeline::new(device, file, &mode.defines())? })
    }

    pub fn fill(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        view: &View,
        record: &ReflectionRecord,
    ) -> Result<()> {
        view.list_pixels(frame, scene, &scene.scene.reflectors())?;
        let pass = frame.pass("fallback/environment").compute(&self.pipeline);
        let pass = record.bind(view.bind(scene.bind(pass)));
        // Each invocation reads the answer of its own pixel before it writes it.
        pass.sample("answer", &record.radiance).indirect(&view.footprint.pixels)
    }
}
