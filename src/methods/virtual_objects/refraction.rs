//! What glass and water let through: the same search with Snell's law in place of the law of reflection, named as
//! future work by Estalella et al. 2006 (section 7).
//!
//! One surface alone is looked through: what lies behind it is taken to be within it, as under water, or as what is
//! cast into a ball of glass. What a ray meets after leaving a ball again is drawn as if it had not left.

use std::sync::Arc;

use super::draw::Drawing;
use super::edges::Edges;
use super::rule::Rule;
use super::search::Search;
use super::source::Source;
use super::split::Split;
use crate::error::Result;
use crate::gpu::Device;
use crate::stages::RecordMode;

/// Pipelines and lists of what is refracted; textures and corners are those of what is reflected, which is drawn
/// by then.
pub struct Refraction {
    pub search: Search,
    pub split: Split,
    pub drawing: Drawing,
}

impl Refraction {
    /// For views of `size` pixels.
    ///
    /// # Errors
    /// As of pipelines and lists.
    pub fn new(
        device: &Arc<Device>,
        rule: &Rule,
        mode: RecordMode,
        size: [u32; 2],
        parts: (&Source, &Arc<Edges>),
    ) -> Result<Refraction> {
        let rule = &rule.refracted();
        Ok(Refraction {
            search: Search::new(device, rule, mode, rule.texture_size(size))?,
            split: Split::new(device, rule, mode, parts, size)?,
            drawing: Drawing::new(device, rule, mode)?,
        })
    }
}
