//! Virtual objects: for each vertex of the scene the point of the reflector that shows it is found,
//! and the scene so reflected is drawn through the stencil (Estalella, Martin, Drettakis & Tost 2006,
//! "A GPU-driven algorithm for accurate interactive reflections on curved objects").
//!
//! Choices the paper leaves to us are parameters. Two more: a texel outside the reflector is never
//! better than one on it, and a search whose first texel the reflector has left starts from the middle.
//!
//! Two choices decide whether there is a picture at all: triangles with three hidden vertices are left
//! out, and back faces are culled. What lies hidden behind the reflector lands all round its
//! silhouette, so a surface that crosses the hidden region is torn open in its middle, and a triangle
//! there is stretched over the whole mirror, before the rest.

mod params;
mod search;
mod source;
#[cfg(test)]
mod tests;

use crate::error::Result;
use crate::gpu::{Attachments, Depth, Format, Frame, GraphicsPipeline, Load, Stencil};
use crate::scene::ObjectId;
use crate::stages::{Footprint, GBuffer, GpuScene, MirroredEnvironment, ReflectionRecord, View};

use super::{Changes, Family, MethodInfo, ReflectionMethod, Setup, Values, Want};
use search::{Found, Mirror, Search};
use source::{Lists, Source};

pub const INFO: MethodInfo = MethodInfo {
    id: "virtual-objects",
    title: "Virtual objects: reflection points searched per vertex",
    paper: "Estalella, Martin, Drettakis & Tost 2006",
    family: Family::FeedForward,
    depends: Changes { objects: false, reflectors: false, shading: false },
    flags: false,
    refracts: false,
    variants: &["published"],
    params: params::PARAMS,
    limits: "one reflection a vertex and reflector, so convex reflectors; one bounce; straight between \
             vertices",
    passes: &[
        "virtual-objects/subdivide",
        "footprint/clear-list",
        "footprint/list",
        "virtual-objects/background",
        "virtual-objects/gbuffer",
        "virtual-objects/start",
        "virtual-objects/search",
        "virtual-objects/reflected",
    ],
    counters: &["searches", "steps", "evaluations", "max-steps", "hidden"],
    new: Some(new),
};

struct VirtualObjects {
    environment: MirroredEnvironment,
    gbuffer: GBuffer,
    search: Search,
    reflected: GraphicsPipeline,
    widening: f32,
    /// Longest edge of diffuse meshes, metres; 0 as modelled.
    edge: f32,
    /// What is reflected and where it was found; made by the first `prepare`.
    state: Option<State>,
}

struct State {
    source: Source,
    found: Found,
}

fn new(setup: &Setup) -> Result<Box<dyn ReflectionMethod>> {
    let (device, values) = (setup.device, setup.values);
    Ok(Box::new(VirtualObjects {
        environment: MirroredEnvironment::new(device, setup.mode)?,
        gbuffer: GBuffer::new(device, texture_size(values, setup.size), format(values))?,
        search: Search::new(device, values, setup.mode)?,
        reflected: reflected_pipeline(setup)?,
        widening: values.f32("widening"),
        edge: values.f32("subdivide"),
        state: None,
    }))
}

fn reflected_pipeline(setup: &Setup) -> Result<GraphicsPipeline> {
    let mode = setup.mode;
    let mut defines = mode.defines();
    for (parameter, value, define) in
        [("cull", "none", "TWO_SIDED"), ("unseen", "draw", "DRAW_HIDDEN")]
    {
        if setup.values.is(parameter, value) {
            defines.push((define, 1));
        }
    }
    let attachments = Attachments {
        colours: mode.formats(),
        depth_stencil: true,
        depth: Depth::Nearest,
        stencil: Stencil::Within,
    };
    let file = "virtual_objects/reflected.wgsl";
    GraphicsPipeline::new(setup.device, file, &defines, &attachments)
}

/// Width and height of the textures: the view's shape, and its size unless one is forced.
fn texture_size(values: &Values, [width, height]: [u32; 2]) -> [u32; 2] {
    match values.forced_u32("texture") {
        None => [width, height],
        Some(forced) => {
            let shape = f64::from(height) / f64::from(width);
            [forced, ((f64::from(forced) * shape).round() as u32).max(1)]
        }
    }
}

fn format(values: &Values) -> Format {
    if values.is("precision", "fp16") { Format::Rgba16Float } else { Format::Rgba32Float }
}

impl ReflectionMethod for VirtualObjects {
    fn prepare(&mut self, frame: &mut Frame, scene: &GpuScene, want: &Want) -> Result<()> {
        if self.state.is_none() {
            let device = frame.device().clone();
            let lists =
                frame.cpu("virtual-objects/subdivide", || Lists::new(&scene.scene, self.edge))?;
            let source = lists.upload(&device)?;
            let found = Found::new(&device, source.count, want.reflectors.len())?;
            self.state = Some(State { source, found });
        }
        Ok(())
    }

    fn reflect(
        &mut self,
        frame: &mut Frame,
        scene: &GpuScene,
        view: &View,
        record: &mut ReflectionRecord,
    ) -> Result<()> {
        let Some(state) = &self.state else { return Ok(()) };
        self.environment.fill(frame, scene, "virtual-objects", view, record)?;
        let camera = view.camera.widened(self.widening);
        for (place, &object) in view.reflectors.iter().enumerate() {
            self.gbuffer.draw(frame, scene, "virtual-objects", object, &camera)?;
            let gbuffer = &self.gbuffer;
            let mirror = Mirror { object, place, gbuffer, camera: &camera, cut: view.cut };
            self.search.run(frame, scene, &state.source, &state.found, &mirror, record)?;
            self.draw(frame, scene, view, record, object, state)?;
        }
        Ok(())
    }
}

impl VirtualObjects {
    /// Draw what was found for one reflector into its pixels.
    fn draw(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        view: &View,
        record: &ReflectionRecord,
        reflector: ObjectId,
        State { source, found }: &State,
    ) -> Result<()> {
        let pass = frame.pass("virtual-objects/reflected").graphics(&self.reflected);
        record
            .attach(view.bind(scene.bind(pass)))
            .buffer("vertices", &source.vertices)
            .buffer("virtual_vertices", &found.vertices)
            .buffer("source_triangles", &source.triangles)
            .buffer("first_triangles", &source.first_triangles)
            .uniform("reflector", &reflector)
            .depth_stencil(&view.footprint.depth_stencil, Load::Clear([0.0; 4]), Load::Keep)
            .draw(|draw| {
                draw.stencil_reference(Footprint::stencil_of(reflector));
                source.draw(draw, reflector);
            })
    }
}
