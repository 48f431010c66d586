//! Media and estimators that a program adds: the examples, and messages about wrong ones.

use std::f64::consts::PI;
use std::path::Path;

use trueflight::case::Case;
use trueflight::case::sweep::{SweptQuantity, Variation};
use trueflight::catalogue::{Domain, OwnPage, Page, Settings};
use trueflight::estimators::multiple_scattering::particle::Walker;
use trueflight::estimators::own::estimator;
use trueflight::geometry::{Aabb, Bounds, Point};
use trueflight::media::own::{Formula, SpaceFormula};
use trueflight::media::{Medium, OpticalDepth};
use trueflight::numeric::Span;
use trueflight::problems::MultipleScattering;
use trueflight::record::Verdict;
use trueflight::{Catalogue, cli};

use super::common::{judged, options, source};

#[path = "../../examples/own_medium.rs"]
mod own_medium;

#[path = "../../examples/own_binary/main.rs"]
#[allow(dead_code)] // its `main` takes the arguments of the process
mod own_binary;

#[test]
fn the_example_of_a_medium_passes() {
    own_medium::main();
}

fn of_the_example() -> Catalogue {
    own_binary::catalogue().expect("names that are free")
}

/// Runs a command of the example's program.
fn command(words: &[&str]) -> std::process::ExitCode {
    let words = ["own_binary", "--quiet"].iter().chain(words);
    cli::run_as(&of_the_example(), words).expect("arguments")
}

const CASE: &str = "examples/own_binary/two-rays.toml";

#[test]
fn the_example_of_a_program_draws_judges_and_plots() {
    let out = tempfile::tempdir().expect("a folder");
    let path = out.path().join("run");
    let folder = path.to_str().expect("a name");
    let code = command(&["run", CASE, "--out", folder, "--alpha", "1e-6"]);
    assert_eq!(format!("{code:?}"), format!("{:?}", std::process::ExitCode::SUCCESS));
    let csv = std::fs::read_to_string(path.join("summary.csv")).expect("a summary");
    let rows = csv.lines().filter(|line| line.contains(",haze,two-rays,")).count();
    assert_eq!(rows, 5, "{csv}");
    let files = walk(&path);
    assert!(files.iter().any(|file| file.contains(".png")), "{files:?}");
    let code = command(&["bench", CASE, "--rounds", "1", "--out", folder]);
    assert_eq!(format!("{code:?}"), format!("{:?}", std::process::ExitCode::SUCCESS));
}

fn walk(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("one"));
    let below = |path: std::path::PathBuf| {
        if path.is_dir() { walk(&path) } else { vec![path.display().to_string()] }
    };
    entries.flat_map(|entry| below(entry.path())).collect()
}

#[test]
fn what_an_own_medium_hides_is_found() {
    // The estimators of the catalogue in a medium of closures, against its truth by quadrature.
    let haze = Page { module: "haze", source: "Haze." };
    let bumpy = |t: f64| 0.5 + 0.5 * (3.0 * t).sin() + f64::from(t > 1.0);
    let line = move |_: &Settings| Some(Formula::new(bumpy).with_breaks(vec![1.0]));
    let corner = Page { module: "corner", source: "A corner." };
    let layers = Page { module: "layers", source: "Layers of haze." };
    let bounds = Bounds::Box(Aabb { low: Point([0.0; 3]), high: Point([1.0; 3]) });
    let space = move |_: &Settings| Some(SpaceFormula::new(bounds, 3.0, |[x, y, z]| x + y * z));
    let catalogue = Catalogue::builtin()
        .with(OwnPage::line(haze, &[], line))
        .and_then(|catalogue| catalogue.with(OwnPage::volume(corner, &[], space)))
        .and_then(|catalogue| catalogue.with(OwnPage::layered::<own_medium::Haze>(layers)))
        .expect("names that are free");
    let text = |problem: &str| format!("title = \"own\"\n{problem}");
    let line = text(
        r"[problem.transmittance]
        medium.haze = {}
        span = [0, 3]
        sampling.constant.value = 2.0
        estimators = [{ woodcock = {} }, { ratio = {} }, { closed-form = {} }, { next-flight = {} }]",
    );
    let space = text(
        r"[problem.transmittance]
        volume.corner = {}
        ray = { origin = [0.1, 0.2, -1], direction = [0.1, 0.2, 1], length = 4 }
        sampling.constant.value = 2.0
        estimators = [{ woodcock = {} }, { ratio = {} }, { closed-form = {} }]",
    );
    let layers = text(
        r"[problem.transmittance]
        volume.layers = { scale = 0.8, axis = [1, 0, 1] }
        ray = { origin = [1, 0, 0], direction = [-2, 1, -1], length = 3 }
        sampling.constant.value = 1.0
        estimators = [{ woodcock = {} }, { ratio = {} }, { closed-form = {} }]",
    );
    let ball = text(
        r#"[problem.furnace]
        volume.corner = {}
        ray = { origin = [0.1, 0.2, -1], direction = [0.1, 0.2, 1], length = 4 }
        albedo.constant.extinction = 0.7
        phase.isotropic = {}
        sampling.constant.value = 3.0
        estimators = [{ particle = { rule = "weighted" } }]"#,
    );
    for (name, text) in [("line", line), ("space", space), ("layers", layers), ("ball", ball)] {
        let case = catalogue.read(&source(name, &text));
        let case = case.unwrap_or_else(|error| panic!("{}", error.in_full()));
        let record = judged(&[case], &options(3, 1_000_000));
        for row in record.results.cases[0].rows().collect::<Vec<_>>() {
            assert_eq!(
                row.verdict,
                Some(Verdict::Pass),
                "{name} {}: {}",
                row.experiment.label,
                row.reason()
            );
        }
    }
    // τ of the line by hand: ½·3 + ⅙(1 − cos 9) + 2.
    let depth = 3.5 + (1.0 - 9.0_f64.cos()) / 6.0;
    let found = Formula::new(bumpy).with_breaks(vec![1.0]).optical_depth(Span::new(0.0, 3.0));
    assert!((found.value - depth).abs() <= found.error.max(1e-15), "{found:?} {depth}");
    assert!(found.error < 1e-12, "{found:?}");
}

#[test]
fn depths_of_closures_keep_what_they_say() {
    let span = Span::new(0.0, 1.0);
    let depth = |at: &'static (dyn Fn(f64) -> f64 + Send + Sync)| {
        Medium::from_fn(span, at).optical_depth(span)
    };
    // Smooth fields, of long and short waves, narrow and wide.
    let waves = depth(&|t| 1.0 + (2.0 * PI * 400.0 * t).cos());
    assert!((waves.value - 1.0).abs() <= waves.error && waves.error < 1e-11, "{waves:?}");
    let bump = depth(&|t| (-0.5 * ((t - 0.3) / 0.01).powi(2)).exp());
    let exact = 0.01 * (2.0 * PI).sqrt();
    assert!((bump.value - exact).abs() <= bump.error && bump.error < 1e-13, "{bump:?}");
    // Undeclared steps at 200 places: found, unless they hide near an end of a panel.
    let mut wrong = 0;
    for place in 0..200 {
        let from = (f64::from(place) * 0.618_034).fract() * 0.7;
        let step = move |t: f64| f64::from((from..from + 0.2).contains(&t));
        let found = Medium::from_fn(span, step).optical_depth(span);
        let off = (found.value - 0.2).abs();
        assert!(off < 1e-9, "{from}: {found:?}");
        wrong += u32::from(off > found.error);
        // Declared, they are exact.
        let told = Medium::from_fn_with_breaks(span, vec![from, from + 0.2], step);
        let found = told.optical_depth(span);
        assert!((found.value - 0.2).abs() <= found.error && found.error < 1e-12, "{found:?}");
    }
    assert!(wrong < 4, "{wrong} of 200");
    // Integration also terminates for fields without an integral, or too rough for one.
    assert!(depth(&|_| f64::NAN).value.is_nan());
    assert!(depth(&|t| 1.0 / (t - t)).value.is_nan());
    let rough = depth(&|t| ((1.0 + t * t) * 1e7).round() * 1e-7);
    assert!((rough.value - 4.0 / 3.0).abs() <= rough.error && rough.error < 1e-4, "{rough:?}");
}

#[test]
fn names_are_taken_once() {
    let page = |module| Page { module, source: "Mine." };
    let add = |page| OwnPage::line(page, &[], |_| Some(Formula::new(|_| 1.0)));
    let taken = Catalogue::builtin().with(add(page("constant"))).expect_err("a name taken");
    assert_eq!(
        taken.to_string(),
        "`constant` is the name of another page (media); choose another name"
    );
    let once = Catalogue::builtin().with(add(page("mine"))).expect("a free name");
    assert!(once.with(add(page("mine"))).is_err());
    // Names of estimators of pictures are taken, too.
    let particle = estimator::<MultipleScattering, Walker>(page("particle"));
    assert!(Catalogue::builtin().with(particle).is_err());
}

#[test]
fn closures_that_are_no_extinction_are_errors_with_their_place() {
    let read = |at: fn(f64) -> f64| {
        let page = Page { module: "bad", source: "Bad." };
        let bad = OwnPage::line(page, &[], move |_| Some(Formula::new(at)));
        let catalogue = Catalogue::builtin().with(bad).expect("a free name");
        let text = r#"
            title = "bad"
            [problem.transmittance]
            medium.bad = {}
            span = [0, 1]
            estimators = [{ closed-form = {} }]
        "#;
        catalogue.read(&source("bad", text)).map_err(|error| error.in_full())
    };
    for bad in [|_| f64::NAN, |_| f64::INFINITY, |_| -1.0, |t| t - 0.5] {
        let found = read(bad).err().expect("an error");
        assert!(found.contains("σ_t of `bad` is negative or not finite"), "{found}");
    }
    assert!(read(|t| t).is_ok());
}

#[test]
fn wrong_cases_of_own_pages_are_shown_in_place() {
    let wrong = |from: &str, to: &str| {
        let text = std::fs::read_to_string(CASE).expect("the case").replace(from, to);
        let error = of_the_example().read(&source("wrong", &text)).err().expect("a mistake");
        error.in_full()
    };
    let found = wrong("medium.haze = {}", "medium.hase = {}");
    assert!(found.contains("did you mean `haze`?"), "{found}");
    let found = wrong("medium.haze = {}", "medium.haze = { scale = 1 }");
    assert!(found.contains("`scale` is not known here"), "{found}");
    let found = wrong("two-rays = {}", "two-ray = {}");
    assert!(found.contains("did you mean `two-rays`?"), "{found}");
    let volume =
        "volume.haze = {}\nray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 4 }";
    let found = wrong("medium.haze = {}\nspan = [0, 4]", volume);
    assert!(found.contains("no 3-D form"), "{found}");
}

/// Returns a case with the field `veil` of a page that names these settings, or its mistakes.
fn veiled(
    extinctions: &'static [&'static str],
    at: fn(strength: f64, t: f64) -> f64,
    text: &str,
) -> Result<Case, String> {
    let page = Page { module: "veil", source: "A veil." };
    let read = move |settings: &Settings| {
        let strength = settings.number("strength", Domain::Positive)?;
        Some(Formula::new(move |t| at(strength, t)))
    };
    let catalogue = Catalogue::builtin().with(OwnPage::line(page, extinctions, read));
    let catalogue = catalogue.expect("a free name");
    catalogue.read(&source("veil", text)).map_err(|error| error.in_full())
}

fn swept(sweep: &str) -> String {
    format!(
        "title = \"veil\"\n[problem.transmittance]\nmedium.veil.strength = 0.75\nspan = [0, 2]\n{sweep}\n\
         sampling = 2\ncontrol.field.medium.veil.strength = 0.5\nestimators = [\"double\"]\n"
    )
}

/// Returns the prediction of the only estimator.
fn theory(case: &Case, variation: Variation) -> String {
    let at = case.at(variation).expect("a value of the sweep");
    let prediction = at.predict(0, None, case.pilots(1, 0)).expect("a prediction");
    format!("{prediction:?}")
}

#[test]
fn an_own_medium_is_swept_by_the_settings_that_its_page_names() {
    let fade = |strength: f64, t: f64| strength / (1.0 + t);
    let case = veiled(&["strength"], fade, &swept("sweep.density = [0.5, 2]")).expect("a case");
    let text = swept("");
    for (value, [medium, sampling, control]) in
        [(0.5, ["0.375", "1", "0.25"]), (2.0, ["1.5", "4", "1"]), (3.0, ["2.25", "6", "1.5"])]
    {
        let written = text
            .replace("strength = 0.75", &format!("strength = {medium}"))
            .replace("sampling = 2", &format!("sampling = {sampling}"))
            .replace("strength = 0.5", &format!("strength = {control}"));
        let written = veiled(&[], fade, &written).expect("a case");
        let swept = theory(&case, Some((SweptQuantity::Density, value)));
        assert_eq!(swept, theory(&written, None), "{value}");
    }
}

#[test]
fn an_own_medium_that_is_not_proportional_is_not_swept() {
    let fade = |strength: f64, t: f64| strength / (1.0 + t);
    let power = |strength: f64, t: f64| t.powf(strength);
    let density = swept("sweep.density = [0.5, 2]");
    for (names, at, words) in [
        // A page that names no settings.
        (&[][..], fade as fn(f64, f64) -> f64, "this field has no extinction to scale"),
        // A page that names a wrong one.
        (
            &["strength"],
            power,
            "σ_t of `veil` is not proportional to the settings that its page names",
        ),
    ] {
        let found = veiled(names, at, &density).err().expect("a mistake");
        assert!(found.contains("at density = 0.5: ") && found.contains(words), "{found}");
    }
    // At c = 1 channels are as written, and at 1/2 not halfway between t and t³.
    let colours = "title = \"veil\"\n[problem.transmittance]\nspan = [0, 2]\nsampling = 9\n\
         medium = [{ veil.strength = 1 }, { veil.strength = 3 }]\nestimators = [\"spectral-mis\"]\n";
    let found = veiled(&["strength"], power, &format!("{colours}sweep.contrast = [1, 0.5]\n"));
    let found = found.err().expect("a mistake");
    assert!(found.contains("at contrast = 0.5: σ_t of `veil` is not proportional"), "{found}");
    assert!(veiled(&["strength"], fade, &format!("{colours}sweep.contrast = [1, 0.5]\n")).is_ok());
}
