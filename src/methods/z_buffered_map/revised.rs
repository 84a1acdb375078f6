//! `@revised`: the first crossing of the mirrored ray with depth intervals, found over a pyramid of
//! bounds, refined inside the texel, and certified.
//!
//! What it changes against Patow 1995, and why:
//! - Faces hold w = 1/z, in which a ray is straight and a plane linear; texels are walked by whole
//!   numbers, so none is examined twice or skipped (his section 3 hopes for this).
//! - The first crossing, not the best angle (his equation 2): a pole before a wall stays a pole.
//! - No threshold in degrees: a surface is crossed or it is not, whatever its distance.
//! - Intervals from front to back instead of his section 4's list of surfaces, and the farthest surface.
//! - A flag where the map cannot know: the ray came through what was not stored; it passed a texel in which a
//!   surface ends, goes on as another, or crosses another; or what it met is denied by the texel beyond (it
//!   grazes a bend). Unflagged and wrong may still be what is thinner than a texel, and what ends between two
//!   texels' centres as if it made a corner there.

use std::sync::Arc;

use super::super::{ReflectionMethod, Setup, Want};
use super::{refuse, sizing};
use crate::error::Result;
use crate::gpu::{Device, Frame};
use crate::scene::ObjectId;
use crate::stages::{
    Certificate, GpuScene, IntervalMap, IntervalStage, MOST_INTERVALS, PixelPass, RecordMode,
    ReflectionRecord, View,
};

struct Revised {
    device: Arc<Device>,
    mode: RecordMode,
    stage: IntervalStage,
    reflect: PixelPass,
    size: u32,
    layers: u32,
    /// The reflectors of each group, and the map they share.
    maps: Vec<(Vec<ObjectId>, IntervalMap)>,
}

pub(super) fn new(setup: &Setup) -> Result<Box<dyn ReflectionMethod>> {
    let values = setup.values;
    let (scene, reflectors) = (&setup.scene.scene, setup.reflectors);
    let size = values
        .forced_u32("size")
        .unwrap_or_else(|| sizing::texels(scene, reflectors, setup.size[1]));
    if !size.is_power_of_two() {
        return refuse(setup, format!("size={size}; valid: a power of two"));
    }
    let layers = values.forced_u32("layers").unwrap_or_else(|| {
        let moment = scene.at(0);
        let groups = scene.groups(reflectors);
        let needed = groups.iter().map(|(_, objects)| {
            let centre = scene.centre_of(&moment, objects);
            sizing::intervals(scene, &moment, centre, objects, MOST_INTERVALS)
        });
        needed.max().unwrap_or(1)
    });
    if layers > MOST_INTERVALS {
        return refuse(setup, format!("layers={layers}; valid: 1 to {MOST_INTERVALS}"));
    }
    let mut defines = Vec::new();
    if values.is("search", "scan") {
        defines.push(("SCAN", 1));
    }
    if values.is("refine", "on") {
        defines.push(("REFINE", 1));
    }
    let certificate = match values.get("certificate") {
        "intervals" => Certificate::Intervals,
        _ => Certificate::Edges,
    };
    Ok(Box::new(Revised {
        device: setup.device.clone(),
        mode: setup.mode,
        stage: IntervalStage::new(setup.device, setup.mode, certificate)?,
        reflect: setup.pixel_pass("z_buffered_map/revised.wgsl", &defines)?,
        size,
        layers,
        maps: Vec::new(),
    }))
}

impl ReflectionMethod for Revised {
    fn prepare(&mut self, frame: &mut Frame, scene: &GpuScene, want: &Want) -> Result<()> {
        if self.maps.is_empty() {
            for (group, objects) in scene.scene.groups(want.reflectors) {
                let name = format!("z-buffered map of {group}");
                let map = IntervalMap::new(&self.device, &name, self.size, self.layers, self.mode)?;
                self.maps.push((objects, map));
            }
        }
        for (objects, map) in &mut self.maps {
            let centre = scene.scene.centre_of(scene.moment(), objects);
            self.stage.capture(frame, scene, "z-buffered-map", map, centre, objects)?;
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
            let name = "z-buffered-map/reflect";
            self.reflect.run(frame, name, (scene, view), record, objects, |pass| map.bind(pass))?;
        }
        Ok(())
    }
}
