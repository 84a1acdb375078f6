//! What every method shares on the GPU: the scene, the direct view, the reflectors' footprint and
//! their points and normals, the captured map with one layer or several, the portraits of single
//! objects, the tree for rays, the environment behind what is mirrored, the record, the fallback and
//! the composite. Each is written here once, so two methods differ only in what they find.

mod capture;
mod composite;
mod depth_pyramid;
mod direct_view;
mod fallback;
mod footprint;
mod gbuffer;
mod interval_map;
mod layered_capture;
mod mirrored_environment;
mod pixel_pass;
mod portrait;
mod record;
mod scene;
mod scene_structure;
mod scene_tree;
mod shrink;
mod view;

pub use capture::{Capture, CaptureStage, CubeUniform};
pub use composite::Composite;
pub use depth_pyramid::DepthPyramid;
pub use direct_view::DirectView;
pub use fallback::{FallbackStage, Filling};
pub use footprint::Footprint;
pub use gbuffer::GBuffer;
pub use interval_map::{Certificate, IntervalMap, IntervalStage, MOST_INTERVALS};
pub use layered_capture::{LayeredCapture, LayeredCaptureStage, Sides};
pub use mirrored_environment::MirroredEnvironment;
pub use pixel_pass::{PixelPass, PixelStage};
pub use portrait::{
    PortraitStage, PortraitUniform, PortraitView, Portraits, Sight, own_from_world, own_points,
};
pub use record::{RecordMode, ReflectionRecord};
pub use scene::{GpuScene, Vertex};
pub use scene_structure::SceneStructure;
pub use scene_tree::{SceneTree, TreeKind, TreeLayout, TreeUpdate};
pub use shrink::shrink;
pub use view::{CameraUniform, View};
