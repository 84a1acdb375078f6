//! The z-buffered environment map: a captured map that keeps the depths it was drawn with, so that
//! every mirror pixel can search it for the point its own ray meets (Patow 1995).

mod published;
mod revised;
mod sizing;

use super::params::STAGE;
use super::{Changes, Family, Kind, MethodInfo, Param, ReflectionMethod, Setup};
use crate::error::{Error, Result};

pub const INFO: MethodInfo = MethodInfo {
    id: "z-buffered-map",
    title: "Z-buffered environment map",
    paper: "Patow 1995",
    family: Family::ImageSpace,
    depends: Changes::ALL,
    flags: true,
    refracts: true,
    variants: &["published", "revised"],
    params: &[
        Param {
            name: "size",
            kind: Kind::IntegerOrAuto { min: 4, max: 4096 },
            defaults: &["300", "auto"],
            needs: None,
            doc: "texels along a cube face's side; @revised: a power of two, auto: from the view",
        },
        Param {
            name: "layers",
            kind: Kind::IntegerOrAuto { min: 1, max: 8 },
            defaults: &["2", "auto"],
            needs: None,
            doc: "surfaces kept behind each texel, nearest first (his section 4); @revised: intervals, up \
                  to 4, beside the farthest surface, auto: from the scene",
        },
        Param {
            name: "surfaces",
            kind: Kind::Choice(&["facing", "all"]),
            defaults: &["facing"],
            needs: Some(("variant", &["published"])),
            doc: "keep surfaces that face the map's centre, as with back faces culled; or all",
        },
        Param {
            name: "search",
            kind: Kind::Choice(&["vector", "hybrid", "image", "hierarchical", "scan"]),
            defaults: &["hybrid", "hierarchical"],
            needs: None,
            doc: "steps of t in eq. (1); those, then a line on W's face (his fig. 7); lines on all faces; \
                  @revised: over a pyramid of bounds; every texel on the way",
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
            needs: Some(("variant", &["published"])),
            doc: "largest angle between B and the best predictor that is not background, degrees",
        },
        Param {
            name: "map",
            kind: Kind::Choice(&["reflector", "scene"]),
            defaults: &["reflector"],
            needs: Some(("variant", &["published"])),
            doc: "a map for each group of reflectors, or one for all, without any of them in it",
        },
        Param {
            name: "refine",
            kind: Kind::Choice(&["on", "off"]),
            defaults: &["on"],
            needs: Some(("variant", &["revised"])),
            doc: "show the point where the ray crosses the texel's plane, or the texel's own",
        },
        Param {
            name: "certificate",
            kind: Kind::Choice(&["edges", "intervals"]),
            defaults: &["edges"],
            needs: Some(("variant", &["revised"])),
            doc: "flag rays that pass what was not stored, and a texel in which a surface ends or crosses \
                  another; or only the first",
        },
        STAGE,
    ],
    limits: "what no kept layer holds shows the background; what nearly touches the reflector vanishes; \
             a thin thing may lose to what is behind it; no self-reflection",
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
    counters: &[
        "texels",
        "texels-again",
        "texels-skipped",
        "map-reads",
        "background-pixels",
        "visits",
        "intervals",
        "flagged",
    ],
    new: Some(new),
};

fn new(setup: &Setup) -> Result<Box<dyn ReflectionMethod>> {
    let published = setup.variant == "published";
    let searches: &[&str] =
        if published { &["vector", "hybrid", "image"] } else { &["hierarchical", "scan"] };
    let search = setup.values.get("search");
    if !searches.contains(&search) {
        let valid = searches.join(", ");
        return refuse(setup, format!("search={search}; valid: {valid}"));
    }
    if published { published::new(setup) } else { revised::new(setup) }
}

/// The error of a value that means nothing with the variant.
fn refuse<T>(setup: &Setup, what: String) -> Result<T> {
    Err(Error::Usage(format!("z-buffered-map@{}: {what}", setup.variant)))
}
