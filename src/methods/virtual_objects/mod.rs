//! Virtual objects: for each vertex of the scene the point of the reflector that shows it is found,
//! and the scene so reflected is drawn through the stencil (Estalella, Martin, Drettakis & Tost 2006,
//! "A GPU-driven algorithm for accurate interactive reflections on curved objects").
//!
//! `@published`: a walk over texels, starting where the frame before ended. Choices the paper leaves to us
//! are parameters. Two more: a texel outside the reflector is never better than one on it, and a search
//! whose first texel the reflector has left starts from the middle. Two choices decide whether there is a
//! picture at all: triangles with three hidden vertices are left out, and back faces are culled. What lies
//! hidden behind the reflector lands all round its silhouette, so a surface that crosses the hidden region
//! is torn open in its middle, and a triangle there is stretched over the whole mirror, before the rest.
//!
//! `@revised`: textures that show all of the reflector, searches from coarse to fine that end between
//! texels and remember nothing, hidden parts cut off along the reflector's shadow volume, triangles halved
//! where their middles are drawn in the wrong place, and a flag where the law of reflection is broken.

mod params;
mod pyramid;
mod rule;
mod search;
mod split;
#[cfg(test)]
mod tests;

use crate::error::Result;
use crate::gpu::Frame;
use crate::scene::ObjectId;
use crate::stages::{
    CameraUniform, Footprint, GBuffer, GpuScene, MirroredEnvironment, RecordMode, ReflectionRecord,
    View,
};

use super::reflected::Reflected;
use super::source::{self, Lists, Source};
use super::{Changes, Family, MethodInfo, ReflectionMethod, Setup, Want};
use rule::Rule;
use search::{Found, Mirror, Search};
use split::Split;

pub const INFO: MethodInfo = MethodInfo {
    id: "virtual-objects",
    title: "Virtual objects: reflection points searched per vertex",
    paper: "Estalella, Martin, Drettakis & Tost 2006",
    family: Family::FeedForward,
    depends: Changes { objects: false, reflectors: false, shading: false },
    flags: true,
    refracts: false,
    variants: &["published", "revised"],
    params: params::PARAMS,
    limits: "one reflection a vertex and reflector, so convex reflectors; one bounce; @published: straight \
             between vertices",
    passes: &[
        "virtual-objects/subdivide",
        "virtual-objects/vertices",
        "footprint/clear-list",
        "footprint/list",
        "virtual-objects/background",
        "virtual-objects/gbuffer",
        "virtual-objects/start",
        "virtual-objects/cells",
        "virtual-objects/search",
        "virtual-objects/clear",
        "virtual-objects/split",
        "virtual-objects/reflected",
    ],
    counters: &["searches", "steps", "evaluations", "max-steps", "hidden", "halved", "no-room"],
    new: Some(new),
};

struct VirtualObjects {
    rule: Rule,
    mode: RecordMode,
    size: [u32; 2],
    environment: MirroredEnvironment,
    gbuffer: GBuffer,
    search: Search,
    reflected: Reflected,
    /// What is reflected and where it was found; made by the first `prepare`.
    state: Option<State>,
}

struct State {
    source: Source,
    found: Found,
    /// Where hidden parts are cut off.
    split: Option<Split>,
}

fn new(setup: &Setup) -> Result<Box<dyn ReflectionMethod>> {
    let &Setup { device, mode, size, .. } = setup;
    let rule = Rule::new(setup.values);
    let texels = rule.texture_size(size);
    Ok(Box::new(VirtualObjects {
        environment: MirroredEnvironment::new(device, mode)?,
        gbuffer: GBuffer::new(device, texels, rule.format)?,
        search: Search::new(device, &rule, mode, texels)?,
        reflected: Reflected::new(setup, &rule.defines(mode), rule.residual_px)?,
        state: None,
        rule,
        mode,
        size,
    }))
}

impl ReflectionMethod for VirtualObjects {
    fn prepare(&mut self, frame: &mut Frame, scene: &GpuScene, want: &Want) -> Result<()> {
        if self.state.is_none() {
            let device = frame.device().clone();
            let edge = self.rule.edge;
            let lists =
                frame.cpu("virtual-objects/subdivide", || Lists::new(&scene.scene, edge))?;
            let source = lists.upload(&device)?;
            let (rule, clips) = (&self.rule, self.rule.clips);
            let split = clips.then(|| Split::new(&device, rule, self.mode, &source, self.size));
            let made = if clips { split::corners_made(self.size) } else { 0 };
            // Who starts from the pyramid needs no texels of the frame before.
            let kept = if rule.starts_at_pyramid { 0 } else { want.reflectors.len() };
            let found = Found::new(&device, source.count, kept, made)?;
            self.state = Some(State { source, found, split: split.transpose()? });
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
        let Some(State { source, found, split }) = &self.state else { return Ok(()) };
        source.pose(frame, scene, "virtual-objects")?;
        self.environment.fill(frame, scene, "virtual-objects", view, record)?;
        for (place, &object) in view.reflectors.iter().enumerate() {
            let camera = self.camera(scene, view, object);
            let gbuffer = &self.gbuffer;
            gbuffer.draw(frame, scene, "virtual-objects", object, &camera)?;
            let mirror = Mirror {
                object,
                place,
                vertices: source.count,
                gbuffer,
                camera: &camera,
                cut: view.cut,
            };
            self.search.run(frame, scene, source, found, &mirror, record)?;
            if let Some(split) = split {
                let parts = (source, found, &self.search);
                split.run(frame, view, parts, &mirror, record)?;
            }
            self.draw(frame, scene, view, record, object)?;
        }
        Ok(())
    }
}

impl VirtualObjects {
    /// What the textures of a reflector are drawn with.
    fn camera(&self, scene: &GpuScene, view: &View, object: ObjectId) -> CameraUniform {
        if !self.rule.fitted {
            return view.camera.widened(self.rule.widening);
        }
        let points = scene.scene.closed_points_of(scene.moment(), object);
        view.camera.fitted(&points).unwrap_or_else(|| view.camera.widened(2.0))
    }

    /// Draw what was found for one reflector into its pixels.
    fn draw(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        view: &View,
        record: &ReflectionRecord,
        reflector: ObjectId,
    ) -> Result<()> {
        let Some(State { source, found, split }) = &self.state else { return Ok(()) };
        let corners = &found.corners;
        let to = (view, record, reflector);
        let pass = self.reflected.pass(frame, scene, "virtual-objects", to, source, corners);
        let pass = match split {
            None => pass,
            Some(split) => pass
                .buffer("owners", &source.owners)
                .buffer("source_indices", &source.indices)
                .buffer("drawn", &split.drawn),
        };
        pass.draw(|draw| {
            draw.stencil_reference(Footprint::stencil_of(reflector));
            match split {
                Some(split) => split.draw(draw),
                None => source.draw(draw, reflector),
            }
        })
    }
}
