//! JUnit XML as text: suites of tests, in the form of the Jenkins schema `junit-10.xsd`.

use std::fmt::Write;
use std::time::Duration;

/// Suite of tests.
#[derive(Debug, Default)]
pub struct Suite {
    /// Name.
    pub name: String,
    /// Time of all tests, if it is known.
    pub time: Option<Duration>,
    /// Names and values.
    pub properties: Vec<(&'static str, String)>,
    /// Tests.
    pub tests: Vec<Test>,
    /// Output, if there is one.
    pub output: Option<String>,
}

/// Test of a suite.
#[derive(Debug, Default)]
pub struct Test {
    /// Name.
    pub name: String,
    /// Class, under which most services list the test.
    pub class: Option<String>,
    /// Time, if it is known.
    pub time: Option<Duration>,
    /// Result, if it is no success.
    pub trouble: Option<Trouble>,
    /// Output, if there is one.
    pub output: Option<String>,
}

/// Result of a test that is no success.
#[derive(Debug)]
pub struct Trouble {
    /// Element.
    pub kind: ResultKind,
    /// Type, in one word.
    pub word: &'static str,
    /// Reason, on one line.
    pub message: String,
    /// Details, on any number of lines.
    pub details: Option<String>,
}

/// Kind of a result that is no success.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ResultKind {
    /// The test found a defect.
    Failure,
    /// The test could not do its work.
    Error,
    /// The test was not made.
    Skipped,
}

impl ResultKind {
    fn word(self) -> &'static str {
        match self {
            Self::Failure => "failure",
            Self::Error => "error",
            Self::Skipped => "skipped",
        }
    }
}

/// Returns the suites as a file, with the time of all of them, if it is known. The schema has no count of skipped tests
/// at the root; the suites have theirs.
pub fn text(suites: &[Suite], time: Option<Duration>) -> String {
    let mut page = XmlDocument::default();
    page.text.push_str("<?xml version=\"1.0\" encoding=\"UTF-8\"?>");
    let sum = |kind| suites.iter().map(|suite| suite.count(kind)).sum::<usize>();
    let tests: usize = suites.iter().map(|suite| suite.tests.len()).sum();
    page.start("testsuites");
    page.attribute("name", "trueflight");
    page.attribute("tests", &tests.to_string());
    page.attribute("failures", &sum(ResultKind::Failure).to_string());
    page.attribute("errors", &sum(ResultKind::Error).to_string());
    page.time(time);
    page.within("testsuites", |page| suites.iter().for_each(|suite| suite.write(page)));
    page.text + "\n"
}

impl Suite {
    fn count(&self, kind: ResultKind) -> usize {
        let kinds = self.tests.iter().filter_map(|test| test.trouble.as_ref());
        kinds.filter(|trouble| trouble.kind == kind).count()
    }

    fn write(&self, page: &mut XmlDocument) {
        page.start("testsuite");
        page.attribute("name", &self.name);
        page.attribute("tests", &self.tests.len().to_string());
        page.attribute("skipped", &self.count(ResultKind::Skipped).to_string());
        page.attribute("errors", &self.count(ResultKind::Error).to_string());
        page.attribute("failures", &self.count(ResultKind::Failure).to_string());
        page.time(self.time);
        if self.properties.is_empty() && self.tests.is_empty() && self.output.is_none() {
            return page.end_empty();
        }
        page.within("testsuite", |page| {
            if !self.properties.is_empty() {
                page.start("properties");
                page.within("properties", |page| {
                    for (name, value) in &self.properties {
                        page.start("property");
                        page.attribute("name", name);
                        page.attribute("value", value);
                        page.end_empty();
                    }
                });
            }
            self.tests.iter().for_each(|test| test.write(page));
            page.output(self.output.as_deref());
        });
    }
}

impl Test {
    fn write(&self, page: &mut XmlDocument) {
        page.start("testcase");
        page.attribute("name", &self.name);
        if let Some(class) = &self.class {
            page.attribute("classname", class);
        }
        page.time(self.time);
        if self.trouble.is_none() && self.output.is_none() {
            return page.end_empty();
        }
        page.within("testcase", |page| {
            if let Some(trouble) = &self.trouble {
                page.start(trouble.kind.word());
                page.attribute("message", &trouble.message);
                page.attribute("type", trouble.word);
                match &trouble.details {
                    Some(details) => page.end_with(trouble.kind.word(), details),
                    None => page.end_empty(),
                }
            }
            page.output(self.output.as_deref());
        });
    }
}

/// XML so far: an element a line, indented by its depth.
#[derive(Default)]
struct XmlDocument {
    text: String,
    depth: usize,
}

impl XmlDocument {
    fn line(&mut self) {
        self.text.push('\n');
        self.text.extend(std::iter::repeat_n("    ", self.depth));
    }

    /// Starts an element; attributes follow, then one of the ends.
    fn start(&mut self, name: &str) {
        self.line();
        self.text.push('<');
        self.text.push_str(name);
    }

    fn attribute(&mut self, name: &str, value: &str) {
        // Writing to a string cannot fail.
        let _ = write!(self.text, " {name}=\"");
        self.escape(value);
        self.text.push('"');
    }

    fn time(&mut self, time: Option<Duration>) {
        if let Some(time) = time {
            self.attribute("time", &format!("{:.3}", time.as_secs_f64()));
        }
    }

    fn end_empty(&mut self) {
        self.text.push_str("/>");
    }

    fn end_with(&mut self, name: &str, text: &str) {
        self.text.push('>');
        self.escape(text);
        // Writing to a string cannot fail.
        let _ = write!(self.text, "</{name}>");
    }

    fn within(&mut self, name: &str, content: impl FnOnce(&mut Self)) {
        self.text.push('>');
        self.depth += 1;
        content(self);
        self.depth -= 1;
        self.line();
        // Writing to a string cannot fail.
        let _ = write!(self.text, "</{name}>");
    }

    fn output(&mut self, text: Option<&str>) {
        if let Some(text) = text {
            self.start("system-out");
            self.end_with("system-out", text);
        }
    }

    /// Adds text. Control characters and what is no character, which XML cannot represent, are left out.
    fn escape(&mut self, text: &str) {
        for c in text.chars() {
            match c {
                '&' => self.text.push_str("&amp;"),
                '<' => self.text.push_str("&lt;"),
                '>' => self.text.push_str("&gt;"),
                '"' => self.text.push_str("&quot;"),
                '\'' => self.text.push_str("&apos;"),
                '\n' => self.text.push(c),
                '\0'..' ' | '\u{7f}' | '\u{fffe}' | '\u{ffff}' => {}
                c => self.text.push(c),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_becomes_no_markup_and_has_only_characters_of_xml() {
        let mut page = XmlDocument::default();
        page.escape("<a b=\"c\" d='e'>&amp; ]]>\u{0}\t\r\u{1b}\u{7f}\u{fffe}\n\u{85}σ\u{1f600}");
        let expected =
            "&lt;a b=&quot;c&quot; d=&apos;e&apos;&gt;&amp;amp; ]]&gt;\n\u{85}σ\u{1f600}";
        assert_eq!(page.text, expected);
    }

    #[test]
    fn elements_without_content_are_closed_at_once() {
        let skipped = Trouble {
            kind: ResultKind::Skipped,
            word: "refused",
            message: "a\"b".to_owned(),
            details: None,
        };
        let tests = vec![
            Test { name: "one".to_owned(), ..Test::default() },
            Test { name: "two".to_owned(), trouble: Some(skipped), ..Test::default() },
            Test { name: "three".to_owned(), output: Some(String::new()), ..Test::default() },
        ];
        let full = Suite { name: "full".to_owned(), tests, ..Suite::default() };
        let time = Some(Duration::from_millis(1500));
        let empty = Suite { name: "empty".to_owned(), time, ..Suite::default() };
        let expected = r#"<?xml version="1.0" encoding="UTF-8"?>
<testsuites name="trueflight" tests="3" failures="0" errors="0">
    <testsuite name="full" tests="3" skipped="1" errors="0" failures="0">
        <testcase name="one"/>
        <testcase name="two">
            <skipped message="a&quot;b" type="refused"/>
        </testcase>
        <testcase name="three">
            <system-out></system-out>
        </testcase>
    </testsuite>
    <testsuite name="empty" tests="0" skipped="0" errors="0" failures="0" time="1.500"/>
</testsuites>
"#;
        assert_eq!(text(&[full, empty], None), expected);
    }
}
