//! The best σ̂ along the ray: its formulas against an optimisation step by step, and its rows against draws.

use super::{ANY, SINES, asked, request};
use crate::common::{failing, none, rows};
use trueflight::advise::profile::{PLACES, STEPS, Steps};
use trueflight::advise::{Costs, Group};
use trueflight::theory::collisions::Collisions;
use trueflight::theory::collisions::Rule;
use trueflight::theory::collisions::rules::{Single, Weight};

/// Returns the steps of σ_t = 1 + 0.9 sin 2t on [0, 4].
fn steps(price: [f64; 2]) -> Steps {
    let width = 4.0 / STEPS as f64;
    let place = |step: usize, i: usize| width * (step as f64 + (i as f64 + 0.5) / PLACES as f64);
    let extinction = |t: f64| 1.0 + 0.9 * (2.0 * t).sin();
    let places = |step| (0..PLACES).map(|i| extinction(place(step, i))).collect();
    Steps { residual: (0..STEPS).map(places).collect(), width, price }
}

/// Improves each step in turn by factors that shrink, from a constant; returns the least value of a function.
fn searched(work: impl Fn(&[f64]) -> f64, start: f64) -> f64 {
    let mut sampling = vec![start; STEPS];
    let mut least = work(&sampling);
    let mut factor = 1.5;
    while factor > 1.0005 {
        let before = least;
        for step in 0..STEPS {
            for change in [factor, 1.0 / factor] {
                let old = sampling[step];
                sampling[step] = old * change;
                let changed = work(&sampling);
                if changed < least { least = changed } else { sampling[step] = old }
            }
        }
        if least > before * (1.0 - 1e-6) {
            factor = factor.sqrt();
        }
    }
    least
}

#[test]
fn weights_have_a_profile_in_proportion_to_the_residual() {
    let steps = steps([2.0, 1.0]);
    let best = steps.best(Collisions::Weight, 1.0).expect("a profile");
    let root = |i: usize| {
        let squares: f64 = steps.residual[i].iter().map(|x| x * x).sum();
        (squares / PLACES as f64).sqrt()
    };
    let ratios: Vec<f64> = (0..STEPS).map(|i| best[i] / root(i)).collect();
    assert!(ratios.iter().all(|ratio| (ratio / ratios[0] - 1.0).abs() < 1e-3), "{ratios:?}");
    // The limit for a large κ, of any shape: J·C, found step by step.
    let whole: f64 = (0..STEPS).map(|i| steps.width * root(i)).sum();
    let limit = |sampling: &[f64]| {
        let large: Vec<f64> = sampling.iter().map(|x| x * 1e7).collect();
        steps.work(&Weight, &large)
    };
    let found = searched(limit, 1.0);
    assert!((found / (whole * whole) - 1.0).abs() < 1e-3, "{found} {whole}");
    let over = steps.work(&Weight, &best) / (whole * whole);
    assert!((1.049..1.0501).contains(&over), "{over}");
}

#[test]
fn without_a_fixed_cost_the_profile_is_five_percent_above_its_limit() {
    let steps = steps([0.0, 1.0]);
    let best = steps.best(Collisions::Weight, 1.0).expect("a profile");
    let depth: f64 = steps.residual.iter().flatten().sum::<f64>() * steps.width / PLACES as f64;
    let over = steps.work(&Weight, &best) / (depth * depth);
    // Steps differ from a function by their root mean squares.
    assert!((1.04..1.052).contains(&over), "{over}");
}

#[test]
fn particles_have_a_profile_that_no_step_improves() {
    let steps = steps([2.0, 1.0]);
    let (albedo, start) = (0.3, 2.5);
    let rule = Single::NonTerminating { albedo };
    let best = steps.best(Collisions::Single(rule), start).expect("a profile");
    let work = steps.work(&rule, &best);
    assert!(work < steps.work(&rule, &[start; STEPS]));
    let found = searched(|sampling| steps.work(&rule, sampling), start);
    assert!(work < found * 1.001, "{found} {work}");
    // Pontryagin's principle.
    let share = steps.width / PLACES as f64;
    let over = |i: usize, s: f64, f: &dyn Fn(f64) -> f64| {
        steps.residual[i].iter().map(|x| share * s * f(x / s)).sum::<f64>()
    };
    let loss = |i: usize, s: f64| over(i, s, &|r| rule.outcome(r).mean_loss(2));
    let death = |i: usize, s: f64| over(i, s, &|r| rule.outcome(r).death);
    let mut behind = vec![0.0; STEPS + 1];
    for i in (0..STEPS).rev() {
        let d = death(i, best[i]);
        behind[i] = best[i] * steps.width * -(-d).exp_m1() / d + (-d).exp() * behind[i + 1];
    }
    let total: f64 = (0..STEPS).map(|i| loss(i, best[i])).sum();
    let (growth, price) = (1.0 / -(-total).exp_m1(), 1.0 / (2.0 + behind[0]));
    let mut alive = 1.0;
    for i in 0..STEPS {
        let hamiltonian = |s: f64| {
            let d = death(i, s);
            let lookups = s * steps.width * -(-d).exp_m1() / d + (-d).exp() * behind[i + 1];
            growth * loss(i, s) + price * alive * lookups
        };
        let here = hamiltonian(best[i]);
        for beside in [0.3, 0.6, 0.9, 1.1, 1.6, 3.0] {
            assert!(hamiltonian(best[i] * beside) >= here * (1.0 - 1e-9), "step {i}");
        }
        alive *= (-death(i, best[i])).exp();
    }
    // Even in a homogeneous medium it rises along the ray: collisions there are cheap.
    let level = Steps { residual: vec![vec![1.0; PLACES]; STEPS], ..steps };
    let best = level.best(Collisions::Single(rule), start).expect("a profile");
    assert!(best[STEPS - 1] > 1.2 * best[0], "{best:?}");
}

#[test]
fn rows_of_profiles_are_never_worse_and_agree_with_draws() {
    for costs in [Costs::Lookups, Costs::Given { draw: 1e-7, lookup: 1e-8 }] {
        let advice = asked(&format!("{SINES}{ANY}"), &request(costs));
        assert_eq!(advice.profiles.len(), 2);
        for profile in &advice.profiles {
            assert!(profile.over_constant >= 0.999, "{profile:?}");
            assert!(profile.over_local.is_none_or(|gain| gain > 0.95), "{profile:?}");
        }
        let of = advice.rows.iter().filter(|row| row.lines.contains("sampling.piecewise-constant"));
        for row in of {
            assert_eq!(row.group, Group::Informed);
            none(&failing(&rows(&format!("{SINES}{}", row.lines), 100_000)));
        }
    }
}
