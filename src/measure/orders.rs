//! Errors by the number of mirrors the truth met.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::accuracy::{BadShare, Class};
use super::judge::Judged;
use crate::scene::FrameRecord;

/// How far the pixels are from the truth whose mirrored chain has one order. Glass counts by what it
/// mirrors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct OrderAccuracy {
    /// Reflectors the truth met.
    pub order: u32,
    /// Such pixels, as a share of all compared ones.
    pub share: f64,
    /// Of such pixels, as for all.
    pub bad_share: BadShare,
    /// Of such pixels: no answer, or the environment where the truth shows a surface.
    pub missing: f64,
}

/// By rising order, of the pixels compared.
pub(super) fn by_order(
    truth: &FrameRecord,
    compared: &[usize],
    judged: &[Judged],
) -> Vec<OrderAccuracy> {
    let order_of = |pixel: usize| truth.record.ids[pixel].order();
    let longest = compared.iter().map(|&pixel| order_of(pixel)).max().unwrap_or(0);
    let of = |order: u32| {
        let pairs = compared.iter().zip(judged);
        let such: Vec<_> = pairs.filter(|(pixel, _)| order_of(**pixel) == order).collect();
        let among = |test: &dyn Fn(&Judged) -> bool| {
            such.iter().filter(|(_, judged)| test(judged)).count() as f64 / such.len() as f64
        };
        let bad = |tolerated_px: f32| {
            among(&|judged| {
                judged.class() != Class::Placed
                    || judged.displacement_px.is_some_and(|px| px > tolerated_px)
            })
        };
        (!such.is_empty()).then(|| OrderAccuracy {
            order,
            share: such.len() as f64 / compared.len() as f64,
            bad_share: BadShare { half: bad(0.5), one: bad(1.0), two: bad(2.0), four: bad(4.0) },
            missing: among(&|judged| judged.missing),
        })
    };
    (1..=longest).filter_map(of).collect()
}

/// One for some frames, given by frame: means over the frames, every pixel as heavy as any other where
/// the frames compare as many.
pub fn mean_by_order(frames: &[&[OrderAccuracy]]) -> Vec<OrderAccuracy> {
    let all = || frames.iter().flat_map(|orders| orders.iter());
    let longest = all().map(|one| one.order).max().unwrap_or(0);
    let of = |order: u32| {
        let such = || all().filter(|one| one.order == order);
        let total: f64 = such().map(|one| one.share).sum();
        let mean = |field: fn(&OrderAccuracy) -> f64| {
            such().map(|one| one.share * field(one)).sum::<f64>() / total
        };
        (total > 0.0).then(|| OrderAccuracy {
            order,
            share: total / frames.len() as f64,
            bad_share: BadShare {
                half: mean(|one| one.bad_share.half),
                one: mean(|one| one.bad_share.one),
                two: mean(|one| one.bad_share.two),
                four: mean(|one| one.bad_share.four),
            },
            missing: mean(|one| one.missing),
        })
    };
    (1..=longest).filter_map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one(order: u32, share: f64, bad: f64) -> OrderAccuracy {
        let bad_share = BadShare { half: bad, one: bad, two: bad, four: bad };
        OrderAccuracy { order, share, bad_share, missing: bad }
    }

    #[test]
    fn frames_weigh_as_much_as_they_have_pixels_of_the_order() {
        let frames = [vec![one(1, 0.75, 0.5), one(2, 0.25, 1.0)], vec![one(1, 0.25, 0.1)]];
        let frames: Vec<&[OrderAccuracy]> = frames.iter().map(Vec::as_slice).collect();
        let mean = mean_by_order(&frames);
        assert_eq!(mean.iter().map(|m| m.order).collect::<Vec<_>>(), [1, 2]);
        assert!((mean[0].missing - 0.4).abs() < 1e-12 && mean[0].share == 0.5);
        assert_eq!((mean[1].bad_share.one, mean[1].share), (1.0, 0.125));
        assert!(mean_by_order(&[]).is_empty());
    }
}
