//! A layered capture seen as intervals: what lies behind each texel of a cube is solid from a front to
//! a back, or a sheet; the farthest surface is always kept; what was left out is known. A pyramid of
//! bounds lets a search skip what a ray cannot meet.
//!
//! Our revision of Patow 1995, section 4, whose lists hold surfaces: a ray that passes between two of
//! them cannot tell whether it is inside something.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use super::{GpuScene, LayeredCapture, LayeredCaptureStage, RecordMode, Sides};
use crate::error::Result;
use crate::gpu::{ComputePipeline, Device, Format, Frame, Image, Pass, Shape};
use crate::scene::ObjectId;

/// Most intervals a texel can hold: four bits name a layer, and two layers an interval.
pub const MOST_INTERVALS: u32 = 4;

/// WGSL `IntervalMap` of `shaders/bindings/interval_map.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub struct IntervalUniform {
    peeled: u32,
    intervals: u32,
    levels: u32,
    pad: u32,
}

/// The images of one interval map.
pub struct IntervalMap {
    /// Surfaces nearest first; in its last layer the farthest.
    pub layers: LayeredCapture,
    /// Layers of each interval's front and back, and where what was not stored begins.
    order: Image,
    /// All that a search wants of a texel: its farthest surface, and what is doubtful; then its intervals.
    texels: Image,
    /// Pyramid of the lowest and highest w of intervals, and of the farthest surface; all levels side by
    /// side.
    bounds: Image,
    uniform: IntervalUniform,
}

impl IntervalMap {
    /// `size` is a power of two, `intervals` 1 to [`MOST_INTERVALS`].
    ///
    /// # Errors
    /// [`crate::error::Error::Device`] when the device has no memory or no images for that many.
    pub fn new(
        device: &Arc<Device>,
        name: &str,
        size: u32,
        intervals: u32,
        mode: RecordMode,
    ) -> Result<IntervalMap> {
        // A front and a back each, and one more that tells whether this is all.
        let peeled = 2 * intervals + 1;
        let levels = size.ilog2() + 1;
        // As `in_fours` of shaders/bindings/interval_map.wgsl places texels.
        let image = |what: &str, format, size, layers| {
            Image::new(device, &format!("{name} {what}"), format, size, Shape::Array(layers))
        };
        Ok(IntervalMap {
            layers: LayeredCapture::new(device, name, size, peeled + 1, mode)?,
            order: image("order", Format::Rg32Uint, [size, size], 6)?,
            texels: image("texels", Format::Rgba32Uint, [2 * size, size / 2], 6 * (1 + intervals))?,
            bounds: image("bounds", Format::Rg32Uint, [3 * size, size / 2], 6)?,
            uniform: IntervalUniform { peeled, intervals, levels, pad: 0 },
        })
    }

    /// Bind what a shader that searches it wants.
    pub fn bind<'f>(&'f self, pass: Pass<'f>) -> Pass<'f> {
        self.layers
            .bind(pass)
            .uniform("interval_map", &self.uniform)
            .optional()
            .sample("interval_texels", &self.texels)
            .optional()
            .sample("interval_bounds", &self.bounds)
            .optional()
    }
}

/// What is doubted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Certificate {
    /// That the ray passed what was not stored.
    Intervals,
    /// That too, and that it passed within a texel of where a surface ends, or two things cross.
    Edges,
}

/// Pipelines that fill interval maps.
pub struct IntervalStage {
    capture: LayeredCaptureStage,
    order: ComputePipeline,
    bounds: ComputePipeline,
    pyramid: ComputePipeline,
}

impl IntervalStage {
    pub fn new(
        device: &Arc<Device>,
        mode: RecordMode,
        certificate: Certificate,
    ) -> Result<IntervalStage> {
        let edges = [("EDGES", 1)];
        let defines = if certificate == Certificate::Edges { &edges[..] } else { &[] };
        Ok(IntervalStage {
            capture: LayeredCaptureStage::new(device, mode, Sides::Marked)?,
            order: ComputePipeline::new(device, "stages/interval_order.wgsl", &[])?,
            bounds: ComputePipeline::new(device, "stages/interval_bounds.wgsl", defines)?,
            pyramid: ComputePipeline::new(device, "stages/interval_pyramid.wgsl", &[])?,
        })
    }

    /// Take the scene as seen from `centre`, some objects left out. `name` begins the passes' names.
    pub fn capture(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        name: &str,
        map: &mut IntervalMap,
        centre: Vec3,
        exclude: &[ObjectId],
    ) -> Result<()> {
        self.capture.capture(frame, scene, name, &mut map.layers, centre, exclude)?;
        let IntervalMap { layers, order, texels, bounds, uniform } = &*map;
        // The six faces below one another.
        let over = |level: u32| [layers.size >> level, 6 * (layers.size >> level)];
        let pass = frame.pass(&format!("{name}/intervals")).compute(&self.order);
        layers
            .bind(pass)
            .uniform("interval_map", uniform)
            .store("interval_order", order)
            .over_pixels(over(0))?;
        let pass = frame.pass(&format!("{name}/bounds")).compute(&self.bounds);
        layers
            .bind(pass)
            .uniform("interval_map", uniform)
            .sample("interval_order", order)
            .store("interval_bounds", bounds)
            .store("interval_texels", texels)
            .over_pixels(over(0))?;
        for level in 1..uniform.levels {
            let pass = frame.pass(&format!("{name}/pyramid")).compute(&self.pyramid);
            layers
                .bind(pass)
                .sample("bounds_below", bounds)
                .uniform("level", &level)
                .store("interval_bounds", bounds)
                .over_pixels(over(level))?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::assert_layout;

    #[test]
    fn the_map_is_laid_out_as_its_wgsl_twin() {
        assert_layout!(
            "stages/interval_order.wgsl",
            "IntervalMap",
            IntervalUniform,
            peeled,
            intervals,
            levels,
            pad
        );
    }
}
