//! No reflection at all: what the rest of a frame costs.

use super::{Changes, Family, MethodInfo, ReflectionMethod, Setup, Want};
use crate::error::Result;
use crate::gpu::Frame;
use crate::stages::{GpuScene, ReflectionRecord, View};

pub const INFO: MethodInfo = MethodInfo {
    id: "none",
    title: "No reflection",
    paper: "the cost of a frame without any method",
    family: Family::Baseline,
    depends: Changes { objects: false, reflectors: false, shading: false },
    flags: false,
    refracts: false,
    variants: &["published"],
    params: &[],
    limits: "every reflector pixel is missing",
    passes: &[],
    counters: &[],
    new: Some(new),
};

struct Nothing;

fn new(_setup: &Setup) -> Result<Box<dyn ReflectionMethod>> {
    Ok(Box::new(Nothing))
}

impl ReflectionMethod for Nothing {
    fn prepare(&mut self, _: &mut Frame, _: &GpuScene, _: &Want) -> Result<()> {
        Ok(())
    }

    fn reflect(
        &mut self,
        _: &mut Frame,
        _: &GpuScene,
        _: &View,
        _: &mut ReflectionRecord,
    ) -> Result<()> {
        Ok(())
    }
}
