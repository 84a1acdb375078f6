//! What can be chosen, and what had to be: course notes on the method are all we have of it.

use crate::methods::params::{IMAGE, RESIDUAL_PX};
use crate::methods::{Kind, Param};

const TWO: Option<(&str, &[&str])> = Some(("spheres", &["2"]));

pub const PARAMS: &[Param] = &[
    Param {
        name: "cell",
        kind: Kind::Choice(&["sphere", "walk"]),
        defaults: &["sphere", "walk"],
        needs: None,
        doc: "the triangle that mirrors a vertex: the map's, as if the vertex were on the sphere; or from there \
              across edges to the one whose rays hold it",
    },
    Param {
        name: "spheres",
        kind: Kind::Choice(&["1", "2"]),
        defaults: &["2", "1"],
        needs: None,
        doc: "one sphere, or a near and a far one, of which a vertex's plane is blended",
    },
    Param {
        name: "radius",
        kind: Kind::Real { min: 1.0, max: 1e4 },
        defaults: &["1.5", "2"],
        needs: None,
        doc: "of the sphere, or of the near one, in radii of the reflector about the middle of its box (unstated)",
    },
    Param {
        name: "far",
        kind: Kind::Real { min: 0.0, max: 1e4 },
        defaults: &["0"],
        needs: TWO,
        doc: "radius of the far sphere, counted as `radius`; 0: it holds the scene (unstated)",
    },
    Param {
        name: "blend",
        kind: Kind::Choice(&["linear", "inverse"]),
        defaults: &["inverse"],
        needs: TWO,
        doc: "between two spheres by distance from their centre, or by its inverse, which errs less (unstated)",
    },
    Param {
        name: "size",
        kind: Kind::IntegerOrAuto { min: 16, max: 8192 },
        defaults: &["auto"],
        needs: None,
        doc: "texels along a side of the map; auto: pixels along the view's larger side",
    },
    Param {
        name: "cap",
        kind: Kind::Integer { min: 1, max: 65535 },
        defaults: &["256"],
        needs: Some(("cell", &["walk"])),
        doc: "most triangles looked at in one walk",
    },
    IMAGE,
    Param {
        name: "hidden",
        kind: Kind::Choice(&["cut", "drop"]),
        defaults: &["cut"],
        needs: None,
        doc: "what the reflector hides: cut off by the pixel, or left out with all triangles that reach into it \
              (unstated)",
    },
    Param {
        name: "subdivide",
        kind: Kind::Real { min: 0.0, max: 1000.0 },
        defaults: &["0.25"],
        needs: None,
        doc: "longest edge of diffuse meshes, metres; 0: as modelled",
    },
    RESIDUAL_PX,
];
