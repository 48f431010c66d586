//! Converts records of version 1, which were flat rows of text, into the tree of version 2.
//!
//! In version 1 a case had `rows`, one for each experiment and channel, with everything of the experiment repeated in
//! each, and identities were labels. `null` stood for numbers that are not finite.

use std::collections::BTreeMap;

use serde_json::{Value, json};

/// The fields of a row that belong to its experiment.
const OF_EXPERIMENT: [&str; 16] = [
    "needs",
    "skipped",
    "draws",
    "drawn",
    "stream",
    "command",
    "setup_lookups",
    "lookups_per_draw",
    "predicted_lookups",
    "z_lookups",
    "lookups_deviation",
    "lookups_variance",
    "lookups_pmf",
    "stable_share",
    "p_law",
    "courses",
];
/// Fields of a finding of the gate with `null` for infinity; in other fields `null` stood for NaN.
const INFINITE: [&str; 3] = ["variance", "planned", "ln_e"];

/// Converts a document of version 1.
pub fn upgraded(mut document: Value) -> Value {
    let mut times = Vec::new();
    let timing = document["timing"].take();
    let mut sweeps = BTreeMap::new();
    for (number, case) in items(&mut document["results"]["cases"]).enumerate() {
        let of_rows = |key: &str, row: usize| timing[key][number][row].clone();
        sweeps.insert(text(&case["name"]), text(&case["sweep"]["what"]));
        times.extend(upgrade_case(case, &of_rows));
    }
    let results = &mut document["results"];
    results["schema"] = json!(2);
    for suspect in items(&mut results["gate"]["triage"]) {
        replace_null(&mut suspect["ln_e"], "inf");
    }
    let comparison = &mut document["comparison"];
    if !comparison.is_null() {
        upgrade_comparison(comparison, &sweeps);
    }
    document["schema"] = json!(2);
    document["timing"] = json!({
        "threads": timing["threads"], "level": timing["level"], "seconds": timing["seconds"],
        "experiments": times,
    });
    document
}

/// Converts a case; returns the times of its experiments. `of_rows` returns a time of a row.
fn upgrade_case(case: &mut Value, of_rows: &dyn Fn(&str, usize) -> Value) -> Vec<Value> {
    let what = text(&case["sweep"]["what"]);
    let names = [text(&case["name"]), text(&case["problem"])];
    let (mut experiments, mut times): (Vec<Value>, Vec<Value>) = (Vec::new(), Vec::new());
    let mut listed = Listed::default();
    let mut last = Value::Null;
    for (number, row) in items(&mut case["rows"]).enumerate() {
        let is_first = number == 0 || row["stream"].is_null() || row["stream"] != last;
        last = row["stream"].clone();
        if is_first {
            let experiment = experiment(&names, &what, row, &experiments, &mut listed);
            times.push(json!({
                "id": experiment["id"], "seconds": of_rows("rows", number),
                "reused": of_rows("reused", number).as_bool().unwrap_or_default(),
            }));
            experiments.push(experiment);
        }
        let Some(experiment) = experiments.last_mut() else { continue };
        let findings = items(&mut row["findings"]).map(|found| finding(found.take()));
        let own: Vec<Value> = findings.filter(|found| is_first || found["channel"] != "").collect();
        for (list, new) in [("findings", own), ("channels", vec![channel(row)])] {
            experiment[list].as_array_mut().into_iter().for_each(|list| list.extend(new.clone()));
        }
    }
    let anatomy = case["anatomy"].take();
    case["anatomy"] = upgraded_anatomy(anatomy, &experiments);
    if let Some(sweep) = case["sweep"].as_object_mut() {
        for curve in items(&mut sweep["curves"]) {
            let label = text(&curve["estimator"]);
            let number = curve["listed"].as_u64();
            let number = number.unwrap_or_else(|| listed.number(&label, true, 0) as u64);
            curve["listed"] = json!(number);
            retain_whole(curve.get_mut("points"));
        }
    }
    if !is_whole(&case["visible_bias"]) {
        case["visible_bias"] = Value::Null;
    }
    case["experiments"] = Value::Array(experiments);
    times
}

/// Indices of estimators, for records without them.
#[derive(Default)]
struct Listed(Vec<(String, bool, usize)>);

impl Listed {
    /// Returns the index of an estimator. Experiments of one label and one swept value are distinguished by their
    /// order.
    fn number(&mut self, label: &str, is_swept: bool, earlier: usize) -> usize {
        let key = (label.to_owned(), is_swept, earlier);
        self.0.iter().position(|other| *other == key).unwrap_or_else(|| {
            self.0.push(key);
            self.0.len() - 1
        })
    }
}

/// Returns the experiment of a row, still without channels and findings.
fn experiment(
    [case, problem]: &[String; 2],
    what: &str,
    row: &mut Value,
    before: &[Value],
    listed: &mut Listed,
) -> Value {
    let label = text(&row["estimator"]);
    let (estimator, written) = estimator(&label);
    let swept = row["swept"].as_f64().map(|value| json!({ "what": what, "value": value }));
    let mut id = json!({
        "case": case, "problem": problem, "estimator": estimator,
        "sampling": { "constant": row["sampling"], "kind": row["sampling_kind"] },
        "control": row["control"], "swept": swept, "namesake": written,
    });
    while before.iter().any(|other| other["id"] == id) {
        id["namesake"] = json!(id["namesake"].as_u64().unwrap_or_default() + 1);
    }
    let is_same = |other: &&Value| other["label"] == label && other["id"]["swept"] == id["swept"];
    let earlier = before.iter().filter(is_same).count();
    let number = row["listed"].as_u64();
    let number = number.unwrap_or_else(|| listed.number(&label, swept.is_some(), earlier) as u64);
    let same_as = before.iter().rev().find(|other| other["label"] == row["same_as"]);
    let mut experiment = json!({
        "id": id, "label": label, "listed": number, "findings": [], "channels": [],
        "same_as": same_as.map(|other| other["id"].clone()),
    });
    if let Some(courses) = row["courses"].as_array_mut() {
        courses.retain(|course| {
            course.as_object().is_some_and(|fields| {
                fields.iter().all(|(name, value)| name == "at" || is_whole(value))
            })
        });
    }
    for field in OF_EXPERIMENT {
        let value = row[field].take();
        if !value.is_null() {
            experiment[field] = value;
        }
    }
    experiment
}

/// Returns the name and the settings of an estimator, and its number among namesakes, from a label.
fn estimator(label: &str) -> (Value, u64) {
    let numbered = label.rsplit_once(" #").and_then(|(name, n)| Some((name, n.parse().ok()?)));
    let (label, number) = numbered.unwrap_or((label, 1));
    let settings = label.strip_suffix(')').and_then(|label| label.split_once('('));
    let (name, settings) = settings.unwrap_or((label, ""));
    (json!({ "name": name.trim_end(), "settings": settings }), number)
}

/// Returns the channel of a row.
fn channel(row: &mut Value) -> Value {
    let best = json!({
        "sampling": row["best_sampling"], "fom": row["best_fom"],
        "kind": row["best_kind"], "limit": row["best_limit"],
    });
    let mut channel = row.take();
    channel["name"] = channel["channel"].take();
    channel["best"] = if best["sampling"].is_null() { Value::Null } else { best };
    for loss in items(&mut channel["losses"]) {
        replace_null(loss, "nan");
    }
    if let Some(fields) = channel.as_object_mut() {
        fields.retain(|name, value| !value.is_null() && !OF_EXPERIMENT.contains(&name.as_str()));
    }
    channel
}

/// Converts a finding, with words for numbers that are not finite.
fn finding(mut finding: Value) -> Value {
    retain_whole(finding.get_mut("path"));
    if let Some(gate) = finding["gate"].as_object_mut() {
        for (name, value) in gate.iter_mut().filter(|(name, _)| *name != "needed") {
            let word = if INFINITE.contains(&name.as_str()) { "inf" } else { "nan" };
            replace_null(value, word);
            items(value).for_each(|value| replace_null(value, word));
        }
    }
    finding
}

/// Converts a ray seen from the side, with the identity of its experiment; null if a number is not finite.
fn upgraded_anatomy(mut anatomy: Value, experiments: &[Value]) -> Value {
    let own = experiments.iter().find(|experiment| experiment["label"] == anatomy["estimator"]);
    let Some(own) = own else { return Value::Null };
    for value in items(&mut anatomy["deviation"]) {
        replace_null(value, "nan");
    }
    retain_whole(anatomy.get_mut("measured"));
    anatomy["experiment"] = own["id"].clone();
    if is_whole(&anatomy) { anatomy } else { Value::Null }
}

/// Converts a comparison; `sweeps` has the swept quantity of each case.
fn upgrade_comparison(comparison: &mut Value, sweeps: &BTreeMap<String, String>) {
    let convert = |value: &mut Value| *value = identity(&text(value), sweeps);
    for name in ["added", "missing", "rewritten"] {
        items(&mut comparison[name]).for_each(convert);
    }
    if let Some(lists) = comparison["left_out"].as_object_mut() {
        lists.values_mut().flat_map(items).for_each(convert);
    }
    retain_whole(comparison.get_mut("drifts"));
    items(&mut comparison["drifts"]).for_each(|drift| convert(&mut drift["id"]));
    for change in items(&mut comparison["changes"]) {
        convert(&mut change["id"]);
        for time in ["before", "now"] {
            change[time] = json!({ "value": change[time][0], "error": change[time][1] });
        }
        if !is_whole(&change["interval"]) {
            change["interval"] = Value::Null;
        }
    }
}

/// Returns the identity of a channel from the text `case|estimator|sampling|control|swept|channel`.
fn identity(id: &str, sweeps: &BTreeMap<String, String>) -> Value {
    let mut parts = id.split('|');
    let mut next = || parts.next().unwrap_or_default();
    let [case, label, sampling, control, swept, channel] = std::array::from_fn(|_| next());
    let (estimator, namesake) = estimator(label);
    let what = sweeps.get(case).filter(|what| !what.is_empty());
    let swept = swept
        .parse::<f64>()
        .ok()
        .map(|value| json!({ "what": what.map_or("sampling", String::as_str), "value": value }));
    let sampling = match sampling.parse::<f64>() {
        Ok(value) => json!({ "constant": value, "kind": "constant" }),
        Err(_) => json!({ "constant": null, "kind": sampling }),
    };
    json!({
        "channel": channel,
        "experiment": {
            "case": case, "problem": "", "estimator": estimator, "sampling": sampling,
            "control": control, "swept": swept, "namesake": namesake,
        },
    })
}

/// Returns the items of a list; no items for any other value.
fn items(value: &mut Value) -> impl Iterator<Item = &mut Value> {
    value.as_array_mut().into_iter().flatten()
}

/// Removes the items of a list that lack a number.
fn retain_whole(list: Option<&mut Value>) {
    if let Some(items) = list.and_then(Value::as_array_mut) {
        items.retain(is_whole);
    }
}

fn text(value: &Value) -> String {
    value.as_str().unwrap_or_default().to_owned()
}

fn replace_null(value: &mut Value, word: &str) {
    if value.is_null() {
        *value = json!(word);
    }
}

/// Returns whether a value has all of its numbers.
fn is_whole(value: &Value) -> bool {
    match value {
        Value::Null => false,
        Value::Array(values) => values.iter().all(is_whole),
        Value::Object(fields) => fields.values().all(is_whole),
        _ => true,
    }
}
