//! Pictures: their costs, the predicted errors, pictures that are the same to the byte, and messages about mistakes.

use std::path::PathBuf;

use trueflight::case::CaseText;
use trueflight::catalogue::own_pages::NONE;
use trueflight::render::record::{Exposure, PictureRecord};
use trueflight::render::{self, Picture};
use trueflight::report::render as report;

fn source(text: &str) -> CaseText {
    CaseText { name: "test".into(), path: PathBuf::from("test.toml"), text: text.into() }
}

fn picture(text: &str) -> Picture {
    Picture::read(&source(text), &NONE).unwrap_or_else(|error| panic!("{}", error.render(false)))
}

pub fn rendered(text: &str, seed: u64) -> PictureRecord {
    picture(text).render(seed, &|| {})
}

pub fn mistakes(text: &str) -> String {
    Picture::read(&source(text), &NONE).err().expect("mistakes").render(false)
}

pub fn found(record: &PictureRecord, number: usize) -> &Exposure {
    record.exposures[number].outcome.as_ref().expect("an image")
}

/// Returns a ball in a window of a size; at twice the size the same window is in the middle.
pub fn ball(size: usize, angle: f64) -> String {
    format!(
        "title = \"a ball\"
        [picture.transmittance]
        size = [{size}, {size}]
        lookups = 40
        volume.constant = {{ extinction = 0.8, bounds.sphere = {{ centre = [0, 0, 0], radius = 1 }} }}
        camera = {{ position = [0, 0, 6], target = [0, 0, 0], angle = {angle} }}
        reference.closed-form = {{}}
        estimators = [
          {{ woodcock = {{ sampling.constant.value = 2 }} }},
          {{ ratio = {{ sampling.constant.value = 2 }} }},
        ]"
    )
}

/// Returns Eq. 21 under a constant sky.
fn eq21(lookups: u64) -> String {
    format!(
        "title = \"Eq. 21\"
        [picture.transmittance]
        size = [48, 40]
        lookups = {lookups}
        shared-control = 2
        volume.eq21 = {{}}
        camera = {{ position = [0, 0, -22], target = [0, 0, 10], angle = 38 }}
        reference.closed-form = {{}}
        estimators = [
          {{ woodcock = {{ sampling.constant.value = 1 }} }},
          {{ residual-ratio = {{ sampling.constant.value = 1 }} }},
          {{ double = {{ sampling.constant.value = 0.6, control.explorers.points = 40 }} }},
          {{ ray-marching = {{ steps = 30, expect = \"biased\" }} }},
        ]"
    )
}

const SINGLE: &str = "title = \"single scattering\"
    [picture.single-scattering]
    size = [24, 20]
    lookups = 400
    volume.eq21 = {}
    camera = { position = [0, 0, -22], target = [0, 0, 10], angle = 38 }
    light = { position = [2.1, 1.3, 6.2], power = 1000 }
    albedo = 0.7
    phase.rayleigh = {}
    sampling.constant.value = 1
    reference.quadrature = {}
    estimators = [
      { source-driven = { camera = \"ratio\", shadow.ratio = { sampling = 1 } } },
      { delta-tracking = { shadow.delta = { sampling = 1 } } },
    ]";

const MULTIPLE: &str = "title = \"multiple scattering\"
    [picture.multiple-scattering]
    size = [24, 20]
    lookups = 400
    volume.eq21 = {}
    albedo = 0.7
    phase.rayleigh = {}
    camera = { position = [0, 0, -22], target = [0, 0, 10], angle = 38 }
    sky.gradient = { sun = [1, 1, 0], glare = 3, sharpness = 4 }
    reference.draws = { lookups = 4000, estimator.particle = { rule = \"analog\", sampling.local-majorants.grid = [8, 8, 8] } }
    estimators = [
      { particle = { rule = \"adaptive\", sampling.constant.value = 0.9 } },
      { particle = { rule = \"weighted\", sampling.constant.value = 1 } },
      { particle = { rule = \"terminating\", sampling.constant.value = 0.5 } },
    ]";

/// A frame of empty pixels around a picture takes no random number: the other pixels stay the same.
#[test]
fn empty_pixels_cost_nothing() {
    let narrow = 24.0_f64;
    let wide = 2.0 * (2.0 * (narrow / 2.0).to_radians().tan()).atan().to_degrees();
    let (small, large) = (rendered(&ball(16, narrow), 1), rendered(&ball(32, wide), 1));
    assert!(small.covered > 100 && small.empty > 20, "{} covered", small.covered);
    assert_eq!((small.covered, small.empty + 768), (large.covered, large.empty));
    for number in 0..2 {
        let (inner, outer) = (found(&small, number), found(&large, number));
        assert_eq!((inner.lookups, inner.draws), (outer.lookups, outer.draws));
        for (i, x) in inner.image.iter().enumerate() {
            let same = outer.image[(i / 16 + 8) * 32 + i % 16 + 8];
            assert!((x - same).abs() < 1e-9, "pixel {i}: {x} and {same}");
        }
        assert_eq!(outer.image[0], 1.0, "the sky is seen beside the ball");
    }
}

#[test]
fn lookups_are_equal() {
    for record in [rendered(&eq21(30), 1), rendered(SINGLE, 1), rendered(MULTIPLE, 1)] {
        let budget = record.budget as f64;
        for exposure in record.exposures.iter().filter_map(|e| e.outcome.as_ref().ok()) {
            let off = (exposure.lookups - budget).abs() / budget;
            assert!(off < 0.1, "{} of {budget}", exposure.lookups);
            let merit = exposure.figure_of_merit.expect("an error");
            assert!((merit * exposure.rmse.powi(2) * exposure.lookups - 1.0).abs() < 1e-12);
        }
    }
}

/// `Σ(image − truth)²` against the prediction, in standard deviations of a sum of squared means of n draws:
/// `Var(x̄ − T)² = (μ₄ − 3μ₂²)/n³ + 2μ₂²/n²` with the moments of draws of 0 and 1.
#[test]
fn the_error_is_what_theory_says() {
    for seed in [1, 2, 3] {
        let record = rendered(&eq21(120), seed);
        let woodcock = found(&record, 0);
        let (n, pixels) = (woodcock.draws, record.covered as f64);
        let sky_is_one = |&&p: &&f64| p < 1.0;
        let spread: f64 = record
            .reference
            .image
            .iter()
            .filter(sky_is_one)
            .map(|p| {
                let variance = p * (1.0 - p);
                let fourth = variance * (1.0 - 3.0 * variance);
                (fourth - 3.0 * variance * variance) / n.powi(3) + 2.0 * (variance / n).powi(2)
            })
            .sum();
        let predicted = woodcock.predicted_rmse.expect("theory").powi(2);
        let z = (woodcock.rmse.powi(2) - predicted) * pixels / spread.sqrt();
        assert!(z.abs() < 5.0, "seed {seed}: z = {z}");
        // The mean over all pixels is right, too; ray marching has no spread, and a bias.
        for number in [0, 1] {
            let exposure = found(&record, number);
            let z = exposure.bias / (exposure.rmse / pixels.sqrt());
            assert!(z.abs() < 5.0, "seed {seed}, estimator {number}: z = {z}");
        }
        let marched = found(&record, 3);
        let predicted = marched.predicted_rmse.expect("theory");
        assert!((marched.rmse / predicted - 1.0).abs() < 1e-6, "{} {predicted}", marched.rmse);
    }
}

#[test]
fn scattered_light_is_unbiased() {
    for text in [SINGLE, MULTIPLE] {
        let record = rendered(text, 1);
        let pixels = (record.covered as f64).sqrt();
        for exposure in record.exposures.iter().filter_map(|e| e.outcome.as_ref().ok()) {
            let own = exposure.rmse.hypot(record.reference.error);
            let z = exposure.bias / (own / pixels);
            assert!(z.abs() < 5.0, "{}: z = {z}", record.problem);
        }
    }
}

#[test]
fn a_rule_that_does_not_exist_is_refused_with_its_place() {
    let record = rendered(MULTIPLE, 1);
    let refusal = record.exposures[2].outcome.as_ref().expect_err("r reaches 2");
    assert!(refusal.contains("pixel (") && refusal.contains("r ≤ 2/(a + 1)"), "{refusal}");
    let too_dear = rendered(&eq21(2), 1);
    let refusal = too_dear.exposures[1].outcome.as_ref().expect_err("too dear");
    assert!(refusal.contains("a draw takes") && refusal.contains("there are 2"), "{refusal}");
}

#[test]
fn nothing_is_seen_in_a_white_furnace() {
    let text = "title = \"white\"
        [picture.multiple-scattering]
        size = [12, 12]
        lookups = 60
        volume.eq21 = {}
        albedo = 1
        phase.henyey-greenstein.g = 0.5
        camera = { position = [0, 0, -22], target = [0, 0, 10] }
        sky.constant.radiance = 3
        reference.closed-form = {}
        estimators = [{ particle = { rule = \"non-terminating\", sampling.constant.value = 1 } }]";
    let record = rendered(text, 1);
    let exposure = found(&record, 0);
    assert!(exposure.image.iter().all(|x| (x - 3.0).abs() < 1e-12));
    assert!(exposure.rmse < 1e-12 && exposure.draws > 2.0, "{} draws", exposure.draws);
}

#[test]
fn pictures_are_the_same_on_any_number_of_threads() {
    let texts = [ball(16, 24.0), eq21(30), SINGLE.to_owned(), MULTIPLE.to_owned()];
    let bytes = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        let records: Vec<PictureRecord> =
            pool.install(|| texts.iter().map(|text| rendered(text, 2)).collect());
        let sheets = records.iter().map(|record| report::artifacts(record).expect("a sheet"));
        (sheets.collect::<Vec<_>>(), report::csv(&records).expect("a table"))
    };
    let one = bytes(1);
    assert!(one == bytes(2) && one == bytes(7));
    assert_ne!(
        rendered(&texts[0], 3).exposures[0].outcome.as_ref().expect("an image").image,
        rendered(&texts[0], 2).exposures[0].outcome.as_ref().expect("an image").image
    );
}

/// A ball to the right and above the middle, in a view along −z with y upwards.
#[test]
fn right_is_right_and_up_is_up() {
    let text = ball(16, 40.0).replace("centre = [0, 0, 0]", "centre = [1, 1, 0]");
    let record = rendered(&text, 1);
    let dark = |column: usize, row: usize| record.reference.image[row * 16 + column] < 1.0;
    assert!(dark(11, 4), "the ball is there");
    assert!((0..16).all(|i| (0..16).all(|j| !dark(i, j) || (i >= 7 && j <= 8))));
}

#[test]
fn float_maps_hold_the_image_from_the_lowest_row() {
    let record = rendered(&eq21(30), 1);
    let files = report::artifacts(&record).expect("files");
    let names: Vec<String> = files.iter().map(|file| file.path.display().to_string()).collect();
    assert_eq!(names[0], "test.png");
    let at = names.iter().position(|name| name == "test/1-woodcock.pfm").expect("a map");
    let header = b"Pf\n48 40\n-1.0\n";
    let (head, body) = files[at].bytes.split_at(header.len());
    assert_eq!((head, body.len()), (&header[..], 4 * 48 * 40));
    let read = |row: usize, column: usize| {
        let at = 4 * ((39 - row) * 48 + column);
        f32::from_le_bytes(body[at..at + 4].try_into().expect("four bytes"))
    };
    let image = &found(&record, 0).image;
    for (row, column) in [(0, 0), (39, 0), (20, 24), (13, 30)] {
        #[expect(clippy::cast_possible_truncation)] // as the format does
        let expected = image[row * 48 + column] as f32;
        assert_eq!(read(row, column), expected, "row {row}, column {column}");
    }
    assert!(files[0].bytes.starts_with(b"\x89PNG"));
}

#[test]
fn a_caption_stands_below_the_title_and_every_picture_has_one() {
    let plain = rendered(&ball(16, 40.0), 1);
    let text = ball(16, 40.0).replace("title = ", "caption = \"A ball, seen twice.\"\ntitle = ");
    let with = rendered(&text, 1);
    assert_eq!((plain.caption.as_str(), with.caption.as_str()), ("", "A ball, seen twice."));
    assert_eq!(plain.reference.image, with.reference.image);
    let height = |record: &PictureRecord| {
        let png = report::artifacts(record).expect("files").swap_remove(0).bytes;
        u32::from_be_bytes(png[20..24].try_into().expect("four bytes"))
    };
    assert!(height(&with) > height(&plain));
    for built_in in render::gallery() {
        assert!(built_in.text.contains("\ncaption = \""), "{}", built_in.name);
    }
}

#[test]
fn every_mistake_is_listed_with_its_place_and_cure() {
    let text = "title = \"broken\"
        [picture.transmittance]
        size = [0, 12]
        lookup = 30
        volume.noise = { extinction = 1 }
        camera = { position = [0, 0, 1], target = [0, 0, 1], angle = 200 }
        sky.gradient = { up = [0, 0, 0] }
        reference.guess = {}
        estimators = [{ woodcock = {} }, { ratio = { sampling.pilot = {} } }, { magic = {} }]";
    let said = mistakes(text);
    let expected = [
        ("test.toml:3", "each entry is a finite number above 0"),
        ("test.toml:4", "did you mean `lookups`"),
        ("test.toml:2", "`lookups` is missing"),
        ("test.toml:5", "this volume fills all of space"),
        ("test.toml:6", "below 179 degrees"),
        ("test.toml:7", "`up` has no direction"),
        ("test.toml:8", "`guess` is not known here"),
        ("test.toml:9", "`woodcock` has no sampling extinction"),
        ("test.toml:9", "learned by lookups that nobody counts"),
        ("test.toml:9", "`magic` is not known here"),
    ];
    for (place, words) in expected {
        assert!(said.contains(place) && said.contains(words), "{words}:\n{said}");
    }
    let blind = ball(16, 24.0).replace("position = [0, 0, 6]", "position = [0, 6, 0]");
    assert!(mistakes(&blind).contains("`up` points aside of the view"));
    let bright = SINGLE.replace("[2.1, 1.3, 6.2]", "[0, 0, -22]");
    assert!(mistakes(&bright).contains("the light is"), "{}", mistakes(&bright));
    let endless = MULTIPLE.replace(
        "reference.draws = { lookups = 4000",
        "reference.quadrature = {}\nx = { lookups = 4000",
    );
    assert!(mistakes(&endless).contains("there is no quadrature"), "{}", mistakes(&endless));
    let gray = MULTIPLE.replace(
        "reference.draws = { lookups = 4000",
        "reference.closed-form = {}\nx = { lookups = 4000",
    );
    assert!(mistakes(&gray).contains("there is no closed form"), "{}", mistakes(&gray));
}

#[test]
fn a_picture_is_no_case_and_a_case_no_picture() {
    let case = "title = \"a case\"\n[problem.transmittance]\nmedium.constant.extinction = 1\n";
    let said = mistakes(case);
    assert!(said.contains("this is a case") && said.contains("trueflight run"), "{said}");
    let error = trueflight::case::Case::read(&source(SINGLE)).err().expect("no case");
    let said = error.render(false);
    assert!(said.contains("this is a picture") && said.contains("trueflight render"), "{said}");
    assert_eq!(error.mistakes(), 1, "nothing else is said");
}

#[test]
fn every_built_in_picture_is_well_written() {
    let sources = render::gallery();
    assert_eq!(sources.len(), 9);
    for source in &sources {
        let picture =
            Picture::read(source, &NONE).unwrap_or_else(|e| panic!("{}", e.render(false)));
        assert!(picture.title.len() < 100, "{}", picture.name);
        assert!(render::find(&source.name).is_some());
    }
}

mod command {
    use super::ball;
    use assert_cmd::Command;

    fn run(folder: &std::path::Path, arguments: &str) -> std::process::Output {
        let mut command = Command::cargo_bin("trueflight").expect("the binary");
        command.current_dir(folder).env_remove("NO_COLOR");
        command.args(arguments.split_whitespace()).output().expect("it runs")
    }

    #[test]
    fn files_are_written_and_a_place_that_cannot_be_is_told_before() {
        let place = tempfile::TempDir::new().expect("a folder");
        std::fs::write(place.path().join("ball.toml"), ball(16, 24.0)).expect("a file");
        let output = run(place.path(), "render ball.toml --out out");
        let said = String::from_utf8(output.stdout).expect("text");
        assert_eq!(output.status.code(), Some(0), "{said}");
        assert!(said.contains("are empty and cost nothing") && said.contains("RMSE"), "{said}");
        for file in
            ["ball.png", "gallery.csv", "report.html", "ball/reference.pfm", "ball/2-ratio.exr"]
        {
            assert!(place.path().join("out/gallery").join(file).exists(), "{file}");
        }
        let output = run(place.path(), "render ball.toml --out ball.toml");
        let said = String::from_utf8(output.stderr).expect("text");
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains("cannot write into") && said.contains("--out"), "{said}");
        let output = run(place.path(), "run ball.toml");
        let said = String::from_utf8(output.stderr).expect("text");
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains("trueflight render"), "{said}");
        let output = run(place.path(), "render nothing.toml");
        assert_eq!(output.status.code(), Some(2));
    }
}
