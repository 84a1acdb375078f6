//! Errors of some of the pixels: by the number of mirrors the truth met, by the mirror looked at, by the one met second.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::accuracy::{BadShare, Class};
use super::judge::Judged;
use crate::scene::{FrameRecord, Scene};

/// How far a group of pixels is from the truth.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct GroupAccuracy {
    /// Such pixels, as a share of all compared ones.
    pub share: f64,
    /// Of such pixels, as for all.
    pub bad_share: BadShare,
    /// Of such pixels: no answer, or the environment where the truth shows a surface.
    pub missing: f64,
}

/// Pixels whose mirrored chain has one order in the truth. Glass counts by what it mirrors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct OrderAccuracy {
    /// Reflectors the truth met.
    pub order: u32,
    #[serde(flatten)]
    pub group: GroupAccuracy,
}

/// Pixels that see one reflector.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ReflectorAccuracy {
    /// Its name.
    pub reflector: String,
    #[serde(flatten)]
    pub group: GroupAccuracy,
}

/// Which mirror a chain meets second.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "lowercase")]
pub enum Second {
    /// The first again, or another part of its group.
    Own,
    Other,
}

/// Pixels at which the truth meets two mirrors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SecondAccuracy {
    pub second: Second,
    #[serde(flatten)]
    pub group: GroupAccuracy,
}

/// Of the pixels compared, by rising order.
pub(super) fn by_order(
    truth: &FrameRecord,
    compared: &[usize],
    judged: &[Judged],
) -> Vec<OrderAccuracy> {
    let groups = grouped(compared, judged, |pixel| truth.record.ids[pixel].order());
    // Order 0 is a pixel at which the truth itself has no answer.
    let groups = groups.into_iter().filter(|&(order, _)| order > 0);
    groups.map(|(order, group)| OrderAccuracy { order, group }).collect()
}

/// Of the pixels compared, by the reflectors' names.
pub(super) fn by_reflector(
    scene: &Scene,
    truth: &FrameRecord,
    compared: &[usize],
    judged: &[Judged],
) -> Vec<ReflectorAccuracy> {
    let name = |pixel: usize| scene.objects[truth.reflector[pixel] as usize].name.clone();
    let groups = grouped(compared, judged, name).into_iter();
    groups.map(|(reflector, group)| ReflectorAccuracy { reflector, group }).collect()
}

/// Of the pixels compared, those of order 2 by their second mirror.
pub(super) fn by_second(
    scene: &Scene,
    truth: &FrameRecord,
    compared: &[usize],
    judged: &[Judged],
) -> Vec<SecondAccuracy> {
    let ranks = scene.reflectors();
    // Of more than 254 reflectors the trace cannot tell all apart.
    let group = |rank: u32| {
        let object = ranks.get((rank as usize).wrapping_sub(1))?;
        Some(&scene.objects[*object as usize].group)
    };
    let second = |pixel: usize| {
        let ids = truth.record.ids[pixel];
        let [first, second] = [ids.trace & 0xff, ids.trace >> 8 & 0xff];
        let own = || if group(first) == group(second) { Second::Own } else { Second::Other };
        (ids.order() == 2).then(own)
    };
    let groups = grouped(compared, judged, second).into_iter();
    groups.filter_map(|(second, group)| Some(SecondAccuracy { second: second?, group })).collect()
}

fn grouped<K: Ord>(
    compared: &[usize],
    judged: &[Judged],
    key_of: impl Fn(usize) -> K,
) -> BTreeMap<K, GroupAccuracy> {
    let mut groups: BTreeMap<K, Vec<&Judged>> = BTreeMap::new();
    for (&pixel, judged) in compared.iter().zip(judged) {
        groups.entry(key_of(pixel)).or_default().push(judged);
    }
    groups.into_iter().map(|(key, such)| (key, group_of(&such, compared.len()))).collect()
}

fn group_of(such: &[&Judged], compared: usize) -> GroupAccuracy {
    let among = |test: &dyn Fn(&Judged) -> bool| {
        such.iter().filter(|judged| test(judged)).count() as f64 / such.len() as f64
    };
    let bad = |tolerated_px: f32| {
        among(&|judged| {
            judged.class() != Class::Placed
                || judged.displacement_px.is_some_and(|px| px > tolerated_px)
        })
    };
    GroupAccuracy {
        share: such.len() as f64 / compared as f64,
        bad_share: BadShare { half: bad(0.5), one: bad(1.0), two: bad(2.0), four: bad(4.0) },
        missing: among(&|judged| judged.missing),
    }
}

/// One for some frames, given by frame: means over the frames, every pixel as heavy as any other where
/// the frames compare as many.
pub fn mean_by_order(frames: &[&[OrderAccuracy]]) -> Vec<OrderAccuracy> {
    let groups = mean_of(frames, |one| (one.order, one.group)).into_iter();
    groups.map(|(order, group)| OrderAccuracy { order, group }).collect()
}

/// The same by reflector.
pub fn mean_by_reflector(frames: &[&[ReflectorAccuracy]]) -> Vec<ReflectorAccuracy> {
    let groups = mean_of(frames, |one| (one.reflector.clone(), one.group)).into_iter();
    groups.map(|(reflector, group)| ReflectorAccuracy { reflector, group }).collect()
}

/// The same by the second mirror.
pub fn mean_by_second(frames: &[&[SecondAccuracy]]) -> Vec<SecondAccuracy> {
    let groups = mean_of(frames, |one| (one.second, one.group)).into_iter();
    groups.map(|(second, group)| SecondAccuracy { second, group }).collect()
}

fn mean_of<T, K: Ord>(
    frames: &[&[T]],
    split: impl Fn(&T) -> (K, GroupAccuracy),
) -> BTreeMap<K, GroupAccuracy> {
    let mut groups: BTreeMap<K, Vec<GroupAccuracy>> = BTreeMap::new();
    for one in frames.iter().copied().flatten() {
        let (key, group) = split(one);
        groups.entry(key).or_default().push(group);
    }
    groups.into_iter().map(|(key, such)| (key, mean_group(&such, frames.len()))).collect()
}

fn mean_group(such: &[GroupAccuracy], frames: usize) -> GroupAccuracy {
    let total: f64 = such.iter().map(|one| one.share).sum();
    let mean = |field: fn(&GroupAccuracy) -> f64| {
        such.iter().map(|one| one.share * field(one)).sum::<f64>() / total
    };
    GroupAccuracy {
        share: total / frames as f64,
        bad_share: BadShare {
            half: mean(|one| one.bad_share.half),
            one: mean(|one| one.bad_share.one),
            two: mean(|one| one.bad_share.two),
            four: mean(|one| one.bad_share.four),
        },
        missing: mean(|one| one.missing),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn group(share: f64, bad: f64) -> GroupAccuracy {
        let bad_share = BadShare { half: bad, one: bad, two: bad, four: bad };
        GroupAccuracy { share, bad_share, missing: bad }
    }

    #[test]
    fn frames_weigh_as_much_as_they_have_pixels_of_the_order() {
        let one = |order, share, bad| OrderAccuracy { order, group: group(share, bad) };
        let frames = [vec![one(1, 0.75, 0.5), one(2, 0.25, 1.0)], vec![one(1, 0.25, 0.1)]];
        let frames: Vec<&[OrderAccuracy]> = frames.iter().map(Vec::as_slice).collect();
        let mean = mean_by_order(&frames);
        assert_eq!(mean.iter().map(|m| m.order).collect::<Vec<_>>(), [1, 2]);
        assert!((mean[0].group.missing - 0.4).abs() < 1e-12 && mean[0].group.share == 0.5);
        assert_eq!((mean[1].group.bad_share.one, mean[1].group.share), (1.0, 0.125));
        assert!(mean_by_order(&[]).is_empty());
    }

    #[test]
    fn a_reflector_seen_in_some_frames_only_is_not_diluted_by_the_others() {
        let one = |name: &str, share, bad| ReflectorAccuracy {
            reflector: name.to_owned(),
            group: group(share, bad),
        };
        let frames =
            [vec![one("lid", 0.5, 0.2), one("body", 0.5, 0.0)], vec![one("body", 1.0, 0.3)]];
        let frames: Vec<&[ReflectorAccuracy]> = frames.iter().map(Vec::as_slice).collect();
        let mean = mean_by_reflector(&frames);
        assert_eq!(mean.iter().map(|m| m.reflector.as_str()).collect::<Vec<_>>(), ["body", "lid"]);
        assert!((mean[0].group.missing - 0.2).abs() < 1e-12);
        assert_eq!((mean[1].group.missing, mean[1].group.share), (0.2, 0.25));
    }
}
