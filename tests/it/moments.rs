//! Predictions against numbers from another arithmetic: see `tests/data/README.md`.

use crate::common::{differs, none, predicted, row};
use trueflight::media::{Control, Medium, Piecewise};
use trueflight::numeric::Span;
use trueflight::theory::Mesh;
use trueflight::theory::collisions::Rule;
use trueflight::theory::collisions::rules::{Single, Weight};
use trueflight::theory::ray::product::Product;

/// Row of `transmittance-moments.csv`.
struct Reference {
    columns: Vec<String>,
    fields: Vec<String>,
}

impl Reference {
    fn all() -> Vec<Self> {
        let file = include_str!("../data/transmittance-moments.csv");
        let mut reader = csv::Reader::from_reader(file.as_bytes());
        let words = |record: &csv::StringRecord| record.iter().map(str::to_owned).collect();
        let columns: Vec<String> = words(reader.headers().expect("a header"));
        let rows = reader.records().map(|record| words(&record.expect("a row")));
        rows.map(|fields| Self { columns: columns.clone(), fields }).collect()
    }

    fn text(&self, column: &str) -> &str {
        let index = self.columns.iter().position(|name| name == column);
        &self.fields[index.unwrap_or_else(|| panic!("no column {column}"))]
    }

    fn number(&self, column: &str) -> f64 {
        self.text(column).parse().expect("a number")
    }

    fn name(&self) -> String {
        let columns = ["medium", "cv", "sigma_samp", "estimator", "albedo"];
        columns.map(|column| self.text(column)).join(" ")
    }

    fn rule(&self) -> Box<dyn Rule> {
        let albedo = self.number("albedo");
        match self.text("estimator") {
            "DPM" => Box::new(Weight),
            "SPM-term" => Box::new(Single::Terminating),
            "SPM-termclamp" => Box::new(Single::Clamped),
            "SPM-nonterm" => Box::new(Single::NonTerminating { albedo }),
            "SPM-adaptive" => Box::new(Single::Adaptive { albedo }),
            other => panic!("no estimator {other}"),
        }
    }

    fn control(&self, medium: &Medium) -> Control {
        match self.text("cv") {
            "none" => Control::None,
            "c0.3" => Control::Pieces(Piecewise::constant(0.3, medium.support())),
            "int21" => {
                let Span { from, to } = medium.support();
                let knots: Vec<f64> =
                    (0..=20).map(|i| from + (to - from) * f64::from(i) / 20.0).collect();
                let values: Vec<f64> = knots.iter().map(|&t| medium.extinction(t)).collect();
                Control::Pieces(Piecewise::lines(&knots, &values))
            }
            other => panic!("no control {other}"),
        }
    }
}

fn mesh(name: &str) -> Mesh {
    Mesh::new(crate::common::medium(match name {
        "const" => "medium.constant.extinction = 0.5\nspan = [0, 4]",
        "pwc" => {
            "medium.piecewise-constant = { breaks = [0, 2, 3, 6, 6.5, 10], \
             values = [0.1, 1, 0.4, 0, 0.25] }\nspan = [0, 10]"
        }
        "eq21" => EQ21,
        other => panic!("no medium {other}"),
    }))
}

const EQ21: &str = "volume.eq21 = {}\n\
                    ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 20 }";

fn compare(reference: &Reference, mesh: &Mesh) -> Vec<String> {
    let medium = mesh.medium();
    let sampling = Piecewise::constant(reference.number("sigma_samp"), mesh.support());
    let (control, rule) = (reference.control(medium), reference.rule());
    let product = Product::new(mesh, &sampling, &control, rule.as_ref());
    let prediction = product.predict();
    let channel = &prediction.channels[0];
    let truth = channel.truth.value;
    let [m2, m3, m4] = channel.moments.expect("moments").relative;
    let stated = channel.moments_error().expect("an error");
    let count = prediction.lookups.as_ref().expect("a law of the lookups");
    let numbers = || (0..).map(f64::from).zip(&count.pmf);
    let mean: f64 = numbers().map(|(m, p)| m * p).sum();
    let variance: f64 = numbers().map(|(m, p)| (m - mean) * (m - mean) * p).sum();
    let [j1, j2, j3, j4] = channel.losses.expect("losses");
    // An error of J_k changes m_k by |J_k| times as much, and more.
    let sensitive = 1e-12 * (6.0 * j2.abs() + 4.0 * j3.abs() + j4.abs()).max(1.0);
    assert!(0.0 < stated && stated <= sensitive, "{}: {stated:e}", reference.name());
    let checks = [
        ("tau", mesh.optical_depth().value, 1e-12),
        ("T", truth, 1e-12),
        ("J1", j1, 1e-12),
        ("J2", j2, 1e-12),
        ("J3", j3, 1e-12),
        ("J4", j4, 1e-12),
        ("relvar", m2, sensitive),
        ("relvar", m2, stated),
        ("rel_mu4", m4, stated),
        ("rel_mu3", m3, sensitive),
        ("rel_mu4", m4, sensitive),
        ("E_fetch", count.mean, 1e-11),
        ("Var_fetch", count.variance, 1e-11),
        ("E_fetch", mean, 1e-11),
        ("Var_fetch", variance, 1e-11),
    ];
    let name = reference.name();
    let differences = checks.into_iter().filter_map(|(column, found, tolerance)| {
        differs(&format!("{name}: {column}"), found, reference.number(column), tolerance)
    });
    differences.collect()
}

#[test]
fn every_configuration_agrees_with_30_digit_arithmetic() {
    let references = Reference::all();
    assert_eq!(references.len(), 169);
    let mut differences = Vec::new();
    for medium in ["const", "pwc", "eq21"] {
        let mesh = mesh(medium);
        let of_medium = references.iter().filter(|row| row.text("medium") == medium);
        differences.extend(of_medium.flat_map(|row| compare(row, &mesh)));
    }
    none(&differences);
}

/// σ̂; the variances of double, single terminating (if it exists) and single non-terminating at a = .7; the kurtosis of
/// double to one decimal. Lookups of double are 20 σ̂. Variances are T² expm1(∫w) in 30-digit arithmetic, with panels
/// that end at the kinks of w at r = 1.
type TableRow = (f64, [Option<f64>; 3], f64);
const TABLE: [TableRow; 4] = [
    (0.4, [Some(1.441_433_140_5e-1), None, Some(7.231_465_342_384e-1)], 6.0),
    (0.8, [Some(1.144_062_262_9e-2), Some(3.919_916_781_327e-2), Some(2.792_249_973_349e-2)], 26.6),
    (1.0, [Some(6.589_260_996_6e-3), Some(3.177_453_843_1e-2), Some(2.015_436_238_3e-2)], 32.7),
    (2.0, [Some(1.797_663_200_7e-3), Some(3.177_453_843_1e-2), Some(1.474_384_253_1e-2)], 22.8),
];

#[test]
fn the_central_ray_of_eq_21_has_the_variances_of_the_table() {
    let mut differences = Vec::new();
    for (sampling, variances, kurtosis) in TABLE {
        let rows = predicted(&format!(
            "title = \"the table\"\n[problem.transmittance]\n{EQ21}\n\
             sampling.constant.value = {sampling}\n\
             estimators = [{{ double = {{}} }}, {{ single.rule = \"terminating\" }}, \
             {{ single = {{ rule = \"non-terminating\", albedo = 0.7 }} }}]"
        ));
        for (row, expected) in rows.iter().zip(variances) {
            let what = format!("{} at {sampling}", row.experiment.label);
            match (row.predicted_variance, expected) {
                // Half a unit of the last printed digit, relative to the smallest mantissa.
                (Some(found), Some(expected)) => {
                    differences.extend(differs(&what, found, expected, 5e-11));
                }
                (found, expected) => assert_eq!(found, expected, "{what}"),
            }
        }
        let double = row(&rows, "double");
        let found = double.predicted_kurtosis.expect("a kurtosis");
        assert!((found - kurtosis).abs() <= 0.05, "kurtosis at {sampling}: {found}");
        let lookups = double.experiment.predicted_lookups.expect("lookups");
        differences.extend(differs("lookups", lookups, 20.0 * sampling, 1e-14));
    }
    none(&differences);
}

#[test]
fn non_terminating_far_below_the_density_has_a_kurtosis_beyond_testing() {
    let rows = predicted(&format!(
        "title = \"kurtosis\"\n[problem.transmittance]\n{EQ21}\n\
         sampling.constant.value = 0.4\n\
         estimators = [{{ single = {{ rule = \"non-terminating\", albedo = 0.7 }} }}]"
    ));
    let kurtosis = rows[0].predicted_kurtosis.expect("a kurtosis");
    assert!((kurtosis / 2.5e5 - 1.0).abs() < 0.02, "{kurtosis}");
}

#[test]
fn the_integrals_of_eq_21_on_the_central_ray() {
    let mesh = mesh("eq21");
    let squares = mesh.integrate(&|_, extinction| extinction * extinction);
    let largest = mesh.largest(&|_, extinction| extinction).expect("a support").1;
    let depth = mesh.optical_depth().value;
    assert!((depth / 3.415_684_260_061_982_3 - 1.0).abs() < 1e-15);
    assert!((squares / 1.960_752_650_443_700_7 - 1.0).abs() < 1e-14);
    assert!((largest - 0.955_978_73).abs() < 5e-9);
}

#[test]
fn next_flight_and_unidirectional_mis_have_their_check_values() {
    // Cramer 1978 and Georgiev et al. 2019 at σ_t = 2 on [0, 1], σ̄ = 3; ratio from T = e⁻².
    let rows = predicted(
        "title = \"Volterra\"\n[problem.transmittance]\n\
         medium.constant.extinction = 2\nspan = [0, 1]\nsampling.constant.value = 3\n\
         estimators = [{ next-flight = {} }, { unidirectional-mis = {} }, { ratio = {} }]",
    );
    let expected = [3.908_319_949e-3, 3.200_715_080e-3, 5.116_781_233e-2];
    let pairs = rows.iter().zip(expected);
    let differences = pairs.filter_map(|(row, expected)| {
        let found = row.predicted_variance.expect("a variance");
        differs(&row.experiment.label, found, expected, 2e-10)
    });
    none(&differences.collect::<Vec<_>>());
    let lookups = rows.iter().map(|row| row.experiment.predicted_lookups.expect("lookups"));
    assert!(lookups.into_iter().all(|lookups| (lookups - 3.0).abs() < 1e-14));
}

/// Beyond 5e4 mean free paths of σ̄ the last flights, which make the whole variance, were once not resolved.
#[test]
fn next_flight_has_its_closed_form_from_few_mean_free_paths_to_many() {
    // σ_t = 2 on [0, 1], r = 2/σ̄, ρ = 1 − r, κ = 1 − ρ²; A₁ = e^{−σ_t z} − e^{−σ̄z}, z = 1 − x, so that
    // E[X²] = 2e^{−σ̄−2} − e^{−2σ̄} + σ̄ρ² ∫ (2e^{−(σ̄+2)z} − e^{−2σ̄z}) e^{−σ̄κ(1 − z)} dz.
    let samplings = [3.0, 10.0, 1e3, 1e5, 9e5];
    let rows = predicted(&format!(
        "title = \"layer\"\n[problem.transmittance]\n\
         medium.constant.extinction = 2\nspan = [0, 1]\nsweep.sampling.values = {samplings:?}\n\
         estimators = [{{ next-flight = {{}} }}]",
    ));
    let variance = |sampling: f64| {
        let (r, v) = (2.0 / sampling, (-sampling).exp());
        let (rho, kappa) = (1.0 - r, r * (2.0 - r));
        let over = |rate: f64| -(-sampling * rate).exp_m1() / rate;
        let flown = 2.0 * over(1.0 + r - kappa) - over(2.0 - kappa);
        let truth = (-2f64).exp();
        let second = v * (2.0 * truth - v) + rho * rho * (-sampling * kappa).exp() * flown;
        second - truth * truth
    };
    let pairs = rows.iter().zip(samplings);
    let differences = pairs.filter_map(|(row, sampling)| {
        let found = row.predicted_variance.expect("a variance");
        differs(&format!("{sampling}"), found, variance(sampling), 1e-9)
    });
    none(&differences.collect::<Vec<_>>());
    assert_eq!(rows.len(), samplings.len());
}

#[test]
fn a_walk_that_ends_at_collisions_has_closed_form_lookups_in_a_homogeneous_medium() {
    // ∫ σ̂ e^{−σ̂(1 − q)t} dt over [0, 2]: Woodcock with σ_t = 1, σ̂ = 2.5 has q = 1 − σ_t/σ̂, and
    // the non-terminating rule at a = .6 has q = |1 − r|/(a r + |1 − r|) = .6/.84.
    let rows = predicted(
        "title = \"lookups\"\n[problem.transmittance]\n\
         medium.constant.extinction = 1\nspan = [0, 2]\nsampling.constant.value = 2.5\n\
         estimators = [{ woodcock = {} }, { decomposition.control.constant.value = 0.4 }, \
         { single = { rule = \"non-terminating\", albedo = 0.6 } }, { double = {} }]",
    );
    let ended = |rate: f64| -2.5 * (-2.0 * rate).exp_m1() / rate;
    let expected = [ended(1.0), ended(1.0), ended(2.5 * (1.0 - 0.6 / 0.84)), 5.0];
    let pairs = rows.iter().zip(expected);
    let differences = pairs.filter_map(|(row, expected)| {
        differs(
            &row.experiment.label,
            row.experiment.predicted_lookups.expect("lookups"),
            expected,
            1e-13,
        )
    });
    none(&differences.collect::<Vec<_>>());
}

#[test]
fn variance_is_bounded_on_the_share_of_a_ray_on_which_sampling_is_at_least_half_the_extinction() {
    // w = σ_t²/σ̂ ≤ 2σ_t where σ_t = 4t ≤ 2σ̂. Three knots make no panel end there.
    let samplings = [0.3, 0.7, 1.0, 1.9, 2.5];
    let list = samplings.map(|s| format!("{{ ratio.sampling.constant.value = {s} }}")).join(", ");
    let rows = predicted(&format!(
        "title = \"stable\"\n[problem.transmittance]\n\
         medium.piecewise-linear = {{ knots = [0, 0.3, 1], values = [0, 1.2, 4] }}\nspan = [0, 1]\n\
         estimators = [{list}]"
    ));
    let differences = rows.iter().zip(samplings).filter_map(|(row, sampling)| {
        let share = row.experiment.stable_share.expect("a share");
        differs(&row.experiment.label, share, f64::min(0.5 * sampling, 1.0), 1e-11)
    });
    none(&differences.collect::<Vec<_>>());
}
