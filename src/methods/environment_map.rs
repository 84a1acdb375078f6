//! Environment mapping: one captured map per reflector group, looked up by direction alone
//! (Blinn & Newell 1976; the six cube faces after Greene 1986; the lecture's algorithm).
//!
//! Patow 1995, section 1, shows two ways to index it: by the mirrored direction B (his figure 1),
//! exact for an infinitely distant scene, and by the reflector point W (figure 2), which stands
//! for a scene in touch with the reflector.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};

use super::params::STAGE;
use super::{Changes, Family, Kind, MethodInfo, Param, ReflectionMethod, Setup, Want};
use crate::error::Result;
use crate::gpu::{Device, Frame, Sampler};
use crate::scene::ObjectId;
use crate::stages::{Capture, CaptureStage, GpuScene, PixelPass, ReflectionRecord, View};

pub const INFO: MethodInfo = MethodInfo {
    id: "environment-map",
    title: "Environment map",
    paper: "Blinn & Newell 1976; Greene 1986; Patow 1995 section 1; lecture 18",
    family: Family::ImageSpace,
    depends: Changes::ALL,
    flags: false,
    refracts: true,
    variants: &["published"],
    params: &[
        Param {
            name: "size",
            kind: Kind::Integer { min: 4, max: 4096 },
            defaults: &["512"],
            needs: None,
            doc: "texels along a cube face's side",
        },
        Param {
            name: "index",
            kind: Kind::Choice(&["direction", "surface"]),
            defaults: &["direction"],
            needs: None,
            doc: "look up by the mirrored direction B, or by the reflector point W (Patow fig. 2)",
        },
        STAGE,
    ],
    limits: "no parallax: exact only for a scene infinitely far away; no self-reflection",
    passes: &[
        "environment-map/capture-background",
        "environment-map/capture",
        "footprint/clear-list",
        "footprint/list",
        "environment-map/reflect",
    ],
    counters: &["lookups"],
    new: Some(new),
};

/// WGSL `Params` of `shaders/environment_map/reflect.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub struct Params {
    centre: [f32; 3],
    size: u32,
}

struct EnvironmentMap {
    device: Arc<Device>,
    stage: CaptureStage,
    reflect: PixelPass,
    size: u32,
    /// The reflectors of each group, and the map they share.
    maps: Vec<(Vec<ObjectId>, Capture)>,
}

fn new(setup: &Setup) -> Result<Box<dyn ReflectionMethod>> {
    let mut defines = Vec::new();
    if setup.values.is("index", "surface") {
        defines.push(("INDEX_SURFACE", 1));
    }
    Ok(Box::new(EnvironmentMap {
        device: setup.device.clone(),
        stage: CaptureStage::new(setup.device)?,
        reflect: setup.pixel_pass("environment_map/reflect.wgsl", &defines)?,
        size: setup.values.u32("size"),
        maps: Vec::new(),
    }))
}

impl ReflectionMethod for EnvironmentMap {
    fn prepare(&mut self, frame: &mut Frame, scene: &GpuScene, want: &Want) -> Result<()> {
        if self.maps.is_empty() {
            for (group, objects) in scene.scene.groups(want.reflectors) {
                let name = format!("environment map of {group}");
                self.maps.push((objects, Capture::new(&self.device, &name, self.size)?));
            }
        }
        for (objects, map) in &mut self.maps {
            // "Rendered from the centroid of the reflector" (Martin & Popescu 2004, section 2.1).
            let (low, high) = scene.scene.bounds_of(scene.moment(), objects);
            let centre = 0.5 * (low + high);
            self.stage.capture(frame, scene, "environment-map", map, centre, objects)?;
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
            let params = Params { centre: map.centre.to_array(), size: map.size };
            let name = "environment-map/reflect";
            self.reflect.run(frame, name, (scene, view), record, objects, |pass| {
                pass.uniform("params", &params)
                    .optional()
                    .sample("capture_radiance", &map.radiance)
                    .sample("capture_point", &map.point)
                    .optional()
                    .sample("capture_ids", &map.ids)
                    .optional()
                    .sampler("linear_filter", Sampler::Linear)
            })?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::Params;
    use crate::gpu::layout::assert_layout;

    #[test]
    fn parameters_are_laid_out_as_their_wgsl_twin() {
        assert_layout!("environment_map/reflect.wgsl", "Params", Params, centre, size);
    }
}
