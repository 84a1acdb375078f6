//! What can be chosen, and what had to be: the paper states few of its parameters.

use crate::methods::{Kind, Param};

pub const PARAMS: &[Param] = &[
    Param {
        name: "texture",
        kind: Kind::IntegerOrAuto { min: 16, max: 8192 },
        defaults: &["auto"],
        needs: None,
        doc: "texels across the reflector's textures (unstated); auto: the view's width",
    },
    Param {
        name: "widening",
        kind: Kind::Real { min: 1.0, max: 4.0 },
        defaults: &["1.2"],
        needs: None,
        doc: "how much more than the view the textures show, across and down (5.2; unstated)",
    },
    Param {
        name: "precision",
        kind: Kind::Choice(&["fp32", "fp16"]),
        defaults: &["fp32"],
        needs: None,
        doc: "of the textures (\"floating-point\")",
    },
    Param {
        name: "pattern",
        kind: Kind::Choice(&["crosshair", "crosshair-diagonals", "eight"]),
        defaults: &["crosshair"],
        needs: None,
        doc: "neighbours looked at: four; the diagonals where none of the four is better; all at once",
    },
    Param {
        name: "start",
        kind: Kind::Choice(&["previous", "centre"]),
        defaults: &["previous"],
        needs: None,
        doc: "start from the texel found in the frame before (5.3), or always from the centre",
    },
    Param {
        name: "cap",
        kind: Kind::Integer { min: 1, max: 65535 },
        defaults: &["65535"],
        needs: None,
        doc: "most neighbourhoods looked at in one walk; the paper has no limit, as the largest",
    },
    Param {
        name: "threshold",
        kind: Kind::Real { min: 0.0, max: 1.0 },
        defaults: &["1"],
        needs: None,
        doc: "N.B from which on a texel is good enough; 1: only the best will do, as published",
    },
    Param {
        name: "hidden",
        kind: Kind::Choice(&["half-space", "inverse"]),
        defaults: &["half-space"],
        needs: None,
        doc: "vertices behind the plane found: use that plane, or search again with roles swapped (5.1)",
    },
    Param {
        name: "equation",
        kind: Kind::Choice(&["mirror", "printed"]),
        defaults: &["mirror"],
        needs: None,
        doc: "equation 1, for hidden vertices: as meant, or with the sign slip it is printed with",
    },
    Param {
        name: "cull",
        kind: Kind::Choice(&["back", "none"]),
        defaults: &["back"],
        needs: None,
        doc: "draw only the sides of virtual triangles that a mirror shows, or both (unstated)",
    },
    Param {
        name: "unseen",
        kind: Kind::Choice(&["drop", "draw"]),
        defaults: &["drop"],
        needs: None,
        doc: "triangles of which all three vertices are hidden: left out, or drawn (unstated)",
    },
    Param {
        name: "subdivide",
        kind: Kind::Real { min: 0.0, max: 1000.0 },
        defaults: &["0.25"],
        needs: None,
        doc: "longest edge of diffuse meshes, metres (section 6; unstated); 0: as modelled",
    },
];
