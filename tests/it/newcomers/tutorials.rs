//! Tutorials and README, worked through literally: their programs have the verdicts that the pages show.

use std::path::Path;
use std::process::{Command, Stdio};

use crate::common::place::{Place, code, said, stdout};

fn page(name: &str) -> String {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(name)).expect("a page")
}

/// Returns the contents of the blocks of a page in a language.
fn blocks(name: &str, language: &str) -> Vec<String> {
    let (text, fence) = (page(name), format!("```{language}\n"));
    let after = text.split(fence.as_str()).skip(1);
    after.filter_map(|rest| rest.split("```").next()).map(str::to_owned).collect()
}

/// Returns a folder with the case of the first tutorial.
fn place() -> Place {
    let [case] = blocks("docs/first-medium.md", "toml").try_into().expect("one case");
    Place::new(&[("first.toml", &case)])
}

/// Runs a program in the folder, and returns what it prints; `None` if this machine lacks it.
fn run(place: &Place, program: &str, arguments: &[&str]) -> Option<Vec<u8>> {
    let mut command = Command::new(program);
    command.args(arguments).current_dir(place.path()).stderr(Stdio::inherit());
    let output = command.output().ok()?;
    assert!(output.status.success(), "{program} {arguments:?}: {}", output.status);
    Some(output.stdout)
}

/// Judges draws, and compares the lines with those that a page shows.
fn judged(place: &Place, file: &str, draws: &[u8], exit: i32, shown: &str) {
    std::fs::write(place.path().join(file), draws).expect("draws");
    let arguments = format!("judge --case first.toml --estimator woodcock --swept 1.5 {file}");
    let output = place.command(&arguments).env("COLUMNS", "120").output().expect("it runs");
    assert_eq!(code(&output), exit, "{}", said(&output));
    let text = stdout(&output);
    for line in shown.lines() {
        assert!(text.contains(line.trim_end()), "no \"{line}\" in:\n{text}");
    }
}

/// Compiles and runs a C++ program; `None` without a compiler.
fn compiled(place: &Place, source: &str) -> Option<Vec<u8>> {
    std::fs::write(place.path().join("woodcock.cpp"), source).expect("a file");
    run(place, "c++", &["-O2", "-o", "woodcock", "woodcock.cpp"])?;
    run(place, "./woodcock", &[])
}

#[test]
fn the_bug_in_python_is_found_and_its_cure_passes() {
    let place = place();
    let programs = blocks("docs/first-bug.md", "python");
    let verdicts = blocks("docs/first-bug.md", "text");
    let (wrong, cure) = (&programs[0], &programs[1]);
    let (definition, rest) = wrong.split_once("def draw").expect("a function");
    let (_, main) = rest.split_once("rng = ").expect("a loop");
    let mended = format!("{definition}{cure}\nrng = {main}");
    for (program, exit, shown) in [(wrong, 1, &verdicts[0]), (&mended, 0, &verdicts[1])] {
        let Some(draws) = run(&place, "python3", &["-c", program]) else { return };
        judged(&place, "draws.csv", &draws, exit, shown);
    }
}

#[test]
fn the_bug_in_cpp_is_found() {
    let place = place();
    let [program] = blocks("docs/first-bug.md", "cpp").try_into().expect("one program");
    let verdict = &blocks("docs/first-bug.md", "text")[2];
    let Some(draws) = compiled(&place, &program) else { return };
    judged(&place, "draws.f64", &draws, 1, verdict);
}

#[test]
fn the_gate_passes_and_turns_red_as_tutorial_and_readme_show() {
    let place = place();
    let programs = blocks("docs/first-gate.md", "cpp");
    let tutorial = blocks("docs/first-gate.md", "text");
    let readme: Vec<String> =
        blocks("README.md", "text").into_iter().filter(|block| block.contains("truth")).collect();
    assert_eq!((programs.len(), tutorial.len(), readme.len()), (2, 2, 2));
    let line = "    const double majorant = 1.5, length = 4;\n";
    assert!(programs[0].contains(line));
    let red = programs[0].replace(line, &programs[1]);
    for (program, exit, at) in [(&programs[0], 0, 0), (&red, 1, 1)] {
        let Some(draws) = compiled(&place, program) else { return };
        judged(&place, "draws.f64", &draws, exit, &tutorial[at]);
        judged(&place, "draws.f64", &draws, exit, &readme[at]);
    }
    let output = place.run("judge --case first.toml --estimator woodcock --swept 1.4 draws.f64");
    assert_eq!(code(&output), 2);
    assert!(said(&output).contains("σ_t = 1.500000"), "{}", said(&output));
}
