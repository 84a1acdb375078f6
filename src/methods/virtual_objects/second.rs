//! Second bounces: what mirrors show that are seen in a mirror. Estalella et al. 2006 name them as future
//! work (section 7).
//!
//! The virtual objects of a mirror M2 in a mirror M1, drawn into textures, are M2 as M1 shows it: P2 and N2
//! at every texel. The search for a vertex V then runs on those textures as on any others. What was the eye is
//! another point P1 of M1 at every texel, known exactly: M1's own textures have it. V is drawn behind P1, as
//! far as the path P1, P2, V is long, into the pixels of M1 that show M2.
//!
//! What M2 hides from M1 is cut off as what a mirror hides from the eye: a vertex lies there if the ray that
//! M1 mirrors towards it meets M2 before. With one eye that ray is found by projection, here by a search over M1.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};

use super::draw::{Drawing, Drawn};
use super::edges::Edges;
use super::rule::Rule;
use super::search::{First, Found, Mirror, Search};
use super::split::{Split, corners_made};
use crate::error::Result;
use crate::gpu::{
    Attachments, Buffer, ComputePipeline, Depth, Device, Format, Frame, GraphicsPipeline, Image,
    Load, Pass, Shape, Stencil,
};
use crate::methods::source::Source;
use crate::scene::{NO_OBJECT, ObjectId};
use crate::stages::{CameraUniform, GBuffer, GpuScene, RecordMode, ReflectionRecord, View};

/// WGSL `Shown` of `shaders/virtual_objects/shown.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct ShownUniform {
    first: ObjectId,
    second: ObjectId,
    pad_a: u32,
    pad_b: u32,
}

/// The mirrors that each pixel of one mirror shows.
pub struct Shown {
    pipeline: GraphicsPipeline,
    /// P2; the fourth channel is 1 + the object, 0 where no mirror is shown.
    position: Image,
    /// N2.
    normal: Image,
    /// Light of the mirror's own surface.
    light: Image,
    depth: Image,
    /// How many pixels show each object so.
    pixels: Buffer,
}

/// Pipelines and images of second bounces.
pub struct Second {
    shown: Shown,
    background: ComputePipeline,
    surfaces: GraphicsPipeline,
    /// The second mirror's points and normals, at the texels of the first's.
    gbuffer: GBuffer,
    search: Search,
    found: Found,
    split: Split,
    drawing: Drawing,
}

/// A first mirror with all that was found in it.
pub struct Before<'a> {
    pub source: &'a Source,
    pub found: &'a Found,
    pub split: &'a Split,
    pub mirror: &'a Mirror<'a>,
}

impl Shown {
    fn new(device: &Arc<Device>, size: [u32; 2], objects: usize) -> Result<Shown> {
        let formats = [Format::Rgba32Float, Format::Rgba32Float, Format::Rgba16Float];
        let image = |name: &str, format| Image::new(device, name, format, size, Shape::Flat);
        let defines = [("SHOWN_IN_VIEW", 1)];
        Ok(Shown {
            pipeline: surfaces(device, &defines, &formats)?,
            position: image("mirrors shown, points", formats[0])?,
            normal: image("mirrors shown, normals", formats[1])?,
            light: image("mirrors shown, light", formats[2])?,
            depth: image("mirrors shown, depth", Format::DepthStencil)?,
            pixels: Buffer::storage(device, "mirrors shown, pixels", 4 * objects.max(4) as u64)?,
        })
    }

    /// Bind what shaders read of it.
    pub fn bind<'f>(&'f self, pass: Pass<'f>) -> Pass<'f> {
        pass.sample("shown_position", &self.position)
            .sample("shown_normal", &self.normal)
            .sample("shown_light", &self.light)
    }

    /// Draw it for one mirror.
    fn draw(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        view: &View,
        before: &Before,
    ) -> Result<()> {
        let clear = Load::Clear([0.0; 4]);
        let pass = frame.pass("virtual-objects/shown").graphics(&self.pipeline);
        let (position, normal) = (&view.footprint.position, &view.footprint.normal);
        before
            .bind(scene.bind(pass), NO_OBJECT)
            .uniform("camera", &view.camera)
            .sample("reflector_id", &view.footprint.reflector)
            .sample("first_position", position)
            .sample("first_normal", normal)
            .colour("position", &self.position, clear)
            .colour("normal", &self.normal, clear)
            .colour("light", &self.light, clear)
            .depth_stencil(&self.depth, clear, Load::ClearWords([0; 4]))
            .draw(|draw| before.split.draw(draw))
    }
}

/// A pipeline that draws the mirrors shown.
fn surfaces(
    device: &Arc<Device>,
    defines: &[(&'static str, u32)],
    colours: &[Format],
) -> Result<GraphicsPipeline> {
    let attachments =
        Attachments { colours, depth_stencil: true, depth: Depth::Nearest, stencil: Stencil::Off };
    GraphicsPipeline::new(device, "virtual_objects/shown.wgsl", defines, &attachments)
}

impl Before<'_> {
    /// Bind its virtual objects, of which `second` alone is wanted, or every mirror.
    fn bind<'f>(&self, pass: Pass<'f>, second: ObjectId) -> Pass<'f> {
        let shown = ShownUniform { first: self.mirror.object, second, ..Zeroable::zeroed() };
        pass.uniform("shown", &shown)
            .buffer("vertices", &self.source.vertices)
            .buffer("corners", &self.found.corners)
            .buffer("owners", &self.source.owners)
            .buffer("source_indices", &self.source.indices)
            .buffer("drawn", &self.split.drawn)
    }
}

impl Second {
    /// For views of `size` pixels and textures as wide as `texels` says.
    ///
    /// # Errors
    /// As of pipelines and images.
    pub fn new(
        device: &Arc<Device>,
        rule: &Rule,
        mode: RecordMode,
        size: [u32; 2],
        (source, edges): (&Source, &Arc<Edges>),
        objects: usize,
    ) -> Result<Second> {
        let rule = &rule.second();
        let texels = rule.texture_size(size);
        let file = "virtual_objects/second_background.wgsl";
        Ok(Second {
            shown: Shown::new(device, size, objects)?,
            background: ComputePipeline::new(device, file, &mode.defines())?,
            surfaces: surfaces(device, &[], &[rule.format; 2])?,
            gbuffer: GBuffer::new(device, texels, rule.format)?,
            search: Search::new(device, rule, mode, texels)?,
            found: Found::new(device, source.count, 0, corners_made(rule, source, size))?,
            split: Split::new(device, rule, mode, (source, edges), size)?,
            drawing: Drawing::new(device, rule, mode)?,
        })
    }

    /// Fill the record where a mirror that was just drawn shows other mirrors.
    pub fn run(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        view: &View,
        before: &Before,
        record: &ReflectionRecord,
    ) -> Result<()> {
        self.shown.draw(frame, scene, view, before)?;
        frame.pass("virtual-objects/clear").fill(&[&self.shown.pixels], 0)?;
        let pass = frame.pass("virtual-objects/second-background").compute(&self.background);
        let pass = record.bind(view.bind(scene.bind(pass)));
        self.shown
            .bind(pass)
            .buffer("shown_pixels", &self.shown.pixels)
            .indirect(&view.footprint.pixels)?;
        let first = before.mirror.object;
        let mirrors = scene.scene.reflectors().into_iter();
        let mirrors =
            mirrors.filter(|&o| o != first && scene.scene.material_of(o).mirror.is_some());
        // What is seen in a mirror lies behind it, but for other mirrors not further than the scene is wide.
        let all: Vec<ObjectId> = (0..scene.scene.objects.len() as ObjectId).collect();
        let (low, high) = scene.scene.bounds_of(scene.moment(), &all);
        let camera = before.mirror.camera.deepened(low.distance(high));
        for second in mirrors {
            self.reflect(frame, scene, view, (before, &camera, second), record)?;
        }
        Ok(())
    }

    /// Draw what one mirror shows in another.
    fn reflect(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        view: &View,
        (before, camera, second): (&Before, &CameraUniform, ObjectId),
        record: &ReflectionRecord,
    ) -> Result<()> {
        let (source, first) = (before.source, before.mirror);
        let pass = frame.pass("virtual-objects/second-gbuffer").graphics(&self.surfaces);
        let pass = before
            .bind(scene.bind(pass), second)
            .uniform("camera", camera)
            .sample("first_position", &first.gbuffer.position)
            .sample("first_normal", &first.gbuffer.normal);
        self.gbuffer.attach(pass).draw(|draw| before.split.draw(draw))?;
        let mirror = Mirror {
            object: second,
            place: 0,
            vertices: source.count,
            gbuffer: &self.gbuffer,
            cube: None,
            camera: first.camera,
            cut: true,
            index: 1.0,
            first: Some(First { gbuffer: first.gbuffer, shown_pixels: &self.shown.pixels }),
        };
        self.search.run(frame, scene, source, &self.found, &mirror, record)?;
        let parts = (source, &self.found, &self.search);
        self.split.run(frame, (scene, view), parts, &mirror, record)?;
        let what = Drawn {
            source,
            found: &self.found,
            split: Some(&self.split),
            reflector: second,
            first: Some((first.object, &self.shown)),
        };
        self.drawing.run(frame, scene, view, record, what)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::assert_layout;

    #[test]
    fn the_uniform_is_laid_out_as_its_wgsl_twin() {
        #[rustfmt::skip]
        assert_layout!("virtual_objects/shown.wgsl", "Shown", ShownUniform,
            first, second, pad_a, pad_b);
    }
}
