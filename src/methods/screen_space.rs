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

use super::{Changes, Family, Kind, MethodInfo, Param, ReflectionMethod, Setup, Want};
use crate::error::Result;
use crate::gpu::{ComputePipeline, Format, Frame, Image, Shape};
use crate::stages::{GpuScene, ReflectionRecord, View};

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
    base: ComputePipeline,
    reduce: ComputePipeline,
    reflect: ComputePipeline,
    /// Nearest and farthest depth of each cell, two floats as bits; a level has half the cells of the
    /// one before.
    pyramid: Image,
    limits: Limits,
}

fn new(setup: &Setup) -> Result<Box<dyn ReflectionMethod>> {
    let (device, values, size) = (setup.device, setup.values, setup.size);
    let mut defines = setup.mode.defines();
    if values.is("miss", "environment") {
        defines.push(("MISS_ENVIRONMENT", 1));
    }
    // Down to a single cell.
    let levels = size[0].max(size[1]).ilog2() + 1;
    let (format, flat) = (Format::Rg32Uint, Shape::Flat);
    Ok(Box::new(ScreenSpace {
        base: ComputePipeline::new(device, "screen_space/pyramid_base.wgsl", &[])?,
        reduce: ComputePipeline::new(device, "screen_space/pyramid.wgsl", &[])?,
        reflect: ComputePipeline::new(device, "screen_space/reflect.wgsl", &defines)?,
        pyramid: Image::with_levels(device, "depth pyramid", format, size, flat, levels)?,
        limits: Limits {
            thickness: values.f32("thickness"),
            steps: values.u32("steps"),
            levels,
            pad: 0,
        },
    }))
}

impl ScreenSpace {
    fn build_pyramid(&self, frame: &mut Frame, depth: &Image) -> Result<()> {
        frame
            .pass("screen-space/pyramid-base")
            .compute(&self.base)
            .sample("depth", depth)
            .store("bounds", &self.pyramid)
            .over_pixels(self.pyramid.size)?;
        for level in 1..self.pyramid.levels {
            frame
                .pass("screen-space/pyramid")
                .compute(&self.reduce)
                .sample("below", &self.pyramid)
                .uniform("level_below", &(level - 1))
                .store_level("bounds", &self.pyramid, level)
                .over_pixels(self.pyramid.size.map(|side| (side >> level).max(1)))?;
        }
        Ok(())
    }
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
        self.build_pyramid(frame, &view.direct.depth)?;
        view.list_pixels(frame, scene, view.reflectors)?;
        let pass = frame.pass("screen-space/reflect").compute(&self.reflect);
        let mut pass = record
            .bind(view.bind(scene.bind(pass)))
            .uniform("limits", &self.limits)
            .sample("pyramid", &self.pyramid)
            .sample("direct_object", &view.direct.object)
            .sample("direct_colour", &view.direct.colour)
            .sample("direct_depth", &view.direct.depth);
        if let Some(triangle) = &view.direct.triangle {
            pass = pass.sample("direct_triangle", triangle);
        }
        pass.indirect(&view.footprint.pixels)
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
