//! Cases that are built into the binary: a choice of those under `cases/` and `tests/cases/`, one line each; and
//! examples for the pages of the catalogue, which are built-in cases reduced to the settings that a page needs.

use crate::case::forms::chosen_form;
use crate::case::spec::{BuiltIn, Source, Spec, entry};
use media::catalogue::{Entry, Node, Value, own_pages};

/// Lists built-in cases by their path below `cases/`, without `.toml`; `in "tests/"` means `tests/cases/`.
macro_rules! cases {
    ($($name:literal $(in $folder:literal)?,)*) => {
        BuiltIn {
            folder: "",
            files: &[$(($name, include_str!(concat!("../../", $($folder,)? "cases/", $name, ".toml")))),*],
        }
    };
}

/// The names of the built-in cases with their text.
const CASES: BuiltIn = cases![
    "transmittance/eq21-overview",
    "transmittance/next-flight",
    "transmittance/negative-extinction",
    "transmittance/ratio-exactly-one" in "tests/",
    "transmittance/decomposition",
    "transmittance/local-majorants",
    "transmittance/layers-with-gap",
    "transmittance/exponential",
    "transmittance/gaussian" in "tests/",
    "transmittance/grid-trilinear",
    "transmittance/grid-nearest" in "tests/",
    "transmittance/noise-4" in "tests/",
    "transmittance/pilot",
    "transmittance/biased-ray-marching",
    "transmittance/biased-misuse" in "tests/",
    "transmittance/eq21-missing" in "tests/",
    "transmittance/sines" in "tests/",
    "transmittance/ramps" in "tests/",
    "transmittance/tight-control" in "tests/",
    "transmittance/known-bugs" in "tests/",
    "transmittance/deep" in "tests/",
    "free-flight/eq21-central",
    "free-flight/layers-with-gap",
    "free-flight/exponential",
    "free-flight/known-bugs" in "tests/",
    "transmittance/spectral-layers",
    "transmittance/spectral-smooth" in "tests/",
    "transmittance/curve-eq21-figure-8",
    "transmittance/curve-noise-figure-5",
    "transmittance/curve-known-bugs" in "tests/",
    "rod/three-rules-a0.7",
    "rod/roulette",
    "rod/known-bugs" in "tests/",
    "rod/spectral-three-albedos",
    "rod/spectral-near-albedos" in "tests/",
    "rod/lit-homogeneous",
    "rod/lit-rising" in "tests/",
    "rod/lit-albedos",
    "slab/lit-known-bugs" in "tests/",
    "slab/lit-distant",
    "slab/lit-cap-wide",
    "rod/spectral-lit-three-colours",
    "rod/spectral-lit-one-medium" in "tests/",
    "rod/spectral-lit-as-printed",
    "rod/spectral-lit-contrast",
    "single-scattering/homogeneous",
    "single-scattering/known-bugs" in "tests/",
    "single-scattering/null-paths-layers",
    "single-scattering/spectral-known-bugs" in "tests/",
    "single-scattering/spectral-without-mis",
    "slab/known-bugs" in "tests/",
    "slab/known-bugs-diffuse" in "tests/",
    "slab/spectral-known-bugs" in "tests/",
    "slab/chromatic-three-colours",
    "slab/chromatic-like-colours",
    "furnace/eq21",
    "furnace/known-bugs" in "tests/",
    "furnace/spectral-known-bugs" in "tests/",
    "furnace/spectral-like-colours",
    "lambertian/known-bugs" in "tests/",
    "lambertian/known-bugs-cells" in "tests/",
    "infinite-medium/known-bugs" in "tests/",
    "ball/known-bugs" in "tests/",
    "ball/known-bugs-paths" in "tests/",
    "ball/techniques",
    "ball/techniques-homogeneous" in "tests/",
    "ball/techniques-lamp" in "tests/",
    "ball/environment",
    "rod/bidirectional-known-bugs" in "tests/",
];

/// Cases of `trueflight-lab self-test`, which are not part of the suite.
const CALIBRATION: BuiltIn = cases![
    "transmittance/calibration" in "tests/",
    "free-flight/calibration" in "tests/",
    "transmittance/curve-calibration" in "tests/",
];

/// Cases for `explain` only, with an estimator that no case of the suite has.
const SHOWN: BuiltIn = cases!["lambertian/eq21",];

/// Returns the cases that test the gate itself.
pub fn calibration() -> Vec<Source> {
    CALIBRATION.all()
}

/// Returns every built-in case, in the order of the suite.
pub fn suite() -> Vec<Source> {
    CASES.all()
}

/// Returns the built-in case of a name.
pub fn find(name: &str) -> Option<Source> {
    CASES.find(name).or_else(|| CALIBRATION.find(name))
}

/// Penalty of a case with a sweep, in letters of its text.
const SWEEP: usize = 400;
/// Penalty of a declared bias.
const BIASED: usize = 300;
/// Penalty of options of a problem, for an example of that problem.
const WITH_OPTIONS: usize = 1000;
/// Penalty of problems other than transmittance, for an example of any other page.
const OTHER_PROBLEM: usize = 200;

/// Returns a complete case in which a page of a part of the catalogue is used, as in `example("media", "eq21")`; `None`
/// for pages of other parts, and for those that a program adds.
///
/// A problem has its shortest case. An estimator, a medium, a phase function, a recipe for σ̂ or a control has the
/// shortest case in which it stands, with one estimator. Cases without a sweep, and of transmittance, go first.
pub fn example(part: &str, name: &str) -> Option<String> {
    let page = Target { part, name };
    let sources = [suite(), SHOWN.all()].concat();
    let candidates = sources.iter().flat_map(|source| page.candidates(source));
    let (_, text) = candidates.min()?;
    Some(text)
}

/// Page that an example is made for.
struct Target<'a> {
    part: &'a str,
    name: &'a str,
}

impl Target<'_> {
    /// Returns every way to reduce a case to an example, with its length and penalties.
    fn candidates(&self, source: &Source) -> Vec<(usize, String)> {
        let Ok(spec) = Spec::parse(source, &own_pages::NONE) else { return Vec::new() };
        let Some((problem, body)) = spec.problem() else { return Vec::new() };
        let title = chosen_form(problem, body).map_or(String::new(), |form| form.title);
        let root = spec.entries();
        let Some(list) = entry(body, "estimators") else { return Vec::new() };
        let Value::Array(items) = &list.node.value else { return Vec::new() };
        let others: Vec<&Entry> = body.iter().filter(|own| own.key != "estimators").collect();
        if self.part == "problems" {
            let all = (problem == self.name).then(|| self.reduced(source, root, None));
            let extra = if title == problem { 0 } else { WITH_OPTIONS };
            return all.map(|text| (text.len() + extra, text)).into_iter().collect();
        }
        let fitting = items.iter().filter(|item| self.is_in(&title, &others, item));
        let candidate = |item: &Node| {
            let text = self.reduced(source, root, Some((&list.node, item)));
            let is_general = !self.part.starts_with("estimators");
            let cost = [
                (entry(body, "sweep").is_some(), SWEEP),
                (text.contains("expect"), BIASED),
                (is_general && title != "transmittance", OTHER_PROBLEM),
            ];
            (
                text.len() + cost.iter().filter(|(is, _)| *is).map(|(_, cost)| cost).sum::<usize>(),
                text,
            )
        };
        fitting.map(candidate).collect()
    }

    /// Returns whether the page is used by this estimator of a case, or by the case's own settings.
    fn is_in(&self, title: &str, others: &[&Entry], item: &Node) -> bool {
        let Value::Table(item) = &item.value else { return false };
        let among = |keys: &[&str]| others.iter().any(|own| self.names(own, keys));
        let within = |key: &str| item.iter().any(|own| self.stands_below(own, key));
        match self.part {
            "media" => among(&["medium", "volume"]),
            "phases" => among(&["phase"]),
            "controls" => within("control"),
            "sampling" => {
                let has_own = item.iter().any(|own| has_key(&own.node.value, "sampling"));
                if has_own { within("sampling") } else { among(&["sampling"]) }
            }
            part => {
                let own = part.strip_prefix("estimators of ").is_some_and(|of| of == title);
                own && item.first().is_some_and(|estimator| estimator.key == self.name)
            }
        }
    }

    /// Returns whether an entry has one of these keys and chooses the page.
    fn names(&self, own: &Entry, keys: &[&str]) -> bool {
        let chosen = |value: &Value| matches!(value, Value::Table(table) if entry(table, self.name).is_some());
        keys.contains(&own.key.as_str())
            && match &own.node.value {
                Value::Array(channels) => channels.iter().any(|node| chosen(&node.value)),
                value => chosen(value),
            }
    }

    /// Returns whether an entry, or one below it, has this key and chooses the page.
    fn stands_below(&self, own: &Entry, key: &str) -> bool {
        let below = |table: &Vec<Entry>| table.iter().any(|own| self.stands_below(own, key));
        self.names(own, &[key]) || matches!(&own.node.value, Value::Table(table) if below(table))
    }

    /// Returns the case's text with a title of its own, without the comments at its head, and with one estimator if one
    /// is given.
    fn reduced(&self, source: &Source, root: &[Entry], only: Option<(&Node, &Node)>) -> String {
        let text = &source.text;
        let kind = if self.part == "problems" { "problem" } else { self.part };
        let title = format!("\"An example of {} ({kind})\"", self.name);
        let mut cuts = vec![];
        if let Some(own) = entry(root, "title") {
            cuts.push((own.node.span.clone(), title));
        }
        if let Some((list, item)) = only {
            let item = &text[item.span.clone()];
            cuts.push((list.span.clone(), format!("[\n  {item},\n]")));
        }
        // From the end on: earlier spans keep their places.
        cuts.sort_by_key(|(span, _)| std::cmp::Reverse(span.start));
        let mut reduced = text.clone();
        for (span, new) in cuts {
            reduced.replace_range(span, &new);
        }
        let kept = reduced.lines().skip_while(|line| line.is_empty() || line.starts_with('#'));
        kept.flat_map(|line| [line, "\n"]).collect()
    }
}

/// Returns whether a table has such a key, at any depth.
fn has_key(value: &Value, key: &str) -> bool {
    let is_there = |own: &Entry| own.key == key || has_key(&own.node.value, key);
    matches!(value, Value::Table(table) if table.iter().any(is_there))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_has_the_shortest_case_in_which_it_stands() {
        let text = example("media", "eq21").expect("an example");
        assert!(text.starts_with("title = \"An example of eq21 (media)\"\n"), "{text}");
        assert!(text.contains("volume.eq21") && text.contains("[problem.transmittance]"), "{text}");
        assert_eq!(text.matches("\n  { ").count(), 1, "{text}");
        assert_eq!(example("checks", "mean"), None);
        assert_eq!(example("estimators of transmittance", "no-such"), None);
    }
}
