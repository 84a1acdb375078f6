//! The Vulkan layer: a device, its objects, and frames made of named passes.
//!
//! Everything is written out: images stay in the GENERAL layout, one full barrier stands between
//! two passes, and each pass is timed. Objects hold the [`Device`] they came from and free
//! themselves on drop; a frame's submit waits, so nothing is freed while in use.

mod acceleration;
mod buffer;
mod command;
mod device;
mod dispatch;
mod draw;
mod frame;
mod image;
mod instance;
#[cfg(test)]
pub(crate) mod layout;
mod pass;
mod pipeline;
mod profiler;
mod ray_query;
mod shader;

pub use acceleration::{Acceleration, MeshTriangles, Placement};
pub use buffer::{Buffer, Slice};
pub use device::{Device, DeviceInfo};
pub use draw::{Draw, Load};
pub use frame::{Dump, DumpKind, Frame, Recorded};
pub use image::{Format, Image, Shape};
pub use instance::{ValidationLog, list_devices};
pub use pass::Pass;
pub use pipeline::{Attachments, ComputePipeline, Depth, GraphicsPipeline, Stencil};
pub use profiler::PassTime;
pub use shader::{Binding, BindingKind, Defines, Shaders};

/// Filters a pass can bind to a WGSL `sampler` variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sampler {
    Nearest,
    /// Between texels, and between mip levels where there are any.
    Linear,
}
