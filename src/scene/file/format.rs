//! The keys of a scene file, as `scenes/README.md` documents them. Ranges are in the types.

use std::collections::BTreeMap;

use serde::Deserialize;
use toml::Spanned;

use super::values::{
    Cap, Colour, Crease, Finite, Index, NotNegative, Opening, Positive, Share, Triple, Turn, Whole,
};

/// A range of bytes in the scene file, for error messages.
pub type Span = std::ops::Range<usize>;

/// Steps about an axis.
pub type Slices = Whole<3, 4096>;
/// Steps along a profile.
pub type Stacks = Whole<2, 4096>;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneFile {
    pub about: String,
    #[serde(default = "one_frame")]
    pub frames: Whole<1, 1_000_000>,
    #[serde(default = "film_rate")]
    pub rate_hz: Positive,
    #[serde(default = "four_bounces")]
    pub bounces: Whole<1, 16>,
    #[serde(default)]
    pub lighting: Option<Spanned<LightingFile>>,
    pub environment: Spanned<EnvironmentFile>,
    pub camera: Spanned<CameraFile>,
    #[serde(default)]
    pub materials: BTreeMap<String, Spanned<MaterialFile>>,
    #[serde(default)]
    pub objects: Vec<Spanned<ObjectFile>>,
}

fn one_frame() -> Whole<1, 1_000_000> {
    Whole(1)
}

fn film_rate() -> Positive {
    Positive(24.0)
}

fn four_bounces() -> Whole<1, 16> {
    Whole(4)
}

/// The one line of a scene file that `list scenes` shows; the rest is left to the loader.
#[derive(Deserialize)]
pub struct AboutFile {
    pub about: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LightingFile {
    pub ambient: Colour,
    pub sun: Colour,
    pub towards_sun: Triple,
    #[serde(default)]
    pub shadows: bool,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "snake_case")]
pub enum EnvironmentFile {
    Colour(Colour),
    Gradient(GradientFile),
    LatLong(LatLongFile),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GradientFile {
    pub zenith: Colour,
    pub horizon: Colour,
    pub nadir: Colour,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LatLongFile {
    pub file: Spanned<String>,
    pub cap: Cap,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CameraFile {
    pub fov_deg: Option<Opening>,
    pub height: Option<Positive>,
    pub near: Option<Positive>,
    pub far: Option<Positive>,
    pub eye: Option<Triple>,
    pub target: Option<Triple>,
    pub keys: Option<Vec<Spanned<CameraKeyFile>>>,
    pub orbit: Option<CameraOrbitFile>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CameraKeyFile {
    pub time_s: NotNegative,
    pub eye: Triple,
    pub target: Triple,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CameraOrbitFile {
    pub period_s: Positive,
    #[serde(default = "zero")]
    pub start_deg: Finite,
    pub sweep_deg: Option<Turn>,
}

fn zero() -> Finite {
    Finite(0.0)
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MaterialFile {
    pub colour: Option<Colour>,
    pub checker: Option<CheckerFile>,
    pub grid: Option<GridFile>,
    pub image: Option<ImageFile>,
    pub mirror: Option<MirrorFile>,
    pub glass: Option<GlassFile>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CheckerFile {
    pub even: Colour,
    pub odd: Colour,
    pub size: [Positive; 2],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GridFile {
    pub ground: Colour,
    pub lines: Colour,
    pub size: [Positive; 2],
    pub line: Positive,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ImageFile {
    pub file: Spanned<String>,
    pub size: [Positive; 2],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MirrorFile {
    pub reflectance: Share,
    #[serde(default = "white")]
    pub tint: Colour,
    #[serde(default)]
    pub fresnel: bool,
    pub fade: Option<FadeFile>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FadeFile {
    pub distance: Positive,
    #[serde(default = "none_left")]
    pub floor: Share,
}

fn none_left() -> Share {
    Share(0.0)
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GlassFile {
    pub index: Index,
    #[serde(default = "white")]
    pub tint: Colour,
}

fn white() -> Colour {
    [NotNegative(1.0); 3]
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ObjectFile {
    pub name: Spanned<String>,
    pub shape: Spanned<ShapeFile>,
    pub closed: Option<Spanned<ShapeFile>>,
    pub material: Option<Spanned<String>>,
    pub position: Option<Triple>,
    pub rotation_deg: Option<Triple>,
    pub scale: Option<Positive>,
    pub wobble: Option<Spanned<WobbleFile>>,
    pub orbit: Option<OrbitFile>,
    pub keys: Option<Vec<Spanned<KeyFile>>>,
    pub scatter: Option<Spanned<ScatterFile>>,
    pub impostor: Option<Spanned<ImpostorFile>>,
}

/// What stands for an object in methods that use impostors.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "snake_case")]
pub enum ImpostorFile {
    Facing(Triple),
    Backdrop,
}

/// A wave that travels over an object's surface.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WobbleFile {
    pub amplitude: Positive,
    pub wavelength: Positive,
    pub period_s: Positive,
    #[serde(default = "upwards")]
    pub towards: Triple,
}

fn upwards() -> Triple {
    [Finite(0.0), Finite(1.0), Finite(0.0)]
}

/// Copies of an object in random places.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ScatterFile {
    pub count: Whole<1, 10_000>,
    pub seed: Whole<0, { u32::MAX }>,
    pub low: Triple,
    pub high: Triple,
    #[serde(default = "own_size")]
    pub scale: [Positive; 2],
    #[serde(default)]
    pub turn: bool,
    #[serde(default)]
    pub clear: Vec<ClearFile>,
}

fn own_size() -> [Positive; 2] {
    [Positive(1.0); 2]
}

/// A ball that copies stay out of.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ClearFile {
    pub centre: Triple,
    pub radius: Positive,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OrbitFile {
    pub centre: Triple,
    pub period_s: Positive,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KeyFile {
    pub time_s: NotNegative,
    pub position: Triple,
    pub rotation_deg: Option<Triple>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "snake_case")]
pub enum ShapeFile {
    Sphere(SphereFile),
    Ellipsoid(EllipsoidFile),
    Box(BoxFile),
    Plane(PlaneFile),
    Cylinder(CylinderFile),
    Torus(TorusFile),
    Revolution(RevolutionFile),
    Obj(ObjFile),
    Patches(PatchesFile),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SphereFile {
    pub radius: Positive,
    pub edge: Option<Positive>,
    pub slices: Option<Slices>,
    pub stacks: Option<Stacks>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EllipsoidFile {
    pub radii: [Positive; 3],
    pub edge: Option<Positive>,
    pub slices: Option<Slices>,
    pub stacks: Option<Stacks>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BoxFile {
    pub size: [Positive; 3],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlaneFile {
    pub size: [Positive; 2],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CylinderFile {
    pub radius: Positive,
    pub height: Positive,
    #[serde(default = "yes")]
    pub capped: bool,
    pub edge: Option<Positive>,
    pub slices: Option<Slices>,
}

fn yes() -> bool {
    true
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TorusFile {
    pub ring: Positive,
    pub tube: Positive,
    #[serde(default = "full_turn")]
    pub sweep_deg: Turn,
    pub edge: Option<Positive>,
    pub slices: Option<Slices>,
    pub stacks: Option<Slices>,
}

fn full_turn() -> Turn {
    Turn(360.0)
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RevolutionFile {
    /// (radius, height) from the bottom to the top where the outside is away from the axis.
    pub profile: Vec<[Finite; 2]>,
    pub curve: CurveKind,
    #[serde(default = "full_turn")]
    pub sweep_deg: Turn,
    pub edge: Option<Positive>,
    pub slices: Option<Slices>,
    pub stacks: Option<Stacks>,
}

#[derive(Clone, Copy, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CurveKind {
    Polyline,
    Bezier,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ObjFile {
    pub file: Spanned<String>,
    #[serde(default = "forty")]
    pub crease_deg: Crease,
    /// Materials of this scene in place of the file's own.
    #[serde(default)]
    pub materials: BTreeMap<String, Spanned<String>>,
}

fn forty() -> Crease {
    Crease(40.0)
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PatchesFile {
    pub file: Spanned<String>,
    #[serde(default = "eight")]
    pub steps: Whole<1, 256>,
}

fn eight() -> Whole<1, 256> {
    Whole(8)
}
