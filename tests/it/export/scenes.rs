//! Files of each kind of scene.

use quick_xml::events::Event;
use serde_json::Value;
use trueflight::case::Case;
use trueflight::case::CaseText;
use trueflight::export::Target;
use trueflight::export::truth::Truth;

use super::{CASES, scene};

/// Returns the elements of an XML text with their attributes; panics if it is not well-formed.
fn elements(text: &str) -> Vec<(String, Vec<(String, String)>)> {
    let mut reader = quick_xml::Reader::from_str(text);
    reader.config_mut().check_end_names = true;
    let (mut found, mut depth) = (Vec::new(), 0);
    loop {
        let event = reader.read_event().expect("well-formed");
        match &event {
            Event::Eof => break,
            Event::Start(_) => depth += 1,
            Event::End(_) => depth -= 1,
            _ => {}
        }
        if let Event::Start(element) | Event::Empty(element) = &event {
            let name = element.name().as_ref().to_owned();
            let attributes = element.attributes().map(|attribute| {
                let attribute = attribute.expect("an attribute");
                (attribute.key.as_ref().to_owned(), attribute.value.clone().into_owned())
            });
            found.push((name, attributes.collect()));
        }
    }
    assert_eq!(depth, 0, "elements are left open");
    found
}

#[test]
fn every_kind_is_exported_whole() {
    for case in CASES {
        let scene = scene(case, Target::Mitsuba, None).unwrap_or_else(|e| panic!("{case}: {e}"));
        let truth: Truth = serde_json::from_str(&scene.text("truth.json")).expect("a truth");
        let stated = &scene.exported.truth;
        assert_eq!((truth.version, truth.case.as_str()), (1, *case));
        assert_eq!(truth.questions.len(), stated.questions.len());
        for (read, stated) in truth.questions.iter().zip(&stated.questions) {
            assert!((read.mean / stated.mean - 1.0).abs() < 1e-15, "{case}: digits are lost");
        }
        let there = std::fs::read_dir(scene.folder.path()).expect("a folder").count();
        assert_eq!(there, scene.exported.files.len(), "{case}: something else is left");
        assert!(truth.field.is_none() || scene.path("density.vol").exists());
        for question in &truth.questions {
            assert!(question.mean > 0.0 && question.error < 1e-4 * question.mean, "{case}");
            assert!(question.rounding > 0.0 && question.rounding < 1e-3);
            let found = elements(&scene.text(&question.scene));
            let count = |name: &str| found.iter().filter(|(element, _)| element == name).count();
            assert_eq!(["scene", "sensor", "medium", "emitter"].map(count), [1; 4], "{case}");
            let numbers = found.iter().flat_map(|(_, attributes)| attributes);
            assert!(
                numbers.clone().all(|(_, value)| !value.contains("NaN") && !value.contains("inf"))
            );
        }
    }
}

#[test]
fn the_case_beside_a_scene_is_a_case_with_its_truth() {
    for case in CASES {
        let scene = scene(case, Target::Mitsuba, None).expect("exported");
        let read = Case::read(&CaseText::read(&scene.path("case.toml")).expect("a text"));
        let read = read.unwrap_or_else(|error| panic!("{case}: {}", error.render(false)));
        let ready =
            read.at(None).and_then(|at| at.prepare(0, read.pilots(1, 0))).expect("an answer");
        let truths: Vec<f64> = ready.prediction.channels.iter().map(|c| c.truth.value).collect();
        let stated: Vec<f64> = scene.exported.truth.questions.iter().map(|q| q.mean).collect();
        assert_eq!(truths, stated, "{case}");
    }
}

#[test]
fn laws_are_those_of_the_renderers_estimators() {
    let of = |case: &str| scene(case, Target::Mitsuba, None).expect("exported").exported.truth;
    // Light passes or does not: T(1 − T), for any integrator.
    let truth = of("transmittance/eq21-overview");
    let [question] = truth.questions.as_slice() else { panic!("one picture") };
    for law in [question.without_emitter_sampling, question.with_emitter_sampling] {
        let variance = law.and_then(|law| law.variance).expect("a variance");
        assert!((variance - question.mean * (1.0 - question.mean)).abs() < 1e-12);
    }
    // Every path in a white furnace finds light.
    let truth = of("furnace/eq21");
    assert_eq!(truth.questions[0].mean, 1.0);
    assert_eq!(truth.questions[0].without_emitter_sampling.and_then(|law| law.variance), Some(0.0));
    assert_eq!(truth.questions[0].with_emitter_sampling.and_then(|law| law.variance), None);
    assert!(truth.notes.iter().any(|note| note.contains("white")), "the albedo was 0.7");
    // A white slab reflects all light that it does not transmit.
    let truth = of("slab/cloud");
    let sum: f64 = truth.questions.iter().map(|question| question.mean).sum();
    assert!((sum - 1.0).abs() < 1e-8, "{sum}");
    // No path hits a point.
    let truth = of("single-scattering/known-bugs");
    assert!(truth.questions[0].without_emitter_sampling.is_none());
    assert!(truth.questions[0].with_emitter_sampling.and_then(|law| law.variance).is_some());
}

#[test]
fn truth_json_has_the_documented_keys() {
    let scene = scene("slab/known-bugs", Target::Mitsuba, Some(8)).expect("exported");
    let truth: Value = serde_json::from_str(&scene.text("truth.json")).expect("JSON");
    let keys =
        |value: &Value| value.as_object().expect("a table").keys().cloned().collect::<Vec<_>>();
    let page = include_str!("../../../src/export/truth.rs");
    let prose: String = page.lines().take_while(|line| line.starts_with("//!")).collect();
    let question = &truth["questions"][0];
    let all = [&truth, &truth["field"], question, &question["with_emitter_sampling"]].map(keys);
    for key in all.iter().flatten() {
        assert!(prose.contains(key.as_str()), "{key} is not documented");
    }
    assert_eq!(truth["field"]["size"], serde_json::json!([2, 2, 8]));
}
