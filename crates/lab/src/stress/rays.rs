//! Rays of single scattering by nodes, through homogeneous media and through fields.
//!
//! Theory bisects panels of the stretched variable `arsinh((s − foot)/D)`. This oracle is independent of that: its
//! panels of s grow away from the light and from both ends of the ray.

use std::array::from_fn;

use super::equations::power;
use super::prelude::*;
use super::techniques::{Estimator, Ray, RayPlace};
use theory::problems::{Problem, SingleScattering};
use theory::single::Tracking;

/// Smallest number of panels of s in a field.
const STEPS: u32 = 40;

/// Returns a ray through a homogeneous medium, for moments up to a power.
pub(super) fn even<'a>(estimator: &'a Estimator, sigma: f64, highest: u8) -> Ray<'a> {
    let problem = estimator.problem;
    let (distance, foot) = (DoubleDouble::from(problem.distance()), problem.foot());
    let albedo =
        DoubleDouble::from(problem.albedo()) / (DoubleDouble::PI * DoubleDouble::PI).scaled(4);
    let losses = losses(sigma, estimator.tracking);
    let extinction = DoubleDouble::from(sigma);
    let place = |s: DoubleDouble| {
        let square = distance * distance + (s - foot).powi(2);
        let r = square.sqrt();
        let cast = match estimator.tracking {
            Tracking::Exact => DoubleDouble::default(),
            Tracking::Ratio { sampling, .. } => sampling * r,
            Tracking::Delta { sampling } => sampling * -(-(sigma * r)).exp_m1() / sigma,
        };
        let shadow = losses.map(|loss| (-(loss * r)).exp());
        let scattered = albedo * extinction / square;
        RayPlace { extinction, scattered, shadow, cast: Some(cast) }
    };
    let [sampling, control] = estimator.walk;
    let weight = 1.0 - (sigma - control) / sampling;
    let rate = |k: u8| {
        let left = weight.abs().powi(k.into());
        let left = (1.0 - left).abs().max(if weight < 0.0 { 1.0 + left } else { 0.0 });
        f64::from(k) * control.max(sigma) + sampling * left
    };
    // Points by depth thin out, too.
    let along = (1..=highest).map(rate).fold(0.0, f64::max)
        + sampling.min(30.0 / problem.medium().support().length());
    let aside =
        losses[..=usize::from(highest)].iter().map(|loss| loss.high.abs()).fold(0.0, f64::max);
    Ray::new(estimator, &panels(problem, 1), along + aside, &place)
}

/// Returns the rate, 1/length, at which the k-th moment of a shadow ray's transmittance decays, k = 0 … 4.
fn losses(sigma: f64, tracking: Tracking) -> [DoubleDouble; 5] {
    from_fn(|k| match tracking {
        Tracking::Exact => DoubleDouble::from(sigma) * k as f64,
        Tracking::Ratio { sampling, control } => {
            let weight = 1.0 - (DoubleDouble::from(sigma) - control) / sampling;
            k as f64 * DoubleDouble::from(control) + sampling * (1.0 - power(weight, k))
        }
        Tracking::Delta { .. } => DoubleDouble::from(if k == 0 { 0.0 } else { sigma }),
    })
}

/// Returns a ray through a field.
pub(super) fn varying<'a>(estimator: &'a Estimator) -> Ray<'a> {
    let (problem, rule) = (estimator.problem, GaussLegendre::new(16));
    let place = |s: DoubleDouble| {
        let s = s.value();
        let extinction = DoubleDouble::from(problem.medium().extinction(s));
        let medium = problem.shadow_medium(s);
        let shadow = medium.map_or([1.0; 5], |medium| shadow(&medium, estimator.tracking, &rule));
        let scattered = extinction * problem.source(s);
        RayPlace { extinction, scattered, shadow: shadow.map(DoubleDouble::from), cast: None }
    };
    Ray::new(estimator, &panels(problem, STEPS), 0.0, &place)
}

/// Returns the k-th moment of a shadow ray's transmittance, k = 0 … 4.
fn shadow(medium: &Medium, tracking: Tracking, rule: &GaussLegendre) -> [f64; 5] {
    let support = medium.support();
    let depth = medium.optical_depth(support).value;
    let mut ends = medium.breaks();
    ends.retain(|&t| support.contains_inside(t));
    ends.extend([support.from, support.middle(), support.to]);
    ends.sort_by(f64::total_cmp);
    let lost = |sampling: f64, k: i32| -> f64 {
        let rate = |t: f64| sampling * (1.0 - (1.0 - medium.extinction(t) / sampling).powi(k));
        ends.windows(2).map(|ends| rule.integrate(ends[0], ends[1], rate)).sum()
    };
    [0, 1, 2, 3, 4].map(|k| match tracking {
        _ if k == 0 => 1.0,
        Tracking::Ratio { sampling, .. } if k > 1 => (-lost(sampling, k)).exp(),
        Tracking::Exact => (-f64::from(k) * depth).exp(),
        _ => (-depth).exp(),
    })
}

/// Returns the ends of panels of s: `steps` equal ones, cut further towards the light's foot and both ends.
fn panels(problem: &SingleScattering, steps: u32) -> Vec<f64> {
    let (support, foot) = (problem.medium().support(), problem.foot());
    let mut ends = problem.medium().breaks();
    let step = support.length() / f64::from(steps);
    ends.extend((0..=steps).map(|i| support.from + step * f64::from(i)));
    let mut away = 0.25 * problem.distance();
    while away < support.length() {
        ends.extend([foot - away, foot + away]);
        away *= 1.5;
    }
    // A light just outside sees the ends of the support at a glance: roots of the distance from them.
    let mut near = step;
    while near > 1e-13 * support.length() {
        near *= 0.5;
        ends.extend([support.from + near, support.to - near]);
    }
    ends.push(foot);
    ends.retain(|&s| support.contains_inside(s));
    ends.extend([support.from, support.to]);
    ends.sort_by(f64::total_cmp);
    ends.dedup();
    ends
}
