//! One case, set up on one device for one scene and size: draws frames, reads them back, times them.

use std::path::PathBuf;
use std::sync::Arc;

use crate::error::{Error, Result};
use crate::gpu::Device;
use crate::methods::{Case, MethodInfo};
use crate::scene::{FrameRecord, Moment, Scene};

/// Time of one pass of one frame.
#[derive(Clone, Debug, PartialEq)]
pub struct PassTime {
    /// `method/step`, as given to `Frame::pass`.
    pub name: String,
    /// GPU milliseconds between the timestamps around the pass; 0 for a CPU scope.
    pub gpu_ms: f64,
    /// CPU milliseconds of a CPU scope; 0 for a GPU pass.
    pub cpu_ms: f64,
    /// Shader invocations from the pipeline statistics, where counted.
    pub invocations: u64,
    /// When it began, milliseconds after the frame's first timestamp.
    pub begin_ms: f64,
}

/// Times of one frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrameTimes {
    /// Passes recorded by the method's `prepare`; empty when nothing it depends on moved.
    pub prepare: Vec<PassTime>,
    /// All other passes, in order.
    pub passes: Vec<PassTime>,
    /// GPU milliseconds from the first timestamp to the last, prepare not included.
    pub frame_gpu_ms: f64,
    /// Bytes of device memory the prepared structures hold.
    pub prepare_bytes: u64,
    /// The method's counters, named as in its `MethodInfo`.
    pub counters: Vec<(String, u64)>,
}

/// What is written into the record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecordMode {
    /// Radiance only: what a renderer needs; for timing.
    Radiance,
    /// Radiance and the evidence: for accuracy.
    Full,
}

/// What fills pixels the method left missing or flagged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fallback {
    None,
    Environment,
    Ray,
}

/// How an engine is set up.
#[derive(Clone, Debug)]
pub struct RunOptions {
    pub size: [u32; 2],
    pub record: RecordMode,
    pub fallback: Fallback,
    /// Read shaders from here instead of from the program.
    pub shader_dir: Option<PathBuf>,
    /// Write the stored images of passes that match the pattern into the folder.
    pub dump: Option<(String, PathBuf)>,
    pub seed: u64,
}

pub struct Engine;

impl Engine {
    pub fn new(
        _device: &Arc<Device>,
        _scene: &Scene,
        _case: &Case,
        _registry: &[&'static MethodInfo],
        _options: &RunOptions,
    ) -> Result<Engine> {
        Err(Error::Device("not built yet".into()))
    }

    pub fn frame(&mut self, _moment: &Moment, _cut: bool) -> Result<(FrameRecord, FrameTimes)> {
        Err(Error::Device("not built yet".into()))
    }

    pub fn burst(&mut self, _moments: &[Moment]) -> Result<Vec<FrameTimes>> {
        Err(Error::Device("not built yet".into()))
    }

    pub fn pixels(&self) -> u64 {
        0
    }
}
