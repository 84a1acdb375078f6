//! What stands side by side in a film: a case's frame, other cases' and maps of error.

use super::lab::{Artist, Lab, TRUTH};
use crate::error::{Error, Result};
use crate::geometry::Camera;
use crate::measure::colour;
use crate::methods::{Case, MethodInfo};
use crate::scene::{FrameRecord, Moment, Scene};

/// What a film shows beside a case's frames.
#[derive(Clone, Debug, PartialEq)]
pub enum Beside {
    /// The picture of this case, the truth's for instance.
    Picture(Case),
    /// FLIP's map of the difference from the truth, from black for none to light yellow.
    Error,
}

impl Beside {
    /// `error`, or a case.
    ///
    /// # Errors
    /// [`Error::Usage`], which lists what is valid.
    pub fn parse(text: &str, methods: &[&'static MethodInfo]) -> Result<Beside> {
        if text == "error" {
            return Ok(Beside::Error);
        }
        let case = Case::parse(text, methods).map_err(|cause| {
            Error::Usage(format!("--beside: {cause}; or `error`, the difference from the truth"))
        });
        Ok(Beside::Picture(case?))
    }
}

/// The panels beside a case's frame, from left to right, and what draws them.
pub struct Panels<'s> {
    size: [u32; 2],
    /// Every case drawn, once each.
    artists: Vec<Artist<'s>>,
    /// What each panel shows, and whose frame it needs.
    panels: Vec<(Beside, usize)>,
}

impl<'s> Panels<'s> {
    /// # Errors
    /// Those of [`Lab::companion`].
    pub fn new(lab: &Lab, scene: &'s Scene, beside: &[Beside]) -> Result<Panels<'s>> {
        let (size, truth) = (lab.settings.size, Case::parse(TRUTH, lab.methods)?);
        let mut cases: Vec<&Case> = Vec::new();
        let mut panels = Vec::with_capacity(beside.len());
        for what in beside {
            let case = match what {
                Beside::Picture(case) => case,
                Beside::Error => &truth,
            };
            let place = cases.iter().position(|drawn| *drawn == case).unwrap_or(cases.len());
            if place == cases.len() {
                cases.push(case);
            }
            panels.push((what.clone(), place));
        }
        let artists = cases.into_iter().map(|case| lab.companion(scene, case, size));
        Ok(Panels { size, artists: artists.collect::<Result<_>>()?, panels })
    }

    /// Width and height of the whole, the case's own panel included.
    pub fn picture_size(&self) -> [u32; 2] {
        let [width, height] = self.size;
        [width * (1 + self.panels.len() as u32), height]
    }

    /// The whole picture, 8-bit sRGB, row-major: the case's `frame` and what stands beside it. `cut`: the
    /// last call was not for the frame before.
    ///
    /// # Errors
    /// Those of the engine.
    pub fn picture(&mut self, frame: &FrameRecord, moment: &Moment, cut: bool) -> Result<Vec<u8>> {
        let size = self.size;
        let drawn = self.artists.iter_mut().map(|artist| Ok(artist.frame(moment, size, cut)?.0));
        let drawn = drawn.collect::<Result<Vec<FrameRecord>>>()?;
        let beside = self.panels.iter().map(|(what, place)| match what {
            Beside::Picture(_) => displayed(&drawn[*place]),
            Beside::Error => difference(frame, &drawn[*place], &moment.camera),
        });
        let panels: Vec<_> = std::iter::once(displayed(frame)).chain(beside).collect();
        let width = size[0] as usize;
        let row = |row: usize| panels.iter().flat_map(move |panel| &panel[row * width..][..width]);
        Ok((0..size[1] as usize).flat_map(row).flatten().copied().collect())
    }
}

fn displayed(frame: &FrameRecord) -> Vec<[u8; 3]> {
    frame.colour.iter().map(|&linear| colour::tone_map(linear)).collect()
}

fn difference(frame: &FrameRecord, truth: &FrameRecord, camera: &Camera) -> Vec<[u8; 3]> {
    let ppd = colour::pixels_per_degree(camera, frame.size);
    colour::flip_picture(frame.size, &truth.colour, &frame.colour, ppd)
}
