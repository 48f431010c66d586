//! The JUnit report has the form that CI services read, after the Jenkins schema `junit-10.xsd`.

use std::collections::BTreeMap;

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use trueflight::gate::session::Reason;
use trueflight::record::{CaseRecord, Record};
use trueflight::report::run::junit::{self, Inconclusive};

use crate::golden;

/// Element with its attributes and its children.
#[derive(Default)]
struct Element {
    name: String,
    attributes: BTreeMap<String, String>,
    children: Vec<Element>,
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
                Event::Text(_) | Event::GeneralRef(_) | Event::Decl(_) => {}
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

/// Asserts the form `SUREFIRE_TIME`: digits, optionally a point and more digits.
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

/// Returns the golden record with texts and numbers that XML cannot represent; `golden` compares its report bytewise.
fn record() -> Record {
    let mut record = golden::record();
    record.comparison = None;
    record.results.cases.push(CaseRecord { name: "empty".into(), ..CaseRecord::default() });
    let odd = "off: \"<&>\" ]]> \u{1} \u{1b}[31m";
    let seconds = [1.5, f64::NAN, f64::INFINITY, -1.0, 1e300].into_iter().cycle();
    for case in &mut record.results.cases {
        case.title = "<\"odd\" & 'odd'>".into();
        for (one, seconds) in case.experiments.iter_mut().zip(seconds.clone()) {
            one.label = "ratio <&> \"σ\"".into();
            one.spent.seconds = Some(seconds);
            for finding in &mut one.findings {
                finding.reason = Some(Reason::Dependent(odd.to_owned()));
            }
            one.channels.iter_mut().for_each(|channel| channel.mean = Some(f64::NAN));
        }
        case.name_experiments();
    }
    record
}

#[test]
fn the_form_is_that_of_the_schema() {
    for (inconclusive, counts) in [
        (Inconclusive::Error, ["1", "2", "1"]),
        (Inconclusive::Failure, ["3", "0", "1"]),
        (Inconclusive::Skipped, ["1", "0", "3"]),
    ] {
        let root = assert_valid(&junit::text(&record(), inconclusive));
        let suite = &root.children[0];
        let found = ["failures", "errors", "skipped"].map(|name| suite.attribute(name));
        assert_eq!(found, counts, "{inconclusive:?}");
    }
}
