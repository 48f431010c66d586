//! README and manual: every link has a target, every page is in the table of contents, every case file shown can be
//! read, and every command shown is valid.

use super::{manual, read, root, trueflight};
use crate::common::{none, source};
use trueflight::case::Case;

/// Returns the contents of the blocks in a language.
fn blocks<'a>(text: &'a str, language: &str) -> Vec<&'a str> {
    let fence = format!("```{language}\n");
    let from_fence = text.split(fence.as_str()).skip(1);
    from_fence.filter_map(|rest| rest.split("```").next()).collect()
}

#[test]
fn every_link_leads_somewhere() {
    let mut wrong = Vec::new();
    for (page, text) in manual() {
        let folder = root().join(&page);
        let folder = folder.parent().expect("a folder");
        for target in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let file = target.split('#').next().unwrap_or_default();
            let is_here = !file.is_empty() && !file.contains("://") && !file.contains(' ');
            if is_here && !folder.join(file).exists() {
                wrong.push(format!("{page}: {target}"));
            }
        }
    }
    none(&wrong);
}

#[test]
fn every_page_is_in_the_table_of_contents() {
    let contents = read("docs/SUMMARY.md");
    let pages =
        manual().into_iter().filter_map(|(page, _)| page.strip_prefix("docs/").map(str::to_owned));
    let missing =
        pages.filter(|name| name != "SUMMARY.md" && !contents.contains(&format!("({name})")));
    none(&missing.collect::<Vec<_>>());
}

#[test]
fn the_first_pages_are_short() {
    for (page, most) in [("README.md", 250), ("ARCHITECTURE.md", 120)] {
        let lines = read(page).lines().count();
        assert!(lines <= most, "{page} has {lines} lines, of at most {most}");
    }
}

#[test]
fn every_case_file_shown_can_be_read() {
    let (mut wrong, mut read) = (Vec::new(), 0);
    for (page, text) in manual() {
        for block in blocks(&text, "toml").into_iter().filter(|block| block.contains("[problem.")) {
            read += 1;
            if let Err(error) = Case::read(&source("shown", block)) {
                wrong.push(format!("{page}: {}", error.render(false)));
            }
        }
    }
    none(&wrong);
    assert!(read >= 5, "only {read} cases are shown");
}

/// With `--help` at its end a command is only parsed.
#[test]
fn every_command_shown_is_one() {
    let (mut wrong, mut parsed) = (Vec::new(), 0);
    for (page, text) in manual() {
        for line in blocks(&text, "console").into_iter().flat_map(str::lines) {
            let Some((_, command)) = line.split_once("trueflight ") else { continue };
            let command = command.split(['#', '|', ';', '>']).next().unwrap_or_default();
            if !line.starts_with('$') || line.contains("cargo install") {
                continue;
            }
            let words = command.split_whitespace().map(|word| word.trim_matches(['"', '\'']));
            let output = trueflight(&words.chain(["--help"]).collect::<Vec<_>>());
            parsed += 1;
            if !output.status.success() {
                let error = String::from_utf8_lossy(&output.stderr).into_owned();
                wrong.push(format!("{page}: {line}: {error}"));
            }
        }
    }
    none(&wrong);
    assert!(parsed >= 15, "only {parsed} commands are shown");
}
