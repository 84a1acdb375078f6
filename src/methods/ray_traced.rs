//! Rays traced from every reflector pixel through a tree over the whole scene, to any order: what a
//! practitioner of today does, and so the rival every other method stands beside.
//!
//! In software the tree is built on the processor (obvhs) and followed in a compute shader, on any
//! GPU; with `backend=query` the device builds and searches a structure of its own.
//!
//! The tree has two boxes a node, or eight compressed ones (`tree=wide`). Prediction, that of Ylitie,
//! Karras & Laine 2017: incoherent rays twice as fast through the wide one, as they read less memory.
//! Outcome, on llvmpipe alone and so nothing sure about a GPU, at 640x400: a sixth to a fifth of the
//! nodes and half the triangles; `reflect` in 0.6 of the binary tree's time, frames in 0.77 to 0.88,
//! undecided in `kitchen`, where few pixels mirror. The binary tree's larger leaves are not why: with
//! leaves of three as the wide one has it meets as few triangles and takes as long as before. Where
//! objects move the wide tree is built anew, which undoes the gain in `columns` (15 ms of processor a
//! frame, 14 ms gained): so there `auto` takes the binary tree, which follows them.

use super::{Changes, Family, Kind, MethodInfo, Param, ReflectionMethod, Setup, Want};
use crate::error::Result;
use crate::gpu::{ComputePipeline, Frame};
use crate::stages::{
    GpuScene, ReflectionRecord, SceneStructure, SceneTree, TreeKind, TreeLayout, TreeUpdate, View,
};

pub const INFO: MethodInfo = MethodInfo {
    id: "ray-traced",
    title: "Ray tracing: software traversal in a compute shader, or the device's ray queries",
    paper: "Whitted 1980; tree by PLOC (Meister & Bittner 2018) as built by obvhs; tree=wide by Ylitie, \
            Karras & Laine 2017",
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
            name: "backend",
            kind: Kind::Choice(&["software", "query"]),
            defaults: &["software"],
            needs: None,
            doc: "who follows the rays: a compute shader, or the device (VK_KHR_ray_query)",
        },
        Param {
            name: "tree",
            kind: Kind::Choice(&["auto", "binary", "wide"]),
            defaults: &["auto"],
            needs: Some(("backend", &["software"])),
            doc: "two boxes a node; or eight, compressed, built anew when objects move; auto: eight \
                  where nothing moves",
        },
        Param {
            name: "update",
            kind: Kind::Choice(&["refit", "rebuild"]),
            defaults: &["refit"],
            needs: Some(("tree", &["auto", "binary"])),
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

/// Who follows the rays.
enum Backend {
    Software(SceneTree),
    Query(SceneStructure),
}

struct RayTraced {
    backend: Backend,
    reflect: ComputePipeline,
    bounces: u32,
}

fn new(setup: &Setup) -> Result<Box<dyn ReflectionMethod>> {
    let (device, scene) = (setup.device, &setup.scene.scene);
    let mut defines = setup.mode.defines();
    defines.extend(setup.scene.defines());
    let backend = if setup.values.is("backend", "query") {
        defines.push(("RAY_QUERY", 1));
        Backend::Query(SceneStructure::new(device)?)
    } else {
        let rebuild = setup.values.is("update", "rebuild");
        let wide = match setup.values.get("tree") {
            "auto" => !scene.moves(),
            tree => tree == "wide",
        };
        let kind = match (wide, rebuild) {
            (true, _) => TreeKind::Wide,
            (false, true) => TreeKind::Binary(TreeUpdate::Rebuild),
            (false, false) => TreeKind::Binary(TreeUpdate::Refit),
        };
        let layout = TreeLayout::new(scene, kind, device.storage_limit())?;
        defines.extend(layout.defines());
        Backend::Software(SceneTree::new(device, layout)?)
    };
    let bounces = setup.values.u32("bounces");
    Ok(Box::new(RayTraced {
        backend,
        reflect: ComputePipeline::new(device, "ray_traced/reflect.wgsl", &defines)?,
        bounces: if bounces == 0 { scene.bounces } else { bounces },
    }))
}

impl ReflectionMethod for RayTraced {
    fn prepare(&mut self, frame: &mut Frame, scene: &GpuScene, _: &Want) -> Result<()> {
        match &mut self.backend {
            Backend::Software(tree) => tree.prepare(frame, scene, "ray-traced"),
            Backend::Query(structure) => structure.prepare(frame, scene, "ray-traced"),
        }
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
        let pass = match &self.backend {
            Backend::Software(tree) => tree.bind(pass),
            Backend::Query(structure) => structure.bind(pass),
        };
        let pass = record.bind(view.bind(scene.bind(pass)));
        pass.uniform("bounces", &self.bounces).indirect(&view.footprint.pixels)
    }
}
