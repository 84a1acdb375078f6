//! Counting and choosing objects.

use super::{ObjectId, Scene};

impl Scene {
    /// Triangles drawn: shared meshes count once an object.
    pub fn triangles(&self) -> usize {
        self.objects.iter().map(|object| self.meshes[object.mesh].triangles.len()).sum()
    }

    /// Vertices drawn: shared meshes count once an object.
    pub fn vertices(&self) -> usize {
        self.objects.iter().map(|object| self.meshes[object.mesh].positions.len()).sum()
    }

    /// The objects whose name or group matches `pattern`, in rising order.
    pub fn select(&self, pattern: &str) -> Vec<ObjectId> {
        let matches = |id: &ObjectId| {
            let object = &self.objects[*id as usize];
            matches_pattern(pattern, &object.name) || matches_pattern(pattern, &object.group)
        };
        (0..self.objects.len() as ObjectId).filter(matches).collect()
    }
}

/// Whether `text` matches `pattern`: `*` stands for any characters, `?` for one.
pub fn matches_pattern(pattern: &str, text: &str) -> bool {
    let mut pattern_chars = pattern.chars();
    match pattern_chars.next() {
        None => text.is_empty(),
        Some('*') => {
            let rest = pattern_chars.as_str();
            let tails = text.char_indices().map(|(start, _)| &text[start..]).chain([""]);
            tails.into_iter().any(|tail| matches_pattern(rest, tail))
        }
        Some(expected) => {
            let mut text_chars = text.chars();
            text_chars.next().is_some_and(|found| expected == '?' || expected == found)
                && matches_pattern(pattern_chars.as_str(), text_chars.as_str())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::matches_pattern;

    #[test]
    fn wildcards() {
        for (pattern, text, expected) in [
            ("*", "", true),
            ("*", "teapot.body", true),
            ("teapot.*", "teapot.body", true),
            ("teapot.*", "teapot", false),
            ("*.b?dy", "teapot.body", true),
            ("?", "", false),
            ("sphere", "sphere-2", false),
            ("*o*o*", "columns-dolly", true),
        ] {
            assert_eq!(matches_pattern(pattern, text), expected, "{pattern} on {text}");
        }
    }
}
