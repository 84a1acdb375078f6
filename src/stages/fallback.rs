//! What fills the pixels a method left missing or flagged.

use std::sync::Arc;

use super::{
    GpuScene, RecordMode, ReflectionRecord, SceneTree, TreeKind, TreeLayout, TreeUpdate, View,
};
use crate::error::Result;
use crate::gpu::{ComputePipeline, Device, Frame};

/// With what they are filled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Filling {
    /// The environment in the direction in which light leaves the reflector.
    Environment,
    /// The scene, traced through its tree.
    Ray,
}

/// The stage after every method.
pub struct FallbackStage {
    pipeline: ComputePipeline,
    tree: Option<SceneTree>,
}

impl FallbackStage {
    /// Work counted with full records; the first stands at `shaders/stages/fallback.wgsl`'s `FILLED`.
    pub const COUNTERS: [&'static str; 4] =
        ["fallback-pixels", "fallback-rays", "fallback-nodes", "fallback-triangles"];
    /// Where these counters begin.
    pub const FIRST_COUNTER: usize = 12;

    /// # Errors
    /// [`crate::error::Error::Device`] where the scene's tree is beyond the device.
    pub fn new(
        device: &Arc<Device>,
        scene: &GpuScene,
        filling: Filling,
        mode: RecordMode,
    ) -> Result<Self> {
        let mut defines = mode.defines();
        let tree = match filling {
            Filling::Environment => None,
            Filling::Ray => {
                let kind = TreeKind::Binary(TreeUpdate::Refit);
                let layout = TreeLayout::new(&scene.scene, kind, device.storage_limit())?;
                defines.push(("FALLBACK_RAY", 1));
                defines.extend(layout.defines());
                defines.extend(scene.defines());
                Some(SceneTree::new(device, layout)?)
            }
        };
        let pipeline = ComputePipeline::new(device, "stages/fallback.wgsl", &defines)?;
        Ok(FallbackStage { pipeline, tree })
    }

    /// Whether it depends on where objects are.
    pub fn has_tree(&self) -> bool {
        self.tree.is_some()
    }

    /// Build what it needs, or follow what moved.
    pub fn prepare(&mut self, frame: &mut Frame, scene: &GpuScene) -> Result<()> {
        match &mut self.tree {
            Some(tree) => tree.prepare(frame, scene, "fallback"),
            None => Ok(()),
        }
    }

    /// Fill what is left of one lobe's record.
    pub fn fill(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        view: &View,
        record: &ReflectionRecord,
    ) -> Result<()> {
        view.list_pixels(frame, scene, view.reflectors)?;
        let name = if self.tree.is_some() { "fallback/ray" } else { "fallback/environment" };
        let mut bound = view.bind(scene.bind(frame.pass(name).compute(&self.pipeline)));
        if let Some(tree) = &self.tree {
            bound = tree.bind(bound).uniform("bounces", &scene.scene.bounces);
        }
        // Each invocation reads the answer of its own pixel before it writes it.
        record.bind(bound).sample("answer", &record.radiance).indirect(&view.footprint.pixels)
    }
}
