//! `@revised`: the first crossing of the mirrored ray with depth intervals, found over a pyramid of
//! bounds, refined inside the texel, and certified.
//!
//! What it changes against Patow 1995, and why:
//! - Faces hold w = 1/z, in which a ray is straight and a plane linear; texels are walked by whole
//!   numbers, so none is examined twice or skipped (his section 3 hopes for this).
//! - The first crossing, not the best angle (his equation 2): a pole before a wall stays a pole.
//! - No threshold in degrees: a surface is crossed or it is not, whatever its distance.
//! - Intervals from front to back instead of his section 4's list of surfaces, and the farthest surface.
//! - A flag where the ray came through something the map does not hold.

use std::sync::Arc;

use crate::error::{Error, Result};
use crate::gpu::{ComputePipeline, Device, Frame};
use crate::methods::{ReflectionMethod, Setup, Want};
use crate::scene::ObjectId;
use crate::stages::{
    Certificate, GpuScene, IntervalMap, IntervalStage, RecordMode, ReflectionRecord, View,
};

/// Texels along a face's side and intervals a texel, where `auto` leaves them to us.
const AUTO_SIZE: u32 = 512;
const AUTO_LAYERS: u32 = 2;

struct Revised {
    device: Arc<Device>,
    mode: RecordMode,
    stage: IntervalStage,
    reflect: ComputePipeline,
    size: u32,
    layers: u32,
    /// The reflectors of each group, and the map they share.
    maps: Vec<(Vec<ObjectId>, IntervalMap)>,
}

pub fn new(setup: &Setup) -> Result<Box<dyn ReflectionMethod>> {
    let mut defines = setup.mode.defines();
    if setup.values.is("search", "scan") {
        defines.push(("SCAN", 1));
    }
    if setup.values.is("refine", "on") {
        defines.push(("REFINE", 1));
    }
    let certificate = match setup.values.get("certificate") {
        "intervals" => Certificate::Intervals,
        _ => Certificate::Edges,
    };
    let size = setup.values.forced_u32("size").unwrap_or(AUTO_SIZE);
    if !size.is_power_of_two() {
        let message = format!("z-buffered-map@revised: size={size}; valid: a power of two");
        return Err(Error::Usage(message));
    }
    let file = "z_buffered_map/revised.wgsl";
    Ok(Box::new(Revised {
        device: setup.device.clone(),
        mode: setup.mode,
        stage: IntervalStage::new(setup.device, setup.mode, certificate)?,
        reflect: ComputePipeline::new(setup.device, file, &defines)?,
        size,
        layers: setup.values.forced_u32("layers").unwrap_or(AUTO_LAYERS),
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
            let (low, high) = scene.scene.bounds_of(scene.moment(), objects);
            let centre = 0.5 * (low + high);
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
            view.list_pixels(frame, scene, objects)?;
            let pass = frame.pass("z-buffered-map/reflect").compute(&self.reflect);
            let pass = record.bind(view.bind(scene.bind(pass)));
            map.bind(pass).indirect(&view.footprint.pixels)?;
        }
        Ok(())
    }
}
