//! Zeros of polynomials up to degree four.
//!
//! C. Yuksel, "High-performance polynomial root finding for graphics", HPG 2022: between the zeros
//! of its derivative a polynomial is monotone and has one zero or none, as the signs at the ends
//! tell, and a Newton iteration that never leaves the bracket finds it. The derivative's zeros come
//! the same way. Unlike Ferrari's formula this loses no digits to nearly double zeros.

use std::array;

/// Coefficients in rising order of the power.
pub type Quartic = [f64; 5];

/// Where a polynomial changes its sign.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Zero {
    pub at: f64,
    /// From positive to negative.
    pub falls: bool,
}

/// The zeros within an interval, in rising order. Where the polynomial touches zero without changing
/// its sign there is none.
pub fn zeros(quartic: Quartic, [from, to]: [f64; 2]) -> impl Iterator<Item = Zero> {
    let mut derivatives = [quartic; 4];
    for order in 1..4 {
        derivatives[order] = derivative(derivatives[order - 1]);
    }
    let (mut zeros, mut count) = ([Zero::default(); 4], 0);
    for polynomial in derivatives.into_iter().rev() {
        let cuts = zeros;
        let ends = cuts[..count].iter().map(|cut| cut.at).chain([to]);
        let mut left = from;
        count = 0;
        for right in ends {
            if let Some(zero) = between(polynomial, left, right) {
                zeros[count] = zero;
                count += 1;
            }
            left = right;
        }
    }
    zeros.into_iter().take(count)
}

/// The zero of a polynomial that is monotone from `left` to `right`.
fn between(polynomial: Quartic, left: f64, right: f64) -> Option<Zero> {
    let below = |x: f64| value(polynomial, x) < 0.0;
    let falls = !below(left);
    if below(right) != falls {
        return None;
    }
    let slopes = derivative(polynomial);
    let finest = f64::EPSILON * left.abs().max(right.abs());
    let (mut low, mut high) = (left, right);
    let mut at = 0.5 * (low + high);
    // Newton doubles the digits with each step; at a zero of the slope too it gains a bit at least
    // every other step.
    for _ in 0..100 {
        let height = value(polynomial, at);
        if (height < 0.0) == falls {
            high = at
        } else {
            low = at
        }
        let newton = at - height / value(slopes, at);
        let next = if (low..=high).contains(&newton) { newton } else { 0.5 * (low + high) };
        let step = next - at;
        at = next;
        if step.abs() <= finest {
            break;
        }
    }
    Some(Zero { at, falls })
}

fn derivative(p: Quartic) -> Quartic {
    array::from_fn(|power| p.get(power + 1).map_or(0.0, |c| (power + 1) as f64 * c))
}

/// Horner's scheme.
fn value(p: Quartic, x: f64) -> f64 {
    p.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The polynomial with these zeros, fewer than four of them giving a lower degree.
    fn with_zeros(zeros: &[f64]) -> Quartic {
        zeros.iter().fold([1.0, 0.0, 0.0, 0.0, 0.0], |p, zero| {
            array::from_fn(|power| if power > 0 { p[power - 1] } else { 0.0 } - zero * p[power])
        })
    }

    fn found(p: Quartic, interval: [f64; 2]) -> Vec<f64> {
        zeros(p, interval).map(|zero| zero.at).collect()
    }

    #[test]
    fn every_zero_within_the_interval_is_found() {
        for expected in [
            vec![],
            vec![0.3],
            vec![-1.1, 0.0],
            vec![-0.7, 0.2, 0.21],
            vec![-1.9, -0.4, 0.3, 1.7],
            vec![-1.0, 0.5 - 1e-4, 0.5, 0.5 + 1e-4],
        ] {
            let p = with_zeros(&expected);
            let zeros: Vec<Zero> = zeros(p, [-2.0, 2.0]).collect();
            assert_eq!(zeros.len(), expected.len(), "{expected:?}: {zeros:?}");
            for (index, (zero, at)) in zeros.iter().zip(&expected).enumerate() {
                assert!((zero.at - at).abs() < 1e-7, "{at}: {zero:?}");
                // Positive beyond the last, so the last rises, and directions alternate.
                assert_eq!(zero.falls, (expected.len() - index) % 2 == 0);
            }
        }
        assert_eq!(found(with_zeros(&[-1.0, 0.0, 1.0]), [-0.5, 0.5]), [0.0]);
    }

    #[test]
    fn zeros_that_are_apart_keep_all_their_digits() {
        let expected = [-1.3, -0.2, 0.6, 1.4];
        for (at, expected) in found(with_zeros(&expected), [-2.0, 2.0]).iter().zip(expected) {
            assert!((at - expected).abs() < 4.0 * f64::EPSILON, "{at}");
        }
    }

    #[test]
    fn a_touch_is_no_zero_and_a_pair_of_zeros_is_two() {
        // (x^2 - 1)^2 + lift
        let double = |lift: f64| [1.0 + lift, 0.0, -2.0, 0.0, 1.0];
        assert!(found(double(1e-14), [-2.0, 2.0]).is_empty());
        assert_eq!(found(double(-1e-14), [-2.0, 2.0]).len(), 4);
    }
}
