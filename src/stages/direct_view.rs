//! The direct view: every surface's own shade, its depth and its object, reflections left out; with
//! full records also its triangle.

use std::sync::Arc;

use super::{CameraUniform, GpuScene, RecordMode};
use crate::error::Result;
use crate::gpu::{
    Attachments, Depth, Device, Format, Frame, GraphicsPipeline, Image, Load, Shape, Stencil,
};
use crate::scene::NO_OBJECT;

/// Pipelines and images of the direct view.
pub struct DirectView {
    background: GraphicsPipeline,
    surfaces: GraphicsPipeline,
    /// Linear colour; the environment where no surface is.
    pub colour: Image,
    /// Distance along the camera's axis in metres; infinite where no surface is.
    pub depth: Image,
    /// Object seen; [`NO_OBJECT`] where none is.
    pub object: Image,
    /// Triangle seen of the object's mesh; only with full records.
    pub triangle: Option<Image>,
}

impl DirectView {
    pub fn new(device: &Arc<Device>, size: [u32; 2], mode: RecordMode) -> Result<DirectView> {
        let image = |name: &str, format| Image::new(device, name, format, size, Shape::Flat);
        let colours = [Format::Rgba16Float, Format::R32Float, Format::R32Uint, Format::R32Uint];
        let full = mode == RecordMode::Full;
        let background = Attachments {
            colours: &colours[..1],
            depth_stencil: false,
            depth: Depth::Off,
            stencil: Stencil::Off,
        };
        let surfaces = Attachments {
            colours: if full { &colours } else { &colours[..3] },
            depth_stencil: true,
            depth: Depth::Nearest,
            ..background
        };
        Ok(DirectView {
            background: GraphicsPipeline::new(device, "stages/background.wgsl", &[], &background)?,
            surfaces: GraphicsPipeline::new(
                device,
                "stages/direct_view.wgsl",
                &mode.defines(),
                &surfaces,
            )?,
            colour: image("direct colour", colours[0])?,
            depth: image("direct depth", colours[1])?,
            object: image("direct object", colours[2])?,
            triangle: full.then(|| image("direct triangle", colours[3])).transpose()?,
        })
    }

    /// Draw it; `depth_stencil` is the footprint's, which goes on from its depth.
    pub fn draw(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        camera: &CameraUniform,
        depth_stencil: &Image,
    ) -> Result<()> {
        let pass = frame.pass("direct-view/background").graphics(&self.background);
        scene
            .bind(pass)
            .uniform("camera", camera)
            .colour("colour", &self.colour, Load::Clear([0.0; 4]))
            .draw(|draw| draw.vertices(3))?;
        let pass = frame.pass("direct-view/surfaces").graphics(&self.surfaces);
        let mut pass = scene
            .bind(pass)
            .uniform("camera", camera)
            .colour("colour", &self.colour, Load::Keep)
            .colour("depth", &self.depth, Load::Clear([f32::INFINITY; 4]))
            .colour("object", &self.object, Load::ClearWords([NO_OBJECT; 4]));
        if let Some(triangle) = &self.triangle {
            pass = pass.colour("triangle", triangle, Load::ClearWords([0; 4]));
        }
        pass.depth_stencil(depth_stencil, Load::Clear([0.0; 4]), Load::ClearWords([0; 4]))
            .draw(|draw| scene.draw(draw, |_| true))
    }
}
