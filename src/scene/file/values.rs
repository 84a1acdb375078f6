//! Numbers of a scene file that carry their own range: a value outside fails where it stands.

use std::fmt::Display;

use glam::Vec3;
use serde::Deserialize;

fn in_range(value: f64, valid: &str, is_valid: impl Fn(f64) -> bool) -> Result<f32, String> {
    let single = value as f32;
    if single.is_finite() && is_valid(value) { Ok(single) } else { Err(out_of_range(value, valid)) }
}

fn out_of_range(value: impl Display, valid: &str) -> String {
    format!("{value} is out of range; valid: {valid}")
}

/// Declares a number type with a range and its words.
macro_rules! number {
    ($(#[$doc:meta])* $name:ident, $valid:literal, $is_valid:expr) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
        #[serde(try_from = "f64")]
        pub struct $name(pub f32);

        impl TryFrom<f64> for $name {
            type Error = String;
            fn try_from(value: f64) -> Result<Self, String> {
                in_range(value, $valid, $is_valid).map($name)
            }
        }
    };
}

number!(Finite, "any finite number", |_| true);
number!(Positive, "1e-6 to 1e6", |v| (1e-6..=1e6).contains(&v));
number!(NotNegative, "0 or more", |v| v >= 0.0);
number!(Share, "0 to 1", |v| (0.0..=1.0).contains(&v));
number!(
    /// A refractive index against the outside's.
    Index, "0.2 to 5", |v| (0.2..=5.0).contains(&v)
);
number!(
    /// An opening angle in degrees.
    Opening, "1 to 170", |v| (1.0..=170.0).contains(&v)
);
number!(
    /// The angle between faces up to which an edge counts as smooth, degrees.
    Crease, "0 to 89", |v| (0.0..=89.0).contains(&v)
);
number!(
    /// A part of a full turn in degrees.
    Turn, "1 to 360", |v| (1.0..=360.0).contains(&v)
);
number!(
    /// The largest radiance kept of an image: half precision ends there.
    Cap, "1e-6 to 65504", |v| (1e-6..=65504.0).contains(&v)
);

/// A whole number from `MIN` to `MAX`.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(try_from = "i64")]
pub struct Whole<const MIN: u32, const MAX: u32>(pub u32);

impl<const MIN: u32, const MAX: u32> TryFrom<i64> for Whole<MIN, MAX> {
    type Error = String;
    fn try_from(value: i64) -> Result<Self, String> {
        match u32::try_from(value) {
            Ok(whole) if (MIN..=MAX).contains(&whole) => Ok(Whole(whole)),
            _ => Err(out_of_range(value, &format!("{MIN} to {MAX}"))),
        }
    }
}

/// A point, direction or triple of angles.
pub type Triple = [Finite; 3];
/// Linear Rec.709.
pub type Colour = [NotNegative; 3];

pub fn triple(t: Triple) -> Vec3 {
    Vec3::from(t.map(|c| c.0))
}

pub fn colour(c: Colour) -> Vec3 {
    Vec3::from(c.map(|c| c.0))
}
