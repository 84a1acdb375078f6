//! Orders above one, "future work" in section 9 of Martin & Popescu 2004: "much of the necessary framework for
//! this is already in place". Every trace is a projection of its own, drawn under its first reflector's stencil.
//!
//! Which reflectors a trace shows, and where, is drawn as everything is: their vertices are morphed too. There
//! the picture of the trace one longer is drawn, over all that stands behind. Triangles never join two traces.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};

use super::trace::Trace;
use crate::error::Result;
use crate::gpu::{
    Attachments, Buffer, ComputePipeline, Defines, Depth, Device, Format, Frame, GraphicsPipeline,
    Image, Load, Pass, Shape, Stencil,
};
use crate::methods::source::Source;
use crate::scene::ObjectId;
use crate::stages::{Footprint, GpuScene, RecordMode, ReflectionRecord, View};

/// WGSL `Order` of `shaders/reflection_morphing/morphed.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct OrderUniform {
    first: ObjectId,
    last: ObjectId,
    trace: u32,
    order: u32,
}

const FORMATS: [Format; 4] =
    [Format::Rgba32Float, Format::Rgba32Float, Format::Rgba16Float, Format::Rgba16Float];

/// The reflectors that traces of one order show, at every pixel; see `shaders/reflection_morphing/chain.wgsl`.
struct Level {
    position: Image,
    outgoing: Image,
    light: Image,
    weight: Image,
}

/// Pipelines and images of orders above one.
pub struct Orders {
    /// What traces of one reflector show, and of more.
    shown: [GraphicsPipeline; 2],
    background: ComputePipeline,
    further: GraphicsPipeline,
    /// For every order but the last.
    levels: Vec<Level>,
}

/// Where things are drawn, what, and where it was morphed to.
#[derive(Clone, Copy)]
pub struct Drawing<'a> {
    pub view: &'a View<'a>,
    pub record: &'a ReflectionRecord,
    pub source: &'a Source,
    pub corners: &'a Buffer,
}

impl Orders {
    /// For chains of up to `bounces` reflectors.
    ///
    /// # Errors
    /// As of pipelines and images.
    pub fn new(
        device: &Arc<Device>,
        mode: RecordMode,
        size: [u32; 2],
        bounces: u32,
    ) -> Result<Orders> {
        let shown = |defines| pipeline(device, "shown.wgsl", defines, &FORMATS);
        let folder = "reflection_morphing";
        let background = format!("{folder}/shown_background.wgsl");
        Ok(Orders {
            shown: [shown(&[])?, shown(&[("FURTHER", 1)])?],
            background: ComputePipeline::new(device, &background, &mode.defines())?,
            further: pipeline(device, "further.wgsl", &mode.defines(), mode.formats())?,
            levels: (1..bounces).map(|_| Level::new(device, size)).collect::<Result<_>>()?,
        })
    }

    /// What was morphed by a trace, as a reflection in its first reflector: which reflectors it shows, and the
    /// environment in them.
    pub fn show(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        to: Drawing,
        trace: Trace,
    ) -> Result<()> {
        let (level, clear) = (&self.levels[trace.order as usize - 1], Load::Clear([0.0; 4]));
        let pipeline = &self.shown[usize::from(trace.order > 1)];
        let pass = frame.pass("reflection-morphing/shown").graphics(pipeline);
        let pass = self.bind_before(to.bind(scene.bind(pass), trace), trace);
        pass.sample("reflector_position", &to.view.footprint.position)
            .optional()
            .colour("position", &level.position, clear)
            .colour("outgoing", &level.outgoing, clear)
            .colour("light", &level.light, clear)
            .colour("weight", &level.weight, clear)
            .draw(|draw| {
                draw.stencil_reference(Footprint::stencil_of(trace.first));
                to.source.draw(draw, trace.last);
            })?;
        let pass = frame.pass("reflection-morphing/shown-background").compute(&self.background);
        let pass = to.record.bind(to.view.bind(scene.bind(pass)));
        level
            .bind(pass)
            .uniform("order", &OrderUniform::of(trace))
            .indirect(&to.view.footprint.pixels)
    }

    /// Draw what was morphed by a trace of more than one reflector, where [`Orders::show`] found its last.
    pub fn draw(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        to: Drawing,
        trace: Trace,
    ) -> Result<()> {
        let pass = frame.pass("reflection-morphing/reflected").graphics(&self.further);
        let pass = self.bind_before(to.bind(to.record.attach(scene.bind(pass)), trace), trace);
        pass.buffer("source_triangles", &to.source.triangles)
            .buffer("first_triangles", &to.source.first_triangles)
            .draw(|draw| {
                draw.stencil_reference(Footprint::stencil_of(trace.first));
                to.source.draw(draw, trace.last);
            })
    }

    /// Bind where a trace's last reflector is shown, where that is not the first.
    fn bind_before<'f>(&'f self, pass: Pass<'f>, trace: Trace) -> Pass<'f> {
        match trace.order {
            1 => pass,
            order => self.levels[order as usize - 2].bind(pass),
        }
    }
}

/// One that draws morphed triangles.
fn pipeline(
    device: &Arc<Device>,
    file: &str,
    defines: Defines,
    colours: &[Format],
) -> Result<GraphicsPipeline> {
    let attachments = Attachments {
        colours,
        depth_stencil: true,
        depth: Depth::Nearest,
        stencil: Stencil::Within,
    };
    GraphicsPipeline::new(device, &format!("reflection_morphing/{file}"), defines, &attachments)
}

impl OrderUniform {
    fn of(Trace { packed, order, first, last }: Trace) -> OrderUniform {
        OrderUniform { first, last, trace: packed, order }
    }
}

impl Level {
    fn new(device: &Arc<Device>, size: [u32; 2]) -> Result<Level> {
        let [position, outgoing, light, weight] = FORMATS;
        let image = |name: &str, format| Image::new(device, name, format, size, Shape::Flat);
        Ok(Level {
            position: image("reflectors shown, points", position)?,
            outgoing: image("reflectors shown, ways on", outgoing)?,
            light: image("reflectors shown, light", light)?,
            weight: image("reflectors shown, weights", weight)?,
        })
    }

    fn bind<'f>(&'f self, pass: Pass<'f>) -> Pass<'f> {
        pass.sample("chain_position", &self.position)
            .sample("chain_outgoing", &self.outgoing)
            .sample("chain_light", &self.light)
            .sample("chain_weight", &self.weight)
    }
}

impl Drawing<'_> {
    /// Bind what both draws want.
    fn bind<'f>(&self, pass: Pass<'f>, trace: Trace) -> Pass<'f>
    where
        Self: 'f,
    {
        let footprint = self.view.footprint;
        pass.uniform("order", &OrderUniform::of(trace))
            .uniform("camera", &self.view.camera)
            .sample("reflector_id", &footprint.reflector)
            .buffer("vertices", &self.source.vertices)
            .buffer("corners", self.corners)
            .depth_stencil(&footprint.depth_stencil, Load::Clear([0.0; 4]), Load::Keep)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::assert_layout;

    #[test]
    #[rustfmt::skip]
    fn the_uniform_is_laid_out_as_its_wgsl_twin() {
        assert_layout!("reflection_morphing/further.wgsl", "Order", OrderUniform, first, last, trace, order);
    }
}
