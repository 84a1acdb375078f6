//! Environment mapping: one captured map per reflector group, looked up by direction alone
//! (Blinn & Newell 1976; the six cube faces after Greene 1986; the lecture's algorithm).
//!
//! Patow 1995, section 1, shows two ways to index it: by the mirrored direction B (his figure 1),
//! exact for an infinitely distant scene, and by the reflector point W (figure 2), which stands
//! for a scene in touch with the reflector.

mod map;
mod params;
mod sight;

use super::{Changes, Family, MethodInfo, ReflectionMethod, Setup, Want};
use crate::error::Result;
use crate::gpu::Frame;
use crate::scene::ObjectId;
use crate::stages::{GpuScene, PixelPass, ReflectionRecord, View};
use map::{Map, MapMaker};
use sight::Sight;

pub const INFO: MethodInfo = MethodInfo {
    id: "environment-map",
    title: "Environment map",
    paper: "Blinn & Newell 1976; Greene 1986; Patow 1995 section 1; lecture 18",
    family: Family::ImageSpace,
    depends: Changes::ALL,
    flags: false,
    refracts: true,
    variants: &["published"],
    params: params::PARAMS,
    limits: "no parallax but a proxy's: exact only for a scene infinitely far away, or one that is the \
             proxy; no self-reflection",
    passes: &[
        "environment-map/capture-background",
        "environment-map/capture",
        "environment-map/resample",
        "environment-map/build",
        "environment-map/place",
        "environment-map/refit",
        "environment-map/ball",
        "environment-map/shrink",
        "footprint/clear-list",
        "footprint/list",
        "environment-map/reflect",
    ],
    counters: &["lookups"],
    new: Some(new),
};

struct EnvironmentMap {
    maker: MapMaker,
    sight: Sight,
    reflect: PixelPass,
    /// The reflectors of each group, and the map they share.
    maps: Vec<(Vec<ObjectId>, Map)>,
}

fn new(setup: &Setup) -> Result<Box<dyn ReflectionMethod>> {
    let values = setup.values;
    let maker = MapMaker::new(setup)?;
    let mut defines = maker.defines(values);
    defines.extend(Sight::defines(values));
    match values.get("shade_at") {
        "vertex" => defines.extend([("SHADE_AT_CORNERS", 1), ("SHADE_AT_VERTEX", 1)]),
        "vertex-ray" => defines.extend([("SHADE_AT_CORNERS", 1), ("SHADE_AT_VERTEX_RAY", 1)]),
        _ => {}
    }
    Ok(Box::new(EnvironmentMap {
        maker,
        sight: Sight::new(values),
        reflect: setup.pixel_pass("environment_map/reflect.wgsl", &defines)?,
        maps: Vec::new(),
    }))
}

impl ReflectionMethod for EnvironmentMap {
    fn prepare(&mut self, frame: &mut Frame, scene: &GpuScene, want: &Want) -> Result<()> {
        if self.maps.is_empty() {
            for (group, objects) in scene.scene.groups(want.reflectors) {
                self.maps.push((objects, self.maker.make(&group)?));
            }
        }
        self.maker.prepare(frame, scene)?;
        for (objects, map) in &mut self.maps {
            let centre = scene.scene.centre_of(scene.moment(), objects);
            self.maker.fill(frame, scene, map, centre, objects)?;
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
        for (objects, map) in &self.maps {
            let params = self.sight.params(&scene.scene, scene.moment(), map.centre);
            let name = "environment-map/reflect";
            self.reflect.run(frame, name, (scene, view), record, objects, |pass| {
                map.bind(pass.uniform("params", &params).optional())
            })?;
        }
        Ok(())
    }
}
