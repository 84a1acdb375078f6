//! The reflector G-buffer: points and normals of one reflector as the eye sees them, in textures that
//! methods search.

use std::sync::Arc;

use super::{CameraUniform, GpuScene};
use crate::error::Result;
use crate::gpu::{
    Attachments, Depth, Device, Format, Frame, GraphicsPipeline, Image, Load, Pass, Shape, Stencil,
};
use crate::scene::ObjectId;

/// Pipeline and images of a reflector's points and normals.
pub struct GBuffer {
    surfaces: GraphicsPipeline,
    /// World; the fourth channel is 1 where the reflector is, 0 elsewhere.
    pub position: Image,
    /// World, unit, on the eye's side.
    pub normal: Image,
    depth: Image,
    /// Width and height in texels.
    pub size: [u32; 2],
}

impl GBuffer {
    /// `format`: of points and normals, [`Format::Rgba32Float`] or [`Format::Rgba16Float`].
    ///
    /// # Errors
    /// [`crate::error::Error::Device`] where the device has no such images.
    pub fn new(device: &Arc<Device>, size: [u32; 2], format: Format) -> Result<GBuffer> {
        let image = |name: &str, format| Image::new(device, name, format, size, Shape::Flat);
        let attachments = Attachments {
            colours: &[format, format],
            depth_stencil: true,
            depth: Depth::Nearest,
            stencil: Stencil::Off,
        };
        Ok(GBuffer {
            surfaces: GraphicsPipeline::new(device, "stages/gbuffer.wgsl", &[], &attachments)?,
            position: image("reflector points", format)?,
            normal: image("reflector normals", format)?,
            depth: image("reflector depth", Format::DepthStencil)?,
            size,
        })
    }

    /// Draw one reflector, its closed partner where it has one, and nothing else: what stands before
    /// it hides none of it. `name` begins the pass's name.
    pub fn draw(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        name: &str,
        reflector: ObjectId,
        camera: &CameraUniform,
    ) -> Result<()> {
        self.surfaces(frame, scene, name, camera).draw(|draw| scene.draw_closed(draw, reflector))
    }

    /// The same of the reflector itself, without a partner.
    pub fn draw_open(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        name: &str,
        reflector: ObjectId,
        camera: &CameraUniform,
    ) -> Result<()> {
        self.surfaces(frame, scene, name, camera).draw(|draw| scene.draw_object(draw, reflector))
    }

    fn surfaces<'f>(
        &'f self,
        frame: &'f mut Frame,
        scene: &'f GpuScene,
        name: &str,
        camera: &CameraUniform,
    ) -> Pass<'f> {
        let pass = frame.pass(&format!("{name}/gbuffer")).graphics(&self.surfaces);
        self.attach(scene.bind(pass).uniform("camera", camera))
    }

    /// Draw something else into it, in a pass whose shader has the same two targets.
    pub fn attach<'f>(&'f self, pass: Pass<'f>) -> Pass<'f> {
        let clear = Load::Clear([0.0; 4]);
        pass.colour("position", &self.position, clear)
            .colour("normal", &self.normal, clear)
            .depth_stencil(&self.depth, clear, Load::ClearWords([0; 4]))
    }
}
