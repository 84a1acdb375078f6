//! The method as published: the texel at the best angle of each layer, or the background.
//!
//! Choices we had to make, where the paper is silent:
//! - **Texels are not filtered**: a texel's colour is shown as stored, from the texel's own point.
//! - **B . \[W\] = +-1** within 0.06 degrees (`geometry::reflection_plane::PARALLEL_SINE`): the first
//!   layer is looked up in direction B. A reflector point at the map's centre, which has no \[W\],
//!   is treated so too.
//! - **Background** is the scene's environment in direction B, not the map's texel there (which in
//!   a closed room would be a wall): his figure 6 shows a black hole.
//! - **A texel without a surface has an empty list** (figure 7, "for each entry"), and so never is
//!   a predictor; behind all else there is the background.
//! - **Layers** are asked in order, the first whose best predictor is within the limit answers.
//! - **The line** of figure 7 is Bresenham's (`line=bresenham`), "the most straightforward" of
//!   section 3; what it calls better, all texels touched, is `line=touched`.
//! - **t is counted in metres** (`unit_m`): equation (1) adds a direction and a position, so its
//!   steps fall elsewhere when the same room is measured in other units. `search=image` does not
//!   depend on it.
//! - **The centre** is the middle of the box about the reflectors the map serves, which are left out
//!   of it. With `map=scene` that is all of them, so no mirror then shows another.
//! - **Back faces are culled** (`surfaces=facing`), as his two layers for a room with boxes suggest:
//!   a box then takes one layer, and with both its sides two (`surfaces=all`).

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};

use super::super::{ReflectionMethod, Setup, Want};
use crate::error::Result;
use crate::gpu::{Device, Frame};
use crate::scene::ObjectId;
use crate::stages::{
    GpuScene, LayeredCapture, LayeredCaptureStage, PixelPass, RecordMode, ReflectionRecord, Sides,
    View,
};

/// What his section 5 has, where `auto` leaves it to us.
const SIZE: u32 = 300;
const LAYERS: u32 = 2;

/// WGSL `Params` of `shaders/z_buffered_map/published.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub struct Params {
    steps: u32,
    unit: f32,
    threshold: f32,
    pad: u32,
}

struct Published {
    device: Arc<Device>,
    stage: LayeredCaptureStage,
    reflect: PixelPass,
    params: Params,
    mode: RecordMode,
    size: u32,
    layers: u32,
    one_map: bool,
    /// The reflectors each map serves, and the map.
    maps: Vec<(Vec<ObjectId>, LayeredCapture)>,
}

pub(super) fn new(setup: &Setup) -> Result<Box<dyn ReflectionMethod>> {
    let values = setup.values;
    let layers = values.forced_u32("layers").unwrap_or(LAYERS);
    let mut defines = vec![("LAYERS", layers)];
    match values.get("search") {
        "vector" => defines.push(("SEARCH_VECTOR", 1)),
        "image" => defines.push(("SEARCH_IMAGE", 1)),
        _ => {}
    }
    if values.is("line", "touched") {
        defines.push(("LINE_TOUCHED", 1));
    }
    let sides = if values.is("surfaces", "all") { Sides::Both } else { Sides::Facing };
    Ok(Box::new(Published {
        device: setup.device.clone(),
        stage: LayeredCaptureStage::new(setup.device, setup.mode, sides)?,
        reflect: setup.pixel_pass("z_buffered_map/published.wgsl", &defines)?,
        params: Params {
            steps: values.u32("steps"),
            unit: values.f32("unit_m"),
            threshold: values.f32("threshold_deg").to_radians().sin().powi(2),
            pad: 0,
        },
        mode: setup.mode,
        size: values.forced_u32("size").unwrap_or(SIZE),
        layers,
        one_map: values.is("map", "scene"),
        maps: Vec::new(),
    }))
}

impl Published {
    fn make_maps(&mut self, scene: &GpuScene, reflectors: &[ObjectId]) -> Result<()> {
        let groups = if self.one_map && !reflectors.is_empty() {
            vec![("the scene".to_owned(), reflectors.to_vec())]
        } else {
            scene.scene.groups(reflectors)
        };
        for (group, objects) in groups {
            let name = format!("z-buffered map of {group}");
            let map = LayeredCapture::new(&self.device, &name, self.size, self.layers, self.mode)?;
            self.maps.push((objects, map));
        }
        Ok(())
    }
}

impl ReflectionMethod for Published {
    fn prepare(&mut self, frame: &mut Frame, scene: &GpuScene, want: &Want) -> Result<()> {
        if self.maps.is_empty() {
            self.make_maps(scene, want.reflectors)?;
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
            self.reflect.run(frame, name, (scene, view), record, objects, |pass| {
                map.bind(pass).uniform("params", &self.params)
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
        assert_layout!(
            "z_buffered_map/published.wgsl",
            "Params",
            Params,
            steps,
            unit,
            threshold,
            pad
        );
    }
}
