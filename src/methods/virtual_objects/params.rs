//! What can be chosen, and what had to be: the paper states few of its parameters.

use crate::methods::params::{IMAGE, RESIDUAL_PX};
use crate::methods::{Kind, Param};

/// Choices of `hidden` that reflect hidden vertices too.
const UNCUT: &[&str] = &["half-space", "inverse"];
const CUT: &[&str] = &["clip"];
const SCREEN: Option<(&str, &[&str])> = Some(("reflector_map", &["screen"]));
const CUBE: Option<(&str, &[&str])> = Some(("reflector_map", &["cube"]));

pub const PARAMS: &[Param] = &[
    Param {
        name: "reflector_map",
        kind: Kind::Choice(&["screen", "cube"]),
        defaults: &["screen"],
        needs: None,
        doc: "where the reflector is searched: in textures of what the eye sees of it, or in two cube maps about \
              its centroid, for reflectors all of which is seen from there (Estalella et al. 2005)",
    },
    Param {
        name: "cube_size",
        kind: Kind::Integer { min: 16, max: 4096 },
        defaults: &["256"],
        needs: CUBE,
        doc: "texels along a side of the reflector's cube maps (unstated)",
    },
    Param {
        name: "search",
        kind: Kind::Choice(&["fixed-point", "newton"]),
        defaults: &["fixed-point", "newton"],
        needs: CUBE,
        doc: "steps along B - N, as we guess the search of 2005 to be; or Gauss-Newton steps on it, in the \
              manner of Roger & Holzschuch 2006 (hidden=inverse searches back along B - N)",
    },
    Param {
        name: "step",
        kind: Kind::Real { min: 0.01, max: 4.0 },
        defaults: &["1"],
        needs: Some(("search", &["fixed-point"])),
        doc: "how much of B - N is added to the direction searched in (unknown to us)",
    },
    Param {
        name: "most_steps",
        kind: Kind::Integer { min: 1, max: 4096 },
        defaults: &["64"],
        needs: CUBE,
        doc: "most steps of a search of the cube maps (unknown to us)",
    },
    Param {
        name: "frustum",
        kind: Kind::Choice(&["widened", "fitted"]),
        defaults: &["widened", "fitted"],
        needs: None,
        doc: "what the reflector's textures show: the view, widened (5.2); or the reflector, all of it",
    },
    Param {
        name: "texture",
        kind: Kind::IntegerOrAuto { min: 16, max: 8192 },
        defaults: &["auto"],
        needs: None,
        doc: "texels across the reflector's textures (unstated); auto: the view's width, its larger \
              side where fitted",
    },
    Param {
        name: "widening",
        kind: Kind::Real { min: 1.0, max: 4.0 },
        defaults: &["1.2"],
        needs: Some(("frustum", &["widened"])),
        doc: "how much more than the view the textures show, across and down (5.2; unstated)",
    },
    Param {
        name: "skirt",
        kind: Kind::Real { min: 0.0, max: 0.25 },
        defaults: &["0"],
        needs: Some(("roots", &["one"])),
        doc: "open reflectors: how far their surface is carried on beyond its edge, for searches that leave it there, \
              as a share of the textures; 0: their closed partners are searched (5.1)",
    },
    Param {
        name: "precision",
        kind: Kind::Choice(&["fp32", "fp16"]),
        defaults: &["fp32"],
        needs: None,
        doc: "of the textures (\"floating-point\")",
    },
    Param {
        name: "objective",
        kind: Kind::Choice(&["dot", "cross"]),
        defaults: &["dot", "cross"],
        needs: SCREEN,
        doc: "what a walk seeks: the highest N.B (section 4), or the least |N x B|, which is not flat there",
    },
    Param {
        name: "pattern",
        kind: Kind::Choice(&["crosshair", "crosshair-diagonals", "eight"]),
        defaults: &["crosshair", "eight"],
        needs: SCREEN,
        doc: "neighbours looked at: four; the diagonals where none of the four is better; all at once",
    },
    Param {
        name: "start",
        kind: Kind::Choice(&["previous", "centre", "pyramid"]),
        defaults: &["previous", "pyramid"],
        needs: SCREEN,
        doc: "start from the texel found in the frame before (5.3), from the centre, or coarse to fine",
    },
    Param {
        name: "roots",
        kind: Kind::Choice(&["one", "all"]),
        defaults: &["one"],
        needs: Some(("hidden", CUT)),
        doc: "reflection points of a vertex: the best, or every one, each in a mesh of its branch",
    },
    Param {
        name: "point",
        kind: Kind::Choice(&["texel", "newton"]),
        defaults: &["texel", "newton"],
        needs: SCREEN,
        doc: "the reflection point: the best texel's, or between texels by Gauss-Newton steps",
    },
    IMAGE,
    Param {
        name: "cap",
        kind: Kind::Integer { min: 1, max: 65535 },
        defaults: &["65535"],
        needs: SCREEN,
        doc: "most neighbourhoods looked at in one walk; the paper has no limit, as the largest",
    },
    Param {
        name: "threshold",
        kind: Kind::Real { min: 0.0, max: 1.0 },
        defaults: &["1"],
        needs: Some(("objective", &["dot"])),
        doc: "N.B from which on a texel is good enough; 1: only the best will do, as published",
    },
    Param {
        name: "hidden",
        kind: Kind::Choice(&["half-space", "inverse", "clip"]),
        defaults: &["half-space", "clip"],
        needs: None,
        doc: "vertices behind the plane found: use that plane, or search again with roles swapped (5.1); or \
              cut off what the reflector's shadow volume holds",
    },
    Param {
        name: "equation",
        kind: Kind::Choice(&["mirror", "printed"]),
        defaults: &["mirror"],
        needs: Some(("hidden", UNCUT)),
        doc: "equation 1, for hidden vertices: as meant, or with the sign slip it is printed with",
    },
    Param {
        name: "cull",
        kind: Kind::Choice(&["back", "none"]),
        defaults: &["back", "none"],
        needs: None,
        doc: "draw only the sides of virtual triangles that a mirror shows, or both (unstated)",
    },
    Param {
        name: "unseen",
        kind: Kind::Choice(&["drop", "draw"]),
        defaults: &["drop"],
        needs: Some(("hidden", UNCUT)),
        doc: "triangles of which all three vertices are hidden: left out, or drawn (unstated)",
    },
    Param {
        name: "subdivide",
        kind: Kind::Real { min: 0.0, max: 1000.0 },
        defaults: &["0.25", "0"],
        needs: None,
        doc: "longest edge of diffuse meshes, metres (section 6; unstated); 0: as modelled",
    },
    Param {
        name: "split_px",
        kind: Kind::Real { min: 0.0, max: 1000.0 },
        defaults: &["0.5"],
        needs: Some(("hidden", CUT)),
        doc: "pixels an edge's middle may be drawn from its true place before it is halved; 0: never halved",
    },
    Param {
        name: "generations",
        kind: Kind::Integer { min: 1, max: 14 },
        defaults: &["10"],
        needs: Some(("hidden", CUT)),
        doc: "most times an edge is halved",
    },
    RESIDUAL_PX,
    Param {
        name: "bounces",
        kind: Kind::Integer { min: 1, max: 2 },
        defaults: &["1"],
        needs: Some(("hidden", CUT)),
        doc: "longest chain of mirrors: 1, or 2, for which every pair of mirrors is searched (section 7, \
              left open)",
    },
];
