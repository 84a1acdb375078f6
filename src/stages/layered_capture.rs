//! The captured map with several layers: behind each texel of a cube the surfaces its centre sees
//! one behind the other, nearest first, by depth peeling (Everitt, "Interactive order-independent
//! transparency", 2001). Patow 1995, section 4, keeps such depth-sorted lists.
//!
//! Each layer is one more drawing of the scene that keeps the nearest fragment strictly behind the
//! layer before. The result is the same on every run: no order of fragments enters into it.
//! Surfaces within two units in the last place of one another count as one; two copies of a face
//! may differ by more, and then fill two layers.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use super::capture::CubeUniform;
use super::{GpuScene, RecordMode};
use crate::error::Result;
use crate::gpu::{
    Attachments, Depth, Device, Format, Frame, GraphicsPipeline, Image, Load, Pass, Shape, Stencil,
};
use crate::scene::ObjectId;

/// Which sides of surfaces are captured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sides {
    /// Both, so that a closed thing fills two layers.
    Both,
    /// Those alone whose front is towards the centre: what a renderer that culls back faces keeps.
    Facing,
    /// Both, marked as `shaders/bindings/interval_map.wgsl` reads it: which are backs, and which belong
    /// to objects without an inside. The last layer holds the farthest surface.
    Marked,
}

/// Surface, radiance, ids, and the depth the next layer is peeled from.
const FORMATS: [Format; 4] =
    [Format::Rg32Uint, Format::Rgba16Float, Format::Rg32Uint, Format::R32Float];
const FORMATS_WITHOUT_IDS: [Format; 3] = [FORMATS[0], FORMATS[1], FORMATS[3]];

/// WGSL `LayeredMap` of `shaders/bindings/layers.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub struct LayeredMapUniform {
    centre: [f32; 3],
    size: u32,
}

/// The images of one layered capture. Layer `6 * layer + face` of each image is one face of one
/// surface layer. Where a texel has no surface left, that layer and all later ones are empty.
pub struct LayeredCapture {
    /// First word: the bits of w = 1/z, z the depth along the face's axis in metres, 0 where there
    /// is nothing. Second: dw/du and dw/dv per texel of the surface's own plane, two half floats.
    pub surface: Image,
    /// Light from the surface towards the centre; the environment's where there is nothing.
    pub radiance: Image,
    /// Object and triangle; with [`RecordMode::Full`] only.
    pub ids: Option<Image>,
    /// Depths as rasterised, of the layer drawn and of the one before, by turns.
    peel: [Image; 2],
    depth: Image,
    /// Where it was taken from.
    pub centre: Vec3,
    /// Texels along a face's side.
    pub size: u32,
    /// Surface layers, at least 1.
    pub layers: u32,
}

impl LayeredCapture {
    /// # Errors
    /// [`crate::error::Error::Device`] when the device has no memory or no images for that many.
    pub fn new(
        device: &Arc<Device>,
        name: &str,
        size: u32,
        layers: u32,
        mode: RecordMode,
    ) -> Result<LayeredCapture> {
        let image = |what: &str, format, shape| {
            Image::new(device, &format!("{name} {what}"), format, [size; 2], shape)
        };
        let all = Shape::Array(6 * layers);
        let ids = match mode {
            RecordMode::Radiance => None,
            RecordMode::Full => Some(image("ids", FORMATS[2], all)?),
        };
        Ok(LayeredCapture {
            surface: image("surface", FORMATS[0], all)?,
            radiance: image("radiance", FORMATS[1], all)?,
            ids,
            peel: [
                image("even depths", FORMATS[3], Shape::Array(6))?,
                image("odd depths", FORMATS[3], Shape::Array(6))?,
            ],
            depth: image("depth", Format::DepthStencil, Shape::Array(6))?,
            centre: Vec3::ZERO,
            size,
            layers,
        })
    }

    /// Bind what a shader wants of it, as `shaders/bindings/layers.wgsl` names it.
    pub fn bind<'f>(&'f self, pass: Pass<'f>) -> Pass<'f> {
        let map = LayeredMapUniform { centre: self.centre.to_array(), size: self.size };
        let pass = pass
            .uniform("layered_map", &map)
            .optional()
            .sample("layer_surface", &self.surface)
            .optional()
            .sample("layer_radiance", &self.radiance)
            .optional();
        match &self.ids {
            None => pass,
            Some(ids) => pass.sample("layer_ids", ids).optional(),
        }
    }
}

/// Pipelines that fill layered captures.
pub struct LayeredCaptureStage {
    /// Where sides are marked nobody asks what lies behind the last surface.
    background: Option<GraphicsPipeline>,
    surfaces: GraphicsPipeline,
    /// Fills the last layer where sides are marked.
    farthest: Option<GraphicsPipeline>,
}

impl LayeredCaptureStage {
    pub fn new(
        device: &Arc<Device>,
        mode: RecordMode,
        sides: Sides,
    ) -> Result<LayeredCaptureStage> {
        let (colours, stored) = match mode {
            RecordMode::Radiance => (&FORMATS_WITHOUT_IDS[..], 2),
            RecordMode::Full => (&FORMATS[..], 3),
        };
        let background = Attachments {
            colours: &colours[..stored],
            depth_stencil: false,
            depth: Depth::Off,
            stencil: Stencil::Off,
        };
        let surfaces =
            Attachments { colours, depth_stencil: true, depth: Depth::Nearest, ..background };
        let mut defines = mode.defines();
        match sides {
            Sides::Both => {}
            Sides::Facing => defines.push(("FACING_ONLY", 1)),
            Sides::Marked => defines.push(("MARK_SIDES", 1)),
        }
        let pipeline = |file, a| GraphicsPipeline::new(device, file, &defines, a);
        let file = "stages/layered_capture.wgsl";
        let farthest = Attachments { depth: Depth::Farthest, ..surfaces };
        Ok(LayeredCaptureStage {
            background: (sides != Sides::Marked)
                .then(|| pipeline("stages/layered_background.wgsl", &background))
                .transpose()?,
            surfaces: pipeline(file, &surfaces)?,
            farthest: (sides == Sides::Marked).then(|| pipeline(file, &farthest)).transpose()?,
        })
    }

    /// Take the scene as seen from `centre`, some objects left out. `name` begins the passes' names.
    /// `target` must have been made for the same record mode as the stage.
    pub fn capture(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        name: &str,
        target: &mut LayeredCapture,
        centre: Vec3,
        exclude: &[ObjectId],
    ) -> Result<()> {
        target.centre = centre;
        let target = &*target;
        if let Some(background) = &self.background {
            let pass = frame.pass(&format!("{name}/capture-background")).graphics(background);
            attach(scene.bind(pass), target, 0, true)
                .draw_layers(6 * target.layers, |draw| draw.vertices(3))?;
        }
        let uniform = CubeUniform::new(centre);
        let objects = match &self.farthest {
            None => None,
            Some(_) => Some(scene.selection(frame, &scene.closed())?),
        };
        for layer in 0..target.layers {
            let [own, before] = [layer % 2, (layer + 1) % 2].map(|i| &target.peel[i as usize]);
            let farthest = self.farthest.as_ref().filter(|_| layer + 1 == target.layers);
            let (pipeline, start) = match farthest {
                None => (&self.surfaces, 0.0),
                Some(farthest) => (farthest, 1.0),
            };
            if layer == 0 || farthest.is_some() {
                // Nothing is nearer than the first layer, and the farthest is behind nothing.
                let start = frame.pass(&format!("{name}/capture-start"));
                start.clear(&[("depth_before", before, Load::Clear([f32::INFINITY; 4]))])?;
            }
            let pass = frame.pass(&format!("{name}/capture")).graphics(pipeline);
            let mut pass = attach(scene.bind(pass), target, 6 * layer, self.background.is_some())
                .uniform("cube", &uniform)
                .sample("depth_before", before)
                .colour("depth", own, Load::Clear([0.0; 4]))
                .depth_stencil(&target.depth, Load::Clear([start; 4]), Load::ClearWords([0; 4]));
            if let Some(objects) = objects {
                pass = pass.slice("objects", objects);
            }
            pass.draw_layers(6, |draw| scene.draw(draw, |object| !exclude.contains(&object)))?;
        }
        Ok(())
    }
}

/// Draw into the images of a capture from a layer on, keeping what is there or starting from nothing.
fn attach<'f>(pass: Pass<'f>, target: &'f LayeredCapture, first: u32, keep: bool) -> Pass<'f> {
    let (floats, words) = match keep {
        true => (Load::Keep, Load::Keep),
        false => (Load::Clear([0.0; 4]), Load::ClearWords([0; 4])),
    };
    let pass = pass.colour_from("surface", &target.surface, first, words);
    let pass = pass.colour_from("radiance", &target.radiance, first, floats);
    match &target.ids {
        None => pass,
        Some(ids) => pass.colour_from("ids", ids, first, words),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::assert_layout;

    #[test]
    fn the_map_is_laid_out_as_its_wgsl_twin() {
        assert_layout!(
            "z_buffered_map/published.wgsl",
            "LayeredMap",
            LayeredMapUniform,
            centre,
            size
        );
    }
}
