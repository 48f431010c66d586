//! Text of JSON to and from types, by one writer and one reader.
//!
//! Serde compiles the whole tree of a type again for every form that it is written in and every source that it is read
//! from. Here types are written as one line, which is broken into lines as text, and are read from a [`Value`].

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

/// Returns a value as JSON with one line for each number, word, list and object.
///
/// # Errors
///
/// The value has keys that are no words.
pub fn pretty(value: &impl Serialize) -> serde_json::Result<String> {
    Ok(indented(&serde_json::to_string(value)?))
}

/// Reads a value.
///
/// # Errors
///
/// The text is no JSON, or its content is not that of the type.
pub fn read<T: DeserializeOwned>(text: &[u8]) -> serde_json::Result<T> {
    serde_json::from_value(serde_json::from_slice::<Value>(text)?)
}

/// Breaks JSON of one line into lines, in the form of [`serde_json::to_string_pretty`].
fn indented(text: &str) -> String {
    let mut lines = String::with_capacity(2 * text.len());
    let (mut depth, mut is_open) = (0, false);
    let (mut in_word, mut is_escaped) = (false, false);
    for sign in text.chars() {
        if in_word {
            lines.push(sign);
            in_word = is_escaped || sign != '"';
            is_escaped = !is_escaped && sign == '\\';
            continue;
        }
        let is_end = matches!(sign, ']' | '}');
        if is_end {
            depth -= 1;
        }
        // Lists and objects without content stay as they are.
        if is_open != is_end {
            begin_line(&mut lines, depth);
        }
        lines.push(sign);
        is_open = matches!(sign, '[' | '{');
        match sign {
            '[' | '{' => depth += 1,
            ',' => begin_line(&mut lines, depth),
            ':' => lines.push(' '),
            '"' => in_word = true,
            _ => {}
        }
    }
    lines
}

fn begin_line(lines: &mut String, depth: usize) {
    lines.push('\n');
    lines.extend(std::iter::repeat_n("  ", depth));
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;

    #[test]
    fn lines_are_those_of_the_library() {
        let values = [
            json!([]),
            json!({}),
            json!(-0.0),
            json!("a \"word\": [1, 2], {3} \\"),
            json!([[], {}, [[]], "", "\\", "\n\u{7}é"]),
            json!({ "a": [1, 2.5e-300, null], "b,": { "c:": {}, "\"": [true, "\\\""] }, "d": [{}] }),
        ];
        for value in values {
            let lines = pretty(&value).expect("lines");
            assert_eq!(lines, serde_json::to_string_pretty(&value).expect("lines"));
            assert_eq!(read::<Value>(lines.as_bytes()).expect("a value"), value);
        }
    }

    #[test]
    fn a_text_of_another_type_is_not_read() {
        assert_eq!(read::<Vec<f64>>(b"[1, -0.0, 1e300]").expect("numbers"), [1.0, -0.0, 1e300]);
        assert!(read::<Vec<f64>>(b"{}").is_err());
        assert!(read::<Vec<f64>>(b"[1").is_err());
    }
}
