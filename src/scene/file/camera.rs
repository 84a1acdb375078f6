//! The camera's key frames or orbit.

use glam::Vec3;
use toml::Spanned;

use super::build::rising;
use super::format::{CameraFile, CameraKeyFile, Span};
use super::source::Source;
use super::values::triple;
use crate::error::Result;
use crate::geometry::{Camera, Projection};
use crate::scene::CameraPath;

/// Depths drawn where a scene file names none, metres.
const NEAR: f32 = 0.02;
const FAR: f32 = 200.0;

/// The path of a camera at `rate_hz` frames a second.
pub fn path(source: &Source, spanned: &Spanned<CameraFile>, rate_hz: f32) -> Result<CameraPath> {
    let (span, file) = (spanned.span(), spanned.get_ref());
    let fail = |message: String| Err(source.error(&span, message));
    let projection = match (file.fov_deg, file.height) {
        (Some(fov), None) => Projection::Perspective { fov_y: fov.0.to_radians() },
        (None, Some(height)) => Projection::Orthographic { height: height.0 },
        _ => return fail("a camera needs one projection; valid: fov_deg or height".to_owned()),
    };
    let (near, far) = (file.near.map_or(NEAR, |n| n.0), file.far.map_or(FAR, |f| f.0));
    if near >= far {
        return fail(format!("near = {near} is out of range; valid: below far = {far}"));
    }
    let at = |eye: Vec3, target: Vec3| Camera { eye, target, up: Vec3::Y, projection, near, far };
    match (file.eye, file.target, &file.keys, &file.orbit) {
        (None, None, Some(keys), None) => {
            let convert = |key: &CameraKeyFile| {
                (key.time_s.0 * rate_hz, at(triple(key.eye), triple(key.target)))
            };
            for key in keys {
                let value = key.get_ref();
                check_direction(source, &key.span(), triple(value.eye), triple(value.target))?;
            }
            let keys = rising(source, &span, keys, |key| key.time_s.0, convert)?;
            Ok(CameraPath::Keys(keys))
        }
        (Some(eye), Some(target), None, orbit) => {
            let camera = at(triple(eye), triple(target));
            check_direction(source, &span, camera.eye, camera.target)?;
            Ok(match orbit {
                None => CameraPath::Keys(vec![(0.0, camera)]),
                Some(orbit) => CameraPath::Orbit {
                    camera,
                    start: orbit.start_deg.0.to_radians(),
                    period: orbit.period_s.0 * rate_hz,
                    sweep: orbit.sweep_deg.map(|sweep| sweep.0.to_radians()),
                },
            })
        }
        _ => fail(
            "a camera needs one path; valid: eye and target (with orbit or without), or keys"
                .to_owned(),
        ),
    }
}

/// The picture's up direction is undefined for a camera that looks straight up or down.
fn check_direction(source: &Source, span: &Span, eye: Vec3, target: Vec3) -> Result<()> {
    let forward = (target - eye).try_normalize();
    match forward {
        Some(forward) if forward.y.abs() < 0.99999 => Ok(()),
        _ => Err(source.error(
            span,
            "the camera looks nowhere or straight up or down; valid: a target beside the eye",
        )),
    }
}
