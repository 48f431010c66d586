//! Slabs with a light behind them: moments in closed form, and one mean of all techniques.
//!
//! ```text
//! a beam along μ, found by shadow rays alone:   E[X^k] = a q^k ∫ σ e^{−σz} e^{−β(L − z)} dz,   q = p(μ)
//!     β = kσ/μ of exact transmittances, σ/μ of delta tracking, σ̂(1 − (1 − r)^k)/μ of ratio tracking
//! a cap, unidirectional:   X is 0 or 1
//! ```

use super::equations::power;
use super::fields::homogeneous;
use super::prelude::*;
use super::slabs::henyey_greenstein;
use theory::light::{Combination, Densities, Heuristic, Shadow, Techniques};
use theory::problems::LitSlab;
use theory::problems::lit_slab::LightBehind;
use theory::slab::lit;

/// All rows.
pub fn rows(run: Run) -> Vec<TrialRow> {
    let range = "a beam, 3 shadows, r = 0.1 … 1, τ = 1e-3 … 10, τ/μ < 60, |g| to 0.9";
    let mut of_beam = vec![TrialRow::stated("light behind a slab", range)];
    of_beam.extend(TrialRow::moments("draws of light behind a slab", range));
    let mut rows = run.fill([32, 1280], of_beam, Slab::any, beam);
    let range = "caps and discs, 2 shadows, 2 heuristics, directional and full, |g| to 0.9";
    let row = TrialRow::stated("mean of techniques behind a slab", range);
    rows.extend(run.fill([4, 256], [row], Slab::any, mean));
    rows
}

parameters! {
    /// A slab with a light behind it, and how it is found.
    Slab {
        depth: f64 = sized(-3.0, 1.0),
        albedo: f64 = between(0.05, 1.0),
        asymmetry: f64 = between(-0.9, 0.9),
        ratio: f64 = sized(-1.0, 0.0),
        shadow: Shadow = any_of(&[Shadow::Exact, Shadow::Delta, Shadow::Ratio]),
        heuristic: Heuristic = any_of(&[Heuristic::Balance, Heuristic::Power]),
        cosine: f64 = between(0.1, 1.0),
        is_disc: bool = proptest::bool::ANY,
        distance: f64 = sized(-1.0, 1.0),
    }
}

impl Slab {
    fn problem(&self, light: LightBehind) -> (Mesh, LitSlab, Piecewise) {
        let medium = homogeneous(self.depth, 1.0);
        let flown = Piecewise::constant(self.depth / self.ratio, medium.span());
        let phase = henyey_greenstein(self.asymmetry);
        let problem = LitSlab::new(medium.clone(), self.albedo, phase, light);
        (Mesh::new(medium), problem, flown)
    }
}

/// `E[X^k]` of shadow rays to a beam.
fn beam(slab: &Slab, seen: &mut Seen) {
    let cosine = slab.cosine.max(slab.depth / 60.0);
    let (mesh, problem, flown) = slab.problem(LightBehind::Distant(cosine));
    let techniques = Techniques { shadow: Some(slab.shadow), combination: Combination::NextEvent };
    let computed = lit::predict(&mesh, &problem, &flown, techniques, true);
    let (depth, null) = (DoubleDouble::from(slab.depth), 1.0 - DoubleDouble::from(slab.ratio));
    let towards = DoubleDouble::from(problem.phase.value(cosine));
    let raw = [1, 2, 3, 4].map(|k: usize| {
        let lost = match slab.shadow {
            Shadow::Exact => depth * k as f64,
            Shadow::Delta => depth,
            Shadow::Ratio => depth / slab.ratio * (1.0 - power(null, k)),
        };
        // (e^{−σL} − e^{−βL})/(β − σ)
        let more = lost / cosine - depth;
        let between = if more.high == 0.0 { DoubleDouble::ONE } else { -(-more).exp_m1() / more };
        power(towards, k) * slab.albedo * depth * (-depth).exp() * between
    });
    seen.stated(0, computed.channels[0].truth, raw[0]);
    seen.resolved([1, 2], computed.channels[0].moments, &raw);
}

/// Hits and shadow rays, weighted, have the mean of shadow rays alone.
fn mean(slab: &Slab, seen: &mut Seen) -> Option<()> {
    let light = if slab.is_disc {
        LightBehind::Disc { distance: slab.distance, radius: 0.5 }
    } else {
        LightBehind::Cap(slab.cosine.min(0.99))
    };
    let (mesh, problem, flown) = slab.problem(light);
    if lit::slant_depth(&mesh, &problem).is_some() {
        return None;
    }
    let truth = lit::truth(&mesh, &problem, &flown);
    for (shadow, densities) in [
        (slab.shadow, Densities::Directional),
        (Shadow::Ratio, Densities::Full),
        (Shadow::Exact, Densities::Full),
    ] {
        let combination = Combination::Mis(densities, slab.heuristic);
        let techniques = Techniques { shadow: Some(shadow), combination };
        seen.at(format_args!("{techniques:?}"));
        let mean = lit::mean(&mesh, &problem, &flown, techniques);
        seen.see(0, over((mean.value - truth.value).abs(), mean.error + truth.error));
    }
    Some(())
}
