//! The edges between a scene's triangles, each once.

use std::sync::Arc;

use rayon::prelude::*;

use crate::error::Result;
use crate::gpu::{Buffer, Device};

/// Edges as halving looks at them; those with other vertices at the same places are others.
pub struct Edges {
    /// Two vertices each.
    pub pairs: Buffer,
    /// Three a triangle, into `pairs`: from its first vertex to its second, and so on.
    pub of_triangles: Buffer,
    pub count: u32,
}

impl Edges {
    /// Of triangles with three indices each.
    ///
    /// # Errors
    /// [`crate::error::Error::Device`] with the numbers when a list is beyond the device's limits.
    pub fn new(device: &Arc<Device>, indices: &[u32]) -> Result<Edges> {
        let (pairs, of_triangles) = paired(indices);
        Ok(Edges {
            pairs: Buffer::with_data(device, "reflected edges", &pairs)?,
            of_triangles: Buffer::with_data(device, "reflected triangles' edges", &of_triangles)?,
            count: pairs.len() as u32,
        })
    }
}

/// Each edge's two vertices, the lower first; and each triangle's three edges.
fn paired(indices: &[u32]) -> (Vec<[u32; 2]>, Vec<u32>) {
    let place = |i: usize| {
        let (a, b) = (indices[i], indices[if i % 3 == 2 { i - 2 } else { i + 1 }]);
        ([a.min(b), a.max(b)], i)
    };
    let mut sides: Vec<_> = (0..indices.len()).into_par_iter().map(place).collect();
    sides.par_sort_unstable();
    let mut pairs = Vec::new();
    let mut of_triangles = vec![0; indices.len()];
    for (pair, side) in sides {
        if pairs.last() != Some(&pair) {
            pairs.push(pair);
        }
        of_triangles[side] = pairs.len() as u32 - 1;
    }
    (pairs, of_triangles)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_triangles_share_the_edge_between_them() {
        let (pairs, of_triangles) = paired(&[0, 1, 2, 2, 1, 3]);
        assert_eq!(pairs, [[0, 1], [0, 2], [1, 2], [1, 3], [2, 3]]);
        assert_eq!(of_triangles, [0, 2, 1, 2, 3, 4]);
    }
}
