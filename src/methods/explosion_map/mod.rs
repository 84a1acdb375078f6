//! Explosion maps: the reflector's triangles drawn where the light they mirror leaves a sphere about it, so
//! that a look-up by direction tells which triangle mirrors a vertex (Ofek & Rappoport 1998, "Interactive
//! reflections on curved objects").
//!
//! What we know of the paper is what Blythe's course notes of 1999 (section 11.1.3) tell of it: the sphere, the
//! map and its equations, triangles drawn by number, point and normal interpolated in the triangle found,
//! and that this is exact for vertices on the sphere alone. Parameters say what had to be chosen.
//!
//! `@published`: two spheres, one about the reflector and one about the scene, and a vertex's plane blended
//! of both.
//!
//! `@revised`: the map only says where to begin. Whether the rays of a triangle's corners hold the vertex at
//! its own distance is computed, and neighbours are gone to until they do, so no radius matters.

mod map;
mod params;
mod reflector;
mod search;
#[cfg(test)]
mod tests;

use super::reflected::{Corner, Reflected};
use super::source::{Lists, Source};
use super::{Changes, Family, MethodInfo, ReflectionMethod, Setup, Want};
use crate::error::Result;
use crate::gpu::{Buffer, Frame};
use crate::stages::{GpuScene, MirroredEnvironment, ReflectionRecord, View};
use map::Map;
use reflector::Reflector;
use search::Search;

pub const INFO: MethodInfo = MethodInfo {
    id: "explosion-map",
    title: "Explosion map: reflection points looked up per vertex",
    paper: "Ofek & Rappoport 1998, as Blythe 1999 describes it",
    family: Family::FeedForward,
    depends: Changes { objects: false, reflectors: false, shading: false },
    flags: true,
    refracts: false,
    variants: &["published", "revised"],
    params: params::PARAMS,
    limits: "closed convex reflectors, or open ones seen from their front; one bounce; straight between \
             vertices; @published: exact on the spheres only",
    passes: &[
        "explosion-map/subdivide",
        "explosion-map/vertices",
        "footprint/clear-list",
        "footprint/list",
        "explosion-map/background",
        "explosion-map/rays",
        "explosion-map/map",
        "explosion-map/search",
        "explosion-map/reflected",
    ],
    counters: &["searches", "triangles", "max-triangles", "hidden", "lost"],
    new: Some(new),
};

struct ExplosionMap {
    environment: MirroredEnvironment,
    reflectors: Vec<Reflector>,
    map: Map,
    search: Search,
    reflected: Reflected,
    /// Longest edge of diffuse meshes, metres; 0 as modelled.
    edge: f32,
    /// What is reflected, and the [`Corner`]s found for the reflector at hand; made by the first `prepare`.
    state: Option<(Source, Buffer)>,
}

fn new(setup: &Setup) -> Result<Box<dyn ReflectionMethod>> {
    Ok(Box::new(ExplosionMap::new(setup)?))
}

impl ExplosionMap {
    fn new(setup: &Setup) -> Result<ExplosionMap> {
        let &Setup { device, values, size, .. } = setup;
        let scene = &setup.scene.scene;
        let reflectors =
            setup.reflectors.iter().map(|&object| Reflector::new(device, scene, object));
        let reflectors = reflectors.collect::<Result<Vec<_>>>()?;
        let corners = reflectors.iter().map(|r| r.corners).max().unwrap_or(0);
        let side = values.forced_u32("size").unwrap_or(size[0].max(size[1]).max(16));
        Ok(ExplosionMap {
            environment: MirroredEnvironment::new(device, setup.mode)?,
            map: Map::new(device, values, side, corners)?,
            reflectors,
            search: Search::new(setup)?,
            reflected: reflected(setup)?,
            edge: values.f32("subdivide"),
            state: None,
        })
    }
}

/// Both sides of what is hidden are drawn, as the pixel decides what is cut off.
fn reflected(setup: &Setup) -> Result<Reflected> {
    let hidden = if setup.values.is("hidden", "drop") { "HIDDEN_DROPPED" } else { "HIDDEN_CUT" };
    let mut defines = setup.mode.defines();
    defines.extend(["TWO_SIDED", "DRAW_HIDDEN", hidden].map(|define| (define, 1)));
    Reflected::new(setup.device, setup.mode, &defines, setup.values.f32("residual_px"))
}

impl ReflectionMethod for ExplosionMap {
    fn prepare(&mut self, frame: &mut Frame, scene: &GpuScene, _: &Want) -> Result<()> {
        if self.state.is_none() {
            let device = frame.device().clone();
            let lists =
                frame.cpu("explosion-map/subdivide", || Lists::new(&scene.scene, self.edge))?;
            let source = lists.upload(&device)?;
            let bytes = size_of::<Corner>() as u64 * u64::from(source.count.max(1));
            let corners = Buffer::storage(&device, "reflected corners", bytes)?;
            self.state = Some((source, corners));
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
        let Some((source, corners)) = &self.state else { return Ok(()) };
        source.pose(frame, scene, "explosion-map")?;
        self.environment.fill(frame, scene, "explosion-map", view, record)?;
        let record = &*record;
        for reflector in &self.reflectors {
            let object = reflector.object;
            if !view.reflectors.contains(&object) {
                continue;
            }
            let spheres = self.map.fill(frame, scene, &view.camera, reflector)?;
            let parts = (&self.map, &spheres, reflector);
            self.search.run(frame, scene, (&view.camera, record), parts, source, corners)?;
            let (name, to) = ("explosion-map", (view, record));
            self.reflected.draw(frame, scene, name, to, object, (source, corners))?;
        }
        Ok(())
    }
}
