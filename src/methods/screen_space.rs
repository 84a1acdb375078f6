//! Screen-space reflection: the mirrored ray is followed through the depth of the picture itself, over a
//! pyramid of depth bounds ("Hi-Z": Greene, Kass & Miller 1993 for the pyramid, Uludag 2014 for rays).
//!
//! It costs no map and knows every moving thing, but only what the eye sees: a ray that leaves the
//! screen, goes behind what is on it or faces the eye has no answer there. On a convex mirror in front of
//! the eye that is most of them. Such pixels are flagged and show the environment, or stay missing.
//!
//! Choices: a surface stops rays up to `thickness` times its depth behind its front, whichever way they
//! come, since the picture does not say how thick it is; a ray that comes to another reflector has
//! no answer, since the direct view holds only that one's own shade; the reflector a ray starts on never
//! stops it.

use bytemuck::{Pod, Zeroable};

use super::params::STAGE;
use super::{Changes, Family, Kind, MethodInfo, Param, ReflectionMethod, Setup, Want};
use crate::error::Result;
use crate::gpu::Frame;
use crate::stages::{DepthPyramid, GpuScene, PixelPass, ReflectionRecord, View};

pub const INFO: MethodInfo = MethodInfo {
    id: "screen-space",
    title: "Screen space: the picture's own depth searched along the ray",
    paper: "Greene, Kass & Miller 1993 (depth pyramid); Uludag 2014 (GPU Pro 5, Hi-Z tracing)",
    family: Family::ImageSpace,
    depends: Changes { objects: false, reflectors: false, shading: false },
    flags: true,
    refracts: false,
    variants: &["published"],
    params: &[
        Param {
            name: "thickness",
            kind: Kind::Real { min: 0.0, max: 10.0 },
            defaults: &["0.02"],
            needs: None,
            doc: "how far behind its front a surface still stops a ray, as a share of its depth",
        },
        Param {
            name: "steps",
            kind: Kind::Integer { min: 1, max: 65536 },
            defaults: &["512"],
            needs: None,
            doc: "cells of the depth pyramid a ray may visit",
        },
        Param {
            name: "miss",
            kind: Kind::Choice(&["environment", "missing"]),
            defaults: &["environment"],
            needs: None,
            doc: "what a ray without an answer shows: the environment (flagged), or nothing",
        },
        STAGE,
    ],
    limits: "only what is on the screen, from the front; one bounce; no refraction",
    passes: &[
        "screen-space/pyramid-base",
        "screen-space/pyramid",
        "footprint/clear-list",
        "footprint/list",
        "screen-space/reflect",
    ],
    counters: &["visits", "hits"],
    new: Some(new),
};

/// WGSL `Limits` of `shaders/screen_space/trace.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub struct Limits {
    thickness: f32,
    steps: u32,
    levels: u32,
    pad: u32,
}

struct ScreenSpace {
    pyramid: DepthPyramid,
    reflect: PixelPass,
    limits: Limits,
}

fn new(setup: &Setup) -> Result<Box<dyn ReflectionMethod>> {
    let values = setup.values;
    let mut defines = Vec::new();
    if values.is("miss", "environment") {
        defines.push(("MISS_ENVIRONMENT", 1));
    }
    let pyramid = DepthPyramid::new(setup.device, setup.size)?;
    let limits = Limits {
        thickness: values.f32("thickness"),
        steps: values.u32("steps"),
        levels: pyramid.cells.levels,
        pad: 0,
    };
    let reflect = setup.pixel_pass("screen_space/reflect.wgsl", &defines)?;
    Ok(Box::new(ScreenSpace { pyramid, reflect, limits }))
}

impl ReflectionMethod for ScreenSpace {
    fn prepare(&mut self, _: &mut Frame, _: &GpuScene, _: &Want) -> Result<()> {
        Ok(())
    }

    fn reflect(
        &mut self,
        frame: &mut Frame,
        scene: &GpuScene,
        view: &View,
        record: &mut ReflectionRecord,
    ) -> Result<()> {
        self.pyramid.build(frame, "screen-space", &view.direct.depth)?;
        let (direct, reflectors) = (view.direct, view.reflectors);
        let name = "screen-space/reflect";
        self.reflect.run(frame, name, (scene, view), record, reflectors, |pass| {
            let pass = pass
                .uniform("limits", &self.limits)
                .sample("pyramid", &self.pyramid.cells)
                .sample("direct_object", &direct.object)
                .sample("direct_colour", &direct.colour)
                .sample("direct_depth", &direct.depth);
            match &direct.triangle {
                Some(triangle) => pass.sample("direct_triangle", triangle),
                None => pass,
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::Limits;
    use crate::gpu::layout::assert_layout;

    #[test]
    #[rustfmt::skip]
    fn limits_are_laid_out_as_their_wgsl_twin() {
        assert_layout!("screen_space/reflect.wgsl", "Limits", Limits,
            thickness, steps, levels, pad);
    }
}
