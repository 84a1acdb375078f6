//! What every method shares on the GPU: the scene, the direct view, the reflectors' footprint and
//! their points and normals, the captured map, the tree for rays, the environment behind what is
//! mirrored, the record, the fallback and the composite. Each is written here once, so two methods
//! differ only in what they find.

mod capture;
mod composite;
mod direct_view;
mod fallback;
mod footprint;
mod gbuffer;
mod mirrored_environment;
mod record;
mod scene;
mod scene_structure;
mod scene_tree;
mod view;

pub use capture::{Capture, CaptureStage};
pub use composite::Composite;
pub use direct_view::DirectView;
pub use fallback::{FallbackStage, Filling};
pub use footprint::Footprint;
pub use gbuffer::GBuffer;
pub use mirrored_environment::MirroredEnvironment;
pub use record::{RecordMode, ReflectionRecord};
pub use scene::{GpuScene, Vertex};
pub use scene_structure::SceneStructure;
pub use scene_tree::{SceneTree, TreeKind, TreeLayout, TreeUpdate};
pub use view::{CameraUniform, View};
