//! Which mirrors a point is seen in.

use crate::truth::{Bounce, Chain};

/// Chains of the same reflectors that mirror and refract alike have the same key.
pub(super) type Key = u64;

/// The first bounces of a chain: what light meets, wherever it meets it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mirrors<'a> {
    /// At least one.
    pub bounces: &'a [Bounce],
    pub key: Key,
}

impl<'a> Mirrors<'a> {
    /// All of a chain.
    pub fn of(chain: &'a Chain) -> Self {
        Mirrors::first(chain, chain.order())
    }

    /// The first `order` of a chain that is as long, at least 1.
    pub fn first(chain: &'a Chain, order: u32) -> Self {
        let key = packed(chain.trace, chain.refractions(), order);
        Mirrors { bounces: &chain.bounces[..order as usize], key }
    }

    /// The first, the first two and so on up to all of a chain.
    pub fn beginnings(chain: &'a Chain) -> impl Iterator<Item = Self> {
        (1..=chain.order()).map(|order| Mirrors::first(chain, order))
    }

    pub fn order(&self) -> u32 {
        self.bounces.len() as u32
    }

    /// What a record says of them, order and trace: not where they refract.
    pub fn recorded(&self) -> (u32, u32) {
        (self.order(), self.key as u32)
    }
}

fn packed(trace: u32, refractions: u32, order: u32) -> Key {
    let trace = trace & (u32::MAX >> 32u32.saturating_sub(8 * order));
    let refractions = refractions & ((1 << order.min(31)) - 1);
    Key::from(trace) | Key::from(refractions) << 32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_holds_as_many_reflectors_as_asked_for() {
        assert_eq!(packed(0x0403_0201, 0b10, 1), 0x01);
        assert_eq!(packed(0x0403_0201, 0b10, 3), 0x2_0003_0201);
        assert_eq!(packed(0x0403_0201, 0, 4), 0x0403_0201);
        assert_eq!(packed(0x0403_0201, 0b10_0001, 6), 0x21_0403_0201);
    }
}
