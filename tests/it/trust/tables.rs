//! The tables of the manual have the names of `trueflight list`, and the sentences of `trueflight explain`.
//!
//! A comment `<!-- list PART -->` precedes a table about a part of the catalogue. Names are the code in the table's
//! first column; with the part `estimators` the first column has the problems and the second the names. A column `is`
//! has the sentence of `list`, a column `unbiased for` the paragraph of `explain`.

use std::collections::{BTreeMap, BTreeSet};

use super::{Listed, files, listed, manual, read, stdout};
use crate::common::none;

/// Returns the cells of a row.
fn cells(line: &str) -> Vec<String> {
    let inside = line.trim().trim_start_matches('|').trim_end_matches('|').replace("\\|", "\u{1}");
    inside.split('|').map(|cell| cell.trim().replace('\u{1}', "|")).collect()
}

/// Returns texts between back ticks.
fn code(cell: &str) -> Vec<String> {
    cell.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

/// Name in a table: its part, the name, and the cells of its row by their heads.
type Row = (String, String, BTreeMap<String, String>);

/// Returns the rows of all tables of the manual that are about a part of the catalogue.
fn rows() -> Vec<Row> {
    let mut rows = Vec::new();
    for (page, text) in manual() {
        let mut lines = text.lines().peekable();
        while let Some(line) = lines.next() {
            let marked = line.strip_prefix("<!-- list ").and_then(|rest| rest.strip_suffix(" -->"));
            let Some(part) = marked else { continue };
            let head = cells(lines.next().unwrap_or_default());
            assert!(
                lines.next().is_some_and(|line| line.starts_with("|--")),
                "{page}: no table after {line}"
            );
            while let Some(line) = lines.next_if(|line| line.starts_with('|')) {
                let row = cells(line);
                assert_eq!(row.len(), head.len(), "{page}: {line}");
                let by_head: BTreeMap<_, _> =
                    head.iter().cloned().zip(row.iter().cloned()).collect();
                let (parts, names) = if part == "estimators" {
                    let problems =
                        code(&row[0]).into_iter().map(|of| format!("estimators of {of}"));
                    (problems.collect(), code(&row[1]))
                } else {
                    (vec![part.to_owned()], code(&row[0]))
                };
                for part in parts {
                    let named =
                        names.iter().map(|name| (part.clone(), name.clone(), by_head.clone()));
                    rows.extend(named);
                }
            }
        }
    }
    rows
}

/// Parts of files and of built-in cases, for which the manual has no table.
const UNLISTED: [&str; 3] = ["files", "cases", "pictures"];

fn catalogue() -> Vec<Listed> {
    listed().into_iter().filter(|row| !UNLISTED.contains(&row.part.as_str())).collect()
}

#[test]
fn tables_have_the_names_of_the_catalogue() {
    let known: BTreeSet<_> = catalogue().into_iter().map(|row| (row.part, row.name)).collect();
    let rows = rows();
    let shown: BTreeSet<_> = rows.iter().map(|row| (row.0.clone(), row.1.clone())).collect();
    none(
        &known
            .difference(&shown)
            .map(|(part, name)| {
                format!("{name} ({part}): add a row below its `<!-- list … -->` in docs/")
            })
            .collect::<Vec<_>>(),
    );
    let strange = shown.difference(&known);
    none(&strange.map(|(part, name)| format!("{name} is not among {part}")).collect::<Vec<_>>());
    assert_eq!(rows.len(), shown.len(), "a name stands in two rows");
}

#[test]
fn tables_say_what_the_catalogue_says() {
    let summaries: BTreeMap<_, _> =
        catalogue().into_iter().map(|row| ((row.part, row.name), row.summary)).collect();
    let (mut wrong, mut compared) = (Vec::new(), 0);
    for (part, name, cells) in rows() {
        let place = format!("{name} ({part})");
        if let Some(cell) = cells.get("is") {
            compared += 1;
            let summary = &summaries[&(part.clone(), name.clone())];
            if cell != summary {
                wrong.push(format!("{place}: \"{cell}\", and in list \"{summary}\""));
            }
        }
        if part.starts_with("estimators") {
            compared += 1;
            let (own, text) = (format!("{name} ({part})\n"), stdout(&["explain", &name]));
            let page = text.split(&own).nth(1).unwrap_or_else(|| panic!("no page of {place}"));
            let said =
                page.split("\n\n").find_map(|paragraph| paragraph.strip_prefix("Unbiased for: "));
            let said = said.map(|said| said.replace('\n', " ").trim_end_matches('.').to_owned());
            let cell = cells.get("unbiased for").cloned();
            if said.is_none() || said != cell {
                wrong.push(format!("{place}: {cell:?}, and in explain {said:?}"));
            }
        }
    }
    none(&wrong);
    assert!(compared > 120, "only {compared} cells were compared");
}

/// In a homogeneous medium of σ_t = 1 and at σ̂ = 0.4, r is 2.5: no majorant, above 2 and above 2/(a + 1). In a medium
/// as thin as 0.2 no variance is infinite.
#[test]
fn what_is_refused_below_the_density_is_what_the_manual_says() {
    let said: BTreeMap<_, _> = rows()
        .into_iter()
        .filter_map(|(part, name, cells)| Some(((part, name), cells.get("unbiased for")?.clone())))
        .collect();
    let cases = [
        ("transmittance", ""),
        ("rod", "albedo = 0.5\nforward = 0.5\n"),
        ("rod with light", "albedo = 0.5\nforward = 0.5\nlight = 'emitter'\n"),
    ];
    let (mut wrong, mut compared) = (Vec::new(), 0);
    for (problem, body) in cases {
        let kind = problem.split(' ').next().unwrap_or_default();
        for ((_, name), domain) in
            said.iter().filter(|((part, _), _)| *part == format!("estimators of {problem}"))
        {
            let settings = match name.as_str() {
                "single" => "{ single = { rule = \"terminating\" } }".to_owned(),
                "ray-marching" => "{ ray-marching = { steps = 3 } }".to_owned(),
                "local-majorant" => {
                    "{ local-majorant = { sampling.piecewise-constant = { breaks = [0, 1], values = [0.4] } } }".to_owned()
                }
                // As a control the minimum of σ_t leaves a residual of 0.
                "decomposition" => "{ decomposition = { control.constant.value = 0.5 } }".to_owned(),
                name => format!("{{ {name} = {{}} }}"),
            };
            let text = format!(
                "title = \"t\"\n[problem.{kind}]\nmedium.constant.extinction = 1\nspan = [0, 0.2]\n{body}sampling.constant.value = 0.4\nestimators = [{settings}]\n"
            );
            let cases = [crate::common::case("test", &text)];
            let plan = trueflight::plan::Plan::new(&cases, &crate::common::options(1, 1000));
            let is_refused = plan.experiments().any(|(_, planned)| planned.outcome.is_err());
            let is_exact =
                domain.contains("exactly") || domain.contains("the variance is infinite");
            let should = domain.contains("refused") && !is_exact;
            compared += 1;
            if is_refused != should {
                wrong.push(format!(
                    "{problem}: {name}: refused {is_refused}, but unbiased for {domain}"
                ));
            }
        }
    }
    none(&wrong);
    assert!(compared >= 20, "only {compared} estimators were planned");
}

#[test]
fn counts_in_documents_are_those_of_the_repository() {
    let count = |folder: &str| {
        let files = files(folder);
        files.iter().filter(|path| path.extension().is_some_and(|end| end == "toml")).count()
    };
    let (shown, more) = (count("cases"), count("tests/cases"));
    let counts = [
        ("README.md", format!("{shown} of them are in [cases/](cases) to read, {more} more")),
        ("docs/cases.md", format!("`README.md` is a table of {shown} files")),
    ];
    for (page, words) in counts {
        assert!(read(page).contains(&words), "{page}: {words}");
    }
}

#[test]
fn the_table_of_cases_has_every_file() {
    let table = read("cases/README.md");
    let rows = table.lines().filter(|line| line.starts_with("| `")).map(cells);
    let shown: BTreeSet<String> = rows.flat_map(|row| code(&row[0])).collect();
    let files = files("cases").into_iter();
    let files = files.filter(|path| path.extension().is_some_and(|end| end == "toml"));
    let names = files.map(|path| {
        let name = path.strip_prefix("cases").expect("below the folder").with_extension("");
        name.to_string_lossy().into_owned()
    });
    assert_eq!(shown, names.collect());
}

/// Pages name the number of known bugs in `results/self-test/mutants.csv`.
#[test]
fn the_number_of_known_bugs_is_that_of_the_results() {
    let path = super::root().join("results/self-test/mutants.csv");
    let count = csv::Reader::from_path(path).expect("a table").records().count();
    for (page, words) in [
        ("docs/self-test.md", format!("The table of all {count} mutants")),
        ("docs/failures.md", format!("those of most of the {count} [known bugs]")),
    ] {
        assert!(read(page).contains(&words), "{page}: {words}");
    }
}

#[test]
fn the_first_page_of_the_manual_has_all_pages() {
    let links = |text: &str| -> Vec<String> {
        let lines = text.lines().filter(|line| line.starts_with("- ["));
        lines.map(str::to_owned).collect()
    };
    assert_eq!(links(&read("docs/index.md")), links(&read("docs/SUMMARY.md")));
}
