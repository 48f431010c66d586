//! README and manual: every link has a target, every page is in the table of contents, every case file shown can be
//! read, and every command shown is valid.

use super::{files, manual, read, root, trueflight};
use crate::common::{none, source};
use trueflight::case::Case;

/// Returns the contents of the blocks in a language.
fn blocks<'a>(text: &'a str, language: &str) -> Vec<&'a str> {
    let fence = format!("```{language}\n");
    let from_fence = text.split(fence.as_str()).skip(1);
    from_fence.filter_map(|rest| rest.split("```").next()).collect()
}

/// Returns the anchors of the headings of a page, as GitHub and mdBook name them.
fn anchors(page: &std::path::Path) -> impl Iterator<Item = String> {
    let text = std::fs::read_to_string(page).unwrap_or_default();
    let headings: Vec<String> =
        text.lines().filter(|line| line.starts_with('#')).map(str::to_owned).collect();
    headings.into_iter().map(|line| {
        let words = line.trim_start_matches('#').trim().to_lowercase();
        let kept = words.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
        kept.map(|c| if c == ' ' { '-' } else { c }).collect()
    })
}

#[test]
fn every_link_leads_somewhere() {
    let mut wrong = Vec::new();
    for (page, text) in manual() {
        let folder = root().join(&page);
        let folder = folder.parent().expect("a folder");
        for target in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
            if file.contains("://") || target.contains(' ') {
                continue;
            }
            let path = if file.is_empty() { root().join(&page) } else { folder.join(file) };
            let has_anchors = path.extension().is_some_and(|end| end == "md");
            let is_there =
                anchor.is_empty() || !has_anchors || anchors(&path).any(|name| name == anchor);
            if !path.exists() || !is_there {
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
    for (page, most) in [("README.md", 200), ("ARCHITECTURE.md", 120)] {
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

/// Every workflow is shown whole on a page, takes actions by their commits and machines by their versions, and its commands
/// are valid.
#[test]
fn workflows_are_shown_pinned_and_valid() {
    let (mut wrong, mut parsed) = (Vec::new(), 0);
    let pages = manual();
    for path in files("examples/workflows") {
        let (name, text) = (path.to_string_lossy().into_owned(), read(&path.to_string_lossy()));
        let shown = format!("```yaml\n{text}```\n");
        if !pages.iter().any(|(_, page)| page.contains(&shown)) {
            wrong.push(format!("{name}: no page shows it"));
        }
        for line in text.lines() {
            let action = line.split_once("uses: ").and_then(|(_, action)| action.split_once('@'));
            let commit = action.map(|(_, version)| version.split(' ').next().unwrap_or_default());
            let is_commit =
                |text: &str| text.len() == 40 && text.bytes().all(|c| c.is_ascii_hexdigit());
            if commit.is_some_and(|commit| !is_commit(commit)) || line.contains("-latest") {
                wrong.push(format!("{name}: {}", line.trim()));
            }
        }
        // Folded lines of a command are one.
        let joined = text.replace(">\n", "").lines().map(str::trim).collect::<Vec<_>>().join("\n");
        let joined = joined.replace("\n--", " --").replace("\npasses/", " passes/");
        for line in joined.lines() {
            let Some((_, command)) = line.split_once("/trueflight ") else { continue };
            let command =
                command.replace("${{ matrix.part }}", "1").replace("$(date +%Y%m%d)", "1");
            let output =
                trueflight(&command.split_whitespace().chain(["--help"]).collect::<Vec<_>>());
            parsed += 1;
            if !output.status.success() {
                let error = String::from_utf8_lossy(&output.stderr).into_owned();
                wrong.push(format!("{name}: {command}: {error}"));
            }
        }
    }
    none(&wrong);
    assert!(parsed >= 6, "only {parsed} commands are in workflows");
}
