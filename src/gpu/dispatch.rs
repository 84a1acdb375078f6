//! What a pass does without drawing: compute, clears and fills.

use ash::vk;

use super::draw::Load;
use super::pass::{Pass, Program};
use super::{Buffer, ComputePipeline, Image};
use crate::error::Result;

impl<'f> Pass<'f> {
    /// Run at least `count` invocations in one dimension; the shader checks the excess.
    pub fn over(self, count: u32) -> Result<()> {
        self.dispatch([count, 1])
    }

    /// Run at least one invocation a pixel; the shader checks the excess.
    pub fn over_pixels(self, size: [u32; 2]) -> Result<()> {
        self.dispatch(size)
    }

    fn dispatch(self, extent: [u32; 2]) -> Result<()> {
        let pipeline = self.compute_pipeline()?;
        let [x, y, _] = pipeline.workgroup;
        let groups = [extent[0].div_ceil(x), extent[1].div_ceil(y)];
        self.record(Some((&pipeline.owner, vk::PipelineBindPoint::COMPUTE)), |pass| {
            let frame = &pass.frame;
            // SAFETY: recording, with pipeline and descriptors bound by `record`.
            unsafe { frame.device.raw.cmd_dispatch(frame.commands, groups[0], groups[1], 1) };
            Ok(())
        })
    }

    /// Run as many workgroups as three words at the start of `arguments` say.
    pub fn indirect(self, arguments: &Buffer) -> Result<()> {
        let pipeline = self.compute_pipeline()?;
        self.frame.keep(arguments.owner.clone());
        self.record(Some((&pipeline.owner, vk::PipelineBindPoint::COMPUTE)), |pass| {
            let frame = &pass.frame;
            // SAFETY: as in `dispatch`; the buffer is kept and holds at least 16 bytes.
            unsafe { frame.device.raw.cmd_dispatch_indirect(frame.commands, arguments.raw, 0) };
            Ok(())
        })
    }

    fn compute_pipeline(&self) -> Result<&'f ComputePipeline> {
        match self.program {
            Program::Compute(pipeline) => Ok(pipeline),
            _ => Err(self.wrong("no compute pipeline to dispatch")),
        }
    }

    /// Fill images, each with one value; names are their dumps'.
    pub fn clear(mut self, images: &[(&'static str, &'f Image, Load)]) -> Result<()> {
        for &(name, image, _) in images {
            self = self.store(name, image);
        }
        self.record(None, |pass| {
            let frame = &pass.frame;
            for (_, image, load) in images {
                // SAFETY: recording; the image is kept, its format takes clears of this kind.
                unsafe {
                    frame.device.raw.cmd_clear_color_image(
                        frame.commands,
                        image.owner.raw,
                        vk::ImageLayout::GENERAL,
                        &load.colour(),
                        &[image.range()],
                    );
                }
            }
            Ok(())
        })
    }

    /// Fill buffers with one word.
    pub fn fill(self, buffers: &[&Buffer], word: u32) -> Result<()> {
        self.fill_first(buffers, vk::WHOLE_SIZE, word)
    }

    /// Fill the first `bytes` of buffers, a multiple of 4, with one word.
    pub fn fill_first(self, buffers: &[&Buffer], bytes: u64, word: u32) -> Result<()> {
        self.record(None, |pass| {
            for buffer in buffers {
                pass.frame.keep(buffer.owner.clone());
                let (raw, commands) = (&pass.frame.device.raw, pass.frame.commands);
                // SAFETY: recording; the buffer is kept.
                unsafe { raw.cmd_fill_buffer(commands, buffer.raw, 0, bytes, word) };
            }
            Ok(())
        })
    }
}
