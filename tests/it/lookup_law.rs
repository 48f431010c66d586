//! Probabilities of the numbers of lookups against closed forms.

use crate::common::{differs, none};
use trueflight::media::{Control, Piecewise};
use trueflight::theory::collisions::Rule;
use trueflight::theory::collisions::rules::{Null, Single, Weight};
use trueflight::theory::ray::product::Product;
use trueflight::theory::{CountDistribution, Mesh};

fn law(medium: &str, sampling: f64, killing: f64, rule: &dyn Rule) -> CountDistribution {
    let mesh = Mesh::new(crate::common::medium(medium));
    let sampling = Piecewise::constant(sampling, mesh.support());
    let product = Product { killing, ..Product::new(&mesh, &sampling, &Control::None, rule) };
    product.predict().lookups.expect("a law")
}

/// Returns Poisson probabilities as the product `e^{−m} ∏ m/k`: unlike a logarithm of a factorial, exact to a few last
/// digits.
fn poisson(n: u32, mean: f64) -> f64 {
    (1..=n).map(|k| mean / f64::from(k)).fold((-mean).exp(), |p, factor| p * factor)
}

fn constant(extinction: f64, length: f64) -> String {
    format!("medium.constant.extinction = {extinction}\nspan = [0, {length}]")
}

const EQ21: &str = "volume.eq21 = {}\n\
                    ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 20 }";
const STEPS: &str = "medium.piecewise-constant = { breaks = [0, 2, 3, 6, 6.5, 10], \
                     values = [0.1, 1, 0.4, 0, 0.25] }\nspan = [0, 10]";

/// Lists differences beyond 1e-13 of the largest probability; the tail must be negligible.
fn compare(what: &str, law: &CountDistribution, exact: impl Fn(u32) -> f64) -> Vec<String> {
    let most = law.pmf.iter().fold(0.0f64, |most, &p| most.max(p));
    let found = (0..).zip(&law.pmf).filter_map(|(m, &p)| {
        let expected = exact(m);
        let off = (p - expected).abs() > 1e-13 * most;
        off.then(|| format!("{what}: P({m}) = {p:e} against {expected:e}"))
    });
    found.collect()
}

#[test]
fn a_walk_that_nothing_ends_is_poisson() {
    for sampling in [0.01, 0.4, 5.0, 30.0] {
        let law = law(EQ21, sampling, 0.0, &Weight);
        none(&compare("Poisson", &law, |m| poisson(m, 20.0 * sampling)));
    }
}

#[test]
fn woodcock_in_a_homogeneous_medium_is_a_geometric_law_cut_by_a_poisson_one() {
    // Of N ~ Poisson(σ̂ℓ) tentative collisions each is real with probability p = σ_t/σ̂, and the
    // first real one is the last: M = m if all m = N are null, or if N ≥ m and the m-th is the
    // first real one.
    for (sampling, extinction, length) in [(2.5, 1.0, 2.0), (4.0, 0.1, 30.0), (9.0, 0.02, 60.0)] {
        let law = law(&constant(extinction, length), sampling, 0.0, &Null);
        let (p, mean) = (extinction / sampling, sampling * length);
        let at_least = |m: u32| 1.0 - (0..m).map(|n| poisson(n, mean)).sum::<f64>();
        let exact = |m: u32| {
            let null = |k: u32| (1.0 - p).powi(i32::try_from(k).expect("a small number"));
            let all_null = poisson(m, mean) * null(m);
            if m == 0 { all_null } else { all_null + at_least(m) * null(m - 1) * p }
        };
        none(&compare(&format!("σ̂ = {sampling}"), &law, exact));
    }
}

#[test]
fn a_killed_walk_in_a_homogeneous_medium_has_a_killed_law() {
    // A clock of rate c stops the walk at u without a lookup. With every collision null, M is
    // Poisson(σ̂ min(u, ℓ)): P(0) = e^{−(σ̂+c)ℓ} + c/(σ̂ + c) (1 − e^{−(σ̂+c)ℓ}), and by parts
    // P(m) = e^{−cℓ} Pois(m; σ̂ℓ) + c σ̂^m/(σ̂ + c)^{m+1} P(N' > m), N' ~ Poisson((σ̂ + c)ℓ).
    let (sampling, killing, length) = (3.0, 0.25, 6.0);
    let mesh = constant(0.0, length);
    let law = law(&mesh, sampling, killing, &Weight);
    let rate = sampling + killing;
    let exact = |m: u32| {
        let above = 1.0 - (0..=m).map(|n| poisson(n, rate * length)).sum::<f64>();
        let power = i32::try_from(m).expect("a small number");
        (-killing * length).exp() * poisson(m, sampling * length)
            + killing / rate * (sampling / rate).powi(power) * above
    };
    none(&compare("killed", &law, exact));
}

#[test]
fn every_law_sums_to_one_and_has_the_mean_and_the_variance_of_the_integrals() {
    let rules: [(&str, &dyn Rule); 6] = [
        ("null", &Null),
        ("weight", &Weight),
        ("terminating", &Single::Terminating),
        ("clamped", &Single::Clamped),
        ("non-terminating", &Single::NonTerminating { albedo: 0.7 }),
        ("adaptive", &Single::Adaptive { albedo: 0.3 }),
    ];
    let noise = "volume.noise = { extinction = 1.2, octaves = 3, seed = 5 }\n\
                 ray = { origin = [0.3, 0.7, -0.4], direction = [0.6, 0.5, 0.4], length = 5 }";
    let mut differences = Vec::new();
    for (medium, sampling) in [
        (EQ21, 0.4),
        (EQ21, 1.0),
        (EQ21, 5.0),
        (EQ21, 80.0),
        (STEPS, 0.6),
        (STEPS, 7.0),
        (noise, 1.3),
        (noise, 40.0),
    ] {
        for killing in [0.0, 0.3] {
            for (name, rule) in rules {
                let what = format!("{name}, σ̂ = {sampling}, c = {killing}");
                let law = law(medium, sampling, killing, rule);
                let numbers = || (0..).map(f64::from).zip(&law.pmf);
                let sum: f64 = law.pmf.iter().sum();
                let mean: f64 = numbers().map(|(m, p)| m * p).sum();
                let variance: f64 =
                    numbers().map(|(m, p)| (m - law.mean) * (m - law.mean) * p).sum();
                differences.extend(differs(&format!("{what}: sum"), sum, 1.0, 1e-12));
                differences.extend(differs(&format!("{what}: mean"), mean, law.mean, 1e-10));
                let expected = law.variance;
                differences.extend(differs(&format!("{what}: var"), variance, expected, 1e-10));
            }
        }
    }
    none(&differences);
}

#[test]
fn a_certain_number_has_one_probability() {
    assert_eq!(CountDistribution::always(0.0).pmf, [1.0]);
    assert_eq!(CountDistribution::always(3.0).pmf, [0.0, 0.0, 0.0, 1.0]);
    assert_eq!(CountDistribution::poisson(0.0).pmf, [1.0]);
    assert!(CountDistribution::poisson(2001.0).pmf.is_empty());
}
