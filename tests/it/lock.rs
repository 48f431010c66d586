//! Predictions and draws of all cases, and the tables of the self-test, which a change of structure must keep.
//!
//! `tests/lock/README.md` says which program made the values, and how to freeze them again.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::{env, fs};

use crate::common::{LOCKED_DRAWS, none, shipped_draws, shipped_record};
use lab::report::self_test;
use lab::self_test::streams;
use lab::self_test::{SelfTest, calibration, mutation};
use trueflight::catalogue::Page;
use trueflight::estimators::{self, FormCatalogue};
use trueflight::report::run::{checks_csv, summary_csv};

/// Columns that identify a row of a case.
const LABELS: [&str; 5] = ["estimator", "sampling", "control", "swept", "channel"];

/// Columns of `summary.csv` that are frozen digit by digit; all others are frozen as one hash a case.
const DIGITS: [&str; 7] =
    ["verdict", "truth", "predicted_variance", "predicted_lookups", "mean", "variance", "z_mean"];

/// Columns that are not results: times, reuse of earlier draws, and wording.
const FREE: [&str; 5] = ["seconds", "ns_per_lookup", "reused", "reason", "what"];

/// Replaces a cell that equals the one above it.
const DITTO: &str = "^";

/// A table with its columns by name.
#[derive(Debug, Clone, Default)]
struct Table {
    columns: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    /// Parses CSV text with a header.
    fn parse(text: &str) -> Self {
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let strings = |record: &csv::StringRecord| record.iter().map(str::to_owned).collect();
        let columns = strings(reader.headers().expect("a header"));
        let rows = reader.records().map(|row| strings(&row.expect("a row"))).collect();
        Self { columns, rows }
    }

    /// Formats the table as CSV text.
    fn text(&self) -> String {
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(&self.columns).expect("a header");
        for row in &self.rows {
            writer.write_record(row).expect("a row");
        }
        String::from_utf8(writer.into_inner().expect("all rows")).expect("text")
    }

    /// Returns the index of a column.
    fn column(&self, name: &str) -> usize {
        let found = self.columns.iter().position(|column| column == name);
        found.unwrap_or_else(|| panic!("no column `{name}`: rename it in tests/lock, too"))
    }

    /// Returns the named columns only.
    fn choose(&self, names: &[&str]) -> Self {
        let at: Vec<usize> = names.iter().map(|name| self.column(name)).collect();
        let rows = self.rows.iter().map(|row| at.iter().map(|&i| row[i].clone()).collect());
        Self { columns: names.iter().map(|&name| name.to_owned()).collect(), rows: rows.collect() }
    }

    /// Replaces each cell that equals the one above it by a ditto mark.
    fn fold(mut self) -> Self {
        for i in (1..self.rows.len()).rev() {
            let (above, below) = self.rows.split_at_mut(i);
            for (cell, upper) in below[0].iter_mut().zip(&above[i - 1]) {
                if cell == upper && !cell.is_empty() {
                    DITTO.clone_into(cell);
                }
            }
        }
        self
    }

    /// Replaces each ditto mark by the cell above it.
    fn unfold(mut self) -> Self {
        for i in 1..self.rows.len() {
            let (above, below) = self.rows.split_at_mut(i);
            for (cell, upper) in below[0].iter_mut().zip(&above[i - 1]) {
                if cell == DITTO {
                    cell.clone_from(upper);
                }
            }
        }
        self
    }

    /// Returns the rows of each case, in the order of the table.
    fn by_case(&self) -> BTreeMap<&str, Vec<&Vec<String>>> {
        let at = self.column("case");
        let mut cases: BTreeMap<&str, Vec<_>> = BTreeMap::new();
        for row in &self.rows {
            cases.entry(&row[at]).or_default().push(row);
        }
        cases
    }
}

/// The frozen form of a run: digits of each row, and a hash of each other column of each case.
struct Lock {
    digits: Table,
    hashes: Table,
}

impl Lock {
    /// Builds the frozen form from `summary.csv` and `checks.csv`.
    fn new(summary: &Table, checks: &Table) -> Self {
        let names: Vec<&str> = ["case"].into_iter().chain(LABELS).chain(DIGITS).collect();
        let not_hashed: Vec<&str> = names.iter().copied().chain(FREE).collect();
        let checks_not_hashed: Vec<&str> = ["case"].into_iter().chain(FREE).collect();
        let tables = [("summary", summary, not_hashed), ("checks", checks, checks_not_hashed)];
        let mut hashes = Table { columns: vec!["case".to_owned()], rows: Vec::new() };
        let mut by_case: BTreeMap<&str, Vec<String>> =
            summary.by_case().into_keys().map(|case| (case, vec![case.to_owned()])).collect();
        for (prefix, table, not_hashed) in tables {
            let cases = table.by_case();
            for (at, column) in table.columns.iter().enumerate() {
                if not_hashed.contains(&column.as_str()) {
                    continue;
                }
                hashes.columns.push(format!("{prefix}.{column}"));
                for (case, row) in &mut by_case {
                    row.push(cases.get(case).map_or_else(String::new, |rows| hash(rows, at)));
                }
            }
        }
        hashes.rows.extend(by_case.into_values());
        Self { digits: summary.choose(&names), hashes }
    }

    /// Lists the differences from the frozen form, cell by cell.
    fn differences(&self, now: &Self) -> Vec<String> {
        let keys = |table: &Table| -> BTreeMap<String, Vec<String>> {
            let keyed = table.rows.iter().map(|row| {
                let labels: Vec<&str> = row[..=LABELS.len()].iter().map(String::as_str).collect();
                (labels.join(" | "), row.clone())
            });
            keyed.collect()
        };
        let mut wrong = compared(&keys(&self.digits), &keys(&now.digits), &self.digits.columns);
        let names: Vec<&str> = self.hashes.columns.iter().map(String::as_str).collect();
        let by_case = |table: Table| -> BTreeMap<String, Vec<String>> {
            table.rows.into_iter().map(|row| (row[0].clone(), row)).collect()
        };
        let (frozen, hashes) = (by_case(self.hashes.clone()), by_case(now.hashes.choose(&names)));
        wrong.extend(compared(&frozen, &hashes, &self.hashes.columns));
        wrong
    }
}

/// Lists the rows that were added or removed, and the cells that differ.
fn compared(
    frozen: &BTreeMap<String, Vec<String>>,
    now: &BTreeMap<String, Vec<String>>,
    columns: &[String],
) -> Vec<String> {
    let mut wrong: Vec<String> = now
        .keys()
        .filter(|key| !frozen.contains_key(*key))
        .map(|key| format!("{key}: new"))
        .collect();
    for (key, old) in frozen {
        let Some(new) = now.get(key) else {
            wrong.push(format!("{key}: missing"));
            continue;
        };
        let cells = columns.iter().zip(old.iter().zip(new)).filter(|(_, (old, new))| old != new);
        wrong.extend(cells.map(|(name, (old, new))| format!("{key}: {name} {old} -> {new}")));
    }
    wrong
}

/// Hashes a column of some rows (FNV-1a, 24 bits); an empty column has an empty hash.
fn hash(rows: &[&Vec<String>], column: usize) -> String {
    if rows.iter().all(|row| row[column].is_empty()) {
        return String::new();
    }
    let bytes = rows.iter().flat_map(|row| row[column].bytes().chain([b'\n']));
    let fold = |state: u64, byte| (state ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    format!("{:06x}", bytes.fold(0xcbf2_9ce4_8422_2325, fold) >> 40)
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/lock")
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Returns the frozen form of `folder()`.
fn frozen() -> Lock {
    let table = |name: &str| Table::parse(&read(&folder().join(name))).unfold();
    Lock { digits: table("rows.csv"), hashes: table("hashes.csv") }
}

/// Returns the lock of `summary.csv` and `checks.csv` in a folder of results.
fn of_results(folder: &Path) -> Lock {
    let table = |name: &str| Table::parse(&read(&folder.join(name)));
    Lock::new(&table("summary.csv"), &table("checks.csv"))
}

#[test]
#[cfg_attr(
    not(all(target_arch = "x86_64", target_os = "linux")),
    ignore = "frozen on Linux, x86-64"
)]
fn all_cases_predict_and_draw_what_they_did() {
    // Results of another program are compared instead: see the README beside the frozen values.
    let now = match env::var_os("LOCK_RESULTS") {
        Some(results) => of_results(Path::new(&results)),
        None if shipped_draws() != LOCKED_DRAWS => return,
        None => {
            let record = shipped_record();
            let summary = summary_csv::csv(record).expect("renders");
            let checks = checks_csv::render(record).expect("renders").remove(0).bytes;
            let checks = String::from_utf8(checks).expect("text");
            Lock::new(&Table::parse(&summary), &Table::parse(&checks))
        }
    };
    if env::var_os("UPDATE_LOCK").is_some() {
        let [rows, hashes] = [now.digits.clone().fold().text(), now.hashes.text()];
        fs::write(folder().join("rows.csv"), rows).expect("written");
        fs::write(folder().join("hashes.csv"), hashes).expect("written");
    }
    none(&frozen().differences(&now));
}

#[test]
fn every_estimator_of_the_catalogue_is_drawn() {
    let rows = frozen().digits.rows;
    let mut missing = Vec::new();
    for FormCatalogue { problem, title, pages, .. } in estimators::catalogues() {
        let of_problem = |row: &&Vec<String>| row[0].split('/').next() == Some(problem.as_str());
        let drawn = rows.iter().filter(of_problem).filter(|row| row[6] != "refused");
        let names: BTreeSet<&str> = drawn.filter_map(|row| row[1].split(' ').next()).collect();
        let all = pages.iter().map(Page::name);
        missing.extend(all.filter(|name| !names.contains(name.as_str())).map(|name| {
            format!("{title}: {name} is in no case: add one, and freeze it with UPDATE_LOCK=1")
        }));
    }
    none(&missing);
}

#[test]
fn a_changed_digit_is_found_in_its_row_and_column() {
    let summary = "case,estimator,sampling,control,swept,channel,verdict,truth,predicted_variance,\
                   predicted_lookups,mean,variance,z_mean,fom\n\
                   a,ratio,1,,,,pass,0.5,0.1,2,0.51,0.11,1.5,3\n\
                   a,ratio,2,,,,pass,0.5,0.2,3,0.52,0.22,1.6,4\n";
    let checks = "case,estimator,ln_e\na,ratio,-1\n";
    let lock =
        |summary: &str, checks: &str| Lock::new(&Table::parse(summary), &Table::parse(checks));
    let before = lock(summary, checks);
    assert_eq!(before.differences(&lock(summary, checks)), [""; 0]);
    let folded = Table::parse(&before.digits.clone().fold().text()).unfold();
    assert_eq!(folded.rows, before.digits.rows);
    let changed = lock(&summary.replace("0.52", "0.53").replace("1.6,4", "1.6,5"), checks);
    let found = before.differences(&changed);
    assert_eq!(found[0], "a | ratio | 2 |  |  | : mean 0.52 -> 0.53");
    assert!(found[1].starts_with("a: summary.fom ") && found.len() == 2, "{found:?}");
    let found = before.differences(&lock(summary, &checks.replace("-1", "-2")));
    assert!(found[0].starts_with("a: checks.ln_e ") && found.len() == 1, "{found:?}");
    let found = before.differences(&lock(&summary.replace("ratio,2", "ratio,3"), checks));
    assert_eq!(found[..2], ["a | ratio | 3 |  |  | : new", "a | ratio | 2 |  |  | : missing"]);
}

#[test]
#[ignore = "long: the short self-test with all mutants"]
fn the_tables_of_the_self_test_are_what_they_were() {
    let found = SelfTest {
        calibration: calibration::calibrate(400, &|_| {}).expect("calibrates"),
        streams: streams::all(5, &|_| {}),
        mutants: mutation::all(1).expect("draws"),
        seconds: 0.0,
    };
    let mut wrong = Vec::new();
    for artifact in self_test::artifacts(&found).expect("renders") {
        let path = folder().join(&artifact.path);
        let (before, now) = (read(&path), String::from_utf8(artifact.bytes).expect("text"));
        let (before, now) = (Table::parse(&before), Table::parse(&now));
        let by_name = |table: &Table| -> BTreeMap<String, Vec<String>> {
            let keyed = table.rows.iter().enumerate();
            keyed.map(|(i, row)| (format!("{:03} {}", i, row[0]), row.clone())).collect()
        };
        let names: Vec<&str> = before.columns.iter().map(String::as_str).collect();
        let now = by_name(&now.choose(&names));
        wrong.extend(compared(&by_name(&before), &now, &before.columns));
    }
    none(&wrong);
}
