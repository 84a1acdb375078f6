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

/// Checks every line; gives the names of the material libraries with their lines.
///
/// # Errors
/// [`crate::error::Error::Scene`] with file and line: a number missing, malformed or not finite, a
/// face with an index out of range, with under three corners or without area.
pub fn check(asset: &Asset, text: &str) -> Result<Vec<(usize, String)>> {
    let mut counts = Counts::default();
    let mut libraries = Vec::new();
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
            Some("f") => check_face(words, &counts).map_err(fail)?,
            Some("mtllib") => libraries.extend(words.map(|name| (line + 1, name.to_owned()))),
            _ => {}
        }
    }
    Ok(libraries)
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

fn check_face<'a>(
    words: impl Iterator<Item = &'a str>,
    counts: &Counts,
) -> std::result::Result<(), String> {
    let limits = [counts.positions.len(), counts.texture_coordinates, counts.normals];
    let mut corners = Vec::new();
    for word in words {
        for (place, (index, count)) in word.split('/').zip(limits).enumerate() {
            if place == 1 && index.is_empty() {
                continue; // v//vn
            }
            let index = resolve(index, count)?;
            if place == 0 {
                corners.push(counts.positions[index]);
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
    Ok(())
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
