//! Sampling locations: "the nodes of a regular 3D grid"; and sampling cells, its boxes (Martin & Popescu
//! 2004, section 1.2).

use glam::{IVec3, Vec3};

/// The grid has a node at the world's origin, so that views of one scene share its files.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Metres from node to node.
    pub cell: f32,
}

/// The cell an eye is in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SamplingCell {
    /// The node with the least coordinates.
    base: IVec3,
    /// Where the eye is in the cell, 0 to 1 along each axis.
    place: Vec3,
}

/// One of the nodes round an eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    pub node: IVec3,
    /// Its part in what is interpolated; all eight add up to 1.
    pub weight: f32,
}

impl Grid {
    pub fn cell_of(&self, eye: Vec3) -> SamplingCell {
        let scaled = eye / self.cell;
        let base = scaled.floor();
        SamplingCell { base: base.as_ivec3(), place: (scaled - base).clamp(Vec3::ZERO, Vec3::ONE) }
    }

    /// Where a node is, world.
    pub fn location(&self, node: IVec3) -> Vec3 {
        self.cell * node.as_vec3()
    }
}

impl SamplingCell {
    /// The eight nodes, each in a place of its own: of any two neighbours along an axis one has an even number
    /// there and one an odd, so that a node keeps its place when the eye goes to the next cell.
    pub fn corners(&self) -> [Corner; 8] {
        std::array::from_fn(|slot| {
            let odd = IVec3::new(1, 2, 4).map(|bit| i32::from(slot as i32 & bit != 0));
            let step = (odd - self.base) & IVec3::ONE;
            let far = step.cmpeq(IVec3::ONE);
            let weights = Vec3::select(far, self.place, 1.0 - self.place);
            Corner { node: self.base + step, weight: weights.element_product() }
        })
    }
}
