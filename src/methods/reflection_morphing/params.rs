//! What can be chosen, and what had to be: the paper states neither cell size nor edge length.

use crate::methods::{Kind, Param};
use crate::scene::record::TRACE_BOUNCES;

/// For what nodes at the eye do without.
const GRID: Option<(&str, &[&str])> = Some(("nodes", &["grid"]));

pub const PARAMS: &[Param] = &[
    Param {
        name: "nodes",
        kind: Kind::Choice(&["grid", "eye"]),
        defaults: &["grid"],
        needs: None,
        doc: "where rays are traced from: a grid's nodes, beforehand (section 3); or the eye, in every frame",
    },
    Param {
        name: "map",
        kind: Kind::Integer { min: 8, max: 2048 },
        defaults: &["256"],
        needs: None,
        doc: "texels along a side of a ray map's faces (4.1; section 8 has 256); nodes=eye: of the reflector's textures",
    },
    Param {
        name: "depth",
        kind: Kind::Integer { min: 0, max: 10 },
        defaults: &["5"],
        needs: GRID,
        doc: "how often a cell of an octree may be split (4.2; section 8 has 5)",
    },
    Param {
        name: "bounces",
        kind: Kind::Integer { min: 1, max: TRACE_BOUNCES as i64 },
        defaults: &["1"],
        needs: None,
        doc: "longest chain of mirrors, and layers of ray maps (4.1; section 8 has 1)",
    },
    Param {
        name: "traces",
        kind: Kind::Choice(&["apart", "mixed"]),
        defaults: &["apart"],
        needs: Some(("bounces", &["2", "3", "4"])),
        doc: "a vertex has one projection by each chain of mirrors, and triangles never join two; or (nodes=grid) one \
              by the nearest ray of any",
    },
    Param {
        name: "still",
        kind: Kind::Choice(&["out", "in"]),
        defaults: &["out"],
        needs: GRID,
        doc: "diffuse objects that never move: left out of what rays meet, or in, so that they end rays (4.1)",
    },
    Param {
        name: "cell",
        kind: Kind::Real { min: 0.01, max: 100.0 },
        defaults: &["0.5"],
        needs: GRID,
        doc: "metres between sampling locations (section 3; unstated)",
    },
    Param {
        name: "subdivide",
        kind: Kind::Real { min: 0.0, max: 1000.0 },
        defaults: &["0.25"],
        needs: None,
        doc: "longest edge of diffuse meshes, metres (section 5; unstated); 0: as modelled",
    },
    Param {
        name: "leaves",
        kind: Kind::Choice(&["one", "neighbours"]),
        defaults: &["one", "neighbours"],
        needs: Some(("lookup", &["octree"])),
        doc: "where the nearest ray is sought: in the vertex's own leaf, or in all that may hold a nearer one",
    },
    Param {
        name: "point",
        kind: Kind::Choice(&["ray", "bundle"]),
        defaults: &["ray", "bundle"],
        needs: GRID,
        doc: "where a node sees a vertex: where it sees the nearest ray, or between the four rays round the vertex",
    },
    Param {
        name: "weights",
        kind: Kind::Choice(&["all", "valid"]),
        defaults: &["all", "valid"],
        needs: GRID,
        doc: "vertices are drawn that all eight nodes see (section 6), or any, by the weights of those that do",
    },
    Param {
        name: "lookup",
        kind: Kind::Choice(&["octree", "brute-force"]),
        defaults: &["octree"],
        needs: None,
        doc: "the nearest ray: of those in the vertex's leaf, or of all (section 1.2); nodes=eye: the bundle of rays it is \
              in, of those its cell lists, or of all",
    },
    Param {
        name: "files",
        kind: Kind::Choice(&["kept", "none"]),
        defaults: &["kept"],
        needs: GRID,
        doc: "octrees of reflectors that stand still are kept on disk (4.2), or built in every run",
    },
];
