//! Furnaces in several channels: the radiance is 1 in each, for any media; and refusals.

use trueflight::record::Verdict;

use crate::common::{case, predicted, rows};
use crate::packets::compare;

const BALL: &str = include_str!("../cases/furnace/spectral-known-bugs.toml");
const LIKE: &str = include_str!("../../cases/furnace/spectral-like-colours.toml");
const NOISE: &str = include_str!("../cases/furnace/spectral-noise.toml");

#[test]
fn every_channel_is_as_bright_as_the_walls() {
    for (text, channels) in [(BALL, 3_u8), (NOISE, 2)] {
        let rows = rows(text, 400_000);
        for row in &rows {
            assert_eq!(row.truth, Some(1.0));
            assert_eq!(
                row.verdict,
                Some(Verdict::Pass),
                "{}: {}",
                row.experiment.label,
                row.reason()
            );
        }
        let of_balance = rows.iter().filter(|row| row.experiment.label.starts_with("spectral-mis"));
        let heroes = (text.matches("{ spectral-mis").count(), channels);
        assert_eq!(of_balance.clone().count(), heroes.0 * usize::from(heroes.1));
        // The predicted bound, 1/w − 1, is never reached: all channels have a score in most walks.
        for row in of_balance {
            let weights: &[f64] = match row.experiment.label.as_str() {
                "spectral-mis" => &[1.0 / f64::from(channels); 3],
                "spectral-mis (hero by luminance)" => &[0.2126, 0.7152, 0.0722],
                "spectral-mis (hero 0.8 0.2)" => &[0.8, 0.2],
                _ => &[0.6, 0.2, 0.2],
            };
            let channel: usize = row.channel["channel ".len()..].parse().expect("its number");
            let (spread, bound) = (row.variance.expect("drawn"), 1.0 / weights[channel - 1] - 1.0);
            assert!(spread < 0.85 * bound, "{}: {spread} of {bound}", row.experiment.label);
        }
    }
}

/// `Var X_λ = 1/w_λ − 1` of one channel a draw: w = .2126, .7152, .0722.
#[test]
fn one_channel_a_draw_costs_what_its_chance_says() {
    let text = BALL.replace("{ independent = {} }", "{ independent = { hero = \"luminance\" } }");
    let rows = predicted(&text);
    for (row, weight) in rows.iter().zip([0.2126, 0.7152, 0.0722]) {
        let variance = row.predicted_variance.expect("known");
        assert!(
            (variance - (1.0 / weight - 1.0)).abs() < 1e-12 / weight,
            "{}",
            row.experiment.label
        );
    }
}

/// Walks without multiple importance sampling also have the mean 1, with a second moment below its bound.
#[test]
fn walks_relative_to_one_walker_find_the_walls() {
    let rows = rows(LIKE, 400_000);
    assert_eq!(rows.len(), 7 * 3);
    for row in &rows {
        assert_eq!(row.verdict, Some(Verdict::Pass), "{}: {}", row.experiment.label, row.reason());
    }
    let spread = |estimator: &str| {
        let of = rows.iter().filter(|row| row.experiment.label == estimator);
        of.map(|row| row.variance.expect("drawn")).fold(0.0, f64::max)
    };
    // Even for similar colours weights spread; the balance heuristic bounds them.
    assert!(spread("spectral-mis") < spread("hero"));
    assert!(spread("hero") < 0.2 && spread("spectral-tracking (maximum)") < 0.2);
}

/// Forward peaks, losses that cancel and majorants that equal σ_t to rounding have valid bounds: no correct estimator
/// fails.
#[test]
fn bounds_hold_at_the_edges() {
    let ball = |extinctions: [f64; 2],
                albedos: [f64; 2],
                g: [f64; 2],
                radius: f64,
                sampling: &str| {
        let volume = extinctions.map(|extinction| {
            format!("{{ constant = {{ extinction = {extinction:?}, bounds.sphere = {{ centre = [0, 0, 0], radius = {radius:?} }} }} }}")
        });
        format!(
            "title = \"edge\"\n[problem.furnace]\nvolume = [{}, {}]\n\
             ray = {{ origin = [0.1, 0.05, -2], direction = [0, 0, 1], length = 4 }}\nalbedos = {albedos:?}\n\
             phases = [{{ henyey-greenstein.g = {:?} }}, {{ henyey-greenstein.g = {:?} }}]\n{sampling}\nestimators = [{{ hero = {{}} }}]\n",
            volume[0], volume[1], g[0], g[1]
        )
    };
    let edges = [
        ball([5.0, 5.0], [0.98, 0.98], [0.999, 0.998], 1.0, "sampling.constant.value = 5.5"),
        ball([0.45, 0.675], [0.95, 0.1], [0.3, 0.3], 0.5, "sampling.constant.value = 0.9"),
        ball(
            [1.8, 1.5],
            [0.5, 0.5],
            [0.0, 0.0],
            1.0,
            "sampling.constant.value = 0.6\nsweep.sampling-scale.values = [3]",
        ),
        ball([1.000_000_000_5, 0.5], [0.5, 0.5], [0.0, 0.0], 1.0, "sampling.constant.value = 1"),
        ball([1.0, 1.0], [1.0, 0.9], [0.0, 0.0], 1.0, "sampling.constant.value = 1.5"),
    ];
    for text in edges {
        for row in rows(&text, 20_000) {
            assert_eq!(
                row.verdict,
                Some(Verdict::Refused),
                "{text}{}: {}",
                row.channel,
                row.reason()
            );
            assert!(
                ["multiply E[X²] by", "without limit", "too peaked"]
                    .iter()
                    .any(|words| row.reason().contains(words)),
                "{}",
                row.reason()
            );
        }
    }
}

/// With one channel every draw is 1.
#[test]
fn one_channel_alone_is_certain() {
    let text = "title = \"one\"
        [problem.furnace]
        volume = [{ constant = { extinction = 1, bounds.sphere = { centre = [0, 0, 0], radius = 1 } } }]
        ray = { origin = [0, 0, -2], direction = [0, 0, 1], length = 4 }
        albedos = [0.5]
        phases = [{ isotropic = {} }]
        sampling.constant.value = 1.5
        estimators = [{ independent = {} }, { spectral-mis = {} }, { hero = {} }, { spectral-tracking = {} }]";
    for row in rows(text, 20_000) {
        assert_eq!(row.verdict, Some(Verdict::Pass), "{}: {}", row.experiment.label, row.reason());
    }
}

/// A list of heroes of the wrong length does not panic if the estimator is declared biased.
#[test]
fn too_few_heroes_of_a_declared_bias_are_no_panic() {
    let heroes = "{ spectral-mis = { hero = [0.5, 0.5], expect = \"biased\" } }";
    assert!(!predicted(&BALL.replacen("{ spectral-mis = {} }", heroes, 1)).is_empty());
}

/// Pairs of fields in a ball or a box, of every cost, with every phase function, and σ̂ of one value or two.
#[test]
fn walks_side_by_side_are_walks_one_by_one() {
    const BALL_OF: &str = "bounds.sphere = { centre = [0, 0, 0], radius = 1 }";
    const BOX_OF: &str = "bounds.box = { low = [-1, -0.8, -1], high = [1, 0.9, 0.7] }";
    const FIELDS: [&str; 5] = [
        "constant = { extinction = 2.1,",
        "gaussian = { peak = 1.9, centre = [0.5, 0, 0], width = 0.8,",
        "noise = { extinction = 2, octaves = 3, seed = 3,",
        "piecewise-linear = { knots = [-1, 0, 1], values = [0.8, 0.1, 1.9],",
        "grid = { random = { size = [3, 4, 3], seed = 5 }, extinction = 1.5,",
    ];
    const PHASES: [&str; 3] =
        ["isotropic = {}", "rayleigh = {}", "henyey-greenstein = { g = -0.7 }"];
    let mut cases = vec![case("ball", BALL), case("noise", NOISE), case("like", LIKE)];
    for (body, bounds) in [BALL_OF, BOX_OF].into_iter().enumerate() {
        // Grids exist in boxes only.
        let fields = if body == 0 { &FIELDS[..4] } else { &FIELDS };
        for first in 0..fields.len() {
            let other = (first + 1 + body) % fields.len();
            let volume = |field: usize| format!("{{ {} {bounds} }} }}", fields[field]);
            let [one, two] = [first, other].map(volume);
            let [here, there] = [first % PHASES.len(), (other + body) % PHASES.len()];
            let text = format!(
                "title = \"walks\"\n[problem.furnace]\nvolume = [{one}, {two}]
                ray = {{ origin = [0.3, 0.2, -3], direction = [0.1, 0, 1], length = 9 }}
                albedos = [0.95, 1]\nphases = [{{ {} }}, {{ {} }}]\nsampling.constant.value = 2.1
                estimators = [{{ independent = {{}} }}, {{ spectral-mis = {{}} }},
                    {{ independent = {{ hero = [0.2, 0.8] }} }},
                    {{ spectral-mis = {{ hero = [0.7, 0.3],
                        sampling = [{{ constant.value = 2.5 }}, {{ constant.value = 2.2 }}] }} }},
                    {{ spectral-tracking = {{ probabilities = \"history\" }} }}]",
                PHASES[here], PHASES[there]
            );
            cases.push(case(&format!("{first} and {other}, body {body}"), &text));
        }
    }
    compare(&cases, 39);
}
