//! Lists as words and as groups.

/// Returns the words that are not empty, with this between any two.
pub fn joined<T: AsRef<str>>(words: impl IntoIterator<Item = T>, by: &str) -> String {
    let mut text = String::new();
    for word in words {
        add(&mut text, word.as_ref(), by);
    }
    text
}

fn add(text: &mut String, word: &str, by: &str) {
    if !word.is_empty() {
        text.push_str(if text.is_empty() { "" } else { by });
        text.push_str(word);
    }
}

/// Returns the items in groups of the same kind, in the order of their first items.
pub fn grouped<T>(
    items: impl IntoIterator<Item = T>,
    is_same: impl Fn(&T, &T) -> bool,
) -> Vec<Vec<T>> {
    let mut groups: Vec<Vec<T>> = Vec::new();
    for item in items {
        match groups.iter_mut().find(|group| is_same(&group[0], &item)) {
            Some(group) => group.push(item),
            None => groups.push(vec![item]),
        }
    }
    groups
}

/// Returns the number of things that a list of at most this length leaves out; `None` for none.
pub fn left_out(all: usize, maximum: usize) -> Option<usize> {
    all.checked_sub(maximum).filter(|&left| left > 0)
}
