//! Random numbers that are the same everywhere: of a seed alone.

use std::f32::consts::TAU;

use glam::{Quat, Vec3};

/// Steele, Lea & Flood 2014: a 64-bit generator of one word of state.
#[derive(Clone, Debug)]
pub struct SplitMix64(u64);

impl SplitMix64 {
    pub fn new(seed: u64) -> Self {
        SplitMix64(seed)
    }

    pub fn next_u64(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number in `0..end`; `end` is positive. Lemire's multiplication, bias below 2^-32 for the
    /// sample sizes of a benchmark.
    pub fn below(&mut self, end: usize) -> usize {
        ((u128::from(self.next_u64()) * end as u128) >> 64) as usize
    }

    /// Fisher and Yates's shuffle.
    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for end in (2..=items.len()).rev() {
            items.swap(end - 1, self.below(end));
        }
    }

    /// A number from 0 to below 1, in steps of 2^-24.
    pub fn unit(&mut self) -> f32 {
        (self.next_u64() >> 40) as f32 / (1u64 << 24) as f32
    }

    /// A point of the box between two corners.
    pub fn within(&mut self, low: Vec3, high: Vec3) -> Vec3 {
        let share = Vec3::new(self.unit(), self.unit(), self.unit());
        low + share * (high - low)
    }

    /// A rotation, all equally likely (Shoemake 1992).
    pub fn rotation(&mut self) -> Quat {
        let (share, first, second) = (self.unit(), TAU * self.unit(), TAU * self.unit());
        let (low, high) = ((1.0 - share).sqrt(), share.sqrt());
        Quat::from_xyzw(
            low * first.sin(),
            low * first.cos(),
            high * second.sin(),
            high * second.cos(),
        )
        .normalize()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_generator_is_the_published_one() {
        // First outputs of the reference implementation for seed 1234567.
        let mut random = SplitMix64::new(1_234_567);
        let expected = [6457827717110365317, 3203168211198807973, 9817491932198370423];
        assert_eq!([(); 3].map(|()| random.next_u64()), expected);
    }

    #[test]
    fn a_shuffle_is_a_permutation_and_reaches_every_place() {
        let mut random = SplitMix64::new(5);
        let mut first = [0; 4];
        for _ in 0..400 {
            let mut items = [0, 1, 2, 3];
            random.shuffle(&mut items);
            first[items[0]] += 1;
            items.sort_unstable();
            assert_eq!(items, [0, 1, 2, 3]);
        }
        assert!(first.iter().all(|n| (60..140).contains(n)), "{first:?}");
    }

    #[test]
    fn rotations_turn_an_axis_everywhere() {
        let mut random = SplitMix64::new(7);
        let turned: Vec<Vec3> = (0..4000).map(|_| random.rotation() * Vec3::X).collect();
        let mean = turned.iter().sum::<Vec3>() / 4000.0;
        let squares = turned.iter().map(|t| *t * *t).sum::<Vec3>() / 4000.0;
        assert!(mean.abs().max_element() < 0.05, "{mean}");
        assert!((squares - 1.0 / 3.0).abs().max_element() < 0.02, "{squares}");
    }
}
