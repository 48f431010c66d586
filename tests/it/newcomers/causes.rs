//! Likely causes of failures: the table against the patterns of all known bugs, and against the manual.
//!
//! `tests/data/known-bugs.csv` has the pattern of each known bug in a million draws, from seed 1, and the kind of the
//! bug, assigned by hand. [`write_patterns`] prints the patterns again.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use crate::common;
use lab::mutants::{self, streams};
use lab::self_test;
use lab::self_test::mutation::{self, MutantWalk};
use trueflight::draw::run;
use trueflight::gate::causes::{CAUSES, DeviationSide, Pattern, SweepPart, TABLE, line};
use trueflight::plan::Plan;
use trueflight::record::build;
use trueflight::record::{CaseRecord, Verdict};
use trueflight::report::run::failures;

/// Smallest share of the known bugs of a kind that their line names.
const SHARE: f64 = 0.9;
/// Maximum number of causes in a line.
const MAX_CAUSES: usize = 4;

type Flag = (char, fn(&mut Pattern) -> &mut bool);

const FLAGS: [Flag; 6] = [
    ('c', |p| &mut p.curve),
    ('d', |p| &mut p.distribution),
    ('b', |p| &mut p.balance),
    ('n', |p| &mut p.number),
    ('s', |p| &mut p.dependence),
    ('r', |p| &mut p.resolution),
];

/// Returns a pattern as one word of the table: mean, variance and lookups by their sign, then a letter for each other
/// check.
fn word(pattern: &Pattern) -> String {
    let sides = [pattern.mean, pattern.variance, pattern.lookups];
    let mut word: String = sides.map(DeviationSide::sign).iter().collect();
    let mut pattern = *pattern;
    word.extend(FLAGS.iter().filter(|flag| *flag.1(&mut pattern)).map(|flag| flag.0));
    word
}

fn pattern(word: &str) -> Pattern {
    let side = |sign: char| match sign {
        '0' => DeviationSide::Right,
        '-' => DeviationSide::Low,
        '+' => DeviationSide::High,
        '*' => DeviationSide::Both,
        _ => panic!("{sign} is no side"),
    };
    let mut signs = word.chars();
    let mut next = || side(signs.next().expect("a sign"));
    let [mean, variance, lookups] = [next(), next(), next()];
    let mut pattern = Pattern { mean, variance, lookups, ..Pattern::default() };
    for letter in signs {
        let flag = FLAGS.iter().find(|flag| flag.0 == letter).expect("a letter of a check");
        *flag.1(&mut pattern) = true;
    }
    assert_eq!(self::word(&pattern), word);
    pattern
}

/// Returns the known bugs: name, pattern and kind.
fn known_bugs() -> Vec<[String; 3]> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/known-bugs.csv");
    let mut reader = csv::Reader::from_path(path).expect("the table");
    let lines = reader.records().map(|line| line.expect("a line"));
    lines.map(|line| [0, 1, 2].map(|field| line[field].to_owned())).collect()
}

#[test]
fn every_known_bug_is_of_a_kind_that_the_table_knows() {
    let bugs = known_bugs();
    let named: BTreeSet<&str> = bugs.iter().map(|bug| bug[0].as_str()).collect();
    let mut known: BTreeSet<&str> = mutants::all().iter().map(|about| about.name).collect();
    known.extend(streams::MUTANTS.iter().map(|mutant| mutant.name));
    assert_eq!((named.len(), &named), (bugs.len(), &known));
    let kinds: BTreeSet<&str> = CAUSES.iter().map(|cause| cause.name).collect();
    let used: BTreeSet<&str> = bugs.iter().map(|bug| bug[2].as_str()).collect();
    assert_eq!((kinds.len(), kinds), (CAUSES.len(), used));
}

/// Returns for each line of the table the number of known bugs with its pattern, and of those of a kind that it names.
fn explained() -> BTreeMap<&'static str, [usize; 2]> {
    let mut counts: BTreeMap<&str, [usize; 2]> =
        TABLE.iter().map(|line| (line.pattern, [0; 2])).collect();
    for [name, word, kind] in known_bugs() {
        let line = line(&pattern(&word)).unwrap_or_else(|| panic!("{name}: no line for {word}"));
        let count = counts.get_mut(line.pattern).expect("a line of the table");
        count[0] += 1;
        count[1] += usize::from(line.causes.iter().any(|cause| cause.name == kind));
    }
    counts
}

#[test]
fn the_causes_that_are_listed_explain_the_known_bugs() {
    let counts = explained();
    assert_eq!(counts.len(), TABLE.len(), "two lines have one name");
    let [all, right] = counts.values().fold([0; 2], |[a, r], [b, s]| [a + b, r + s]);
    let share = right as f64 / all as f64;
    assert!(share >= SHARE, "{right} of {all}");
    for line in TABLE {
        assert!(!line.causes.is_empty() && line.causes.len() <= MAX_CAUSES, "{}", line.pattern);
        // Each line by itself is right for more than half, too.
        let [bugs, found] = counts[line.pattern];
        assert!(2 * found >= bugs, "{}: {found} of {bugs}", line.pattern);
    }
}

#[test]
fn the_manual_has_the_table() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/failures.md");
    let page = std::fs::read_to_string(page).expect("the page");
    let counts = explained();
    for line in TABLE {
        let [bugs, found] = counts[line.pattern];
        let named: Vec<String> =
            line.causes.iter().map(|cause| format!("[{0}](#{0})", cause.name)).collect();
        let share = if bugs == 0 { "–".to_owned() } else { format!("{found} of {bugs}") };
        let row = format!("| {} | {} | {share} |", line.pattern, named.join(", "));
        assert!(page.contains(&row), "not in the page:\n{row}");
    }
    for cause in CAUSES {
        assert!(page.contains(&format!("### {}\n", cause.name)), "no section {}", cause.name);
    }
}

/// Bugs that are quick to draw, one of each kind.
const QUICK: [&str; 10] = [
    "control-forgotten",
    "lookup-at-previous",
    "flight-log2",
    "number-shared",
    "cap-16",
    "weight-absolute",
    "majorant-too-low",
    "next-flight-counted-twice",
    "two-walks-averaged",
    "weight-f32",
];

#[test]
fn the_patterns_on_record_are_those_that_bugs_leave() {
    let recorded: BTreeMap<String, String> =
        known_bugs().into_iter().map(|[name, word, _]| (name, word)).collect();
    let drawn =
        self_test::mutation::patterns(1, DRAWS, &|name| QUICK.contains(&name)).expect("cases");
    assert_eq!(drawn.len(), QUICK.len());
    for (name, pattern) in drawn {
        assert_eq!(word(&pattern), recorded[name], "{name}");
    }
}

/// Returns a judged case swept over σ̂, with a known bug in the place of ratio tracking.
fn swept_with(bug: &str) -> CaseRecord {
    let text = "title = \"swept\"
        [problem.transmittance]
        volume.eq21 = {}
        ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 20 }
        sweep.sampling.values = [0.5, 1, 2, 4]
        estimators = [{ ratio = {} }]";
    let cases = [common::case("swept", text)];
    let options = common::options(1, 400_000);
    let mut plan = Plan::new(&cases, &options);
    let about = mutants::all().into_iter().find(|about| about.name == bug).expect("a known bug");
    for planned in &mut plan.cases[0].experiments {
        let faulty = mutation::experiment(&about, MutantWalk::Faulty, &cases[0], planned, 1);
        let faulty = faulty.expect("a mutant of ratio tracking").expect("it can be drawn");
        planned.outcome.as_mut().expect("it can be drawn").experiment = faulty;
    }
    let draws = run::draw(&plan, &|_| {});
    build::judged(&plan, &draws, 0.0).results.cases.remove(0)
}

/// In Eq. 21 σ_t is below 0.956, and a walk has 20 σ̂ collisions on average.
#[test]
fn a_failure_at_one_end_of_a_sweep_is_told_as_such() {
    for (bug, end) in [
        ("weight-absolute", SweepPart::LowEnd),
        ("weight-clamped", SweepPart::LowEnd),
        ("cap-100", SweepPart::HighEnd),
        ("flight-log2", SweepPart::Anywhere),
    ] {
        let case = swept_with(bug);
        let failing: Vec<_> =
            case.rows().filter(|row| row.verdict == Some(Verdict::Fail)).collect();
        assert!(!failing.is_empty(), "{bug}");
        for row in failing {
            assert_eq!(failures::pattern(&row).place, end, "{bug}");
            let said = failures::causes(&row).join(" ");
            let hint = end.hint().unwrap_or("usual causes where");
            assert!(said.contains(hint), "{bug}: {said}");
        }
    }
}

/// Number of draws of the record.
const DRAWS: u64 = 1_000_000;

#[test]
#[ignore = "long: prints the patterns of all known bugs, some minutes of two cores"]
fn write_patterns() {
    for (name, pattern) in self_test::mutation::patterns(1, DRAWS, &|_| true).expect("cases") {
        println!("PATTERN,{name},{}", word(&pattern));
    }
}
