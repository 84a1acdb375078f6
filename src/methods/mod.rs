//! The methods: each one's answer to "which scene point does this mirror pixel show?"
//!
//! To add one: a module here, its shader folder, one line in [`METHODS`], its tolerance rows in
//! `tests/methods_vs_truth.rs` and its figures.

pub mod case;
pub mod nearest;
pub mod params;

pub use case::{Case, Selected};
pub use params::{Kind, Param, Values};

/// What a method needs to be told about again when it moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Changes {
    /// Poses of diffuse objects.
    pub objects: bool,
    /// Poses of reflectors.
    pub reflectors: bool,
    /// Light and environment.
    pub shading: bool,
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
    /// The first is the default; a method without variants has one, "published".
    pub variants: &'static [&'static str],
    pub params: &'static [Param],
    /// What it cannot do, for `describe`.
    pub limits: &'static str,
    /// Names of the passes it records, for `describe`.
    pub passes: &'static [&'static str],
    /// Device-independent work it counts with `--record full`, in buffer order.
    pub counters: &'static [&'static str],
}

/// The methods a user can name.
pub static METHODS: &[MethodInfo] = &[];
