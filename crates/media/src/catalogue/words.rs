//! Wording of messages: ranges, lists of names, and the name that was probably meant.

use std::ops::RangeInclusive;

use strsim::osa_distance;

/// A range of counts in words.
pub fn whole(range: &RangeInclusive<u64>) -> String {
    format!("a whole number from {} to {}", range.start(), range.end())
}

/// Words in back ticks, with commas between them.
pub fn quoted<S: AsRef<str>>(words: &[S]) -> String {
    let words: Vec<String> = words.iter().map(|word| format!("`{}`", word.as_ref())).collect();
    words.join(", ")
}

/// "did you mean" if there is a similar known word, else the whole list.
pub fn suggestion(written: &str, words: &[&str], otherwise: &str) -> String {
    let near = words.iter().map(|word| (osa_distance(written, word), word)).min();
    match near {
        Some((edits, word)) if edits <= 1 + written.len() / 4 => {
            format!("did you mean `{word}`? ({otherwise})")
        }
        _ => otherwise.to_owned(),
    }
}

/// Words of other programs and papers, and the keys of case files for the same thing, the likeliest first.
const SYNONYMS: [(&[&str], &[&str]); 13] = [
    (
        &["sigma", "sigma-hat", "majorant", "mu-bar", "sigma-max", "sigma-bar", "rate"],
        &["sampling"],
    ),
    (
        &["sigma", "sigma-t", "mu-t", "mu", "density", "sigma-maj", "attenuation"],
        &["extinction", "medium", "volume"],
    ),
    (&["sigma-c", "mu-c", "control-variate"], &["control"]),
    (&["value", "sigma-t", "values"], &["extinction", "medium", "volume"]),
    (&["field", "media", "grid", "profile"], &["medium", "volume"]),
    (&["omega", "a", "single-scattering-albedo", "sigma-s"], &["albedo", "albedos"]),
    (&["g", "phase-function", "anisotropy"], &["g", "phase"]),
    (&["estimator", "trackers", "methods", "algorithms"], &["estimators"]),
    (&["samples", "spp", "paths", "n"], &["draws"]),
    (&["length", "range", "interval", "extent"], &["span", "ray"]),
    (&["eps", "epsilon", "tolerances"], &["tolerance"]),
    (&["name", "description"], &["title"]),
    (&["bound", "aabb", "bbox", "bounding-box"], &["bounds"]),
];

/// The key of a table that was probably meant: a similar one, or a synonym.
pub fn meant(written: &str, keys: &[&str], otherwise: &str) -> String {
    let plain = written.to_lowercase().replace('_', "-");
    let named = SYNONYMS.iter().filter(|(words, _)| words.contains(&plain.as_str()));
    let mut known = named.flat_map(|(_, meant)| meant.iter()).filter(|key| keys.contains(key));
    match known.next() {
        Some(key) => format!("did you mean `{key}`? ({otherwise})"),
        None => suggestion(written, keys, otherwise),
    }
}

/// The beginning of a text that is too long for a message.
pub fn brief(text: &str) -> String {
    const MAX_LETTERS: usize = 60;
    let mut letters = text.chars();
    let beginning: String = letters.by_ref().take(MAX_LETTERS).collect();
    if letters.next().is_some() { beginning + "…" } else { beginning }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_that_changed_places_are_one_mistake() {
        assert_eq!(suggestion("medai", &["mean", "media"], "x"), "did you mean `media`? (x)");
    }
}
