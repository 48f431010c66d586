//! How the house is built: floors, the order of the harness, what draws may call, and how long files are.

mod calls;
mod floors;
mod harness;
mod sources;

use std::collections::BTreeMap;

use self::sources::File;

/// A file of more lines is two files.
const LONGEST: usize = 400;

#[test]
fn no_file_is_long() {
    let mut long = Vec::new();
    for folder in ["src", "tests", "benches"] {
        for file in File::below(folder) {
            let lines = file.text.lines().count();
            if lines > LONGEST {
                long.push(format!("{folder}/{}: {lines} lines", file.name()));
            }
        }
    }
    assert!(long.is_empty(), "files above {LONGEST} lines:\n{}", long.join("\n"));
}

#[test]
fn most_files_are_a_page_and_no_room_is_the_house() {
    let mut lines = Vec::new();
    let mut rooms = BTreeMap::<String, usize>::new();
    for file in File::all() {
        let count = file.text.lines().count();
        lines.push(count);
        *rooms.entry(file.module()).or_default() += count;
    }
    lines.sort_unstable();
    let (median, all) = (lines[lines.len() / 2], lines.iter().sum::<usize>());
    assert!(median <= 150, "half of the files have more than {median} lines");
    for (room, lines) in rooms {
        assert!(5 * lines <= all, "{room} has {lines} of {all} lines");
    }
}
