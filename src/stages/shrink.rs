//! Mip levels of an image, each from the one before.

use crate::error::Result;
use crate::gpu::{ComputePipeline, Frame, Image};

/// Fill all levels of `image` but the first; `name` begins the passes' names. The pipeline is that of
/// `stages/shrink.wgsl`, for images of one layer with `FLAT_MAP` defined.
pub fn shrink(
    frame: &mut Frame,
    pipeline: &ComputePipeline,
    name: &str,
    image: &Image,
) -> Result<()> {
    for level in 1..image.levels {
        let [width, height] = image.size.map(|side| (side >> level).max(1));
        frame
            .pass(&format!("{name}/shrink"))
            .compute(pipeline)
            .sample("finer", image)
            .store_level("coarser", image, level)
            .uniform("level", &(level as i32 - 1))
            .over_pixels([width, height * image.shape.layers()])?;
    }
    Ok(())
}
