//! A case's parameters, read once.

use super::cube::CubeRule;
use crate::gpu::Format;
use crate::methods::Values;
use crate::stages::RecordMode;

/// What searches and draws do, and how far.
#[derive(Clone)]
pub struct Rule {
    defines: Vec<(&'static str, u32)>,
    /// Textures show the reflector, not the view.
    pub fitted: bool,
    /// Texels across the textures, where forced.
    texture: Option<u32>,
    pub widening: f32,
    /// How far an open reflector is carried on, as a share of the textures; 0: its closed partner is
    /// searched.
    pub skirt: f32,
    pub format: Format,
    /// Searches look at cube maps, not at what the eye sees.
    pub cube: Option<CubeRule>,
    /// Every frame starts anew.
    pub forgets: bool,
    /// Searches go from coarse to fine, or hidden parts are cut: a pyramid is needed.
    pub pyramid: bool,
    pub starts_at_pyramid: bool,
    /// All reflection points of a vertex are sought, not one.
    pub all: bool,
    pub cap: u32,
    pub threshold: f32,
    /// Hidden parts are cut off.
    pub clips: bool,
    pub split_px: f32,
    pub generations: u32,
    pub residual_px: f32,
    /// What mirrors show of mirrors is reflected too.
    pub twice: bool,
    /// Longest edge of diffuse meshes, metres; 0 as modelled.
    pub edge: f32,
}

/// Shader definitions that values stand for.
const DEFINES: &[(&str, &str, &str)] = &[
    ("reflector_map", "cube", "REFLECTOR_CUBE"),
    ("search", "newton", "CUBE_NEWTON"),
    ("objective", "cross", "OBJECTIVE_CROSS"),
    ("pattern", "crosshair-diagonals", "PATTERN_DIAGONALS"),
    ("pattern", "eight", "PATTERN_EIGHT"),
    ("point", "newton", "POINT_NEWTON"),
    ("image", "push", "IMAGE_PUSH"),
    ("roots", "all", "ROOTS_ALL"),
    ("hidden", "inverse", "HIDDEN_INVERSE"),
    ("hidden", "clip", "HIDDEN_CLIP"),
    ("equation", "printed", "EQUATION_PRINTED"),
    ("cull", "none", "TWO_SIDED"),
    ("unseen", "draw", "DRAW_HIDDEN"),
];

impl Rule {
    pub fn new(values: &Values) -> Rule {
        let chosen = DEFINES.iter().filter(|(name, value, _)| values.is(name, value));
        let mut defines: Vec<_> = chosen.map(|&(_, _, define)| (define, 1)).collect();
        let clips = values.is("hidden", "clip");
        let cube = CubeRule::new(values);
        let all = values.is("roots", "all");
        let starts_at_pyramid = cube.is_none() && values.is("start", "pyramid");
        let pyramid = cube.is_none() && !all && (clips || starts_at_pyramid);
        let more = [("PYRAMID", pyramid), ("START_PYRAMID", starts_at_pyramid)];
        defines
            .extend(more.into_iter().filter(|&(_, wanted)| wanted).map(|(define, _)| (define, 1)));
        let fp16 = values.is("precision", "fp16");
        Rule {
            defines,
            fitted: values.is("frustum", "fitted"),
            texture: values.forced_u32("texture"),
            widening: values.f32("widening"),
            skirt: values.f32("skirt"),
            format: if fp16 { Format::Rgba16Float } else { Format::Rgba32Float },
            cube,
            forgets: !values.is("start", "previous"),
            pyramid,
            starts_at_pyramid,
            all,
            cap: values.u32("cap"),
            threshold: values.f32("threshold"),
            clips,
            split_px: values.f32("split_px"),
            generations: values.u32("generations"),
            residual_px: values.f32("residual_px"),
            twice: clips && values.u32("bounces") == 2,
            edge: values.f32("subdivide"),
        }
    }

    /// That of a reflector seen in another one.
    pub fn second(&self) -> Rule {
        self.anew("SECOND")
    }

    /// That of what is seen through a surface.
    pub fn refracted(&self) -> Rule {
        self.anew("REFRACTED")
    }

    /// With one more definition, one point a vertex searched in textures, and nothing remembered of the frame before.
    fn anew(&self, define: &'static str) -> Rule {
        let mut rule = self.clone();
        let replaced = ["START_PYRAMID", "PYRAMID", "REFLECTOR_CUBE", "CUBE_NEWTON", "ROOTS_ALL"];
        rule.defines.retain(|(define, _)| !replaced.contains(define));
        rule.defines.extend([("START_PYRAMID", 1), ("PYRAMID", 1), (define, 1)]);
        rule.forgets = true;
        rule.starts_at_pyramid = true;
        rule.pyramid = true;
        rule.all = false;
        rule.cube = None;
        rule
    }

    /// For the method's shaders.
    pub fn defines(&self, mode: RecordMode) -> Vec<(&'static str, u32)> {
        let mut defines = mode.defines();
        defines.extend(&self.defines);
        defines
    }

    /// Width and height of the textures for a view of that size. Fitted ones are square, with as many
    /// texels across as the view's larger side has pixels unless forced: with half as many, noise at the
    /// rim halves three times as many triangles. The others have the view's shape.
    pub fn texture_size(&self, [width, height]: [u32; 2]) -> [u32; 2] {
        if self.fitted {
            return [self.texture.unwrap_or(width.max(height).max(16)); 2];
        }
        let Some(forced) = self.texture else { return [width, height] };
        let shape = f64::from(height) / f64::from(width);
        [forced, ((f64::from(forced) * shape).round() as u32).max(1)]
    }
}
