//! `report.html`: complete, safe, small, and the same from a stored record.

mod command;
mod page;

use std::collections::BTreeSet;

use trueflight::case::Case;
use trueflight::case::suite;
use trueflight::gate::session::Reason;
use trueflight::plan::{Plan, PlannedCase};
use trueflight::record::baseline::MeasuredValue;
use trueflight::record::{CaseRecord, Record, Row, Verdict, build};
use trueflight::report::run::{html, record_json};

use crate::common::{options, shipped_plan, shipped_record};
use crate::golden::record;
use page::{Element, elements};

/// Text in a case that tries to inject markup.
const HOSTILE: &str = "</title><script>alert(1)</script><img src=x onerror=alert(2)>\"' &amp; ]]>";

fn text(record: &Record) -> String {
    html::text(record).expect("renders")
}

fn all<'a>(elements: &'a [Element], name: &str) -> Vec<&'a Element> {
    elements.iter().filter(|element| element.name == name).collect()
}

/// Returns the built-in suite with few draws and the curves of its plots.
fn built_in() -> Record {
    let sources = suite::suite();
    let cases: Vec<Case> =
        sources.iter().map(|source| Case::read(source).expect("a case")).collect();
    let mut record = shipped_record().clone();
    let of_name = |case: &Case| {
        let found = record.results.cases.iter().find(|found| found.name == case.name);
        found.expect("the suite is among the shipped cases").clone()
    };
    record.results.cases = cases.iter().map(of_name).collect();
    // Predicted curves need no experiments.
    let bare = cases.iter().map(|case| PlannedCase { case, experiments: Vec::new() });
    let levels = shipped_plan().levels;
    let plan = Plan { options: options(1, 1), cases: bare.collect(), levels };
    build::add_curves(&plan, &mut record);
    record
}

/// Asserts the properties of every page.
fn assert_whole(html: &str, record: &Record) {
    let elements = elements(html);
    let ids: Vec<&str> =
        elements.iter().filter_map(|one| one.attributes.get("id")).map(String::as_str).collect();
    let distinct: BTreeSet<&str> = ids.iter().copied().collect();
    assert_eq!(ids.len(), distinct.len(), "an id stands twice");
    for element in &elements {
        for (name, value) in &element.attributes {
            assert!(!name.starts_with("on") && name != "src", "{name} of {}", element.name);
            let target = match name.as_str() {
                "href" => value.strip_prefix('#').expect("a place on the page"),
                "aria-labelledby" => value,
                _ => continue,
            };
            assert!(distinct.contains(target), "{target} is nowhere");
        }
    }
    assert!(!html.contains("://") && !html.contains("url(") && !html.contains("@import"));
    assert_eq!(all(&elements, "script").len(), 1);
    let bodies: Vec<&Element> = all(&elements, "tbody");
    let experiments: Vec<_> =
        bodies.iter().filter(|body| body.attributes.contains_key("data-verdict")).collect();
    let rows: Vec<Row> = record.results.rows().collect();
    assert_eq!(experiments.len(), rows.len());
    for (body, row) in experiments.iter().zip(rows) {
        let experiment = row.experiment;
        let words =
            [&row.case.name, &experiment.label, &row.channel, &row.reason(), &experiment.command];
        for word in words {
            assert!(body.text.contains(word.as_str()), "{word} is not in {}", body.text);
        }
        let word = row.verdict.map_or("undecided", Verdict::word);
        assert_eq!(body.attributes["data-verdict"], word);
    }
    for case in &record.results.cases {
        let shown = all(&elements, "details").iter().any(|one| one.text.contains(&case.title));
        assert!(shown, "{}", case.title);
    }
}

#[test]
fn a_page_is_well_formed_and_has_every_experiment() {
    let record = record();
    assert_whole(&text(&record), &record);
}

/// Compares two pages; the panic shows the first difference.
fn assert_same(one: &str, other: &str) {
    if let Some((line, pair)) =
        one.split('>').zip(other.split('>')).enumerate().find(|(_, (a, b))| a != b)
    {
        panic!("they part at tag {line}: {pair:?}");
    }
    assert_eq!(one.len(), other.len());
}

/// Returns the record as read back from its file.
fn read_back(record: &Record) -> Record {
    let json = record_json::text(record).expect("renders");
    record_json::read(json.as_bytes()).expect("reads")
}

#[test]
fn the_page_of_the_built_in_suite_is_small_and_the_same_from_its_json() {
    let record = built_in();
    let rows: Vec<Row> = record.results.rows().collect();
    for verdict in [Verdict::Pass, Verdict::Inconclusive, Verdict::Underpowered, Verdict::Refused] {
        assert!(rows.iter().any(|row| row.verdict == Some(verdict)), "none is {}", verdict.word());
    }
    let html = text(&record);
    assert_whole(&html, &record);
    assert!(html.len() < 4_000_000, "{} bytes", html.len());
    assert_same(&html, &text(&read_back(&record)));
}

#[test]
fn numbers_that_json_cannot_hold_make_the_same_page_from_it() {
    for odd in [f64::NAN, f64::INFINITY] {
        let mut record = record();
        let results = &mut record.results;
        let gate = &mut results.gate;
        for place in [&mut gate.ln_mean_e, &mut gate.smallest_margin, &mut gate.worst_bias] {
            *place = Some(odd);
        }
        for case in &mut results.cases {
            case.pace = Some(odd);
            for one in &mut case.experiments {
                one.lookups_per_draw = one.lookups_per_draw.map(|_| odd);
                for channel in &mut one.channels {
                    for place in [
                        &mut channel.mean,
                        &mut channel.standard_error,
                        &mut channel.variance,
                        &mut channel.z_mean,
                        &mut channel.z_variance,
                        &mut channel.predicted_variance,
                        &mut channel.fom,
                        &mut channel.detectable_bias,
                        &mut channel.predicted_kurtosis,
                    ] {
                        *place = place.map(|_| odd);
                    }
                }
                for finding in &mut one.findings {
                    finding.path.iter_mut().for_each(|look| look[1] = odd);
                    if let Some(gate) = &mut finding.gate {
                        (gate.variance, gate.ln_e, gate.ln_p) = (odd, odd, [odd; 2]);
                    }
                }
                one.courses.iter_mut().for_each(|course| course.sampling = vec![odd; 4]);
            }
            if let Some(anatomy) = &mut case.anatomy {
                anatomy.deviation.fill(odd);
            }
        }
        for change in &mut record.comparison.as_mut().expect("a comparison").changes {
            change.before.value = 1.0;
            change.now = MeasuredValue { value: odd, error: Some(odd) };
            (change.ratio, change.interval) = (odd, Some([0.5, odd]));
        }
        let html = text(&record);
        assert_whole(&html, &record);
        assert_same(&html, &text(&read_back(&record)));
    }
}

#[test]
fn small_plots_show_ln_e_beside_its_limit_and_where_an_inequality_fails() {
    let elements = elements(&text(&record()));
    let figures = all(&elements, "figure");
    let captions: Vec<&str> = figures.iter().map(|figure| figure.text.as_str()).collect();
    let evidence = "ln E from look to look, 4096 to 262144 draws: mean";
    assert!(captions.iter().any(|caption| caption.contains(evidence)), "{captions:#?}");
    let course = "From t = 0 to 3, up to 0.9 per length; it fails at t = 1: σ_t σ\u{302}";
    assert!(captions.iter().any(|caption| caption.contains(course)), "{captions:#?}");
    // ln E = 31.25 of 8.5 is beyond the upper edge, −0.25 of 8.5 just below the middle.
    let lines = all(&elements, "path");
    let way = |d: &str| lines.iter().any(|line| line.attributes["d"] == d);
    assert!(
        way("M0 61l333-4 67-57"),
        "{:?}",
        lines.iter().map(|line| &line.attributes["d"]).collect::<Vec<_>>()
    );
}

#[test]
fn words_of_a_case_are_text_whatever_is_in_them() {
    let mut record = record();
    for case in &mut record.results.cases {
        for word in [&mut case.title, &mut case.path, &mut case.problem, &mut case.medium] {
            *word = HOSTILE.to_owned();
        }
        for one in &mut case.experiments {
            for word in [&mut one.label, &mut one.id.control, &mut one.command] {
                *word = HOSTILE.to_owned();
            }
            for (number, channel) in one.channels.iter_mut().enumerate() {
                channel.channel = format!("{HOSTILE}{number}");
            }
            for finding in &mut one.findings {
                finding.channel = format!("{HOSTILE}0");
                finding.reason = Some(Reason::Dependent(HOSTILE.to_owned()));
            }
        }
        case.name_experiments();
        if let Some(sweep) = &mut case.sweep {
            sweep.axis = HOSTILE.to_owned();
        }
    }
    record.results.version = HOSTILE.to_owned();
    record.timing.level = HOSTILE.to_owned();
    record.results.gate.triage[0].experiment = HOSTILE.to_owned();
    record.comparison.as_mut().expect("a comparison").name = HOSTILE.to_owned();
    let html = text(&record);
    assert_whole(&html, &record);
    let elements = elements(&html);
    assert!(all(&elements, "img").is_empty());
    let plots: Vec<_> = all(&elements, "symbol");
    let plots: Vec<_> =
        plots.into_iter().filter(|plot| plot.attributes["id"] != "ground").collect();
    assert!(plots.len() == 2 && plots.iter().all(|plot| plot.text.contains("<script>alert(1)")));
}

#[test]
fn the_first_line_is_the_verdict() {
    let heading = |record: &Record| {
        let elements = elements(&text(record));
        all(&elements, "h1")[0].text.clone()
    };
    let mut record = record();
    let line = heading(&record);
    assert!(line.starts_with("fail: 3 of 11 fail, something became worse"), "{line}");
    record.comparison = None;
    let set = |record: &mut Record, verdicts: &[Verdict]| {
        let channels = record.results.cases.iter_mut().flat_map(CaseRecord::channels_mut);
        channels
            .zip(verdicts.iter().cycle())
            .for_each(|(row, &verdict)| row.verdict = Some(verdict));
    };
    set(&mut record, &[Verdict::Pass, Verdict::Inconclusive]);
    assert_eq!(heading(&record), "inconclusive: 5 of 11 are inconclusive");
    set(&mut record, &[Verdict::Pass, Verdict::Underpowered]);
    assert_eq!(heading(&record), "pass: nothing of 11 fails or is inconclusive");
    set(&mut record, &[Verdict::Refused]);
    assert_eq!(heading(&record), "nothing was tested: none of 11 passes or fails");
}

#[test]
fn changes_have_arrows_ratios_and_intervals() {
    let html = text(&record());
    let elements = elements(&html);
    let line = |what: &str| {
        let rows = all(&elements, "tr");
        let found = rows.iter().find(|row| row.text.contains(what));
        found.unwrap_or_else(|| panic!("no {what}")).text.clone()
    };
    let variance = line("↑ worse");
    assert!(variance.contains("1.500") && variance.contains("[1.425, 1.575]"), "{variance}");
    let lookups = line("↓ better");
    assert!(lookups.contains("0.5000") && lookups.contains("[0.4750, 0.5250]"), "{lookups}");
    let time = line("time per draw");
    assert!(time.contains("2.000") && time.contains("unknown"), "{time}");
    assert!(line("✗ fails over all runs").contains("ln E = 9.25 ≥ 8.5"));
}
