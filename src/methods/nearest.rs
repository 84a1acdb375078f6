//! "Did you mean ...?"

/// The candidate nearest to a misspelt word, where one is near enough to be meant.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let limit = 1 + word.chars().count() / 3;
    let scored = candidates.into_iter().map(|candidate| (edits(word, candidate), candidate));
    let (distance, candidate) = scored.min_by_key(|(distance, _)| *distance)?;
    (distance <= limit).then_some(candidate)
}

/// The end of an error message about an unknown `word`: a guess, if any, and all that is valid.
pub fn valid_names<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> String {
    let candidates: Vec<&str> = candidates.into_iter().collect();
    let guess = nearest(word, candidates.iter().copied());
    let guess = guess.map(|name| format!("did you mean {name}? ")).unwrap_or_default();
    match candidates.as_slice() {
        [] => format!("{guess}there are none"),
        names => format!("{guess}valid: {}", names.join(", ")),
    }
}

/// Levenshtein's distance: insertions, deletions and substitutions of one character.
fn edits(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, y) in b.iter().enumerate() {
            let substituted = diagonal + usize::from(x != *y);
            diagonal = row[j + 1];
            row[j + 1] = substituted.min(row[j] + 1).min(row[j + 1] + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_levenshteins() {
        for (a, b, expected) in [("kitten", "sitting", 3), ("", "abc", 3), ("flaw", "lawn", 2)] {
            assert_eq!(edits(a, b), expected);
            assert_eq!(edits(b, a), expected);
        }
    }

    #[test]
    fn only_near_words_are_suggested() {
        let names = ["environment-map", "planar-mirror", "none"];
        assert_eq!(nearest("enviroment-map", names), Some("environment-map"));
        assert_eq!(nearest("mirror", names), None);
        assert_eq!(
            valid_names("nome", names),
            format!("did you mean none? valid: {}", names.join(", "))
        );
    }
}
