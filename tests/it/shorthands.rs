//! Names and numbers in the place of tables: both spellings are the same case. Messages about near misses are in
//! `tests/wrong/`.

use std::path::PathBuf;

use trueflight::case::{CaseText, Spec};
use trueflight::media::catalogue::OwnPages;

use super::common::{case, case_file, judged, options, predicted, shipped_texts};

/// Returns the draws and findings of a case, without its name: bit for bit.
fn results(text: &str) -> String {
    let record = judged(&[case("test", text)], &options(1, 4000));
    let experiments = &record.results.cases[0].experiments;
    assert!(!experiments.is_empty(), "{text}");
    serde_json::to_string(experiments).expect("JSON")
}

/// Returns a transmittance case with some more lines.
fn transmittance(lines: &str) -> String {
    format!("title = \"x\"\n[problem.transmittance]\nspan = [0, 2]\n{lines}\n")
}

#[test]
fn numbers_stand_for_the_page_constant() {
    let long = "medium.constant.extinction = 0.5\nsampling.constant.value = 2\n\
                estimators = [{ ratio = {} }, { residual-ratio = { control.constant.value = 0.25 } }]";
    let expected = results(&transmittance(long));
    for (key, written) in [
        ("medium", "medium = 0.5\nsampling = 2"),
        ("constant", "medium.constant = 0.5\nsampling.constant = 2"),
        ("tables", "medium = { constant = 0.5 }\nsampling = { constant = { value = 2 } }"),
    ] {
        for control in ["control = 0.25", "control.constant = 0.25"] {
            let estimators =
                format!("estimators = [\"ratio\", {{ residual-ratio = {{ {control} }} }}]");
            let short = transmittance(&format!("{written}\n{estimators}"));
            assert_eq!(results(&short), expected, "{key}, {control}");
        }
    }
}

#[test]
fn names_stand_for_tables_without_keys_and_the_other_way_round() {
    let frame = |control: &str, rule: &str| {
        transmittance(&format!(
            "medium = 0.5\nsampling = 2\ncontrol{control}\n\
             estimators = [{{ double = {{}} }}, {{ single = {{ rule{rule}, albedo = 0.7 }} }}]"
        ))
    };
    let expected = results(&frame(".mean = {}", " = \"non-terminating\""));
    for (control, rule) in [
        (" = \"mean\"", " = \"non-terminating\""),
        (" = { mean = {} }", ".non-terminating = {}"),
        (".mean = {}", " = { non-terminating = {} }"),
    ] {
        assert_eq!(results(&frame(control, rule)), expected, "{control}, {rule}");
    }
    let one = transmittance("medium = 0.5\nsampling = 2\nestimators = [{ ratio = {} }]");
    for list in ["\"ratio\"", "[\"ratio\"]"] {
        let short = transmittance(&format!("medium = 0.5\nsampling = 2\nestimators = {list}"));
        assert_eq!(results(&short), results(&one), "{list}");
    }
}

#[test]
fn shadows_are_spelled_alike_everywhere() {
    // The file of a user who took the word from lit rods.
    let field = include_str!("../data/field/19-shadow-keys/cube.toml");
    assert!(field.contains("shadow = \"exact\""));
    let table = field.replace("shadow = \"exact\"", "shadow.exact = {}");
    assert_eq!(results(field), results(&table));
    let lit = |shadow: &str| {
        format!(
            "title = \"x\"\n[problem.rod]\nlight = 'emitter'\nmedium = 1\nspan = [0, 1]\nalbedo = 0.5\nforward = 0.6\nsampling = 2\n\
             estimators = [{{ next-event.shadow{shadow} }}]\n"
        )
    };
    for word in ["exact", "ratio", "delta"] {
        let [one, other] = [format!(" = \"{word}\""), format!(".{word} = {{}}")].map(|w| lit(&w));
        assert_eq!(results(&one), results(&other), "{word}");
    }
}

#[test]
fn phases_lights_and_bounds_may_be_names_too() {
    let slab = |phase: &str, light: &str| {
        format!(
            "title = \"x\"\n[problem.slab]\nmedium = 1\nspan = [0, 1]\nalbedo = 0.5\nsampling = 1\nphase{phase}\n\
             incidence{light}\nestimators = [\"analog\"]\n"
        )
    };
    let [long, short] =
        [slab(".isotropic = {}", ".diffuse = {}"), slab(" = \"isotropic\"", " = \"diffuse\"")];
    assert_eq!(results(&long), results(&short));
}

#[test]
fn a_sweep_takes_the_list_alone_and_scales_short_forms() {
    let rest = "estimators = [\"ratio\", { double = { control = 0.25 } }]";
    let [long, short] = ["sweep.sampling.values = [1, 2, 3]", "sweep.sampling = [1, 2, 3]"]
        .map(|sweep| results(&transmittance(&format!("medium = 0.5\n{sweep}\n{rest}"))));
    assert_eq!(long, short);
    // T = exp(−s σ_t ℓ) if the whole medium is multiplied by s: a short form must be multiplied, too.
    let text =
        transmittance(&format!("medium = 0.5\nsampling = 2\nsweep.density = [1, 2]\n{rest}"));
    let rows = predicted(&text);
    let told: Vec<_> = rows.iter().map(|row| (row.truth, row.experiment.sampling())).collect();
    assert_eq!(told.len(), 4);
    for (row, factor) in rows.iter().zip([1.0, 2.0, 1.0, 2.0]) {
        let truth = row.truth.expect("a truth");
        assert!((truth / (-factor * 0.5 * 2.0_f64).exp() - 1.0).abs() < 1e-12, "{told:?}");
        assert_eq!(row.experiment.sampling(), Some(2.0 * factor), "{told:?}");
    }
}

#[test]
fn channels_may_be_listed_by_numbers() {
    let frame = |medium: &str, sampling: &str| {
        format!(
            "title = \"x\"\n[problem.transmittance]\nmedium = {medium}\nspan = [0, 2]\nsampling = {sampling}\n\
             estimators = [{{ hero = {{ collisions = \"delta\" }} }}, \"independent\"]\n"
        )
    };
    let page = |key: &str, numbers: [f64; 2]| {
        numbers.map(|x| format!("{{ constant.{key} = {x} }}")).join(", ")
    };
    let long = frame(
        &format!("[{}]", page("extinction", [0.5, 1.0])),
        &format!("[{}]", page("value", [0.75, 1.25])),
    );
    assert_eq!(results(&frame("[0.5, 1]", "[0.75, 1.25]")), results(&long));
    // At c = 0 both channels are grey: their mean.
    let rows = predicted(&(frame("[0.5, 1]", "[0.75, 1.25]") + "sweep.contrast = [0, 1]\n"));
    let grey = rows
        .iter()
        .filter(|row| row.experiment.swept() == Some(0.0) && row.channel.starts_with("channel"));
    let truths: Vec<f64> = grey.filter_map(|row| row.truth).collect();
    assert!(!truths.is_empty());
    assert!(truths.iter().all(|truth| (truth / (-0.75 * 2.0_f64).exp() - 1.0).abs() < 1e-12));
}

/// Settings of one channel, and of a list of channels.
const LISTS: [[&str; 2]; 6] = [
    ["medium", "medium"],
    ["volume", "volume"],
    ["albedo", "albedos"],
    ["phase", "phases"],
    ["sampling", "sampling"],
    ["forward", "forward"],
];

/// A case with a list of one for each setting of a channel.
fn listed(text: &str) -> String {
    fn list(settings: &mut toml::Table, lists: &[[&str; 2]]) {
        for [one, several] in lists {
            if let Some(value) = settings.remove(*one) {
                settings.insert((*several).to_owned(), vec![value].into());
            }
        }
    }
    let mut root: toml::Table = text.parse().expect("TOML");
    let problems = root["problem"].as_table_mut().expect("a problem");
    for settings in problems.iter_mut().filter_map(|(_, settings)| settings.as_table_mut()) {
        list(settings, &LISTS);
        let estimators = settings["estimators"].as_array_mut().into_iter().flatten();
        for named in estimators.filter_map(toml::Value::as_table_mut) {
            for own in named.iter_mut().filter_map(|(_, own)| own.as_table_mut()) {
                list(own, &LISTS[4..5]);
            }
        }
    }
    toml::to_string(&root).expect("TOML")
}

/// The settings that are read of a case.
fn settings(text: &str) -> toml::Table {
    let (name, text) = ("test".to_owned(), text.to_owned());
    let source = CaseText { name, path: PathBuf::new(), text };
    let spec = Spec::parse(&source, &OwnPages::default()).expect("TOML");
    toml::to_string(&spec).expect("TOML").parse().expect("TOML")
}

#[test]
fn a_list_of_one_channel_is_the_channel_in_all_shipped_cases() {
    let mut count = 0;
    for text in shipped_texts() {
        let own = settings(&text);
        let problem = own["problem"].as_table().and_then(|problems| problems.values().next());
        let problem = problem.and_then(toml::Value::as_table).expect("a problem");
        let has_channels = ["medium", "volume"]
            .iter()
            .any(|key| problem.get(*key).is_some_and(toml::Value::is_array));
        if !has_channels && !problem.contains_key("albedos") {
            assert_eq!(settings(&listed(&text)), own, "{text}");
            count += 1;
        }
    }
    assert!(count > 50, "only {count} cases");
}

/// Names, predictions, draws and verdicts of experiments.
#[test]
fn experiments_with_a_list_of_one_channel_are_those_without() {
    for name in [
        "transmittance/eq21-control",
        "transmittance/curve-eq21-figure-8",
        "rod/three-rules-a0.7",
        "rod/lit-homogeneous",
        "rod/bidirectional-transmitted",
        "slab/three-rules",
        "slab/lit-distant",
        "single-scattering/homogeneous",
        "furnace/albedos",
    ] {
        let text = std::fs::read_to_string(case_file(name)).expect("a case");
        assert_eq!(results(&listed(&text)), results(&text), "{name}");
    }
}
