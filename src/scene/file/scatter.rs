//! Copies of an object in random places, the same for the same seed.

use glam::{Affine3A, Quat, Vec3};
use toml::Spanned;

use super::format::{ClearFile, ScatterFile};
use super::source::Source;
use super::values::triple;
use crate::error::Result;
use crate::geometry::random::SplitMix64;

/// Places tried for one copy before there is taken to be none.
const TRIES: u32 = 1000;

/// One copy.
pub struct Placement {
    /// Enlarges the mesh about its origin.
    pub scale: f32,
    /// World from object space.
    pub pose: Affine3A,
}

/// Where the copies stand. `reach`: how far the shape extends from its origin, metres.
///
/// A copy's size, place and rotation are drawn in this order, a place anew until it is clear.
pub fn placements(
    source: &Source,
    spanned: &Spanned<ScatterFile>,
    reach: f32,
) -> Result<Vec<Placement>> {
    let (span, file) = (spanned.span(), spanned.get_ref());
    let (low, high) = (triple(file.low), triple(file.high));
    if low.cmpgt(high).any() {
        return Err(source.error(&span, "low is above high; valid: opposite corners of a box"));
    }
    let [least, most] = file.scale.map(|scale| scale.0);
    if least > most {
        let message = format!("scale = [{least}, {most}] falls; valid: the smallest, the largest");
        return Err(source.error(&span, message));
    }
    let mut random = SplitMix64::new(u64::from(file.seed.0));
    let mut placement = || {
        let scale = least + random.unit() * (most - least);
        let is_clear = |place: &Vec3| {
            let keeps =
                |c: &ClearFile| place.distance(triple(c.centre)) >= c.radius.0 + scale * reach;
            file.clear.iter().all(keeps)
        };
        let place = (0..TRIES).map(|_| random.within(low, high)).find(is_clear)?;
        let rotation = if file.turn { random.rotation() } else { Quat::IDENTITY };
        Some(Placement { scale, pose: Affine3A::from_rotation_translation(rotation, place) })
    };
    let placed: Option<Vec<_>> = (0..file.count.0).map(|_| placement()).collect();
    placed.ok_or_else(|| {
        let message = format!("no clear place in {TRIES} tries; valid: a box with room for each");
        source.error(&span, message)
    })
}
