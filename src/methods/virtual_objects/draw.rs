//! Drawing what was found for one reflector into its pixels, or into those that show it in another.

use std::sync::Arc;

use super::rule::Rule;
use super::search::Found;
use super::second::Shown;
use super::split::Split;
use crate::error::Result;
use crate::gpu::{Device, Frame};
use crate::methods::reflected::Reflected;
use crate::methods::source::Source;
use crate::scene::ObjectId;
use crate::stages::{Footprint, GpuScene, RecordMode, ReflectionRecord, View};

/// The pipeline.
pub struct Drawing(Reflected);

/// What is drawn.
#[derive(Clone, Copy)]
pub struct Drawn<'a> {
    pub source: &'a Source,
    pub found: &'a Found,
    pub split: Option<&'a Split>,
    /// In what.
    pub reflector: ObjectId,
    /// The reflector that shows that one, where it is not the eye that sees it.
    pub first: Option<(ObjectId, &'a Shown)>,
}

impl Drawing {
    /// # Errors
    /// As of pipelines.
    pub fn new(device: &Arc<Device>, rule: &Rule, mode: RecordMode) -> Result<Drawing> {
        Reflected::new(device, mode, &rule.defines(mode), rule.residual_px).map(Drawing)
    }

    pub fn run(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        view: &View,
        record: &ReflectionRecord,
        what: Drawn,
    ) -> Result<()> {
        let Drawn { source, found, split, reflector, first } = what;
        let in_first = first.map_or(reflector, |(object, _)| object);
        let (name, mirrors) = ("virtual-objects", (reflector, in_first));
        let mut pass =
            self.0.pass(frame, scene, name, (view, record), mirrors, (source, &found.corners));
        if let Some(split) = split {
            pass = pass.buffer("owners", &source.owners).buffer("drawn", &split.drawn);
        }
        if let Some((_, shown)) = first {
            pass = shown.bind(pass);
        }
        pass.draw(|draw| {
            draw.stencil_reference(Footprint::stencil_of(in_first));
            match split {
                Some(split) => split.draw(draw),
                None => source.draw(draw, reflector),
            }
        })
    }
}
