//! The parameters of environment mapping.

use super::super::params::STAGE;
use super::super::{Kind, Param};

pub const PARAMS: &[Param] = &[
    Param {
        name: "size",
        kind: Kind::Integer { min: 4, max: 4096 },
        defaults: &["512"],
        needs: None,
        doc: "texels along a cube face's side; a sphere map has twice as many a side, a lat-long map \
              four times and twice: as fine where each is finest",
    },
    Param {
        name: "projection",
        kind: Kind::Choice(&["cube", "sphere", "latlong"]),
        defaults: &["cube"],
        needs: None,
        doc: "the map: six faces (Greene 1986), a mirrored ball's picture (lecture 18), or polar \
              (Blinn & Newell 1976); the latter two are resampled from the first",
    },
    Param {
        name: "source",
        kind: Kind::Choice(&["capture", "ball"]),
        defaults: &["capture"],
        needs: Some(("projection", &["sphere"])),
        doc: "what a sphere map holds: the scene from one point, or the picture of a mirrored ball there, \
              seen along -z in parallel",
    },
    Param {
        name: "ball_radius",
        kind: Kind::Real { min: 1e-4, max: 1e3 },
        defaults: &["0.2"],
        needs: Some(("source", &["ball"])),
        doc: "of that ball, metres",
    },
    Param {
        name: "filter",
        kind: Kind::Choice(&["nearest", "bilinear", "mip"]),
        defaults: &["bilinear"],
        needs: None,
        doc: "between texels: none, linear, or linear in the mip level whose texels are as far apart as \
              the rays of neighbouring pixels",
    },
    Param {
        name: "index",
        kind: Kind::Choice(&["direction", "surface"]),
        defaults: &["direction"],
        needs: None,
        doc: "look up by the mirrored direction B, or by the reflector point W (Patow fig. 2)",
    },
    Param {
        name: "proxy",
        kind: Kind::Choice(&["none", "sphere", "box"]),
        defaults: &["none"],
        needs: Some(("index", &["direction"])),
        doc: "shape that stands for the scene: looked up is where the ray leaves it; the box is that of \
              all objects but the reflectors",
    },
    Param {
        name: "proxy_radius",
        kind: Kind::Real { min: 0.0, max: 1e6 },
        defaults: &["0"],
        needs: Some(("proxy", &["sphere"])),
        doc: "of the sphere about the map's centre, metres; 0 takes the mean distance to the box's sides",
    },
    Param {
        name: "shade_at",
        kind: Kind::Choice(&["pixel", "vertex-ray", "vertex"]),
        defaults: &["pixel"],
        needs: None,
        doc: "where rays leave: each pixel, the corners of its triangle (rays blended; lecture 18, \
              solution 2), or the corners with colours blended (solution 1)",
    },
    STAGE,
];
