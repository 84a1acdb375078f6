//! The tree over all triangles of the scene on the GPU, for whoever traces rays: built on the
//! processor by obvhs, fitted on the GPU to what moves.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use super::GpuScene;
use crate::error::{Error, Result};
use crate::geometry::tree::{Node, Tree};
use crate::geometry::wide_tree::{WideNode, WideTree};
use crate::gpu::{Buffer, ComputePipeline, Device, Frame, Pass};
use crate::scene::{Moment, ObjectId, Scene};

/// Buffers an array is cut into where one would be beyond the device's limit.
const PARTS: usize = 4;

/// `DEEPEST` of `shaders/bindings/tree.wgsl`.
const DEEPEST: u32 = 64;

/// `WIDE_DEEPEST` of `shaders/bindings/wide_tree.wgsl`.
const WIDE_DEEPEST: u32 = 32;

/// Three corners, each with a word: object, triangle, none.
type Slot = [[f32; 4]; 3];

/// WGSL `Run` of `shaders/scene_tree/`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub struct Run {
    first: u32,
    count: u32,
    pad_a: u32,
    pad_b: u32,
}

/// Which tree, and so what is done when objects move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TreeKind {
    /// Two children a node.
    Binary(TreeUpdate),
    /// Eight a node, compressed; built anew.
    Wide,
}

/// When objects move: fit the boxes again, or build anew.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TreeUpdate {
    Refit,
    Rebuild,
}

/// How the tree of a scene lies in buffers: known before it is built, as shaders depend on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TreeLayout {
    kind: TreeKind,
    /// Nodes and triangles a buffer holds; `None` where one holds all.
    parts: Option<[u32; 2]>,
}

impl TreeLayout {
    /// For a scene on a device whose bindings hold so many bytes ([`Device::storage_limit`]).
    ///
    /// # Errors
    /// [`Error::Device`] with the numbers where four buffers do not hold it.
    pub fn new(scene: &Scene, kind: TreeKind, limit: u64) -> Result<Self> {
        let triangles = scene.triangles();
        let (most_nodes, node) = match kind {
            TreeKind::Binary(_) => (Tree::most_nodes(triangles), size_of::<Node>() as u64),
            TreeKind::Wide => (WideTree::most_nodes(triangles), size_of::<WideNode>() as u64),
        };
        let slot = size_of::<Slot>() as u64;
        let most = [most_nodes as u64 * node, triangles as u64 * slot];
        let largest = most[0].max(most[1]);
        if largest > PARTS as u64 * limit {
            return Err(Error::Device(format!(
                "the tree of scene {} needs {largest} bytes in one array, the device takes \
                 {PARTS} buffers of {limit}",
                scene.name
            )));
        }
        let parts = (largest > limit).then(|| [limit / node, limit / slot].map(|n| n as u32));
        Ok(TreeLayout { kind, parts })
    }

    /// Shader definitions of everything that imports `bindings::tree` or `bindings::wide_tree`.
    pub fn defines(&self) -> Vec<(&'static str, u32)> {
        let mut defines = Vec::new();
        if self.kind == TreeKind::Wide {
            defines.push(("TREE_WIDE", 1));
        }
        if let Some([nodes, slots]) = self.parts {
            defines.extend([("TREE_PARTS", 1), ("NODES_OF_PART", nodes), ("SLOTS_OF_PART", slots)]);
        }
        defines
    }

    fn part_lengths(&self) -> [usize; 2] {
        self.parts.map_or([usize::MAX; 2], |parts| parts.map(|n| n as usize))
    }
}

/// The tree and what keeps it true.
pub struct SceneTree {
    device: Arc<Device>,
    layout: TreeLayout,
    /// Whether an object's triangles are in it.
    holds: fn(&Scene, ObjectId) -> bool,
    /// Only for a tree that is fitted.
    fitting: Option<Fitting>,
    built: Option<Built>,
}

/// What fits a tree.
struct Fitting {
    place: ComputePipeline,
    refit: ComputePipeline,
}

/// One build.
struct Built {
    nodes: Vec<Buffer>,
    corners: Vec<Buffer>,
    /// What moves: triangles first, then nodes, depth by depth from the deepest; and where each
    /// run of the list ends. `None` in a still scene.
    moving: Option<(Buffer, Vec<Run>)>,
}

impl SceneTree {
    pub fn new(device: &Arc<Device>, layout: TreeLayout) -> Result<Self> {
        let defines = layout.defines();
        let fitting = match layout.kind {
            TreeKind::Binary(TreeUpdate::Refit) => Some(Fitting {
                place: ComputePipeline::new(device, "scene_tree/place.wgsl", &defines)?,
                refit: ComputePipeline::new(device, "scene_tree/refit.wgsl", &defines)?,
            }),
            TreeKind::Binary(TreeUpdate::Rebuild) | TreeKind::Wide => None,
        };
        Ok(SceneTree { device: device.clone(), layout, holds: |_, _| true, fitting, built: None })
    }

    /// One that holds the scene's reflectors and nothing else.
    pub fn of_reflectors(device: &Arc<Device>, layout: TreeLayout) -> Result<Self> {
        Ok(SceneTree { holds: Scene::is_reflector, ..SceneTree::new(device, layout)? })
    }

    /// Make it that of the frame's moment. Passes and scopes are named under `owner`.
    ///
    /// # Errors
    /// [`Error::Device`] where the tree does not fit the device or is too deep for the shader.
    pub fn prepare(&mut self, frame: &mut Frame, scene: &GpuScene, owner: &str) -> Result<()> {
        match (&self.built, &self.fitting) {
            (Some(built), Some(fitting)) => self.fit(frame, scene, owner, built, fitting),
            _ => {
                let built = frame.cpu(&format!("{owner}/build"), || self.build(scene))?;
                self.built = Some(built);
                Ok(())
            }
        }
    }

    /// Bind it to a pass whose shader imports `bindings::tree` or `bindings::wide_tree`.
    pub fn bind<'f>(&self, mut pass: Pass<'f>) -> Pass<'f> {
        const NODES: [&str; PARTS] = ["nodes_a", "nodes_b", "nodes_c", "nodes_d"];
        const CORNERS: [&str; PARTS] = ["corners_a", "corners_b", "corners_c", "corners_d"];
        let Some(built) = &self.built else { return pass };
        for (names, buffers) in [(NODES, &built.nodes), (CORNERS, &built.corners)] {
            for (name, buffer) in names.into_iter().zip(buffers) {
                pass = pass.buffer(name, buffer).optional();
            }
        }
        pass
    }

    fn build(&self, scene: &GpuScene) -> Result<Built> {
        let (triangles, owners) = world_triangles(&scene.scene, scene.moment(), self.holds);
        let [most_nodes, most_slots] = self.layout.part_lengths();
        let (nodes, order, moving) = match self.layout.kind {
            TreeKind::Binary(update) => {
                let tree = Tree::new(&triangles);
                check_depth(&scene.scene, tree.depth, DEEPEST)?;
                let moving = match update {
                    TreeUpdate::Refit => self.moving(&scene.scene, &tree, &owners)?,
                    TreeUpdate::Rebuild => None,
                };
                (parts(&self.device, "tree nodes", &tree.nodes, most_nodes)?, tree.order, moving)
            }
            TreeKind::Wide => {
                let tree = WideTree::new(&triangles);
                check_depth(&scene.scene, tree.depth, WIDE_DEEPEST)?;
                (parts(&self.device, "tree nodes", &tree.nodes, most_nodes)?, tree.order, None)
            }
        };
        let slot = |&index: &u32| -> Slot {
            let (object, triangle) = owners[index as usize];
            let words = [object, triangle, 0].map(f32::from_bits);
            let corners = triangles[index as usize];
            std::array::from_fn(|i| corners[i].extend(words[i]).to_array())
        };
        let slots: Vec<Slot> = order.iter().map(slot).collect();
        let corners = parts(&self.device, "tree corners", &slots, most_slots)?;
        Ok(Built { nodes, corners, moving })
    }

    /// The list of what moves in a scene.
    fn moving(
        &self,
        scene: &Scene,
        tree: &Tree,
        owners: &[(ObjectId, u32)],
    ) -> Result<Option<(Buffer, Vec<Run>)>> {
        let moves = |triangle: u32| {
            let (object, _) = owners[triangle as usize];
            scene.is_moving(object)
        };
        let slots = tree.order.iter().zip(0..).filter(|(triangle, _)| moves(**triangle));
        let mut list: Vec<u32> = slots.map(|(_, slot)| slot).collect();
        if list.is_empty() {
            return Ok(None);
        }
        let run = |first: usize, count: usize| Run {
            first: first as u32,
            count: count as u32,
            pad_a: 0,
            pad_b: 0,
        };
        let mut runs = vec![run(0, list.len())];
        for level in tree.touched(moves) {
            runs.push(run(list.len(), level.len()));
            list.extend(level);
        }
        Ok(Some((Buffer::with_data(&self.device, "tree moving", &list)?, runs)))
    }

    fn fit(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        owner: &str,
        built: &Built,
        fitting: &Fitting,
    ) -> Result<()> {
        let Some((list, runs)) = &built.moving else { return Ok(()) };
        for (index, run) in runs.iter().enumerate() {
            let (step, pipeline) =
                if index == 0 { ("place", &fitting.place) } else { ("refit", &fitting.refit) };
            let pass = frame.pass(&format!("{owner}/{step}")).compute(pipeline);
            let pass = self.bind(scene.bind(pass));
            pass.uniform("run", run).buffer("list", list).over(run.count)?;
        }
        Ok(())
    }
}

fn check_depth(scene: &Scene, depth: u32, deepest: u32) -> Result<()> {
    if depth <= deepest {
        return Ok(());
    }
    Err(Error::Device(format!(
        "the tree of scene {} is {depth} nodes deep, the shader follows {deepest}",
        scene.name
    )))
}

/// The triangles of a moment in the world of those objects that are chosen, and the object and number of each.
fn world_triangles(
    scene: &Scene,
    moment: &Moment,
    chosen: fn(&Scene, ObjectId) -> bool,
) -> (Vec<[Vec3; 3]>, Vec<(ObjectId, u32)>) {
    let (mut triangles, mut owners) = (Vec::new(), Vec::new());
    for object in (0..scene.objects.len() as ObjectId).filter(|&object| chosen(scene, object)) {
        for (corners, number) in scene.world_triangles(moment, object).zip(0..) {
            triangles.push(corners);
            owners.push((object, number));
        }
    }
    (triangles, owners)
}

/// An array in buffers of at most so many elements; none is empty.
fn parts<T: Pod>(device: &Arc<Device>, name: &str, data: &[T], most: usize) -> Result<Vec<Buffer>> {
    let whole = most == usize::MAX;
    let count = if whole { 1 } else { PARTS };
    let zero = [T::zeroed()];
    let part = |index: usize| {
        let slice = if whole { data } else { data.chunks(most).nth(index).unwrap_or(&[]) };
        Buffer::with_data(device, name, if slice.is_empty() { &zero } else { slice })
    };
    (0..count).map(part).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::assert_layout;
    use crate::scene;

    #[test]
    #[rustfmt::skip]
    fn structs_are_laid_out_as_their_wgsl_twins() {
        assert_layout!("scene_tree/place.wgsl", "Run", Run, first, count, pad_a, pad_b);
        assert_layout!("scene_tree/refit.wgsl", "Run", Run, first, count, pad_a, pad_b);
        assert_layout!("scene_tree/refit.wgsl", "Node", Node, low, count, high, first);
        assert_layout!(
            "tests/wide_node.wgsl", "Node", WideNode,
            low, steps, first_node, first_triangle, kinds, x, y, z,
        );
    }

    #[test]
    fn a_tree_beyond_one_buffer_is_cut_and_one_beyond_four_refused() {
        let scene = scene::load("two-spheres").unwrap();
        let triangles = scene.triangles() as u64;
        let binary = TreeKind::Binary(TreeUpdate::Refit);
        let layout = |limit| TreeLayout::new(&scene, binary, limit);
        assert!(layout(1 << 27).unwrap().defines().is_empty());
        let [nodes, slots] = layout(20 * triangles).unwrap().parts.unwrap();
        assert!(4 * u64::from(nodes) >= 2 * triangles && 4 * u64::from(slots) >= triangles);
        let wide = TreeLayout::new(&scene, TreeKind::Wide, 20 * triangles).unwrap();
        assert_eq!(wide.parts.unwrap()[0], (triangles / 4) as u32);
        let message = layout(10 * triangles).unwrap_err().to_string();
        assert!(message.contains("two-spheres") && message.contains("bytes"), "{message}");
    }
}
