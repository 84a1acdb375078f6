//! One pixel looked at closely: what it sees in truth, and what each case says it sees.

use serde::Serialize;

use super::lab::{Lab, TRUTH};
use crate::error::{Error, Result};
use crate::measure::{Class, accuracy};
use crate::methods::Case;
use crate::scene::{FrameRecord, NO_OBJECT, ObjectId, Scene, Status};
use crate::truth::{Cache, Tracer, TruthOptions};
use glam::Vec2;

/// The answer of `probe`. Positions in metres, world space.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Probe {
    pub scene: String,
    pub frame: u32,
    pub size: [u32; 2],
    pub pixel: [u32; 2],
    /// `None` where the pixel sees no reflector.
    pub mirror: Option<MirrorPoint>,
    /// The truth's first, then one a case.
    pub answers: Vec<Answer>,
}

/// Where the eye's ray meets the mirror.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MirrorPoint {
    pub reflector: String,
    /// The surface point, its unit normal and the unit mirrored direction.
    pub r: [f32; 3],
    pub n: [f32; 3],
    pub b: [f32; 3],
}

/// What one case shows in the pixel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Answer {
    pub case: String,
    /// missing, found or environment.
    pub status: String,
    /// The point shown, w = 1, or the direction, w = 0.
    pub s: [f32; 4],
    pub object: ObjectId,
    pub triangle: u32,
    /// Mirrors met on the way.
    pub order: u32,
    /// Path length from R; `None` for the environment.
    pub distance_m: Option<f32>,
    /// What is wrong with it.
    pub verdict: &'static str,
    /// How far from where it belongs; `None` where that is not defined.
    pub displacement_px: Option<f32>,
}

/// Draws the frame with every case and reads one pixel.
///
/// # Errors
/// [`Error::Usage`] for a pixel outside the picture or a frame outside the animation.
pub fn probe(
    lab: &Lab,
    scene: &Scene,
    cases: &[Case],
    number: u32,
    pixel: [u32; 2],
) -> Result<Probe> {
    let size = lab.settings.size;
    if pixel[0] >= size[0] || pixel[1] >= size[1] {
        let valid = format!("valid: 0,0 to {},{}", size[0] - 1, size[1] - 1);
        return Err(Error::Usage(format!("no pixel {},{}; {valid}", pixel[0], pixel[1])));
    }
    if number >= scene.frames {
        let last = scene.frames.saturating_sub(1);
        return Err(Error::Usage(format!("no frame {number}; valid: 0 to {last}")));
    }
    let at = (pixel[1] * size[0] + pixel[0]) as usize;
    let moment = scene.at(number);
    let tracer = Tracer::new(scene, &moment, TruthOptions::default());
    let truth = Cache::of_user()?.frame(&tracer, size)?;
    let mut answers = Vec::new();
    if truth.reflector[at] != NO_OBJECT {
        answers.push(answer(TRUTH, &truth, at, Class::Placed, Some(0.0)));
    }
    for case in cases {
        lab.progress.set_message(case.text.clone());
        let (frame, _) = lab.artist(scene, case, size)?.frame(&moment, size, true)?;
        let (_, maps) = accuracy(&truth, &only(&frame, at), &tracer)?;
        let displacement = Some(maps.displacement_px[at]).filter(|px| px.is_finite());
        answers.push(answer(&case.text, &frame, at, maps.class[at], displacement));
        lab.progress.inc(1);
    }
    let centre = Vec2::new(pixel[0] as f32 + 0.5, pixel[1] as f32 + 0.5);
    let incident = moment.camera.ray(size, centre).direction;
    let mirror = (truth.reflector[at] != NO_OBJECT).then(|| {
        let (r, n) = (truth.position[at], truth.normal[at]);
        let reflector = scene.objects[truth.reflector[at] as usize].name.clone();
        let b = incident.reflect(n);
        MirrorPoint { reflector, r: r.into(), n: n.into(), b: b.into() }
    });
    Ok(Probe { scene: scene.name.clone(), frame: number, size, pixel, mirror, answers })
}

/// The frame without its other reflector pixels: nothing but the one pixel is judged.
fn only(frame: &FrameRecord, at: usize) -> FrameRecord {
    let mut frame = frame.clone();
    let kept = frame.reflector[at];
    frame.reflector.fill(NO_OBJECT);
    frame.reflector[at] = kept;
    frame
}

fn answer(
    case: &str,
    frame: &FrameRecord,
    at: usize,
    class: Class,
    displacement_px: Option<f32>,
) -> Answer {
    let (record, ids) = (&frame.record, frame.record.ids[at]);
    let status = match ids.status() {
        Status::Missing => "missing",
        Status::Found => "found",
        Status::Environment => "environment",
    };
    let distance = record.last[at].w;
    Answer {
        case: case.to_owned(),
        status: status.to_owned(),
        s: record.point[at].into(),
        object: ids.object,
        triangle: ids.triangle,
        order: ids.order(),
        distance_m: (ids.status() == Status::Found).then_some(distance),
        verdict: verdict(class),
        displacement_px,
    }
}

/// A pixel's class in words.
fn verdict(class: Class) -> &'static str {
    match class {
        Class::Outside => "no mirror",
        Class::Footprint => "other mirror",
        Class::Missing => "missing",
        Class::Spurious => "spurious",
        Class::WrongObject => "wrong object",
        Class::WrongDepth => "wrong depth",
        Class::Unreachable => "unreachable",
        Class::Placed => "right",
    }
}
