//! The z-buffered environment map: a captured map that keeps the distance of what each texel shows,
//! searched along each mirrored ray (Patow 1995).

mod revised;

use super::{Changes, Family, Kind, MethodInfo, Param};

pub const INFO: MethodInfo = MethodInfo {
    id: "z-buffered-map",
    title: "Z-buffered environment map",
    paper: "Patow 1995",
    family: Family::ImageSpace,
    depends: Changes::ALL,
    flags: true,
    refracts: true,
    variants: &["revised"],
    params: &[
        Param {
            name: "size",
            kind: Kind::IntegerOrAuto { min: 16, max: 2048 },
            defaults: &["auto"],
            needs: None,
            doc: "texels along a cube face's side, a power of two",
        },
        Param {
            name: "layers",
            kind: Kind::IntegerOrAuto { min: 1, max: 4 },
            defaults: &["auto"],
            needs: None,
            doc: "intervals kept behind a texel, beside the farthest surface",
        },
        Param {
            name: "search",
            kind: Kind::Choice(&["hierarchical", "scan"]),
            defaults: &["hierarchical"],
            needs: None,
            doc: "over a pyramid of bounds, or every texel on the way",
        },
        Param {
            name: "refine",
            kind: Kind::Choice(&["on", "off"]),
            defaults: &["on"],
            needs: None,
            doc: "the point where the ray crosses the texel's plane, or the texel's own",
        },
        Param {
            name: "certificate",
            kind: Kind::Choice(&["edges", "intervals"]),
            defaults: &["edges"],
            needs: None,
            doc: "what is flagged: passing what was not stored; also passing a texel where a surface ends",
        },
    ],
    limits: "what is thinner than a texel, or hidden behind more intervals than kept; no self-reflection",
    passes: &[
        "z-buffered-map/capture-background",
        "z-buffered-map/capture-start",
        "z-buffered-map/capture",
        "z-buffered-map/intervals",
        "z-buffered-map/bounds",
        "z-buffered-map/pyramid",
        "footprint/clear-list",
        "footprint/list",
        "z-buffered-map/reflect",
    ],
    counters: &["visits", "texels", "intervals", "flagged"],
    new: Some(revised::new),
};
