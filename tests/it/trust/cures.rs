//! Every error message ends in a cure. Messages about case files are tested with random mistakes (`properties`).

use super::{files, read};
use crate::common::none;

/// Beginnings of messages without a cure: an encoder or the system failed, or the message ends in another error's.
const NONE: [&str; 14] = [
    "cannot encode {name} as csv",
    "cannot encode as json: {0}",
    "cannot encode truth.json: {0}",
    "cannot draw {figure}: {message}",
    "a record of form {actual}",
    "not a record, or a broken one",
    "{case} cannot be exported: theory has no answer",
    "{path}: no case file (*.toml)",
    "{} in {}",
    "{case}: `{estimator}`",
    "check `{}`: ",
    "the estimator panicked in draw {draw}",
    "{what} takes {expected}, but was given {}",
    "needs {needs}, but {actual}",
];

/// Returns the messages of the error types in a source text: the format strings of `#[error("…")]`, and those that
/// `Display` of a type named `…Error` or `…Fault` writes.
fn messages(text: &str) -> Vec<String> {
    let displays = text.split("impl fmt::Display for ").skip(1).filter_map(|rest| {
        let (name, body) = rest.split_once(" {")?;
        let is_error = name.ends_with("Error") || name.ends_with("Fault");
        is_error.then(|| body.split("\n}\n").next().unwrap_or(body))
    });
    let written = displays.flat_map(|body| {
        let calls = body.split("write!(").skip(1).chain(body.split("f.write_str(").skip(1));
        calls.map(|call| call.trim_start().trim_start_matches("f,").trim_start())
    });
    let attributes = text.split("#[error(").skip(1).map(str::trim_start);
    let quoted = attributes.chain(written).filter_map(|rest| rest.strip_prefix('"'));
    let strings = quoted.filter_map(|rest| {
        let ends = rest.match_indices('"').find(|&(at, _)| !rest[..at].ends_with('\\'));
        ends.map(|(at, _)| rest[..at].to_owned())
    });
    strings.collect()
}

#[test]
fn every_error_message_ends_in_a_cure() {
    let (mut wrong, mut found, mut used) = (Vec::new(), 0, [false; NONE.len()]);
    for path in ["src", "crates"].into_iter().flat_map(files) {
        if path.extension().is_none_or(|ending| ending != "rs") {
            continue;
        }
        // Reasons of verdicts are not errors.
        if path.ends_with("session/reason.rs") {
            continue;
        }
        let name = path.to_string_lossy().into_owned();
        for message in messages(&read(&name)) {
            found += 1;
            let cure = message.rsplit_once("; ").map_or("", |(_, cure)| cure);
            if !cure.is_empty() {
                continue;
            }
            match NONE.iter().position(|start| message.starts_with(start)) {
                Some(known) => used[known] = true,
                None => wrong.push(format!("{name}: {message}")),
            }
        }
    }
    none(&wrong);
    assert!(found > 50, "only {found} messages were found");
    let unused: Vec<&str> =
        NONE.iter().zip(used).filter(|(_, used)| !used).map(|(start, _)| *start).collect();
    assert!(unused.is_empty(), "these have a cure, or are gone; leave them out: {unused:?}");
}
