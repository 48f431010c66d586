//! The command: exit codes, messages for broken case files, streams of the output.

use std::process::Output;

use crate::common::place::{Place, assert_says, code, stderr, stdout};

/// Text of a case that passes within `--draws 400000`.
const GOOD: &str = "title = \"a good case\"
[problem.transmittance]
medium.constant.extinction = 0.5
span = [0, 2]
sampling.constant.value = 1
estimators = [{ woodcock = {} }, { ratio = {} }]
";

/// First columns of summary.csv, in the order of the design.
const COLUMNS: &str = "case,problem,medium,estimator,sampling,control,channel,seed,draws,mean,\
                       standard_error,truth,truth_error,z_mean,variance,predicted_variance,\
                       z_variance,lookups_per_draw,predicted_lookups,z_lookups,\
                       predicted_kurtosis,detectable_bias,fom,seconds,ns_per_lookup,verdict,reason";

/// Runs a case file of the given text with `--draws`, and compares the exit code.
fn exits(expected: i32, text: &str, draws: &str) -> Output {
    let place = Place::new(&[("case.toml", text)]);
    let output = place.run(&format!("run case.toml --alpha 1e-6 --draws {draws}"));
    assert_eq!(code(&output), expected, "{}{}", stdout(&output), stderr(&output));
    output
}

/// Returns the message about a broken case file: exit code 2, nothing on stdout, nothing written.
fn message(text: &str) -> String {
    let place = Place::new(&[("case.toml", text)]);
    for command in ["run", "predict", "plan"] {
        let output = place.run(&format!("{command} case.toml"));
        assert_eq!(code(&output), 2, "{command}: {}", stderr(&output));
        assert_eq!(stdout(&output), "", "{command}");
    }
    assert!(!place.path().join("results").exists(), "something was written");
    stderr(&place.run("run case.toml"))
}

#[test]
fn a_case_of_which_nothing_can_be_drawn_is_2() {
    let refused = GOOD.replace("value = 1", "value = 0.4").replace(", { ratio = {} }", "");
    let output = exits(2, &refused, "1000");
    assert_says(&stderr(&output), &["refused"]);
}

#[test]
fn usage_is_2() {
    let place = Place::new(&[("case.toml", GOOD)]);
    for arguments in [
        "",
        "fly",
        "run case.toml --draws 0",
        "run case.toml --draws many",
        "run case.toml --alpha 1",
        "run case.toml --alpha nan",
        "run case.toml --seed -1",
        "run case.toml --threads 0",
        "run case.toml --budget soon",
        "run case.toml --format yaml",
        "run case.toml --filter [",
        "run case.toml --filter nothing-of-the-kind",
        "explain nothing-of-the-kind",
        "list nothing-of-the-kind",
        "completions nothing-of-the-kind",
    ] {
        let output = place.run(arguments);
        assert_eq!(code(&output), 2, "trueflight {arguments}");
        assert_eq!(stdout(&output), "", "trueflight {arguments}");
        assert!(!stderr(&output).is_empty(), "trueflight {arguments} says nothing");
    }
}

#[test]
fn numbers_that_no_option_takes_are_told_what_it_takes() {
    let place = Place::new(&[]);
    for (arguments, takes) in [
        ("run --threads -1", "'--threads <N>': it takes a whole number from 1 to 1024"),
        ("run --seed 1.5", "'--seed <N>': it takes a whole number from 0 to 18446744073709551615"),
        ("run --blocks-per-look 0", "'--blocks-per-look <K>': it takes a whole number from 1 to"),
        ("bench --rounds many", "'--rounds <N>': it takes a whole number from 1 to 10000"),
        ("judge --truth half", "'--truth <T>': it takes a number, such as"),
    ] {
        let output = place.run(arguments);
        assert_eq!(code(&output), 2, "trueflight {arguments}");
        assert_says(&stderr(&output), &[takes]);
    }
}

#[test]
fn unknown_cases_are_2_and_the_message_says_what_would_be_right() {
    let place = Place::new(&[]);
    for command in ["run", "predict", "plan"] {
        let output = place.run(&format!("{command} nowhere.toml"));
        assert_eq!((code(&output), stdout(&output).as_str()), (2, ""));
        assert_says(&stderr(&output), &["nowhere.toml", "case file"]);
    }
    std::fs::create_dir(place.path().join("empty")).expect("a folder");
    assert_says(&stderr(&place.run("run empty")), &["empty", "no case file"]);
}

#[test]
fn an_unknown_key_is_shown_in_its_line_with_a_caret() {
    let message = message(&GOOD.replace("extinction", "extincton"));
    assert_says(&message, &["`extincton`", "did you mean `extinction`?", "case.toml:3:"]);
    let lines: Vec<&str> = message.lines().collect();
    // The second of the two mistakes, a missing and an unknown key, is at the unknown key.
    let line = lines.iter().rposition(|line| line.contains("medium.constant.extincton = 0.5"));
    let line = line.expect("the line of the file");
    let key = lines[line].find("extincton").expect("the key");
    let under: Vec<char> = lines[line + 1].chars().collect();
    let column = lines[line][..key].chars().count();
    assert_eq!(under.get(column), Some(&'^'), "no caret under the key:\n{message}");
}

#[test]
fn every_mistake_is_listed_not_only_the_first() {
    let text = GOOD
        .replace("extinction = 0.5", "extinction = -0.5")
        .replace("span = [0, 2]", "span = [0, \"2\"]")
        .replace("{ ratio = {} }", "{ ratoi = {} }, { single.rule = \"terminate\" }")
        .replace("title", "tilte");
    let message = message(&text);
    let wanted = ["-0.5", "`span`", "did you mean `ratio`", "terminate", "`title`", "`tilte`"];
    assert_says(&message, &wanted);
    let mistakes = message.matches("error: ").count();
    assert!(mistakes >= 6, "{mistakes} mistakes shown:\n{message}");
}

#[test]
fn huge_numbers_neither_hang_nor_panic() {
    for (from, to) in
        [("= 0.5", "= 1e308"), ("value = 1", "value = 1e308"), ("[0, 2]", "[0, 1e308]")]
    {
        let place = Place::new(&[("case.toml", &GOOD.replace(from, to))]);
        for command in ["plan", "predict", "run"] {
            let draws = if command == "predict" { "" } else { " --draws 1000" };
            let output = place.run(&format!("{command} case.toml{draws}"));
            let said = stderr(&output);
            assert!([0, 2, 3].contains(&code(&output)), "{command} with {to}: {said}");
            assert!(!said.contains("panicked"), "{said}");
        }
        let output = place.run("plan case.toml");
        assert_says(&stdout(&output), &["refused"]);
    }
}

#[test]
fn what_is_not_toml_is_shown_in_place() {
    let message = message(&GOOD.replace("[problem.transmittance]", "[problem.transmittance"));
    assert_says(&message, &["not TOML", "case.toml:2:", "^"]);
    assert_says(&self::message(""), &["title", "problem"]);
}

#[test]
fn mistakes_in_two_files_are_both_shown_and_nothing_runs() {
    let broken = GOOD.replace("title", "titel");
    let place = Place::new(&[("a.toml", &broken), ("b.toml", GOOD), ("c.toml", &broken)]);
    let output = place.run("run . --draws 1000");
    assert_eq!(code(&output), 2);
    assert_says(&stderr(&output), &["a.toml", "c.toml", "nothing was run"]);
    assert_eq!(stdout(&output), "");
}

#[test]
fn an_unwritable_folder_is_known_before_the_drawing() {
    let place = Place::new(&[("case.toml", GOOD), ("file", "")]);
    let begin = std::time::Instant::now();
    let output = place.run("run case.toml --out file/below --draws 1000000000");
    assert_eq!(code(&output), 2);
    assert_says(&stderr(&output), &["cannot write", "file/below", "--out"]);
    assert!(begin.elapsed().as_secs() < 20, "it drew first");
}

#[test]
fn commands_that_do_not_finish_leave_no_folder() {
    let rays = "title = \"a grid\"\n[problem.transmittance]\nvolume.grid = { random = { size = [8, 8, 8] }, bounds.box = \
                { low = [0, 0, 0], high = [4, 4, 4] } }\nrays = { random = 1000 }\nestimators = [\"ratio\"]\nsampling = 1\n";
    let place = Place::new(&[("case.toml", GOOD), ("rays.toml", rays)]);
    for failing in ["bench case.toml --baseline none", "judge --images none.npy --truth 1"] {
        assert_eq!(code(&place.run(&format!("{failing} --out found"))), 2, "{failing}");
        assert!(!place.path().join("found").exists(), "{failing}");
    }
    for long in
        ["advise rays.toml --cost lookup=1us", "bench case.toml --draws 100000000", "render"]
    {
        let mut command = std::process::Command::new(assert_cmd::cargo::cargo_bin("trueflight"));
        let words = long.split(' ').chain(["--out", "found", "--quiet"]);
        let mut run = command.args(words).current_dir(place.path()).spawn().expect("it starts");
        std::thread::sleep(std::time::Duration::from_millis(200));
        assert!(run.try_wait().expect("a process").is_none(), "{long} ended by itself");
        run.kill().expect("it runs");
        run.wait().expect("it ends");
        assert!(!place.path().join("found").exists(), "{long}");
    }
}

#[test]
fn a_command_of_the_lab_is_told_where_it_is() {
    for name in ["self-test", "stress"] {
        let output = Place::new(&[]).run(name);
        assert_eq!(code(&output), 2);
        assert_says(&stderr(&output), &[&format!("-p trueflight-lab -- {name}")]);
    }
}

#[test]
fn results_are_written_where_they_are_wanted() {
    let place = Place::new(&[("case.toml", GOOD)]);
    let output = place.run("run case.toml --out here --draws 2000 --quiet");
    assert_eq!((code(&output), stdout(&output).as_str()), (3, ""));
    let summary = std::fs::read_to_string(place.path().join("here/summary.csv")).expect("a table");
    assert!(summary.starts_with(COLUMNS), "{summary}");
    let mut reader = csv::Reader::from_reader(summary.as_bytes());
    let headers = reader.headers().expect("columns").clone();
    let rows: Vec<csv::StringRecord> = reader.records().map(|row| row.expect("a row")).collect();
    assert_eq!(rows.len(), 2);
    let field = |name: &str| {
        let at = headers.iter().position(|header| header == name).expect("the column");
        rows[0][at].to_owned()
    };
    assert_eq!((field("estimator"), field("draws")), ("woodcock".into(), "2000".into()));
    let truth: f64 = field("truth").parse().expect("a number");
    assert!((truth - (-1f64).exp()).abs() < 1e-16);
    // No file is incomplete.
    let names = std::fs::read_dir(place.path().join("here")).expect("a folder");
    let temporary = names.filter(|entry| {
        entry.as_ref().expect("an entry").file_name().to_string_lossy().starts_with('.')
    });
    assert_eq!(temporary.count(), 0);
}

/// A particle leaves a slab on one side only: `Cov[X_R, X_T] = −RT`.
#[test]
fn predictions_hold_covariances_of_neighbouring_channels() {
    let slab = "title = \"slab\"\n[problem.slab]\nmedium.constant.extinction = 1\nspan = [0, 2]\nalbedo = 0.9\n\
                phase.isotropic = {}\nincidence.diffuse = {}\nsampling.constant.value = 1\n\
                estimators = [\"analog\", \"weighted\"]\n";
    let place = Place::new(&[("case.toml", slab)]);
    let json = place.run("predict case.toml --format json");
    let rows: Vec<serde_json::Map<String, serde_json::Value>> =
        serde_json::from_slice(&json.stdout).expect("JSON and nothing else");
    for pair in rows.chunks(2) {
        let number = |row: usize, column: &str| pair[row][column].as_f64().expect("a number");
        let product = number(0, "truth") * number(1, "truth");
        assert!((number(0, "covariance") / product + 1.0).abs() < 1e-12, "{pair:?}");
        assert_eq!(pair[1]["covariance"], serde_json::Value::Null);
        assert!(number(0, "lookups_error") < 1e-3, "{pair:?}");
        assert!(number(0, "lookups_moments_error") < 1e-3, "{pair:?}");
        assert!(!pair[0].contains_key("shadow_lookups") || pair[0]["shadow_lookups"].is_null());
    }
}

#[test]
fn csv_and_json_hold_the_columns_and_nothing_else() {
    let place = Place::new(&[("case.toml", GOOD)]);
    for command in ["run case.toml --draws 2000", "predict case.toml --optimum", "plan case.toml"] {
        let table = place.run(&format!("{command} --format csv"));
        assert!(stdout(&table).starts_with(COLUMNS), "{command}");
        assert_eq!(stderr(&table), "", "{command}");
        assert_eq!(stdout(&table).lines().count(), 3, "{command}");
        let json = place.run(&format!("{command} --format json"));
        let rows: Vec<serde_json::Map<String, serde_json::Value>> =
            serde_json::from_slice(&json.stdout).expect("JSON and nothing else");
        assert_eq!(rows.len(), 2, "{command}");
        for column in COLUMNS.split(',') {
            assert!(rows[0].contains_key(column), "{command}: no {column}");
        }
        assert!(rows[0]["moments_error"].is_number(), "{command}");
        assert!(rows[0]["lookups_error"].is_number(), "{command}");
        assert_eq!(rows[0]["best_fom"].is_number(), command.ends_with("optimum"), "{command}");
        // Unknown numbers are empty, never zero.
        if !command.starts_with("run") {
            assert_eq!(rows[0]["mean"], serde_json::Value::Null, "{command}");
            assert_eq!(rows[0]["variance"], serde_json::Value::Null, "{command}");
        }
    }
}

#[test]
fn predict_and_plan_write_no_files() {
    let place = Place::new(&[("case.toml", GOOD)]);
    assert_eq!(code(&place.run("predict case.toml")), 0);
    assert_eq!(code(&place.run("plan case.toml")), 0);
    assert_eq!(std::fs::read_dir(place.path()).expect("a folder").count(), 1);
}

#[test]
fn filters_keep_what_they_name() {
    let place = Place::new(&[("case.toml", GOOD)]);
    let output = place.run("plan case.toml --format csv --filter case:ratio");
    assert_eq!(stdout(&output).lines().count(), 2);
    assert_says(&stdout(&output), &["ratio"]);
}

#[test]
fn the_catalogue_lists_and_explains_every_page() {
    let place = Place::new(&[]);
    let listed = place.run("list --format csv");
    assert_eq!((code(&listed), stderr(&listed).as_str()), (0, ""));
    let text = stdout(&listed);
    let mut names: Vec<String> = csv::Reader::from_reader(text.as_bytes())
        .records()
        .map(|row| row.expect("a row")[1].to_owned())
        .collect();
    for name in ["eq21", "pilot", "explorers", "double", "next-flight", "ball"] {
        assert!(names.iter().any(|known| known == name), "{name} is not listed");
    }
    names.sort();
    names.dedup();
    for name in names {
        let output = place.run(&format!("explain {name}"));
        assert_eq!(code(&output), 0, "explain {name}: {}", stderr(&output));
        assert!(stdout(&output).lines().count() > 2, "explain {name} says next to nothing");
    }
    assert_says(&stdout(&place.run("list media")), &["eq21"]);
    assert!(!stdout(&place.run("list media")).contains("next-flight"));
}

#[test]
fn help_version_and_completions() {
    let place = Place::new(&[]);
    let help = place.run("--help");
    assert_eq!(code(&help), 0);
    assert_says(&stdout(&help), &["run", "predict", "plan", "list", "explain", "completions"]);
    let version = stdout(&place.run("--version"));
    assert_eq!(version.trim(), format!("trueflight {}", env!("CARGO_PKG_VERSION")));
    for shell in ["bash", "zsh", "fish"] {
        let output = place.run(&format!("completions {shell}"));
        assert_eq!(code(&output), 0);
        assert_says(&stdout(&output), &["trueflight", "predict", "transmittance/eq21-overview"]);
        assert_says(&stdout(&output), &["next-flight"]);
    }
    assert_says(&stdout(&place.run("completions zsh")), &["{compadd -- ", "; _files}"]);
}

#[test]
fn an_old_name_of_an_option_is_answered_by_the_new_one() {
    let place = Place::new(&[("case.toml", GOOD)]);
    for (arguments, new) in [
        ("run case.toml --time 5m", "--budget"),
        ("check case.toml --time 5m", "--budget"),
        ("check case.toml --json record.json", "--record"),
    ] {
        let output = place.run(arguments);
        assert_eq!(code(&output), 2, "{arguments}");
        assert_says(&stderr(&output), &["unexpected argument", new]);
        assert!(!stdout(&place.run("run --help")).contains("--time <"), "it is shown");
    }
}

/// Returns the commands that the help of all commands lists.
fn commands(place: &Place) -> Vec<String> {
    let help = stdout(&place.run("--help"));
    let list = help.split("Commands:\n").nth(1).expect("a list").split("\n\n").next();
    // Lines with more indentation continue a description.
    let lines = list.expect("a list").lines().filter_map(|line| line.strip_prefix("  "));
    let names = lines.filter_map(|line| line.split(' ').next());
    names.filter(|name| !["", "help"].contains(name)).map(str::to_owned).collect()
}

#[test]
fn help_pages_have_examples_exit_codes_and_pages_of_the_manual() {
    let place = Place::new(&[]);
    let commands = commands(&place);
    assert!(commands.len() > 10, "{commands:?}");
    let (mut wrong, mut parsed) = (Vec::new(), 0);
    for command in &commands {
        let help = stdout(&place.run(&format!("{command} --help")));
        let (_, end) = help.split_once("\nExamples:\n").expect("examples");
        let (examples, end) = end.split_once("\n\nExit codes:\n").expect("exit codes");
        let (codes, manual) = end.split_once("\n\nManual: ").expect("a page of the manual");
        assert!(codes.starts_with("  0  ") && codes.contains("\n  2  "), "{codes}");
        for page in manual.trim().split(", ") {
            let page = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(page);
            assert!(page.exists(), "{}", page.display());
        }
        for example in examples.lines() {
            let words = example.trim().strip_prefix("trueflight ").expect("a command");
            let words = words.split(['>', '|']).next().unwrap_or_default();
            assert!(words.starts_with(command.as_str()), "{example}");
            let output = place.run(&format!("{words} --help"));
            parsed += 1;
            if code(&output) != 0 {
                wrong.push(format!("{example}: {}", stderr(&output)));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(parsed > 20, "{parsed} examples");
}

#[test]
fn options_of_run_and_check_are_those_of_one_command() {
    let place = Place::new(&[]);
    let options = |command: &str| -> Vec<String> {
        let help = stdout(&place.run(&format!("{command} --help")));
        let words = help.lines().filter_map(|line| {
            let line = line.trim_start();
            let line = line.strip_prefix("-v, ").or(line.strip_prefix("-q, ")).unwrap_or(line);
            line.starts_with("--").then(|| line.split(' ').next()).flatten()
        });
        words.map(str::to_owned).collect()
    };
    let (run, check) = (options("run"), options("check"));
    let more: Vec<&String> = run.iter().filter(|option| !check.contains(option)).collect();
    assert_eq!(more, ["--fresh", "--resume", "--shard"]);
    assert!(check.len() > 15 && check.iter().all(|option| run.contains(option)), "{check:?}");
}

#[test]
fn colours_only_where_they_are_wanted() {
    let place = Place::new(&[("case.toml", GOOD)]);
    let coloured = |arguments: &str| stdout(&place.run(arguments)).contains('\u{1b}');
    assert!(!coloured("plan case.toml"), "stdout is no terminal here");
    assert!(coloured("predict case.toml --color always") || coloured("list --color always"));
    assert!(!coloured("predict case.toml --color never"));
}

#[test]
fn a_second_run_in_the_same_folder_reuses_what_has_not_changed() {
    let place = Place::new(&[("case.toml", GOOD)]);
    let first = place.run("run case.toml --draws 50000");
    assert!(!stdout(&first).contains("were reused"));
    let summary = || std::fs::read_to_string(place.path().join("results/summary.csv")).expect("it");
    let drawn = summary();
    let plan = stdout(&place.run("plan case.toml --draws 50000"));
    assert!(plan.contains("have not changed since the last run in results"), "{plan}");
    let second = place.run("run case.toml --draws 50000");
    assert!(stdout(&second).contains("were reused (--fresh makes them anew)"));
    // Even the times are those of the first run; only one column shows the reuse.
    let told = summary();
    assert!(told.lines().skip(1).all(|line| line.contains(",yes,") || line.contains("refused")));
    assert_eq!(told.replace(",yes,", ",,"), drawn);
    for changed in ["--fresh", "--seed 2", "--save-baseline main"] {
        let output = place.run(&format!("run case.toml --draws 50000 {changed}"));
        assert!(!stdout(&output).contains("were reused"), "{changed}");
    }
    std::fs::write(place.path().join("results/draws.bin"), "broken").expect("writable");
    let output = place.run("run case.toml --draws 50000");
    assert_eq!(code(&output), 0);
    assert!(!stdout(&output).contains("were reused"));
}
