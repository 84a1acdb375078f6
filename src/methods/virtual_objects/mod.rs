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
//!
//! `roots=all` has every reflection point of a vertex where the paper has one (its section 7), by a search
//! that loses none (`roots`), and draws the scene once for each branch of them (`link`).
//!
//! `bounces=2`: mirrors seen in mirrors reflect too, see `second`. Glass is looked through by its first surface,
//! see `refraction`. Both have one point a vertex.
//!
//! Reflectors may be searched in cube maps instead, as the older methods do (`reflector_map=cube`); what the eye
//! sees of them is then drawn only for `hidden=clip`, which cuts along it.

mod bounds;
mod cube;
mod draw;
mod edges;
mod link;
mod params;
mod pyramid;
mod refraction;
mod roots;
mod rule;
mod search;
mod second;
mod skirt;
mod split;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use crate::error::{Error, Result};
use crate::gpu::{Device, Format, Frame};
use crate::scene::{Lobe, ObjectId, Scene};
use crate::stages::{
    CameraUniform, GBuffer, GpuScene, MirroredEnvironment, RecordMode, ReflectionRecord, View,
};

use super::source::{self, Lists, Source};
use super::{Changes, Family, MethodInfo, ReflectionMethod, Setup, Want};
use cube::CubeMaps;
use draw::{Drawing, Drawn};
use edges::Edges;
use refraction::Refraction;
use roots::Nodes;
use rule::Rule;
use search::{Found, Mirror, Search};
use second::{Before, Second};
use skirt::Skirt;
use split::Split;

pub const INFO: MethodInfo = MethodInfo {
    id: "virtual-objects",
    title: "Virtual objects: reflection points searched per vertex",
    paper: "Estalella, Martin, Drettakis & Tost 2006",
    family: Family::FeedForward,
    depends: Changes { objects: false, reflectors: false, shading: false },
    flags: true,
    refracts: true,
    variants: &["published", "revised"],
    params: params::PARAMS,
    limits: "one reflection a vertex and reflector, so convex reflectors, but with roots=all; one bounce, or \
             two; what glass lets through by its first surface alone, and not @published, which is straight \
             between vertices; reflector_map=cube: reflectors star-shaped about their centroid",
    passes: &[
        "virtual-objects/subdivide",
        "virtual-objects/cube",
        "virtual-objects/vertices",
        "footprint/clear-list",
        "footprint/list",
        "virtual-objects/background",
        "virtual-objects/gbuffer",
        "virtual-objects/skirt",
        "virtual-objects/start",
        "virtual-objects/cells",
        "virtual-objects/search",
        "virtual-objects/bounds",
        "virtual-objects/roots",
        "virtual-objects/follow",
        "virtual-objects/tear",
        "virtual-objects/halve",
        "virtual-objects/branches",
        "virtual-objects/clear",
        "virtual-objects/measure",
        "virtual-objects/look",
        "virtual-objects/split",
        "virtual-objects/cut",
        "virtual-objects/reflected",
        "virtual-objects/shown",
        "virtual-objects/second-background",
        "virtual-objects/second-gbuffer",
    ],
    counters: &[
        "searches",
        "steps",
        "evaluations",
        "max-steps",
        "hidden",
        "halved",
        "no-room",
        "visits",
        "roots",
        "roots-beyond",
        "clipped",
        "unfinished",
    ],
    new: Some(new),
};

struct VirtualObjects {
    rule: Rule,
    mode: RecordMode,
    size: [u32; 2],
    environment: MirroredEnvironment,
    gbuffer: GBuffer,
    /// What carries open reflectors on in it.
    skirt: Option<Skirt>,
    /// Where these are searched.
    cubes: Option<CubeMaps>,
    search: Search,
    drawing: Drawing,
    /// What is reflected and where it was found; made by the first `prepare`.
    state: Option<State>,
}

struct State {
    source: Source,
    found: Found,
    /// Where hidden parts are cut off.
    split: Option<Split>,
    /// What mirrors show of mirrors.
    second: Option<Second>,
    refraction: Option<Refraction>,
}

fn new(setup: &Setup) -> Result<Box<dyn ReflectionMethod>> {
    let &Setup { device, mode, size, .. } = setup;
    let rule = Rule::new(setup.values);
    if (rule.all || rule.skirt > 0.0) && rule.cube.is_some() {
        return Err(Error::Usage(
            "roots=all and skirt search what the eye sees of a reflector; they need reflector_map=screen"
                .into(),
        ));
    }
    let texels = rule.texture_size(size);
    let cubes = rule.cube.map(|cube| CubeMaps::new(device, cube, rule.format));
    let is_open = |&mirror: &ObjectId| !setup.scene.is_closed(mirror);
    let skirted = rule.skirt > 0.0 && setup.reflectors.iter().any(is_open);
    let skirt = skirted.then(|| Skirt::new(device, texels, rule.format, rule.skirt));
    let format = if skirted { Format::Rgba32Float } else { rule.format };
    Ok(Box::new(VirtualObjects {
        environment: MirroredEnvironment::new(device, mode)?,
        gbuffer: GBuffer::new(device, texels, format)?,
        skirt: skirt.transpose()?,
        cubes: cubes.transpose()?,
        search: Search::new(device, &rule, mode, texels)?,
        drawing: Drawing::new(device, &rule, mode)?,
        state: None,
        rule,
        mode,
        size,
    }))
}

impl ReflectionMethod for VirtualObjects {
    fn prepare(&mut self, frame: &mut Frame, scene: &GpuScene, want: &Want) -> Result<()> {
        if self.state.is_none() {
            let edge = self.rule.edge;
            let lists =
                frame.cpu("virtual-objects/subdivide", || Lists::new(&scene.scene, edge))?;
            let reflectors = want.reflectors.len();
            self.state = Some(self.state_for(frame.device(), &scene.scene, &lists, reflectors)?);
            if let Some(cubes) = &mut self.cubes {
                for &object in want.reflectors {
                    cubes.draw(frame, scene, object)?;
                }
            }
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
        let Some(State { source, found, split, second, refraction }) = &self.state else {
            return Ok(());
        };
        let (search, split, second, drawing) = match (view.lobe, refraction) {
            (Lobe::Reflected, _) => (&self.search, split.as_ref(), second.as_ref(), &self.drawing),
            (Lobe::Refracted, Some(r)) => (&r.search, Some(&r.split), None, &r.drawing),
            (Lobe::Refracted, None) => return Ok(()),
        };
        source.pose(frame, scene, "virtual-objects")?;
        self.environment.fill(frame, scene, "virtual-objects", view, record)?;
        for (place, &object) in view.reflectors.iter().enumerate() {
            let camera = self.camera(scene, view, object);
            let gbuffer = &self.gbuffer;
            if let Some(cubes) = &mut self.cubes {
                cubes.draw(frame, scene, object)?;
            }
            if let Some(skirt) = self.skirt_of(scene, object) {
                skirt.draw(frame, scene, object, &camera, gbuffer)?;
            } else if self.rule.all {
                // Its edge ends branches as a fold does, so it needs no partner to go on in.
                gbuffer.draw_open(frame, scene, "virtual-objects", object, &camera)?;
            } else if self.cubes.is_none() || self.rule.clips {
                gbuffer.draw(frame, scene, "virtual-objects", object, &camera)?;
            }
            let mirror = Mirror {
                object,
                place,
                vertices: source.count,
                gbuffer,
                cube: self.cubes.as_ref().and_then(|cubes| cubes.of(scene, object)),
                camera: &camera,
                cut: view.cut,
                index: scene.scene.material_of(object).glass.map_or(1.0, |glass| glass.index),
                first: None,
            };
            search.run(frame, scene, source, found, &mirror, record)?;
            if let Some(split) = split {
                let parts = (source, found, search);
                split.run(frame, (scene, view), parts, &mirror, record)?;
            }
            let what = Drawn { source, found, split, reflector: object, first: None };
            drawing.run(frame, scene, view, record, what)?;
            if let (Some(second), Some(split)) = (second, split) {
                let before = Before { source, found, split, mirror: &mirror };
                second.run(frame, scene, view, &before, record)?;
            }
        }
        Ok(())
    }
}

impl VirtualObjects {
    /// Lists for what so many reflectors reflect.
    fn state_for(
        &self,
        device: &Arc<Device>,
        scene: &Scene,
        lists: &Lists,
        reflectors: usize,
    ) -> Result<State> {
        let (rule, mode, size) = (&self.rule, self.mode, self.size);
        let source = lists.upload(device)?;
        // Who starts from the pyramid, or from directions, needs no texels of the frame before.
        let kept = if rule.starts_at_pyramid || rule.cube.is_some() { 0 } else { reflectors };
        let made = if rule.clips { split::corners_made(rule, &source, size) } else { 0 };
        let mut found = Found::new(device, source.count, kept, made)?;
        if !rule.clips {
            return Ok(State { source, found, split: None, second: None, refraction: None });
        }
        if rule.all {
            found.nodes = Some(Nodes::new(device, source.count, link::nodes_made(size))?);
        }
        let edges = Arc::new(Edges::new(device, &lists.indices)?);
        let parts = (&source, &edges);
        let split = Split::new(device, rule, mode, parts, size)?;
        let objects = scene.objects.len();
        let second = rule.twice.then(|| Second::new(device, rule, mode, size, parts, objects));
        let refraction = scene.refracts().then(|| Refraction::new(device, rule, mode, size, parts));
        let (second, refraction) = (second.transpose()?, refraction.transpose()?);
        Ok(State { source, found, split: Some(split), second, refraction })
    }

    /// What carries a reflector on, where it is open.
    fn skirt_of(&self, scene: &GpuScene, object: ObjectId) -> Option<&Skirt> {
        self.skirt.as_ref().filter(|_| !scene.is_closed(object))
    }

    /// What the textures of a reflector are drawn with.
    fn camera(&self, scene: &GpuScene, view: &View, object: ObjectId) -> CameraUniform {
        if !self.rule.fitted {
            return view.camera.widened(self.rule.widening);
        }
        let moment = scene.moment();
        let wide = || view.camera.widened(2.0);
        match self.skirt_of(scene, object) {
            None => {
                let points = scene.scene.closed_points_of(moment, object);
                view.camera.fitted(&points).unwrap_or_else(wide)
            }
            Some(skirt) => {
                let points = scene.scene.points_of(moment, object);
                skirt.camera(view.camera.fitted(&points).unwrap_or_else(wide))
            }
        }
    }
}
