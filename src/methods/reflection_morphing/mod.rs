//! Reflection morphing: scene vertices projected through rays traced beforehand from the corners of a cell
//! round the eye, the eight projections interpolated, and the scene so reflected drawn through the stencil
//! (Martin & Popescu 2004, "Reflection Morphing").
//!
//! `@published`, with section 8's sizes. "Reflectors only affect the direction of a ray, not its color, and
//! should thus be considered as being part of the camera": rays know nothing of diffuse objects, which may
//! move; they are made anew where a reflector moves.
//!
//! `@revised`: a vertex is projected between the four rays that it runs among (`point`), found beside the
//! nearest of all (`leaves`); it is drawn where any node sees it (`weights`).
//!
//! `bounces` above one: see `orders`.
//!
//! Choices the paper leaves to us: where nodes lie (`cell`, from the world's origin on), how finely meshes are
//! cut (`subdivide`), that rays seen inside a closed mirror are left out, and that both sides of reflected
//! triangles are drawn. Look-ups of vertices that stand still are kept for as long as their node is one of
//! the eight ("these vertices must only be morphed once for each sampling cell", section 8): a node that two
//! cells share is not asked again.
//!
//! `nodes=eye`: the eye is the only node, made anew in every frame, see `eye`.

mod eye;
pub mod file;
pub mod grid;
mod morph;
mod nodes;
mod orders;
mod params;
pub mod ray_map;
#[cfg(test)]
mod tests;
mod trace;

use crate::error::{Error, Result};
use crate::geometry::Projection;
use crate::gpu::Frame;
use crate::scene::Lobe;
use crate::stages::{GpuScene, MirroredEnvironment, ReflectionRecord, View};
use crate::truth::Cache;

use super::reflected::Reflected;
use super::source::{Lists, Source};
use super::{Changes, Family, MethodInfo, ReflectionMethod, Setup, Values, Want};
use file::Recipe;
use grid::{Corner, Grid, SamplingCell};
use morph::{Morph, Vertices};
use nodes::Nodes;
use orders::{Drawing, Orders};
use trace::Trace;

pub const INFO: MethodInfo = MethodInfo {
    id: "reflection-morphing",
    title: "Reflection morphing: vertices projected through precomputed rays",
    paper: "Martin & Popescu 2004",
    family: Family::FeedForward,
    depends: Changes { objects: false, reflectors: true, shading: false },
    flags: false,
    refracts: true,
    variants: &["published", "revised"],
    params: params::PARAMS,
    limits: "one reflection a vertex and chain of reflectors (`bounces`); reflectors that move cost \
             eight octrees a frame, but not with nodes=eye; what glass lets through with nodes=eye alone, by its first \
             surface; vertices no ray passes by take their triangles with them",
    passes: &[
        "reflection-morphing/subdivide",
        "reflection-morphing/octree",
        "reflection-morphing/build",
        "reflection-morphing/place",
        "reflection-morphing/refit",
        "reflection-morphing/vertices",
        "footprint/clear-list",
        "footprint/list",
        "reflection-morphing/background",
        "reflection-morphing/look-up-still",
        "reflection-morphing/look-up-moving",
        "reflection-morphing/morph",
        "reflection-morphing/gbuffer",
        "reflection-morphing/rays",
        "reflection-morphing/clear",
        "reflection-morphing/count",
        "reflection-morphing/sum",
        "reflection-morphing/fill",
        "reflection-morphing/project",
        "reflection-morphing/reflected",
        "reflection-morphing/shown",
        "reflection-morphing/follow",
        "reflection-morphing/shown-background",
    ],
    counters: &["look-ups", "rays", "valid", "entries", "no-room", "followed"],
    new: Some(new),
};

struct ReflectionMorphing {
    /// Longest edge of diffuse meshes, metres; 0 as modelled.
    edge: f32,
    grid: Grid,
    nodes: Nodes,
    environment: MirroredEnvironment,
    morph: Morph,
    reflected: Reflected,
    /// Of chains of more than one reflector, each by its own projection.
    orders: Option<Orders>,
    bounces: u32,
    /// What is reflected and where it was found; made by the first `prepare`.
    state: Option<State>,
}

struct State {
    source: Source,
    vertices: Vertices,
}

fn new(setup: &Setup) -> Result<Box<dyn ReflectionMethod>> {
    let &Setup { device, mode, values, .. } = setup;
    if values.is("nodes", "eye") {
        let extent = ray_map::extent(&setup.scene.scene);
        return Ok(Box::new(eye::EyeNode::new(setup, extent)?));
    }
    if matches!(setup.scene.scene.camera.at(0.0).projection, Projection::Orthographic { .. }) {
        return Err(Error::Usage(
            "reflection-morphing traces rays from where an eye can be; parallel rays meet in no eye; \
             valid: a scene whose camera has an angle of view"
                .to_owned(),
        ));
    }
    let bounces = values.u32("bounces");
    let recipe = Recipe {
        map: values.u32("map"),
        depth: values.u32("depth"),
        layers: bounces,
        still: values.is("still", "in"),
    };
    let grid = Grid { cell: values.f32("cell") };
    let scene = &setup.scene.scene;
    let moves = scene.reflectors().into_iter().any(|mirror| scene.is_moving(mirror));
    let files = values.is("files", "kept") && !moves;
    let look_up = look_up_defines(values);
    let mapped = look_up.contains(&("RAY_MAP", 1));
    let apart = bounces > 1 && values.is("traces", "apart");
    let orders = apart.then(|| Orders::new(device, mode, setup.size, bounces));
    let with_mode = |defines: &[(&'static str, u32)]| [&mode.defines(), defines].concat();
    Ok(Box::new(ReflectionMorphing {
        edge: values.f32("subdivide"),
        grid,
        nodes: Nodes::new(recipe, grid, files.then(Cache::of_user).transpose()?, mapped),
        environment: MirroredEnvironment::new(device, mode)?,
        morph: Morph::new(device, &with_mode(&look_up))?,
        reflected: Reflected::new(device, mode, &with_mode(&[("TWO_SIDED", 1)]), 0.0)?,
        orders: orders.transpose()?,
        bounces,
        state: None,
    }))
}

/// How vertices are looked up and their places weighed.
fn look_up_defines(values: &Values) -> Vec<(&'static str, u32)> {
    let (further, bundles) = (values.u32("bounces") > 1, values.is("point", "bundle"));
    let choices = [
        ("BRUTE_FORCE", values.is("lookup", "brute-force")),
        ("LEAVES_NEIGHBOURS", values.is("leaves", "neighbours")),
        ("POINT_BUNDLE", bundles),
        ("WEIGHTS_VALID", values.is("weights", "valid")),
        ("TRACES_MIXED", values.is("traces", "mixed")),
        ("RAY_MAP", further || bundles),
    ];
    choices.into_iter().filter(|(_, on)| *on).map(|(name, _)| (name, 1)).collect()
}

impl ReflectionMethod for ReflectionMorphing {
    fn prepare(&mut self, frame: &mut Frame, scene: &GpuScene, want: &Want) -> Result<()> {
        if self.state.is_none() {
            let device = frame.device().clone();
            let edge = self.edge;
            let lists =
                frame.cpu("reflection-morphing/subdivide", || Lists::new(&scene.scene, edge))?;
            let vertices = Vertices::new(&device, &scene.scene, &lists)?;
            self.state = Some(State { source: lists.upload(&device)?, vertices });
        }
        if want.changed.reflectors {
            self.nodes.clear();
        }
        let cell = self.grid.cell_of(scene.moment().camera.eye);
        self.fetch(frame, scene, &cell)
    }

    fn reflect(
        &mut self,
        frame: &mut Frame,
        scene: &GpuScene,
        view: &View,
        record: &mut ReflectionRecord,
    ) -> Result<()> {
        if view.lobe == Lobe::Refracted {
            return Ok(());
        }
        let cell = self.grid.cell_of(view.camera.eye());
        self.fetch(frame, scene, &cell)?;
        let Some(State { source, .. }) = &self.state else { return Ok(()) };
        source.pose(frame, scene, "reflection-morphing")?;
        self.environment.fill(frame, scene, "reflection-morphing", view, record)?;
        let corners = cell.corners();
        for &object in view.reflectors {
            let trace = Trace::of(&scene.scene, object);
            self.follow(frame, scene, (view, record), &corners, trace)?;
        }
        Ok(())
    }
}

impl ReflectionMorphing {
    /// "Determine the sampling cell occupied by the desired view", and have its octrees at hand.
    fn fetch(&mut self, frame: &mut Frame, scene: &GpuScene, cell: &SamplingCell) -> Result<()> {
        let corners = cell.corners();
        if (0..).zip(&corners).all(|(slot, corner)| !self.nodes.lacks(slot, corner)) {
            return Ok(());
        }
        let device = frame.device().clone();
        let at = (&*scene.scene, scene.moment());
        frame.cpu("reflection-morphing/octree", || self.nodes.fetch(&device, at, &corners))
    }

    /// Draw what is seen by a trace, and by those that go on from it.
    fn follow(
        &mut self,
        frame: &mut Frame,
        scene: &GpuScene,
        (view, record): (&View, &ReflectionRecord),
        corners: &[Corner; 8],
        trace: Trace,
    ) -> Result<()> {
        let Some(State { source, vertices }) = &mut self.state else { return Ok(()) };
        let nodes = &mut self.nodes;
        self.morph.look_up(frame, scene, (source, vertices), nodes, trace, record)?;
        let camera = (&view.camera, record);
        self.morph.run(frame, scene, (source, vertices), corners, trace, camera)?;
        let to = Drawing { view, record, source, corners: &vertices.corners };
        match &self.orders {
            Some(orders) if trace.order > 1 => orders.draw(frame, scene, to, trace)?,
            _ => {
                let (name, to) = ("reflection-morphing", (view, record));
                let what = (&*source, &vertices.corners);
                self.reflected.draw(frame, scene, name, to, trace.first, what)?;
            }
        }
        let Some(orders) = self.orders.as_ref().filter(|_| trace.order < self.bounces) else {
            return Ok(());
        };
        let mirrors = scene.scene.reflectors().into_iter();
        let longer = mirrors.map(|mirror| trace.on(&scene.scene, mirror));
        let longer: Vec<Trace> = longer.filter(|longer| nodes.know(longer.packed)).collect();
        if !longer.is_empty() {
            orders.show(frame, scene, to, trace)?;
        }
        longer
            .into_iter()
            .try_for_each(|longer| self.follow(frame, scene, (view, record), corners, longer))
    }
}
