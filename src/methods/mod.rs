//! The methods: each one's answer to "which scene point does this mirror pixel show?"
//!
//! To add one: a module here, its shader folder, one line in [`METHODS`], its tolerance rows in
//! `tests/methods_vs_truth.rs` and its figures.

mod billboard_impostors;
pub mod case;
pub mod depth_impostors;
mod distance_impostor;
mod environment_map;
mod explosion_map;
pub mod nearest;
mod none;
pub mod params;
mod planar_mirror;
mod ray_traced;
mod reflected;
pub mod reflection_morphing;
mod screen_space;
mod source;
mod truth;
mod virtual_objects;
mod z_buffered_map;

use std::sync::Arc;

use glam::Vec3;

pub use case::{Case, Selected};
pub use params::{Kind, Param, Values};

use crate::error::Result;
use crate::gpu::{Defines, Device, Frame};
use crate::scene::ObjectId;
use crate::stages::{GpuScene, PixelPass, PixelStage, RecordMode, ReflectionRecord, View};

/// One paper's answer to "which scene point does this mirror pixel show?"
pub trait ReflectionMethod {
    /// Build what does not depend on the current eye: maps, octrees, impostors. Called before the
    /// first frame, and again before a frame in which something in `MethodInfo::depends` moved.
    fn prepare(&mut self, frame: &mut Frame, scene: &GpuScene, want: &Want) -> Result<()>;

    /// Fill the record for one view, only where its reflectors are.
    fn reflect(
        &mut self,
        frame: &mut Frame,
        scene: &GpuScene,
        view: &View,
        record: &mut ReflectionRecord,
    ) -> Result<()>;
}

/// What is asked of `prepare`.
pub struct Want<'a> {
    /// What moved since the last call; everything at the first.
    pub changed: Changes,
    /// Opposite corners of the box of all eyes to come, world.
    pub eyes: [Vec3; 2],
    /// The reflectors the method will be asked for.
    pub reflectors: &'a [ObjectId],
}

/// What a method needs to be told about again when it moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Changes {
    /// Poses and shapes of diffuse objects.
    pub objects: bool,
    /// Poses and shapes of reflectors.
    pub reflectors: bool,
    /// Light and environment.
    pub shading: bool,
}

impl Changes {
    pub const ALL: Changes = Changes { objects: true, reflectors: true, shading: true };

    /// Whether any kind of change is in both.
    pub fn touches(self, other: Changes) -> bool {
        self.objects && other.objects
            || self.reflectors && other.reflectors
            || self.shading && other.shading
    }
}

/// Where a method looks for its answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// Nothing is reflected, or the truth itself.
    Baseline,
    /// Per pixel, from captured images.
    ImageSpace,
    /// The scene's vertices are moved and drawn.
    FeedForward,
    /// Rays against the scene.
    RayTracing,
}

/// What a method is made with.
pub struct Setup<'a> {
    pub device: &'a Arc<Device>,
    pub scene: &'a GpuScene,
    pub variant: &'a str,
    pub values: &'a Values,
    pub mode: RecordMode,
    /// Width and height of the views to come, pixels.
    pub size: [u32; 2],
    /// The reflectors it will be asked for.
    pub reflectors: &'a [ObjectId],
}

impl Setup<'_> {
    /// A shader over the reflectors' pixels, in the form that the parameter [`params::STAGE`] asks for.
    ///
    /// # Errors
    /// [`crate::error::Error::Shader`] where it does not compile.
    pub fn pixel_pass(&self, file: &str, defines: Defines) -> Result<PixelPass> {
        let fragment = self.values.is(params::STAGE.name, "fragment");
        let stage = if fragment { PixelStage::Fragment } else { PixelStage::Compute };
        PixelPass::new(self.device, file, defines, self.mode, stage)
    }
}

/// Makes a method for a case.
pub type Make = fn(&Setup) -> Result<Box<dyn ReflectionMethod>>;

/// A method's card: what `list`, `describe`, the case parser and the harness know of it.
pub struct MethodInfo {
    pub id: &'static str,
    pub title: &'static str,
    /// Authors, year, section.
    pub paper: &'static str,
    pub family: Family,
    /// What a prepared structure depends on.
    pub depends: Changes,
    /// Whether the method ever sets the flag.
    pub flags: bool,
    /// Whether it fills the record of what glass lets through; otherwise that stays missing.
    pub refracts: bool,
    /// The first is the default; a method without variants has one, "published".
    pub variants: &'static [&'static str],
    pub params: &'static [Param],
    /// What it cannot do, for `describe`.
    pub limits: &'static str,
    /// Names of the passes it records, for `describe`.
    pub passes: &'static [&'static str],
    /// Device-independent work it counts with `--record full`, in buffer order.
    pub counters: &'static [&'static str],
    /// How it is made; `None` for the truth, which runs on the CPU.
    pub new: Option<Make>,
}

/// The methods a user can name.
pub static METHODS: &[MethodInfo] = &[
    truth::INFO,
    none::INFO,
    ray_traced::INFO,
    environment_map::INFO,
    planar_mirror::INFO,
    z_buffered_map::INFO,
    distance_impostor::INFO,
    screen_space::INFO,
    virtual_objects::INFO,
    explosion_map::INFO,
    reflection_morphing::INFO,
    billboard_impostors::INFO,
    depth_impostors::INFO,
];
