//! The files of the harness import each other in one order.

use super::sources::{File, heads, product, tokens};

/// The files of the harness in the order in which they may import each other, from its prose.
fn order_in_the_harness(prose: &str) -> Vec<&str> {
    let list = prose.split("//! ```").nth(1).expect("a list");
    // The first word of a line says what its files are about.
    list.lines().skip(1).flat_map(|line| line.split_whitespace().skip(2)).collect()
}

#[test]
fn files_of_the_harness_import_only_those_before_them() {
    let files = File::all();
    let files = || files.iter().filter(|file| file.module() == "harness");
    let prose = files().find(|file| file.path.ends_with("harness/mod.rs")).expect("its prose");
    let order = order_in_the_harness(&prose.text);
    let place = |name: &str| order.iter().position(|listed| *listed == name);
    let (mut wrong, mut edges) = (Vec::new(), 0);
    for file in files().filter(|file| file.path != prose.path).map(product) {
        let part = file.path.components().nth(1).expect("a file").as_os_str().to_string_lossy();
        let own = part.trim_end_matches(".rs");
        let Some(own_place) = place(own) else {
            wrong.push(format!("{own} is not listed"));
            continue;
        };
        let tokens = tokens(&file.text);
        let inside = file.depth() - 1;
        for i in 0..tokens.len() {
            let follows = i > 0 && tokens[i - 1] == "::";
            let up = (0..inside).all(|n| {
                let at = i + 2 * n;
                tokens.get(at).is_some_and(|t| t == "super")
                    && tokens.get(at + 1).is_some_and(|t| t == "::")
            });
            let by_root =
                tokens[i..].starts_with(&["crate", "::", "harness", "::"].map(String::from));
            let from = if by_root { i + 4 } else { i + 2 * inside };
            if follows || !(by_root || up && inside > 0) {
                continue;
            }
            for other in heads(&tokens[from..]).iter().filter(|other| *other != own) {
                let Some(theirs) = place(other) else { continue };
                edges += 1;
                if theirs >= own_place {
                    wrong.push(format!("{} → {other}", file.name()));
                }
            }
        }
    }
    assert!(edges > 50, "{edges} edges were found");
    assert!(wrong.is_empty(), "imports that go back:\n{}", wrong.join("\n"));
}
