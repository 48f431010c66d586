//! Page of HTML as a list of elements, read by a parser of XML with a list of the elements without an end.

use std::collections::BTreeMap;

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

/// Elements that end where another one begins or ends.
const OPTIONAL: [&str; 7] = ["td", "th", "tr", "dt", "dd", "li", "option"];
/// Elements without an end.
const VOID: [&str; 3] = ["meta", "input", "link"];

/// Element.
pub struct Element {
    pub name: String,
    pub attributes: BTreeMap<String, String>,
    /// All text in it.
    pub text: String,
}

/// Returns the elements of a page in the order in which they begin. Panics if an end is missing or misplaced.
pub fn elements(html: &str) -> Vec<Element> {
    let html = without(&without(html, "style"), "script");
    let mut reader = Reader::from_str(&html);
    reader.config_mut().check_end_names = false;
    let (mut all, mut open): (Vec<Element>, Vec<usize>) = (Vec::new(), Vec::new());
    loop {
        match reader.read_event().expect("well-formed HTML") {
            Event::Start(start) => {
                let ended = ended_by(start.name().as_ref());
                while open.last().is_some_and(|&at| ended.contains(&all[at].name.as_str())) {
                    open.pop();
                }
                all.push(element(&start));
                if !VOID.contains(&all[all.len() - 1].name.as_str()) {
                    open.push(all.len() - 1);
                }
            }
            Event::Empty(start) => all.push(element(&start)),
            Event::End(end) => {
                let is_astray = |at: usize| {
                    let name = all[at].name.as_str();
                    OPTIONAL.contains(&name) && name != end.name().as_ref()
                };
                while open.last().is_some_and(|&at| is_astray(at)) {
                    open.pop();
                }
                let last = open.pop().expect("something is open");
                assert_eq!(all[last].name, end.name().as_ref(), "the end of another element");
            }
            Event::Text(text) => open.iter().for_each(|&at| all[at].text.push_str(&text)),
            Event::GeneralRef(name) => {
                let text = format!("&{};", &*name);
                let text = quick_xml::escape::unescape(&text).expect("a known entity");
                for &at in &open {
                    all[at].text.push_str(&text);
                }
            }
            Event::DocType(_) => assert!(all.is_empty(), "a second document"),
            Event::Eof => break,
            other => panic!("unexpected {other:?}"),
        }
    }
    assert!(open.is_empty(), "{} elements are not closed", open.len());
    all
}

/// Returns the elements that end where this one begins, if they are open.
fn ended_by(name: &str) -> &'static [&'static str] {
    match name {
        "td" | "th" => &["td", "th"],
        "tr" => &["td", "th", "tr"],
        "dt" | "dd" => &["dt", "dd"],
        "li" => &["li"],
        "option" => &["option"],
        _ => &[],
    }
}

fn element(start: &BytesStart) -> Element {
    let attributes = start.html_attributes().map(|attribute| {
        let attribute = attribute.expect("a well-formed attribute");
        let value = quick_xml::escape::unescape(&attribute.value).expect("known entities");
        (attribute.key.as_ref().to_owned(), value.into_owned())
    });
    let name = start.name().as_ref().to_owned();
    Element { name, attributes: attributes.collect(), text: String::new() }
}

/// Returns the page without the content of the first element of this name, which is not HTML.
fn without(html: &str, name: &str) -> String {
    let (begin, end) = (format!("<{name}>"), format!("</{name}>"));
    let (before, rest) = html.split_once(&begin).expect("the element");
    let (_, after) = rest.split_once(&end).expect("its end");
    format!("{before}{begin}{end}{after}")
}
