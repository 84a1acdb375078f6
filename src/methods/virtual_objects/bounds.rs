//! A pyramid of bounds over the reflector's patches: where points of each cell can be and how its normals
//! can point, for a search that must lose no reflection point.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};

use crate::error::Result;
use crate::gpu::{ComputePipeline, Device, Format, Frame, Image, Pass, Shape};
use crate::stages::GBuffer;

/// A search starts with all cells of the top, at most as many a side.
const TOP_SIDE: u32 = 4;

/// WGSL `Level` of `shaders/virtual_objects/bounds.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct LevelUniform {
    level: i32,
    pad_a: i32,
    pad_b: i32,
    pad_c: i32,
}

/// Pipeline and images of the bounds.
pub struct Bounds {
    reduce: ComputePipeline,
    /// Centre and radius, world; below 0 where there is no patch. Level 0 are the patches that begin at each
    /// texel; four cells make one of the next, so sides are rounded up.
    balls: Image,
    /// Axis and sine of half the opening; 1 or more for all directions.
    cones: Image,
}

impl Bounds {
    /// For textures of `size` texels.
    ///
    /// # Errors
    /// [`crate::error::Error::Device`] where the device has no such images.
    pub fn new(device: &Arc<Device>, size: [u32; 2]) -> Result<Bounds> {
        let side = size[0].max(size[1]);
        let top = (0..).find(|level| side.div_ceil(1 << level) <= TOP_SIDE).unwrap_or(0);
        let whole = size.map(|side| side.next_multiple_of(1 << top));
        let image = |name| {
            let (format, flat) = (Format::Rgba32Float, Shape::Flat);
            Image::with_levels(device, name, format, whole, flat, top + 1)
        };
        Ok(Bounds {
            reduce: ComputePipeline::new(device, "virtual_objects/bounds.wgsl", &[])?,
            balls: image("reflector balls")?,
            cones: image("reflector cones")?,
        })
    }

    /// The coarsest level.
    pub fn top(&self) -> i32 {
        self.balls.levels as i32 - 1
    }

    /// Build it over what the textures show now.
    pub fn build(&self, frame: &mut Frame, gbuffer: &GBuffer) -> Result<()> {
        for level in 0..self.balls.levels {
            frame
                .pass("virtual-objects/bounds")
                .compute(&self.reduce)
                .uniform("at", &LevelUniform { level: level as i32, ..Zeroable::zeroed() })
                .sample("mirror_position", &gbuffer.position)
                .sample("mirror_normal", &gbuffer.normal)
                .sample("balls_below", &self.balls)
                .sample("cones_below", &self.cones)
                .store_level("balls", &self.balls, level)
                .store_level("cones", &self.cones, level)
                .over_pixels(self.balls.size.map(|side| side >> level))?;
        }
        Ok(())
    }

    /// Bind it to searches.
    pub fn bind<'f>(&'f self, pass: Pass<'f>) -> Pass<'f> {
        let pass = pass.sample("mirror_balls", &self.balls).optional();
        pass.sample("mirror_cones", &self.cones).optional()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::assert_layout;

    #[test]
    fn the_uniform_is_laid_out_as_its_wgsl_twin() {
        #[rustfmt::skip]
        assert_layout!("virtual_objects/bounds.wgsl", "Level", LevelUniform, level, pad_a, pad_b, pad_c);
    }
}
