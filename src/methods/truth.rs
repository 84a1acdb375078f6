//! The truth as a case: the CPU ray tracer of [`crate::truth`], named like any method.

use super::{Changes, Family, Kind, MethodInfo, Param};

pub const INFO: MethodInfo = MethodInfo {
    id: "truth",
    title: "CPU ray tracer",
    paper: "Whitted 1980; what every method is compared with",
    family: Family::Baseline,
    depends: Changes::ALL,
    flags: false,
    refracts: true,
    variants: &["published"],
    params: &[
        Param {
            name: "spp",
            kind: Kind::Integer { min: 1, max: 1024 },
            defaults: &["1"],
            needs: None,
            doc: "samples a pixel; 1 is the ray through the pixel's centre",
        },
        Param {
            name: "bounces",
            kind: Kind::Integer { min: 0, max: 4 },
            defaults: &["0"],
            needs: None,
            doc: "longest chain of mirrors followed; 0 takes the scene's",
        },
        Param {
            name: "shapes",
            kind: Kind::Choice(&["tessellated", "analytic"]),
            defaults: &["tessellated"],
            needs: None,
            doc: "round shapes and planes as the meshes the GPU draws, or in closed form",
        },
    ],
    limits: "runs on the CPU; its times are not compared",
    passes: &[],
    counters: &[],
    new: None,
};
