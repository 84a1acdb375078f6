//! The reflectors' footprint: which mirror each pixel shows, where, and with which normal; in the
//! stencil, and as a compacted pixel list.

use std::sync::Arc;

use super::{CameraUniform, GpuScene};
use crate::error::Result;
use crate::gpu::{
    Attachments, Buffer, ComputePipeline, Depth, Device, Format, Frame, GraphicsPipeline, Image,
    Load, Shape, Stencil,
};
use crate::scene::{NO_OBJECT, ObjectId};

/// Pipelines and images of the footprint.
pub struct Footprint {
    surfaces: GraphicsPipeline,
    lister: ComputePipeline,
    /// Reflector seen; [`NO_OBJECT`] elsewhere. The authority on what a pixel belongs to.
    pub reflector: Image,
    /// R, world.
    pub position: Image,
    /// N, world, unit, on the eye's side.
    pub normal: Image,
    /// The direct view's depth, and [`Footprint::stencil_of`] the reflector seen.
    pub depth_stencil: Image,
    /// Indirect arguments, count, then one word a pixel; see `shaders/bindings/view.wgsl`.
    pub pixels: Buffer,
    size: [u32; 2],
}

impl Footprint {
    pub fn new(device: &Arc<Device>, size: [u32; 2]) -> Result<Footprint> {
        let image = |name: &str, format| Image::new(device, name, format, size, Shape::Flat);
        let colours = [Format::R32Uint, Format::Rgba32Float, Format::Rgba32Float];
        let attachments = Attachments {
            colours: &colours,
            depth_stencil: true,
            depth: Depth::NearestOrEqual,
            stencil: Stencil::Mark,
            views: 0,
        };
        let pixels = u64::from(size[0]) * u64::from(size[1]);
        Ok(Footprint {
            surfaces: GraphicsPipeline::new(device, "stages/footprint.wgsl", &[], &attachments)?,
            lister: ComputePipeline::new(device, "stages/pixels.wgsl", &[])?,
            reflector: image("footprint reflector", colours[0])?,
            position: image("footprint position", colours[1])?,
            normal: image("footprint normal", colours[2])?,
            depth_stencil: image("footprint depth and stencil", Format::DepthStencil)?,
            pixels: Buffer::storage(device, "footprint pixels", 16 + 4 * pixels)?,
            size,
        })
    }

    /// Stencil value of a reflector's pixels; two reflectors may share one.
    pub fn stencil_of(object: ObjectId) -> u32 {
        1 + object % 255
    }

    /// Draw it over the direct view's depth.
    pub fn draw(&self, frame: &mut Frame, scene: &GpuScene, camera: &CameraUniform) -> Result<()> {
        let pass = frame.pass("footprint/surfaces").graphics(&self.surfaces);
        scene
            .bind(pass)
            .uniform("camera", camera)
            .colour("reflector", &self.reflector, Load::ClearWords([NO_OBJECT; 4]))
            .colour("position", &self.position, Load::Clear([0.0; 4]))
            .colour("normal", &self.normal, Load::Clear([0.0; 4]))
            .depth_stencil(&self.depth_stencil, Load::Keep, Load::Keep)
            .draw(|draw| {
                for object in scene.scene.reflectors() {
                    draw.stencil_reference(Self::stencil_of(object));
                    scene.draw_object(draw, object);
                }
            })
    }

    /// Make the pixel list that of these reflectors.
    pub fn list_pixels(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        reflectors: &[ObjectId],
    ) -> Result<()> {
        let selection = scene.selection(frame, reflectors)?;
        frame.pass("footprint/clear-list").fill(&[&self.pixels], 0)?;
        frame
            .pass("footprint/list")
            .compute(&self.lister)
            .slice("objects", selection)
            .sample("reflector_id", &self.reflector)
            .buffer("pixels", &self.pixels)
            .over_pixels(self.size)
    }
}
