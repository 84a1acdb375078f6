//! What tobj reports without a line, or not at all: malformed and meaningless lines of OBJ files.

use glam::Vec3;

use super::source::Asset;
use crate::error::Result;

/// Elements met so far.
#[derive(Default)]
struct Counts {
    positions: Vec<Vec3>,
    texture_coordinates: usize,
    normals: usize,
}

/// What the loader needs to know beside what tobj tells it.
#[derive(Default)]
pub struct Facts {
    /// Names of the material libraries with the lines they stand in.
    pub libraries: Vec<(usize, String)>,
    /// Whether faces name normals; `None` without faces. Where faces name none, tobj gives them the
    /// first one of the file, which must not be used.
    pub with_normals: Option<bool>,
}

/// Checks every line.
///
/// # Errors
/// [`crate::error::Error::Scene`] with file and line: a number missing, malformed or not finite, a
/// face with an index out of range, with under three corners or without area, or normals on some
/// faces only.
pub fn check(asset: &Asset, text: &str) -> Result<Facts> {
    let mut counts = Counts::default();
    let mut facts = Facts::default();
    for (line, content) in text.lines().enumerate() {
        let fail = |message: String| asset.error(Some(line + 1), message);
        let mut words = content.split_whitespace();
        match words.next() {
            Some("v") => {
                let [x, y, z] = numbers(words).map_err(fail)?;
                counts.positions.push(Vec3::new(x, y, z));
            }
            Some("vt") => {
                numbers::<2>(words).map_err(fail)?;
                counts.texture_coordinates += 1;
            }
            Some("vn") => {
                let [x, y, z] = numbers(words).map_err(fail)?;
                if Vec3::new(x, y, z).try_normalize().is_none() {
                    return Err(fail("a normal of length 0; valid: any other length".to_owned()));
                }
                counts.normals += 1;
            }
            Some("f") => {
                let with_normals = check_face(words, &counts).map_err(fail)?;
                if *facts.with_normals.get_or_insert(with_normals) != with_normals {
                    let message = "normals on some faces only; valid: on all faces or on none";
                    return Err(fail(message.to_owned()));
                }
            }
            Some("mtllib") => facts.libraries.extend(words.map(|name| (line + 1, name.to_owned()))),
            _ => {}
        }
    }
    Ok(facts)
}

/// The first `N` numbers of a line.
fn numbers<'a, const N: usize>(
    mut words: impl Iterator<Item = &'a str>,
) -> std::result::Result<[f32; N], String> {
    let mut values = [0.0; N];
    for value in &mut values {
        let word = words.next().ok_or_else(|| format!("too few numbers; valid: {N}"))?;
        *value = word
            .parse()
            .ok()
            .filter(|v: &f32| v.is_finite())
            .ok_or_else(|| format!("`{word}` is not a finite number"))?;
    }
    Ok(values)
}

/// Checks a face; gives whether its corners name normals.
fn check_face<'a>(
    words: impl Iterator<Item = &'a str>,
    counts: &Counts,
) -> std::result::Result<bool, String> {
    let limits = [counts.positions.len(), counts.texture_coordinates, counts.normals];
    let mut corners = Vec::new();
    let mut normals = 0;
    for word in words {
        for (place, (index, count)) in word.split('/').zip(limits).enumerate() {
            if place == 1 && index.is_empty() {
                continue; // v//vn
            }
            let index = resolve(index, count)?;
            match place {
                0 => corners.push(counts.positions[index]),
                2 => normals += 1,
                _ => {}
            }
        }
    }
    let Some((&first, rest)) = corners.split_first().filter(|(_, rest)| rest.len() >= 2) else {
        return Err(format!("a face of {} corners; valid: 3 or more", corners.len()));
    };
    let area: Vec3 = rest.windows(2).map(|edge| (edge[0] - first).cross(edge[1] - first)).sum();
    let longest = rest.iter().map(|p| p.distance_squared(first)).fold(0.0, f32::max);
    if area.length() <= f32::EPSILON * longest {
        return Err("a face without area; valid: corners that are not on one line".to_owned());
    }
    match normals {
        0 => Ok(false),
        all if all == corners.len() => Ok(true),
        _ => Err("normals on some corners only; valid: on all corners or on none".to_owned()),
    }
}

/// An index counted from 1, or from the end where negative, as one from 0.
fn resolve(word: &str, count: usize) -> std::result::Result<usize, String> {
    let index: i64 = word.parse().map_err(|_| format!("`{word}` is not an index"))?;
    let resolved = if index < 0 { count as i64 + index } else { index - 1 };
    match usize::try_from(resolved) {
        Ok(resolved) if resolved < count => Ok(resolved),
        _ => Err(format!("index {index} is out of range; valid: 1 to {count}")),
    }
}
