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

impl Scene {
    /// The groups that the given objects are parts of, in the order they first appear, each with all its
    /// reflectors if given some, and all else if given that, rising: parts of one thing share a map, and none
    /// stands in it, whoever serves the others.
    pub fn groups(&self, objects: &[ObjectId]) -> Vec<(String, Vec<ObjectId>)> {
        let kind = |id: ObjectId| (&self.objects[id as usize].group, self.is_reflector(id));
        let mut groups: Vec<(String, Vec<ObjectId>)> = Vec::new();
        for &id in objects {
            if groups.iter().all(|(_, members)| !members.contains(&id)) {
                let all = 0..self.objects.len() as ObjectId;
                let members = all.filter(|&other| kind(other) == kind(id)).collect();
                groups.push((kind(id).0.clone(), members));
            }
        }
        groups
    }
}

/// Whether `text` matches `pattern`: `*` stands for any characters, `?` for one.
pub fn matches_pattern(pattern: &str, text: &str) -> bool {
    let text: Vec<char> = text.chars().collect();
    // reachable[j]: the pattern so far matches the first j characters.
    let mut reachable = vec![false; text.len() + 1];
    reachable[0] = true;
    for symbol in pattern.chars() {
        if symbol == '*' {
            let first = reachable.iter().position(|r| *r).unwrap_or(reachable.len());
            reachable[first..].fill(true);
        } else {
            for j in (1..=text.len()).rev() {
                reachable[j] = reachable[j - 1] && (symbol == '?' || symbol == text[j - 1]);
            }
            reachable[0] = false;
        }
    }
    reachable[text.len()]
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
