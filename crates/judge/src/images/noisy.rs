//! Evidence on a tile with an estimated variance, or with a truth that is a mean of passes.
//!
//! ```text
//! y     (x − T)/u for every pixel of every pass; where T is a mean of R passes: (x̄ − T)/u for every pixel
//! V     the mean of the pixels' V/u², times 1/N + 1/R for averages
//! E     `stats::estimated_variance`, and bets on a range where there is one
//! P±    the normal tail of (ε ∓ ȳ)/σ, σ from a V that the true one exceeds with probability β at most
//! ε     as asked; else (z_β + z) σ with z the normal quantile of 1 − 0.025/K: a correct picture passes in all of
//!       its K tiles with probability 0.95
//! ```
//!
//! The error of T is the same in all passes of a pixel: averages of pixels are then independent, values are not.

use super::claim::Pixels;
use super::judgement::Tile;
use super::picture::Stack;
use super::tiles::{Part, Terms, mean_at};
use super::variance;
use crate::{AT_THE_END, Quantity, Scalar};
use gate::stats::capital::ln_mean_exp;
use gate::stats::estimated_variance::{Estimate, Gathered};
use gate::stats::normal::{upper_quantile, upper_tail};
use gate::stats::verdict::MISS;

/// Returns the evidence of the passes on a part; q as in `variance`, 0 for an exact variance.
pub(super) fn tile(stack: &Stack, pixels: &Pixels, part: Part, terms: Terms, q: f64) -> Tile {
    let places: Vec<usize> = part.places(stack).filter(|&i| pixels.is_known(i)).collect();
    let count = places.len() as f64;
    let unit = pixels.units[part.channel];
    let n = stack.passes as f64;
    let averages: Vec<f64> = places.iter().map(|&i| stack.mean(i)).collect();
    let mean = averages.iter().sum::<f64>() / count;
    let truth = mean_at(&places, |i| pixels.truth[i]);
    let variance = pixels.variance.as_ref().map(|variance| mean_at(&places, |i| variance[i]));
    let share = 1.0 / n + pixels.truth_share;
    let standard_error = variance.map_or(f64::NAN, |v| (v * share / count).sqrt());
    let mut finding = Tile::new(part, [truth, mean, standard_error]);
    let is_free = terms.is_free || places.len() == 1;
    if places.is_empty() {
        return finding;
    }
    if places.iter().all(|&i| pixels.is_certain(i)) {
        return finding.without_doubt(0.0);
    }
    let floor = mean_at(&places, |i| pixels.floor(i)) / unit;
    let is_exact = pixels.truth_share == 0.0;
    // Blocks of y: one per pass, or one of the averages.
    let blocks = if is_exact { stack.passes } else { 1 };
    let block = |pass: usize| -> Vec<f64> {
        if is_exact {
            places.iter().map(|&i| (stack.pass(pass)[i] - pixels.truth[i]) / unit).collect()
        } else {
            places.iter().zip(&averages).map(|(&i, x)| (x - pixels.truth[i]) / unit).collect()
        }
    };
    let all = || -> Vec<f64> { (0..blocks).flat_map(block).collect() };
    let mut ln_e = Vec::new();
    if let Some(variance) = variance.filter(|_| terms.has_variance && is_free) {
        let scale = if is_exact { 1.0 } else { share } / (unit * unit);
        let estimate = match &pixels.estimate {
            Some(finding) => variance::of_tile(variance * scale, q, finding.passes, count),
            None => Estimate { variance: variance * scale, error: 0.0 },
        };
        if variance > 0.0 {
            if estimate.error.is_finite() {
                let mut gathered = Gathered::new(estimate, blocks as f64 * count);
                (0..blocks).for_each(|k| gathered.absorb(&block(k)));
                ln_e.push(gathered.ln_e(floor));
            }
            if let Some(upper) = estimate.upper(MISS) {
                let error = (upper * ((share / count) / (unit * unit) / scale)).sqrt();
                let z = upper_quantile(MISS) + upper_quantile(0.025 / terms.count.max(1) as f64);
                finding.promise(terms.tolerance, terms.is_capped, z, [error, unit], upper_tail);
                finding.plan_by_error(stack.passes, [1.0 / n, pixels.truth_share], z * error);
            }
        } else {
            let y = all();
            let slack = slack(floor);
            if y.iter().all(|y| y.abs() <= slack) {
                finding = finding.without_doubt(slack);
            }
            // Rare bright values that were not drawn make a tile too dark, but not too bright.
            let is_flat = y.iter().all(|x| *x > slack && (x - y[0]).abs() <= slack);
            ln_e.push(if is_flat && is_exact { f64::INFINITY } else { 0.0 });
        }
    }
    let range = if is_exact {
        pixels.range_about(&pixels.truths(&places), unit)
    } else {
        pixels.span(unit)
    };
    let is_bounded = |range: &[f64; 2]| is_free && range.iter().any(|end| end.is_finite());
    if let Some(range) = range.filter(is_bounded) {
        let mean = Quantity { range: Some(range), ..terms.mean(None, floor) };
        let (y, planned) = (all(), terms.planned(blocks as f64 * count));
        let of_block = |first: usize, last: usize, to: &mut Vec<f64>| to.extend(&y[first..last]);
        let bets = Scalar::of_all(mean, Some(planned), AT_THE_END, y.len(), of_block);
        ln_e.push(bets.evidence.ln_e);
        if let (None, Some(design)) = (finding.tolerance, bets.design) {
            (finding.tolerance, finding.ln_p) = (Some(design.tolerance), bets.evidence.ln_pass);
            finding.plan(stack.passes, [1.0 / n, pixels.truth_share], planned / design.draws());
        }
    }
    finding.ln_e = if ln_e.is_empty() { 0.0 } else { ln_mean_exp(&ln_e) };
    finding
}

/// Returns the largest |y| that counts as 0 if no value varied.
pub(super) fn slack(floor: f64) -> f64 {
    4.0 * floor + 1e-15
}
