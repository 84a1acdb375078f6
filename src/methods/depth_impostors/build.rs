//! Rotated rows on the device: built there, or on the processor and copied.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};

use crate::error::Result;
use crate::geometry::depth_rows::{DepthRows, Limits, RowShape};
use crate::gpu::{Buffer, ComputePipeline, Device, Format, Frame, Image, Shape, Slice};
use crate::stages::Portraits;

/// Most samples the passes hold at a time, 2 bytes each, and 4 for the pieces they may make up.
const MOST_SAMPLES: u32 = 1 << 23;

/// Of depth images.
pub const QUADS: Format = Format::Rg32Uint;

/// WGSL `Build` of `shaders/depth_impostors/build.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Build {
    size: u32,
    angles: u32,
    segments: u32,
    layer: u32,
    first_map: u32,
    maps: u32,
    tolerance: f32,
    jump: f32,
}

/// Depth images and their rows, one a layer.
pub struct RowBuffers {
    pub shape: RowShape,
    /// Heights, four neighbours a texel, as `heights.wgsl` packs them.
    pub quads: Image,
    /// Segments in use of each row, map after map, layer after layer.
    pub counts: Buffer,
    /// `shape.segments` a row.
    pub segments: Buffer,
}

impl RowBuffers {
    /// # Errors
    /// [`crate::error::Error::Device`] with the numbers where a buffer is beyond the device's limits.
    pub fn new(device: &Arc<Device>, shape: RowShape, layers: u32) -> Result<RowBuffers> {
        let storage = |name: &str, bytes_each: u32, count: u32| {
            Buffer::storage(device, name, u64::from(bytes_each) * u64::from(count))
        };
        let (size, rows) = ([shape.size; 2], layers * shape.rows());
        Ok(RowBuffers {
            shape,
            quads: Image::new(device, "impostor heights", QUADS, size, Shape::Array(layers))?,
            counts: storage("impostor row counts", 4, rows)?,
            segments: storage("impostor rows", 8 * shape.segments, rows)?,
        })
    }

    /// A layer's depth image; waits for the device.
    pub fn heights(&self, layer: u32) -> Result<Vec<f32>> {
        let quads = self.quads.read::<[u32; 2]>()?;
        let texels = (self.shape.size * self.shape.size) as usize;
        let of_layer = quads.into_iter().skip(layer as usize * texels).take(texels);
        Ok(of_layer.map(|[top, _]| (top & 0xffff) as f32 / 65535.0).collect())
    }

    /// Copy a layer's rows, built on the processor.
    pub fn copy(&self, frame: &mut Frame, name: &str, layer: u32, rows: &DepthRows) -> Result<()> {
        let first = u64::from(layer * self.shape.rows());
        let name = format!("{name}/rows");
        frame.pass(&name).copy(&self.counts, 4 * first, &rows.counts)?;
        let offset = 8 * u64::from(self.shape.segments) * first;
        frame.pass(&name).copy(&self.segments, offset, &rows.segments)
    }
}

/// Pipelines that build rows.
pub struct RowBuilder {
    heights: ComputePipeline,
    rotate: ComputePipeline,
    simplify: ComputePipeline,
    /// Eight a texel, a row of texels each; a map a layer.
    samples: Image,
    pieces: Buffer,
    shape: RowShape,
    /// Maps whose samples fit at a time.
    batch: u32,
}

impl RowBuilder {
    pub fn new(device: &Arc<Device>, shape: RowShape) -> Result<RowBuilder> {
        let pipeline =
            |file: &str| ComputePipeline::new(device, &format!("depth_impostors/{file}.wgsl"), &[]);
        let texels = shape.size * shape.size;
        let batch = (MOST_SAMPLES / texels).clamp(1, shape.angles);
        let pieces = 4 * u64::from(batch * texels);
        let (rows, maps) = ([shape.size / 8, shape.size], Shape::Array(batch));
        Ok(RowBuilder {
            heights: pipeline("heights")?,
            rotate: pipeline("rotate")?,
            simplify: pipeline("simplify")?,
            samples: Image::new(device, "rotated heights", Format::Rgba32Uint, rows, maps)?,
            pieces: Buffer::storage(device, "pieces of rotated rows", pieces)?,
            shape,
            batch,
        })
    }

    /// A portrait's depth image; `portraits` as [`Portraits::uniforms`] has them.
    pub fn heights(
        &self,
        frame: &mut Frame,
        name: &str,
        (taken, portraits): (&Portraits, Slice),
        (buffers, layer): (&RowBuffers, u32),
    ) -> Result<()> {
        let build = self.told(layer, Limits { tolerance: 0.0, jump: 0.0 }, 0);
        frame
            .pass(&format!("{name}/heights"))
            .compute(&self.heights)
            .storage_struct("build", &build)
            .slice("portraits", portraits)
            .sample("portrait_albedo", &taken.albedo)
            .sample("portrait_point", &taken.point)
            .store("quads", &buffers.quads)
            .over_pixels([self.shape.size; 2])
    }

    /// The rows of a layer from its depth image.
    pub fn build(
        &self,
        frame: &mut Frame,
        name: &str,
        buffers: &RowBuffers,
        layer: u32,
        limits: Limits,
    ) -> Result<()> {
        for first_map in (0..self.shape.angles).step_by(self.batch as usize) {
            let build = self.told(layer, limits, first_map);
            let rows = build.maps * self.shape.size;
            frame
                .pass(&format!("{name}/rotate"))
                .compute(&self.rotate)
                .storage_struct("build", &build)
                .sample("quads", &buffers.quads)
                .store("samples", &self.samples)
                .over_pixels([self.shape.size / 8, rows])?;
            frame
                .pass(&format!("{name}/simplify"))
                .compute(&self.simplify)
                .storage_struct("build", &build)
                .sample("samples", &self.samples)
                .buffer("counts", &buffers.counts)
                .buffer("segments", &buffers.segments)
                .buffer("pieces", &self.pieces)
                .over(rows)?;
        }
        Ok(())
    }

    fn told(&self, layer: u32, limits: Limits, first_map: u32) -> Build {
        let RowShape { size, angles, segments } = self.shape;
        Build {
            size,
            angles,
            segments,
            layer,
            first_map,
            maps: self.batch.min(angles - first_map),
            tolerance: limits.tolerance,
            jump: limits.jump,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Build;
    use crate::gpu::layout::assert_layout;

    #[test]
    #[rustfmt::skip]
    fn what_passes_are_told_is_laid_out_as_its_wgsl_twin() {
        assert_layout!("depth_impostors/simplify.wgsl", "Build", Build,
            size, angles, segments, layer, first_map, maps, tolerance, jump);
    }
}
