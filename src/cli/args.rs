//! The flags that commands share, and the values they take.

use std::ops::Range;
use std::path::PathBuf;
use std::str::FromStr;

use clap::Args;

use crate::error::{Error, Result};
use crate::experiment::engine::{Fallback, RecordMode};
use crate::scene::Scene;

/// Flags of every command that draws.
#[derive(Args, Clone, Debug)]
pub struct Common {
    /// Folder for the results [default: out/<scene>/<case>]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Vulkan device: auto, cpu, part of a name, or an index of `list devices`
    #[arg(long, default_value = "auto", value_name = "WHICH")]
    pub device: String,
    /// Picture size in pixels, 16x16 to 16384x16384
    #[arg(long, default_value = "1280x720", value_name = "WxH")]
    pub size: Size,
    /// What fills pixels a method left missing or flagged
    #[arg(long, default_value = "none", value_name = "none|environment|ray", value_parser = fallback)]
    pub fallback: Fallback,
    /// What timed frames write; accuracy always needs full
    #[arg(long, default_value = "radiance", value_name = "radiance|full", value_parser = record)]
    pub record: RecordMode,
    /// Seed of everything random
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Write the images that passes of this name store (`*` and `?` match) to DIR/dump; PASS:VARIABLE writes such an
    /// image alone, or a buffer that such a pass uses, as .npy of 32-bit words
    #[arg(long, value_name = "GLOB")]
    pub dump: Vec<String>,
    /// Read shaders from this folder instead of from the program
    #[arg(long, value_name = "DIR")]
    pub shader_dir: Option<PathBuf>,
    /// Turn the Vulkan validation layers on; a message from them ends in exit code 5
    #[arg(long)]
    pub vulkan_validation: bool,
    /// One JSON object a line on stdout; text for people goes to stderr
    #[arg(long)]
    pub json: bool,
}

fn fallback(text: &str) -> Result<Fallback, String> {
    named(text, &Fallback::NAMES)
}

fn record(text: &str) -> Result<RecordMode, String> {
    named(text, &RecordMode::NAMES)
}

fn named<T: Copy>(text: &str, names: &[(&str, T)]) -> Result<T, String> {
    let found = names.iter().find(|(name, _)| *name == text);
    let valid = || names.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ");
    found.map(|(_, value)| *value).ok_or_else(|| format!("valid: {}", valid()))
}

/// `WxH`, pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size(pub [u32; 2]);

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let sides = text.split_once('x').map(|(w, h)| [w, h].map(|n| n.parse::<u32>().ok()));
        match sides {
            Some([Some(w), Some(h)]) if [w, h].iter().all(|n| (16..=16384).contains(n)) => {
                Ok(Size([w, h]))
            }
            _ => Err("valid: WIDTHxHEIGHT, each 16 to 16384, for instance 1280x720".into()),
        }
    }
}

/// `A..B`: frames of the scene's animation, B not included.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frames(pub Range<u32>);

impl FromStr for Frames {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let ends = text.split_once("..").map(|(a, b)| [a, b].map(|n| n.parse::<u32>().ok()));
        match ends {
            Some([Some(a), Some(b)]) if a < b => Ok(Frames(a..b)),
            _ => Err("valid: A..B with A below B, for instance 0..60".into()),
        }
    }
}

/// The frames of `scene` in `range`, or all.
///
/// # Errors
/// [`Error::Usage`] where the animation is shorter.
pub fn frames_of(scene: &Scene, range: Option<&Frames>) -> Result<Range<u32>> {
    let range = range.map_or(0..scene.frames, |Frames(range)| range.clone());
    if range.end > scene.frames {
        return Err(Error::Usage(format!(
            "scene {} has no frame {}; valid: 0 to {}",
            scene.name,
            range.end - 1,
            scene.frames.saturating_sub(1)
        )));
    }
    Ok(range)
}

/// `METHOD.key=a,b,c`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Vary {
    pub method: String,
    pub key: String,
    pub values: Vec<String>,
}

impl FromStr for Vary {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.split_once('=').and_then(|(name, values)| {
            let (method, key) = name.rsplit_once('.')?;
            let values: Vec<String> = values.split(',').map(|v| v.trim().to_owned()).collect();
            let whole =
                !method.is_empty() && !key.is_empty() && values.iter().all(|v| !v.is_empty());
            whole.then(|| Vary { method: method.to_owned(), key: key.to_owned(), values })
        });
        parts.ok_or_else(|| {
            "valid: METHOD.key=a,b,c, for instance environment-map.index=direction,surface".into()
        })
    }
}

/// `X,Y`: a pixel, from the top left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pixel(pub [u32; 2]);

impl FromStr for Pixel {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once(',').map(|(x, y)| [x, y].map(|n| n.trim().parse::<u32>().ok())) {
            Some([Some(x), Some(y)]) => Ok(Pixel([x, y])),
            _ => Err("valid: X,Y, for instance 640,360".into()),
        }
    }
}

/// `I/N`: part I of N, from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    pub index: usize,
    pub count: usize,
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once('/').map(|(i, n)| [i, n].map(|n| n.parse::<usize>().ok())) {
            Some([Some(index), Some(count)]) if (1..=count).contains(&index) => {
                Ok(Shard { index, count })
            }
            _ => Err("valid: I/N with I from 1 to N, for instance 2/8".into()),
        }
    }
}

/// A share, `0.01` or `1%`, as a number from 0 to 1.
pub fn share(text: &str) -> Result<f64, String> {
    let number = match text.strip_suffix('%') {
        Some(percent) => percent.parse::<f64>().map(|p| p / 100.0),
        None => text.parse::<f64>(),
    };
    let valid = number.ok().filter(|share| (0.0..=1.0).contains(share));
    valid.ok_or_else(|| "valid: a share from 0 to 1, or from 0% to 100%".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_parse_or_say_what_is_valid() {
        assert_eq!("1280x720".parse(), Ok(Size([1280, 720])));
        for bad in ["1280", "0x5", "16385x16", "ax b", "-16x16", "1280X720"] {
            assert!(bad.parse::<Size>().unwrap_err().contains("valid"), "{bad}");
        }
        assert_eq!("3..9".parse(), Ok(Frames(3..9)));
        for bad in ["3", "9..3", "3..3", "..", "3...9"] {
            assert!(bad.parse::<Frames>().is_err(), "{bad}");
        }
        let vary = Vary {
            method: "z-buffered-map".into(),
            key: "layers".into(),
            values: vec!["1".into(), "2".into()],
        };
        assert_eq!("z-buffered-map.layers=1,2".parse(), Ok(vary));
        for bad in ["layers=1", "m.=1", ".k=1", "m.k=", "m.k=1,,2", "m.k"] {
            assert!(bad.parse::<Vary>().is_err(), "{bad}");
        }
        assert_eq!("640,360".parse(), Ok(Pixel([640, 360])));
        assert_eq!("2/8".parse(), Ok(Shard { index: 2, count: 8 }));
        for bad in ["0/8", "9/8", "1", "1/0"] {
            assert!(bad.parse::<Shard>().is_err(), "{bad}");
        }
        assert_eq!((share("1%"), share("0.25")), (Ok(0.01), Ok(0.25)));
        for bad in ["-1", "101%", "nan", "x"] {
            assert!(share(bad).is_err(), "{bad}");
        }
        assert_eq!(fallback("environment"), Ok(Fallback::Environment));
        assert_eq!(fallback("rays"), Err("valid: none, environment, ray".into()));
        assert_eq!(record("ful"), Err("valid: radiance, full".into()));
    }
}
