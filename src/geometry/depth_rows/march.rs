//! Where a ray meets a depth image, texel by texel: "intersection computed as 1D search. Still too many
//! steps along epipolar segment" (Popescu et al. 2006, slide 36).

use glam::{Vec2, Vec3Swizzles};

use super::{Heights, ImageLine, RIM};

/// Where a march ended.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Marched {
    /// In texels of the image.
    pub place: Option<Vec2>,
    /// As a share of the line.
    pub share: f32,
    /// It went behind something past a silhouette.
    pub behind: bool,
    /// Texels read.
    pub reads: u32,
}

/// March along a line, one texel a step along its longer axis; `skins` as in [`super::Rule`].
pub fn march(heights: Heights, line: &ImageLine, jump: f32, skins: bool) -> Marched {
    let longest = (line.end - line.start).xy().abs().max_element();
    let steps = longest.ceil().max(1.0);
    let mut marched = Marched::default();
    let over = |share: f32, surface: f32| line.at(share).z - surface;
    let mut before = (0.0, heights.nearest(line.start.xy()));
    marched.reads = 1;
    for i in 1..=steps as u32 {
        let share = i as f32 / steps;
        let surface = heights.nearest(line.at(share).xy());
        marched.reads += 1;
        let (was, is) = (over(before.0, before.1), over(share, surface));
        let one = before.1 > 0.0 && surface > 0.0 && (surface - before.1).abs() <= jump;
        let crossed = was >= 0.0 && is < 0.0 || skins && was < 0.0 && is >= 0.0;
        if crossed && !one {
            marched.behind = true;
        }
        if crossed && (one || skins || -is <= RIM * jump) {
            let part = was / (was - is);
            // A skin shows the side that has something to show.
            let part = if before.1 == 0.0 {
                1.0
            } else if surface == 0.0 {
                0.0
            } else {
                part
            };
            marched.share = before.0 + part * (share - before.0);
            marched.place = Some(line.at(marched.share).xy());
            marched.behind &= skins || !one;
            return marched;
        }
        before = (share, surface);
    }
    marched
}
