//! Rays traced from every reflector pixel through a tree over the whole scene, to any order: what a
//! practitioner of today does, and so the rival every other method stands beside.
//!
//! The tree is built on the processor (obvhs) and followed in a compute shader, on any GPU.

use super::{Changes, Family, Kind, MethodInfo, Param, ReflectionMethod, Setup, Want};
use crate::error::Result;
use crate::gpu::{ComputePipeline, Frame};
use crate::stages::{GpuScene, ReflectionRecord, SceneTree, TreeLayout, TreeUpdate, View};

pub const INFO: MethodInfo = MethodInfo {
    id: "ray-traced",
    title: "Ray tracing (software traversal in a compute shader)",
    paper: "Whitted 1980; tree by PLOC (Meister & Bittner 2018) as built by obvhs",
    family: Family::RayTracing,
    depends: Changes { objects: true, reflectors: true, shading: false },
    flags: false,
    refracts: true,
    variants: &["published"],
    params: &[
        Param {
            name: "bounces",
            kind: Kind::Integer { min: 0, max: 16 },
            defaults: &["0"],
            needs: None,
            doc: "longest chain of mirrors followed; 0 takes the scene's",
        },
        Param {
            name: "update",
            kind: Kind::Choice(&["refit", "rebuild"]),
            defaults: &["refit"],
            needs: None,
            doc: "when objects move: fit the tree's boxes on the GPU, or build it anew",
        },
    ],
    limits: "as exact as the mesh and single precision",
    passes: &[
        "ray-traced/build",
        "ray-traced/place",
        "ray-traced/refit",
        "footprint/clear-list",
        "footprint/list",
        "ray-traced/reflect",
    ],
    counters: &["rays", "nodes", "triangles"],
    new: Some(new),
};

struct RayTraced {
    tree: SceneTree,
    reflect: ComputePipeline,
    bounces: u32,
}

fn new(setup: &Setup) -> Result<Box<dyn ReflectionMethod>> {
    let scene = &setup.scene.scene;
    let layout = TreeLayout::new(scene, setup.device.storage_limit())?;
    let mut defines = setup.mode.defines();
    defines.extend(layout.defines());
    defines.extend(setup.scene.defines());
    let rebuild = setup.values.is("update", "rebuild");
    let update = if rebuild { TreeUpdate::Rebuild } else { TreeUpdate::Refit };
    let bounces = setup.values.u32("bounces");
    Ok(Box::new(RayTraced {
        tree: SceneTree::new(setup.device, layout, update)?,
        reflect: ComputePipeline::new(setup.device, "ray_traced/reflect.wgsl", &defines)?,
        bounces: if bounces == 0 { scene.bounces } else { bounces },
    }))
}

impl ReflectionMethod for RayTraced {
    fn prepare(&mut self, frame: &mut Frame, scene: &GpuScene, _: &Want) -> Result<()> {
        self.tree.prepare(frame, scene, "ray-traced")
    }

    fn reflect(
        &mut self,
        frame: &mut Frame,
        scene: &GpuScene,
        view: &View,
        record: &mut ReflectionRecord,
    ) -> Result<()> {
        view.list_pixels(frame, scene, view.reflectors)?;
        let pass = frame.pass("ray-traced/reflect").compute(&self.reflect);
        let pass = record.bind(view.bind(scene.bind(self.tree.bind(pass))));
        pass.uniform("bounces", &self.bounces).indirect(&view.footprint.pixels)
    }
}
