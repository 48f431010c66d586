//! Scenes of several channels, each with a truth of its own, and homogeneous media.

use serde_json::Value;
use tempfile::TempDir;
use trueflight::Catalogue;
use trueflight::case::CaseText;
use trueflight::export::truth::Truth;
use trueflight::export::{ExportError, ExportOptions, Target, export_with};

use super::source;

/// Makes a case of a text.
fn written(text: &str) -> CaseText {
    CaseText { name: "own".into(), path: "own.toml".into(), text: text.to_owned() }
}

/// Exports a case; returns its folder and its truth.
fn exported(
    source: &CaseText,
    target: Target,
    wishes: &ExportOptions,
) -> Result<(TempDir, Truth), ExportError> {
    let folder = tempfile::tempdir().expect("a folder");
    let found = export_with(&Catalogue::builtin(), source, target, wishes, folder.path())?;
    Ok((folder, found.truth))
}

fn text(folder: &TempDir, name: &str) -> String {
    std::fs::read_to_string(folder.path().join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
}

fn refused(source: &CaseText, target: Target, wishes: &ExportOptions) -> String {
    match exported(source, target, wishes) {
        Ok((_, truth)) => panic!("{} was exported", truth.case),
        Err(error) => error.to_string(),
    }
}

fn channels(list: &[usize]) -> ExportOptions {
    ExportOptions { channels: Some(list.to_vec()), ..ExportOptions::default() }
}

/// Returns the cube of the field: `T = exp(−2 σ_t)`, `σ_t` = ½, 1, 2.
fn cube() -> CaseText {
    written(include_str!("../../data/field/03-coloured-media/three.toml"))
}

#[test]
fn a_homogeneous_cube_of_three_colours_is_written_as_one() {
    let (folder, truth) =
        exported(&cube(), Target::Mitsuba, &ExportOptions::default()).expect("a scene");
    assert_eq!((truth.version, truth.problem.as_str()), (1, "transmittance"));
    assert!(truth.field.is_none() && !folder.path().join("density.vol").exists());
    let scene = text(&folder, "transmittance.xml");
    assert!(scene.contains("<medium id=\"medium\" type=\"homogeneous\">"), "{scene}");
    // Mitsuba up to 3.4 refuses numbers above 1: σ_t is given in units of the largest.
    assert!(scene.contains("<float name=\"scale\" value=\"2.0\"/>"), "{scene}");
    assert!(scene.contains("<rgb name=\"value\" value=\"0.25 0.5 1.0\"/>"), "{scene}");
    let told: Vec<_> = truth.questions.iter().map(|q| (q.channel, q.scene.as_str())).collect();
    assert_eq!(told, [1, 2, 3].map(|n| (Some(n), "transmittance.xml")));
    for (question, depth) in truth.questions.iter().zip([1.0, 2.0, 4.0_f64]) {
        assert!((question.mean / (-depth).exp() - 1.0).abs() < 1e-12, "{question:?}");
        let laws = [question.with_emitter_sampling, question.without_emitter_sampling];
        for law in laws.map(|law| law.expect("a law")) {
            // The channel for which a renderer samples is unknown, and with it the variance.
            assert_eq!((law.low, law.high, law.variance), (Some(0.0), None, None));
        }
    }
    let wishes = ExportOptions { heterogeneous: true, ..ExportOptions::default() };
    let (folder, again) = exported(&cube(), Target::Mitsuba, &wishes).expect("a scene");
    let scene = text(&folder, "transmittance.xml");
    assert!(scene.contains("type=\"heterogeneous\"") && scene.contains("0.25 0.5 1.0"), "{scene}");
    assert_eq!(again.questions, truth.questions);
}

#[test]
fn layers_of_three_colours_are_one_grid_of_three_channels() {
    let layers = |knots: [f64; 2]| {
        format!("{{ piecewise-linear = {{ knots = [0, 2], values = {knots:?} }} }}")
    };
    let media = [[1.0, 0.0], [0.5, 1.5], [0.25, 0.25]];
    let case = format!(
        "title = \"x\"\n[problem.transmittance]\nmedium = [{}]\nspan = [0, 2]\nsampling = 2\n\
         estimators = [\"independent\"]\n",
        media.map(layers).join(", ")
    );
    let wishes = ExportOptions { cells: Some(64), ..ExportOptions::default() };
    let (folder, truth) = exported(&written(&case), Target::Mitsuba, &wishes).expect("a scene");
    let bytes = std::fs::read(folder.path().join("density.vol")).expect("a field");
    let word = |n: usize| <[u8; 4]>::try_from(&bytes[4 + 4 * n..8 + 4 * n]).expect("a word");
    let header: Vec<i32> = (0..5).map(|n| i32::from_le_bytes(word(n))).collect();
    assert_eq!(header, [1, 2, 2, 64, 3], "float32, 2 × 2 × 64, three channels");
    assert_eq!(bytes.len(), 48 + 4 * 3 * 4 * 64);
    // The samples of a straight line at the centres of cells have its integral.
    let step = 2.0 / 64.0;
    for (channel, question) in truth.questions.iter().enumerate() {
        let sample = |z: usize| f64::from(f32::from_le_bytes(word(11 + 3 * 4 * z + channel)));
        let [from, to] = media[channel];
        let own = std::fs::read(folder.path().join(format!("density-{}.vol", channel + 1)));
        let own = own.expect("a channel alone");
        assert_eq!((own.len(), own[20]), (48 + 4 * 4 * 64, 1));
        for z in 0..64 {
            let right = from + (to - from) * (z as f64 + 0.5) / 64.0;
            assert!((sample(z) - right).abs() < 1e-6, "channel {channel}, layer {z}");
            let alone = own[48 + 16 * z..52 + 16 * z].try_into().expect("four bytes");
            assert_eq!(f64::from(f32::from_le_bytes(alone)), sample(z), "{channel}, layer {z}");
        }
        let depth = (0..64).map(|z| sample(z) * step).sum::<f64>();
        assert!((question.mean / (-depth).exp() - 1.0).abs() < 1e-6, "{question:?}");
    }
    // Where σ_t of the second channel is the majorant, its walks have no null collisions, and other walks have some.
    let note = truth.notes.iter().find(|note| note.contains("tracking for one channel"));
    assert!(note.is_some_and(|note| note.contains("in channel 2 on a stretch")), "{truth:?}");
    let peak = truth.field.as_ref().expect("samples").peak;
    assert!(peak > 1.4 && peak <= 1.5, "that of all channels: {peak}");
}

#[test]
fn slabs_furnaces_and_lamps_have_a_truth_per_channel() {
    let albedos = |case: &str, wishes: &ExportOptions| {
        exported(&source(case), Target::Mitsuba, wishes).unwrap_or_else(|e| panic!("{case}: {e}"))
    };
    // One extinction, three albedos: both pictures in three channels, each as that of the slab of one albedo.
    let (folder, truth) = albedos("slab/spectral-three-albedos", &ExportOptions::default());
    assert_eq!(truth.problem, "slab");
    let scene = text(&folder, "reflectance.xml");
    assert!(scene.contains("value=\"1.0 0.7 0.45714286\""), "{scene}");
    assert_eq!(truth.questions.len(), 6);
    for (number, albedo) in [(1, 1.0), (2, f64::from(0.7_f32)), (3, f64::from(0.457_142_86_f32))] {
        let grey = format!(
            "title = \"x\"\n[problem.slab]\nmedium.constant.extinction = {:?}\nspan = [0, 1]\nalbedo = {albedo:?}\n\
             phase = \"isotropic\"\nincidence.collimated.cosine = 0.5\nsampling = 1.6\nestimators = [\"weighted\"]\n",
            f64::from(1.45_f32)
        );
        let case = trueflight::case::Case::read(&written(&grey)).expect("a case");
        let ready =
            case.at(None).and_then(|at| at.prepare(0, case.pilots(1, 0))).expect("an answer");
        let of_channel = truth.questions.iter().filter(|q| q.channel == Some(number));
        let stated: Vec<f64> = of_channel.map(|question| question.mean).collect();
        let right: Vec<f64> = ready.prediction.channels.iter().map(|c| c.truth.value).collect();
        assert_eq!((stated.len(), right.len()), (2, 2));
        for (stated, right) in stated.iter().zip(&right) {
            assert!((stated / right - 1.0).abs() < 1e-8, "channel {number}: {stated}, {right}");
        }
    }
    let (_, truth) = albedos("slab/chromatic-like-colours", &ExportOptions::default());
    let names: Vec<&str> = truth.questions.iter().map(|q| q.name.as_str()).collect();
    assert_eq!(names[..2], ["reflectance, channel 1", "reflectance, channel 2"]);
    let (folder, truth) = albedos("furnace/spectral-like-colours", &ExportOptions::default());
    assert!(truth.questions.iter().all(|question| question.mean == 1.0));
    assert_eq!(truth.questions.len(), 3);
    let scene = text(&folder, "radiance.xml");
    assert!(scene.contains("type=\"homogeneous\"") && scene.contains("type=\"sphere\""), "{scene}");
    assert!(truth.notes.iter().any(|note| note.contains("white")));
    // Renderers have one phase function, and the radiance in a furnace is 1 with any.
    let (folder, truth) = albedos("furnace/spectral-known-bugs", &ExportOptions::default());
    assert!(truth.notes.iter().any(|note| note.contains("phase function of the first")));
    assert!(text(&folder, "radiance.xml").contains("name=\"g\" value=\"0.6\""));
    assert!(truth.questions.iter().all(|question| question.mean == 1.0));
    // A single channel is grey, and its distribution is known.
    let (folder, one) = albedos("single-scattering/spectral-known-bugs", &channels(&[2]));
    assert_eq!((one.version, one.problem.as_str()), (1, "single-scattering"));
    assert_eq!(one.questions.len(), 1);
    assert!(one.questions[0].with_emitter_sampling.and_then(|law| law.variance).is_some());
    let json: Value = serde_json::from_str(&text(&folder, "truth.json")).expect("JSON");
    assert!(json["questions"][0].get("channel").is_none());
}

#[test]
fn what_a_picture_cannot_hold_is_refused_with_a_cure() {
    let many = written(
        "title = \"x\"\n[problem.transmittance]\nmedium = [1, 2, 3, 4]\nspan = [0, 1]\nsampling = 4\n\
         estimators = [\"independent\"]\n",
    );
    let told = refused(&many, Target::Mitsuba, &ExportOptions::default());
    assert!(told.contains("4 channels") && told.contains("--channels 1,2,3"), "{told}");
    for (list, words) in [
        (&[5][..], "none is number 5"),
        (&[0], "none is number 0"),
        (&[1, 1], "twice"),
        (&[1, 2, 3, 4], "3 channels, not 4"),
        (&[], "3 channels, not 0"),
    ] {
        let told = refused(&many, Target::Mitsuba, &channels(list));
        assert!(told.contains(words) && told.contains("--channels"), "{told}");
    }
    let (_, truth) = exported(&many, Target::Mitsuba, &channels(&[4, 2])).expect("a scene");
    let means: Vec<f64> = truth.questions.iter().map(|question| question.mean).collect();
    for (mean, depth) in means.iter().zip([4.0, 2.0_f64]) {
        assert!((mean / (-depth).exp() - 1.0).abs() < 1e-12, "{means:?}");
    }
    assert_eq!(means.len(), 2);
    assert!(truth.notes.iter().any(|note| note.ends_with("4, 2")), "{:?}", truth.notes);
    let phases = source("slab/chromatic-three-colours");
    let told = refused(&phases, Target::Mitsuba, &ExportOptions::default());
    assert!(told.contains("phase functions") && told.contains("--channels 1"), "{told}");
    assert!(exported(&phases, Target::Mitsuba, &channels(&[3])).is_ok());
    let grey = source("transmittance/eq21-overview");
    assert!(refused(&grey, Target::Mitsuba, &channels(&[2])).contains("1 channel, and none"));
    let wishes = ExportOptions { heterogeneous: true, ..ExportOptions::default() };
    assert!(refused(&cube(), Target::Pbrt, &wishes).contains("leave --heterogeneous out"));
}

#[test]
fn a_channel_is_a_scene_of_its_own_where_a_renderer_has_wavelengths() {
    let (folder, truth) =
        exported(&cube(), Target::Pbrt, &ExportOptions::default()).expect("scenes");
    for (question, extinction) in truth.questions.iter().zip(["0.5", "1.0", "2.0"]) {
        let scene = text(&folder, &question.scene);
        let medium = format!("\"spectrum sigma_a\" [ 200 {extinction} 900 {extinction} ]");
        assert!(scene.contains(&medium) && scene.contains("\"homogeneous\""), "{scene}");
        assert!(question.with_emitter_sampling.is_none());
    }
    let mut scenes: Vec<&str> = truth.questions.iter().map(|q| q.scene.as_str()).collect();
    scenes.dedup();
    assert_eq!(scenes, [1, 2, 3].map(|n| format!("transmittance-{n}.pbrt")));
}

#[test]
fn homogeneous_boxes_of_one_channel_are_homogeneous() {
    for case in ["transmittance/constant-sampling", "slab/thin"] {
        let (folder, truth) =
            exported(&source(case), Target::Mitsuba, &ExportOptions::default()).expect("a scene");
        let question = &truth.questions[0];
        let scene = text(&folder, &question.scene);
        assert!(
            scene.contains("type=\"homogeneous\"") && scene.contains("type=\"cube\""),
            "{case}"
        );
        assert!(truth.field.is_none() && !folder.path().join("density.vol").exists(), "{case}");
        assert!(text(&folder, "case.toml").contains("volume.constant = { extinction = "), "{case}");
        assert!(question.without_emitter_sampling.and_then(|law| law.variance).is_some(), "{case}");
    }
}
