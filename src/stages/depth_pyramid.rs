//! The nearest and the farthest surface in ever larger cells of a view's depth.

use std::sync::Arc;

use crate::error::Result;
use crate::gpu::{ComputePipeline, Device, Format, Frame, Image, Shape};

/// Pipelines and image of a depth pyramid.
pub struct DepthPyramid {
    base: ComputePipeline,
    reduce: ComputePipeline,
    /// Nearest and farthest depth, two floats as bits; 3e38 and 0 where no surface is. A level has half
    /// the cells of the one before, rounded down, down to a single one; the pixel p lies in cell
    /// min(p >> level, last).
    pub cells: Image,
}

impl DepthPyramid {
    pub fn new(device: &Arc<Device>, size: [u32; 2]) -> Result<DepthPyramid> {
        let levels = size[0].max(size[1]).ilog2() + 1;
        let (format, flat) = (Format::Rg32Uint, Shape::Flat);
        Ok(DepthPyramid {
            base: ComputePipeline::new(device, "stages/depth_pyramid_base.wgsl", &[])?,
            reduce: ComputePipeline::new(device, "stages/depth_pyramid.wgsl", &[])?,
            cells: Image::with_levels(device, "depth pyramid", format, size, flat, levels)?,
        })
    }

    /// Build it from depths as [`super::DirectView`] has them; `name` begins the passes' names.
    pub fn build(&self, frame: &mut Frame, name: &str, depth: &Image) -> Result<()> {
        frame
            .pass(&format!("{name}/pyramid-base"))
            .compute(&self.base)
            .sample("depth", depth)
            .store("bounds", &self.cells)
            .over_pixels(self.cells.size)?;
        for level in 1..self.cells.levels {
            frame
                .pass(&format!("{name}/pyramid"))
                .compute(&self.reduce)
                .sample("below", &self.cells)
                .uniform("level_below", &(level - 1))
                .store_level("bounds", &self.cells, level)
                .over_pixels(self.cells.size.map(|side| (side >> level).max(1)))?;
        }
        Ok(())
    }
}
