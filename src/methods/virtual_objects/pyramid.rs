//! A pyramid over the reflector's texels: which texel stands for each cell, for searches from coarse to
//! fine.

use std::sync::Arc;

use crate::error::Result;
use crate::gpu::{ComputePipeline, Device, Format, Frame, Image, Shape};
use crate::stages::GBuffer;

/// A search starts by looking at all cells of the top, at most as many a side.
const TOP_SIDE: u32 = 4;

/// Pipeline and image of the pyramid.
pub struct Pyramid {
    reduce: ComputePipeline,
    /// x | y << 16 of the texel nearest to each cell's middle that shows the reflector, or all ones. The
    /// texel p lies in cell min(p >> level, last).
    pub cells: Image,
}

impl Pyramid {
    /// For textures of `size` texels.
    ///
    /// # Errors
    /// [`crate::error::Error::Device`] where the device has no such images.
    pub fn new(device: &Arc<Device>, size: [u32; 2]) -> Result<Pyramid> {
        let side = size[0].max(size[1]);
        let levels = (0..).find(|level| side >> level <= TOP_SIDE).unwrap_or(0) + 1;
        let (format, flat) = (Format::R32Uint, Shape::Flat);
        Ok(Pyramid {
            reduce: ComputePipeline::new(device, "virtual_objects/cells.wgsl", &[])?,
            cells: Image::with_levels(device, "reflector cells", format, size, flat, levels)?,
        })
    }

    /// The coarsest level.
    pub fn top(&self) -> i32 {
        self.cells.levels as i32 - 1
    }

    /// Build it over what the textures show now.
    pub fn build(&self, frame: &mut Frame, gbuffer: &GBuffer) -> Result<()> {
        for level in 0..self.cells.levels {
            frame
                .pass("virtual-objects/cells")
                .compute(&self.reduce)
                .uniform("level", &level)
                .sample("mirror_position", &gbuffer.position)
                .sample("cells_below", &self.cells)
                .store_level("cells", &self.cells, level)
                .over_pixels(self.cells.size.map(|side| (side >> level).max(1)))?;
        }
        Ok(())
    }
}
