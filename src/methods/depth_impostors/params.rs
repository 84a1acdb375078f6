//! What can be chosen; the slides state segments, angles and little else.

use crate::methods::params::STAGE;
use crate::methods::{Kind, Param};

pub const PARAMS: &[Param] = &[
    Param {
        name: "size",
        kind: Kind::IntegerOrAuto { min: 16, max: 2048 },
        defaults: &["auto"],
        needs: None,
        doc: "texels along a side of a depth image, a multiple of 8; also rows of a rotated map (unstated); auto: 512, \
              or fewer where the rows of all images are beyond one buffer",
    },
    Param {
        name: "search",
        kind: Kind::Choice(&["srdm", "march"]),
        defaults: &["srdm"],
        needs: None,
        doc: "simplified rotated depth maps (slides 37, 38), or texel by texel along the epipolar segment (36)",
    },
    Param {
        name: "step_deg",
        kind: Kind::Integer { min: 1, max: 90 },
        defaults: &["10"],
        needs: Some(("search", &["srdm"])),
        doc: "degrees between rotated maps, rounded to a whole share of 180 (slide 46: 20, 10, 3, 2)",
    },
    Param {
        name: "segments",
        kind: Kind::Integer { min: 1, max: 64 },
        defaults: &["32"],
        needs: Some(("search", &["srdm"])),
        doc: "most segments a row is simplified to (slide 39: 8, 16, 32, 64)",
    },
    Param {
        name: "build",
        kind: Kind::Choice(&["cpu", "gpu"]),
        defaults: &["cpu", "gpu"],
        needs: Some(("search", &["srdm"])),
        doc: "where rows are built: on all cores (slide 39), or on the device (slide 50, future work)",
    },
    Param {
        name: "re_anchor",
        kind: Kind::Choice(&["off", "on"]),
        defaults: &["off", "on"],
        needs: Some(("search", &["srdm"])),
        doc: "search again in the row that the ray is in where the first was hit",
    },
    Param {
        name: "finish",
        kind: Kind::Choice(&["row", "image"]),
        defaults: &["row", "image"],
        needs: Some(("re_anchor", &["on"])),
        doc: "the place is where the row was hit, or found from there between the image's own texels, by one secant",
    },
    Param {
        name: "silhouettes",
        kind: Kind::Choice(&["skins", "gaps"]),
        defaults: &["skins", "gaps"],
        needs: None,
        doc: "surfaces go on across silhouettes, or rays pass behind their rims, and are flagged",
    },
    Param {
        name: "filter",
        kind: Kind::Choice(&["bilinear", "mip"]),
        defaults: &["mip"],
        needs: None,
        doc: "colour between texels, or also between mip levels by the pixel's footprint (slide 35, antialiasing)",
    },
    Param {
        name: "rays",
        kind: Kind::Choice(&["central", "parallel"]),
        defaults: &["central"],
        needs: None,
        doc: "depth images as seen from the reflector's middle (parallel where that is too near), or from far off \
              that way",
    },
    Param {
        name: "view",
        kind: Kind::Choice(&["start", "now"]),
        defaults: &["start", "now"],
        needs: None,
        doc: "taken as the objects stand when the animation starts, and kept (slide 39), or as they stand now",
    },
    Param {
        name: "views",
        kind: Kind::Integer { min: 1, max: 4 },
        defaults: &["1", "2"],
        needs: None,
        doc: "depth images of each object, from all round it; flat things have one (slide 49, occlusion-resistant)",
    },
    Param {
        name: "own",
        kind: Kind::Integer { min: 0, max: 6 },
        defaults: &["0", "6"],
        needs: None,
        doc: "depth images of a mirror itself, in which its rays look for itself before they go on from there, to the \
              scene's order (slide 50, future work); 0: rays pass through it",
    },
    Param {
        name: "backdrop",
        kind: Kind::Choice(&["map", "images"]),
        defaults: &["map", "images"],
        needs: None,
        doc: "what the scene calls its backdrop is in an environment map, as for billboards, or has depth images like \
              all else",
    },
    Param {
        name: "objects",
        kind: Kind::Integer { min: 1, max: 64 },
        defaults: &["16"],
        needs: None,
        doc: "most objects that impostors stand for, for each reflector those that look largest from it; the rest \
              show the environment",
    },
    STAGE,
];
