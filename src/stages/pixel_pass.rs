//! One shader over the pixels of a map's reflectors, in either of two forms: some GPUs shade
//! fragments far slower than they compute.
//!
//! Its file has a function `answer(at: MirrorPoint) -> Chain` and ends with the entry points that call
//! it, `#include includes/answered_pixels.wgsl`: `main`, and with `STAGE_FRAGMENT` defined `vertex`
//! and `fragment`. `environment_map/reflect.wgsl` is an example.

use std::sync::Arc;

use super::{Footprint, GpuScene, RecordMode, ReflectionRecord, View};
use crate::error::Result;
use crate::gpu::{
    Attachments, ComputePipeline, Defines, Depth, Device, Frame, GraphicsPipeline, Load, Pass,
    Stencil,
};
use crate::scene::ObjectId;

/// Where the shader runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PixelStage {
    /// In a compute shader, over the compacted list of pixels.
    Compute,
    /// In a fragment shader, over the whole image, through the stencil of the footprint.
    Fragment,
}

enum Form {
    Compute(ComputePipeline),
    Fragment(GraphicsPipeline),
}

/// The shader's pipeline.
pub struct PixelPass {
    form: Form,
}

impl PixelPass {
    /// From a file under `shaders/`; the mode's definitions and the stage's are added to `defines`.
    ///
    /// # Errors
    /// [`crate::error::Error::Shader`] where it does not compile.
    pub fn new(
        device: &Arc<Device>,
        file: &str,
        defines: Defines,
        mode: RecordMode,
        stage: PixelStage,
    ) -> Result<PixelPass> {
        let mut defines = [defines, &mode.defines()].concat();
        let form = match stage {
            PixelStage::Compute => Form::Compute(ComputePipeline::new(device, file, &defines)?),
            PixelStage::Fragment => {
                defines.push(("STAGE_FRAGMENT", 1));
                let attachments = Attachments {
                    colours: mode.formats(),
                    depth_stencil: true,
                    depth: Depth::Off,
                    stencil: Stencil::Within,
                };
                Form::Fragment(GraphicsPipeline::new(device, file, &defines, &attachments)?)
            }
        };
        Ok(PixelPass { form })
    }

    /// Fill the record of these reflectors, as far as the view asks for them. Scene, view and record
    /// are bound; `bind` adds what is the method's own.
    pub fn run<'f>(
        &'f self,
        frame: &'f mut Frame,
        name: &str,
        (scene, view): (&'f GpuScene, &'f View),
        record: &'f ReflectionRecord,
        reflectors: &[ObjectId],
        bind: impl FnOnce(Pass<'f>) -> Pass<'f>,
    ) -> Result<()> {
        match &self.form {
            Form::Compute(pipeline) => {
                view.list_pixels(frame, scene, reflectors)?;
                let pass = view.bind(scene.bind(frame.pass(name).compute(pipeline)));
                bind(record.bind(pass)).indirect(&view.footprint.pixels)
            }
            Form::Fragment(pipeline) => {
                let asked = view.asked(reflectors);
                let selection = scene.selection(frame, &asked)?;
                let pass = view.bind(scene.bind(frame.pass(name).graphics(pipeline)));
                // The selection takes the place of the scene's own list of objects.
                let pass = record.attach(pass.slice("objects", selection));
                let depth_stencil = &view.footprint.depth_stencil;
                bind(pass).depth_stencil(depth_stencil, Load::Keep, Load::Keep).draw(|draw| {
                    for reference in stencils(&asked) {
                        draw.stencil_reference(reference);
                        draw.vertices(3);
                    }
                })
            }
        }
    }
}

/// The stencil values of some reflectors, each once: a pixel is drawn once.
fn stencils(reflectors: &[ObjectId]) -> Vec<u32> {
    let mut values: Vec<u32> = reflectors.iter().map(|&r| Footprint::stencil_of(r)).collect();
    values.sort_unstable();
    values.dedup();
    values
}
