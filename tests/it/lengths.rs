//! Files are short enough to be read as a unit.

use std::path::Path;

/// Maximum number of lines of a file.
const MAX_LINES: usize = 500;

fn visit(folder: &Path, long: &mut Vec<String>, files: &mut usize) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            visit(&path, long, files);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let lines = std::fs::read_to_string(&path).expect("a text").lines().count();
            *files += 1;
            if lines > MAX_LINES {
                long.push(format!("{}: {lines} lines", path.display()));
            }
        }
    }
}

#[test]
fn no_file_is_long() {
    let (mut long, mut files) = (Vec::new(), 0);
    for folder in ["src", "crates", "tests", "benches", "bindings"] {
        visit(&Path::new(env!("CARGO_MANIFEST_DIR")).join(folder), &mut long, &mut files);
    }
    assert!(files > 300, "the sources were not found");
    assert!(long.is_empty(), "files above {MAX_LINES} lines:\n{}", long.join("\n"));
}
