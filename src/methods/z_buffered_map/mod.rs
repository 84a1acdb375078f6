//! The z-buffered environment map: a captured map that keeps the depths it was drawn with, so that
//! every mirror pixel can search it for the point its own ray meets (Patow 1995).

mod published;

use super::params::STAGE;
use super::{Changes, Family, Kind, MethodInfo, Param};

pub const INFO: MethodInfo = MethodInfo {
    id: "z-buffered-map",
    title: "Z-buffered environment map",
    paper: "Patow 1995",
    family: Family::ImageSpace,
    depends: Changes::ALL,
    flags: false,
    refracts: true,
    variants: &["published"],
    params: &[
        Param {
            name: "size",
            kind: Kind::Integer { min: 4, max: 4096 },
            defaults: &["300"],
            needs: None,
            doc: "texels along a cube face's side",
        },
        Param {
            name: "layers",
            kind: Kind::Integer { min: 1, max: 8 },
            defaults: &["2"],
            needs: None,
            doc: "surfaces kept behind each texel, nearest first (his section 4)",
        },
        Param {
            name: "surfaces",
            kind: Kind::Choice(&["facing", "all"]),
            defaults: &["facing"],
            needs: None,
            doc: "keep surfaces that face the map's centre, as with back faces culled; or all",
        },
        Param {
            name: "search",
            kind: Kind::Choice(&["vector", "hybrid", "image"]),
            defaults: &["hybrid"],
            needs: None,
            doc: "steps of t in eq. (1); those, then a line on W's face (his fig. 7); lines on all faces",
        },
        Param {
            name: "line",
            kind: Kind::Choice(&["bresenham", "touched"]),
            defaults: &["bresenham"],
            needs: Some(("search", &["hybrid", "image"])),
            doc: "texels of a line: one a step along its longer axis, or all it touches",
        },
        Param {
            name: "steps",
            kind: Kind::Integer { min: 1, max: 100_000 },
            defaults: &["200"],
            needs: Some(("search", &["vector", "hybrid"])),
            doc: "steps from t = 0 to 1",
        },
        Param {
            name: "unit_m",
            kind: Kind::Real { min: 1e-6, max: 1e6 },
            defaults: &["1"],
            needs: Some(("search", &["vector", "hybrid"])),
            doc: "metres in the unit of length that t is counted in: eq. (1) depends on it",
        },
        Param {
            name: "threshold_deg",
            kind: Kind::Real { min: 1e-3, max: 45.0 },
            defaults: &["1"],
            needs: None,
            doc: "largest angle between B and the best predictor that is not background, degrees",
        },
        Param {
            name: "map",
            kind: Kind::Choice(&["reflector", "scene"]),
            defaults: &["reflector"],
            needs: None,
            doc: "a map for each group of reflectors, or one for all, without any of them in it",
        },
        STAGE,
    ],
    limits: "what no kept layer holds shows the background; what nearly touches the reflector vanishes; \
             a thin thing may lose to what is behind it; no self-reflection",
    passes: &[
        "z-buffered-map/capture-background",
        "z-buffered-map/capture-start",
        "z-buffered-map/capture",
        "footprint/clear-list",
        "footprint/list",
        "z-buffered-map/reflect",
    ],
    counters: &["texels", "texels-again", "texels-skipped", "map-reads", "background-pixels"],
    new: Some(published::new),
};
