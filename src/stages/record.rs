//! The reflection record on the GPU.

use std::sync::Arc;

use glam::{Vec3, Vec4};
use half::f16;

use crate::error::Result;
use crate::gpu::{Buffer, Device, Format, Frame, Image, Load, Pass, Shape};
use crate::scene::{self, Ids};

use super::FallbackStage;

/// What is written into the record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecordMode {
    /// Radiance only: what a renderer needs; for timing.
    Radiance,
    /// Radiance and the evidence: for accuracy.
    Full,
}

impl RecordMode {
    /// This mode, or the full one where the picture itself needs the evidence: how far what a mirror shows is,
    /// where it fades with that.
    pub fn enough_for(self, scene: &scene::Scene) -> RecordMode {
        if scene.fades() { RecordMode::Full } else { self }
    }

    /// The shader definitions of this mode.
    pub fn defines(self) -> Vec<(&'static str, u32)> {
        match self {
            RecordMode::Radiance => Vec::new(),
            RecordMode::Full => vec![("RECORD_FULL", 1)],
        }
    }

    /// Formats of the record's images as colour attachments, in the order of `@location`s.
    pub fn formats(self) -> &'static [Format] {
        const ALL: [Format; 4] =
            [Format::Rgba16Float, Format::Rgba32Float, Format::Rgba32Float, Format::Rgba32Uint];
        match self {
            RecordMode::Radiance => &ALL[..1],
            RecordMode::Full => &ALL,
        }
    }
}

/// Counters a method may have, and those of the fallback after them.
const COUNTERS: usize = FallbackStage::FIRST_COUNTER + FallbackStage::COUNTERS.len();

/// The images a method fills, see [`scene::ReflectionRecord`].
pub struct ReflectionRecord {
    /// Radiance; the fourth channel says whether and how surely the pixel was answered.
    pub radiance: Image,
    evidence: Option<Evidence>,
}

struct Evidence {
    point: Image,
    last: Image,
    ids: Image,
    /// Device-independent work, in the order of `MethodInfo::counters`; one buffer for each part of a
    /// hybrid.
    counters: Vec<Buffer>,
    /// The part whose work is counted now.
    part: usize,
}

impl ReflectionRecord {
    /// Images of `size` pixels; work is counted for each of `parts` methods.
    pub fn new(
        device: &Arc<Device>,
        size: [u32; 2],
        mode: RecordMode,
        parts: usize,
    ) -> Result<Self> {
        let image = |name: &str, format| Image::new(device, name, format, size, Shape::Flat);
        let evidence = match mode {
            RecordMode::Radiance => None,
            RecordMode::Full => Some(Evidence {
                point: image("record point", Format::Rgba32Float)?,
                last: image("record last point", Format::Rgba32Float)?,
                ids: image("record ids", Format::Rgba32Uint)?,
                counters: (0..parts).map(|_| counters(device)).collect::<Result<_>>()?,
                part: 0,
            }),
        };
        Ok(ReflectionRecord { radiance: image("record radiance", Format::Rgba16Float)?, evidence })
    }

    /// Nothing found anywhere, nothing counted.
    pub fn clear(&self, frame: &mut Frame) -> Result<()> {
        let zero = Load::Clear([0.0; 4]);
        let mut images = vec![("radiance", &self.radiance, zero)];
        if let Some(e) = &self.evidence {
            let missing = Ids::MISSING;
            let words = [missing.object, missing.triangle, missing.trace, missing.bits];
            images.push(("point", &e.point, zero));
            images.push(("last", &e.last, zero));
            images.push(("ids", &e.ids, Load::ClearWords(words)));
            let counters: Vec<&Buffer> = e.counters.iter().collect();
            frame.pass("record/clear-counters").fill(&counters, 0)?;
        }
        frame.pass("record/clear").clear(&images)
    }

    /// Count the work of a part of a hybrid from now on.
    pub fn count_for(&mut self, part: usize) {
        if let Some(e) = &mut self.evidence {
            e.part = part;
        }
    }

    /// Bind it to a compute pass.
    pub fn bind<'f>(&'f self, pass: Pass<'f>) -> Pass<'f> {
        let pass = pass.store("record_radiance", &self.radiance);
        match &self.evidence {
            None => pass,
            Some(e) => pass
                .store("record_point", &e.point)
                .store("record_last", &e.last)
                .store("record_ids", &e.ids)
                .buffer("counters", e.counters())
                .optional(),
        }
    }

    /// Bind its counters alone, to a compute pass that answers no pixel.
    pub fn bind_counters<'f>(&self, pass: Pass<'f>) -> Pass<'f> {
        match &self.evidence {
            None => pass,
            Some(e) => pass.buffer("counters", e.counters()).optional(),
        }
    }

    /// Bind where the last bounces happened and how long paths are, to a pass that reads them; not without
    /// evidence.
    pub fn bind_last<'f>(&'f self, pass: Pass<'f>) -> Pass<'f> {
        match &self.evidence {
            None => pass,
            Some(e) => pass.sample("last", &e.last).optional(),
        }
    }

    /// Attach it to a graphics pass, keeping what is there.
    pub fn attach<'f>(&'f self, pass: Pass<'f>) -> Pass<'f> {
        let pass = pass.colour("record_radiance", &self.radiance, Load::Keep);
        match &self.evidence {
            None => pass,
            Some(e) => pass
                .colour("record_point", &e.point, Load::Keep)
                .colour("record_last", &e.last, Load::Keep)
                .colour("record_ids", &e.ids, Load::Keep)
                .buffer("counters", e.counters())
                .optional(),
        }
    }

    /// Copy it to the host. Without evidence only the radiance is filled.
    pub fn read(&self) -> Result<scene::ReflectionRecord> {
        let radiance = self.radiance.read::<[f16; 4]>()?;
        let mut record = scene::ReflectionRecord::missing(radiance.len());
        record.radiance = radiance.iter().map(|&[r, g, b, _]| half_colour([r, g, b])).collect();
        if let Some(e) = &self.evidence {
            record.point = e.point.read::<Vec4>()?;
            record.last = e.last.read::<Vec4>()?;
            record.ids = e.ids.read::<Ids>()?;
        }
        Ok(record)
    }

    /// The counters of a part, as the last frame left them; none without evidence.
    pub fn counters(&self, part: usize) -> Result<Vec<u32>> {
        self.evidence.as_ref().map_or(Ok(Vec::new()), |e| e.counters[part].read())
    }
}

impl Evidence {
    fn counters(&self) -> &Buffer {
        &self.counters[self.part]
    }
}

fn counters(device: &Arc<Device>) -> Result<Buffer> {
    Buffer::storage(device, "record counters", 4 * COUNTERS as u64)
}

/// A colour of half floats.
pub(super) fn half_colour(c: [f16; 3]) -> Vec3 {
    Vec3::from(c.map(f16::to_f32))
}
