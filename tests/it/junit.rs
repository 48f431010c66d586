//! The JUnit report keeps to the form that CI services read, after the Jenkins schema
//! `junit-10.xsd`.

use std::collections::BTreeMap;

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use trueflight::record::{
    CaseRecord, ChannelRecord, ExperimentRecord, Finding, Record, Results, Spent, Timing, Verdict,
};
use trueflight::report::run::junit::{self, Inconclusive};

/// An element with its attributes, its children and its text.
#[derive(Default)]
struct Element {
    name: String,
    attributes: BTreeMap<String, String>,
    children: Vec<Element>,
    text: String,
}

impl Element {
    fn start(start: &BytesStart) -> Self {
        let attributes = start.attributes().map(|attribute| {
            let attribute = attribute.expect("a well-formed attribute");
            let key = attribute.key.as_ref().to_owned();
            (
                key,
                quick_xml::escape::unescape(&attribute.value).expect("known entities").into_owned(),
            )
        });
        let name = start.name().as_ref().to_owned();
        Self { name, attributes: attributes.collect(), ..Self::default() }
    }

    fn parse(xml: &str) -> Self {
        let mut reader = Reader::from_str(xml);
        let mut open = vec![Self::default()];
        loop {
            match reader.read_event().expect("well-formed XML") {
                Event::Start(start) => open.push(Self::start(&start)),
                Event::Empty(start) => {
                    open.last_mut().expect("a parent").children.push(Self::start(&start));
                }
                Event::End(_) => {
                    let done = open.pop().expect("an element");
                    open.last_mut().expect("a parent").children.push(done);
                }
                Event::Text(text) => open.last_mut().expect("a parent").text.push_str(&text),
                Event::GeneralRef(_) | Event::Decl(_) => {}
                Event::Eof => break,
                other => panic!("unexpected {other:?}"),
            }
        }
        let mut root = open.pop().expect("the document");
        assert!(open.is_empty(), "an element is not closed");
        assert_eq!(root.children.len(), 1, "one root");
        root.children.remove(0)
    }

    fn attribute(&self, name: &str) -> &str {
        self.attributes.get(name).unwrap_or_else(|| panic!("<{}> has no {name}", self.name))
    }

    fn count(&self, name: &str) -> usize {
        self.attribute(name).parse().expect("a count")
    }

    fn may_have(&self, names: &[&str]) {
        for name in self.attributes.keys() {
            assert!(names.contains(&name.as_str()), "<{}> must not have {name}", self.name);
        }
    }

    fn all(&self, name: &str) -> Vec<&Self> {
        self.children.iter().filter(|child| child.name == name).collect()
    }
}

/// `SUREFIRE_TIME`: digits, perhaps a point, digits.
fn assert_time(element: &Element) {
    let time = element.attribute("time");
    assert!(!time.is_empty() && time.chars().all(|c| c.is_ascii_digit() || c == '.'), "{time}");
    assert!(time.parse::<f64>().is_ok_and(f64::is_finite), "{time}");
}

fn assert_valid(xml: &str) -> Element {
    let root = Element::parse(xml);
    assert_eq!(root.name, "testsuites");
    root.may_have(&["name", "time", "tests", "failures", "errors"]);
    assert_time(&root);
    let mut sums = [0; 3];
    for suite in &root.children {
        assert_eq!(suite.name, "testsuite");
        suite.may_have(&["name", "tests", "failures", "errors", "skipped", "time"]);
        assert_time(suite);
        let order: Vec<&str> = suite.children.iter().map(|child| child.name.as_str()).collect();
        assert_eq!(order.first(), Some(&"properties"));
        assert!(order[1..].iter().all(|name| *name == "testcase"), "{order:?}");
        for property in &suite.children[0].children {
            assert_eq!(property.name, "property");
            assert!(!property.attribute("name").is_empty());
            property.attribute("value");
        }
        let tests = suite.all("testcase");
        let with = |name| tests.iter().filter(|test| !test.all(name).is_empty()).count();
        assert_eq!(suite.count("tests"), tests.len());
        assert_eq!(suite.count("failures"), with("failure"));
        assert_eq!(suite.count("errors"), with("error"));
        assert_eq!(suite.count("skipped"), with("skipped"));
        for (sum, name) in sums.iter_mut().zip(["tests", "failures", "errors"]) {
            *sum += suite.count(name);
        }
        for test in tests {
            test.may_have(&["name", "time", "classname"]);
            assert!(!test.attribute("name").is_empty());
            assert_eq!(test.attribute("classname"), suite.attribute("name"));
            assert_time(test);
            assert!(test.children.len() <= 1);
            for child in &test.children {
                assert!(["failure", "error", "skipped"].contains(&child.name.as_str()));
                child.may_have(&["type", "message"]);
                assert!(child.children.is_empty());
            }
        }
    }
    for (sum, name) in sums.into_iter().zip(["tests", "failures", "errors"]) {
        assert_eq!(root.count(name), sum, "{name}");
    }
    root
}

fn experiment((verdict, seconds): (Verdict, f64)) -> ExperimentRecord {
    let finding = Finding {
        check: "mean".into(),
        what: "the mean".into(),
        expects_bias: false,
        channel: String::new(),
        z: Some(9.0),
        p: None,
        gate: None,
        path: Vec::new(),
        block: Some(3),
        verdict,
        reason: "off: \"<&>\" ]]> \u{1} \u{1b}[31m".into(),
    };
    let channel = ChannelRecord {
        reason: finding.reason.clone(),
        verdict: Some(verdict),
        mean: Some(f64::NAN),
        ..ChannelRecord::default()
    };
    ExperimentRecord {
        label: "ratio <&> \"σ\"".into(),
        stream: Some(verdict as u64),
        command: "trueflight run case --filter \"*:ratio\" --seed 7".into(),
        findings: vec![finding],
        spent: Spent { seconds: Some(seconds), is_reused: false },
        channels: vec![channel],
        ..ExperimentRecord::default()
    }
}

fn record() -> Record {
    let all = [
        (Verdict::Pass, 1.5),
        (Verdict::Fail, f64::NAN),
        (Verdict::Inconclusive, f64::INFINITY),
        (Verdict::Underpowered, -1.0),
        (Verdict::Refused, 1e300),
    ];
    let mut case = CaseRecord {
        name: "a/b".into(),
        title: "<\"odd\" & 'odd'>".into(),
        experiments: all.map(experiment).to_vec(),
        ..CaseRecord::default()
    };
    case.name_experiments();
    let empty = CaseRecord { name: "empty".into(), ..CaseRecord::default() };
    Record {
        results: Results {
            schema: 2,
            version: "0.1.0".into(),
            seed: 7,
            alpha: 1e-3,
            streams: String::new(),
            gate: trueflight::record::Gate::default(),
            cut_by_time: false,
            cut_by_budget: false,
            cases: vec![case, empty],
        },
        timing: Timing { threads: 2, level: "avx2".into(), seconds: 1234.5 },
        comparison: None,
    }
}

#[test]
fn the_form_is_that_of_the_schema() {
    for (inconclusive, counts) in [
        (Inconclusive::Error, ["1", "1", "2"]),
        (Inconclusive::Failure, ["2", "0", "2"]),
        (Inconclusive::Skipped, ["1", "0", "3"]),
    ] {
        let root = assert_valid(&junit::text(&record(), inconclusive).expect("renders"));
        let suite = &root.children[0];
        let found = ["failures", "errors", "skipped"].map(|name| suite.attribute(name));
        assert_eq!(found, counts, "{inconclusive:?}");
    }
}

#[test]
fn a_failure_says_all_that_it_takes_to_repeat_it() {
    let root = assert_valid(&junit::text(&record(), Inconclusive::Error).expect("renders"));
    let tests = root.children[0].all("testcase");
    let failure = tests[1].all("failure")[0];
    assert_eq!(failure.attribute("type"), "fail");
    for words in ["case: a/b", "check: mean", "seed: 7", "stream: 1", "block: 3", "--seed 7"] {
        assert!(failure.text.contains(words), "no \"{words}\" in {}", failure.text);
    }
    assert_eq!(tests[2].all("error")[0].attribute("type"), "inconclusive");
    let properties = &root.children[0].children[0].children;
    let names: Vec<&str> = properties.iter().map(|property| property.attribute("name")).collect();
    assert_eq!(names, ["title", "seed", "alpha", "version", "schema"]);
}
