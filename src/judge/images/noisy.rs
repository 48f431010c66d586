//! The evidence on a tile with an estimated variance, or with a truth that is a mean of passes.
//!
//! ```text
//! y     (x − T)/u for every pixel of every pass; where T is a mean of R passes: (x̄ − T)/u for every pixel
//! V     the mean of the pixels' V/u², times 1/N + 1/R for averages
//! E     `stats::estimated_variance`, and bets on a range where there is one
//! P±    the normal tail of (ε ∓ ȳ)/σ, σ from a V that the true one exceeds with chance β at most
//! ε     as asked; else (z_β + z) σ with z the normal quantile of 1 − 0.025/K: a correct picture passes in all of
//!       its K tiles with chance 0.95
//! ```
//!
//! The error of T is one number for all passes of a pixel: averages of pixels are independent then, values are not.

use super::claim::Pixels;
use super::estimate;
use super::judgement::Tile;
use super::picture::Stack;
use super::tiles::{self, AT_THE_END, Part, Terms, judged};
use crate::judge::{Quantity, Scalar};
use gate::session::quantity::MEAN_CAP;
use gate::stats::capital::ln_mean_exp;
use gate::stats::estimated_variance::{Estimate, Gathered};
use gate::stats::normal::{upper_quantile, upper_tail};
use gate::stats::verdict::MISS;

/// Evidence of the passes on a part; q as of `estimate`, 0 for an exact variance.
pub(super) fn tile(stack: &Stack, pixels: &Pixels, part: Part, terms: Terms, q: f64) -> Tile {
    let is_known = |i: &usize| pixels.estimate.as_ref().is_none_or(|found| !found.is_unknown[*i]);
    let places: Vec<usize> = part.places(stack).filter(is_known).collect();
    let count = places.len() as f64;
    let unit = pixels.units[part.channel];
    let mean_of = |of: &dyn Fn(usize) -> f64| places.iter().map(|&i| of(i)).sum::<f64>() / count;
    let n = stack.passes as f64;
    let average = |i: usize| (0..stack.passes).map(|pass| stack.pass(pass)[i]).sum::<f64>() / n;
    let averages: Vec<f64> = places.iter().map(|&i| average(i)).collect();
    let mean = averages.iter().sum::<f64>() / count;
    let truth = mean_of(&|i| pixels.truth[i]);
    let variance = pixels.variance.as_ref().map(|variance| mean_of(&|i| variance[i]));
    let share = 1.0 / n + pixels.truth_share;
    let standard_error = variance.map_or(f64::NAN, |v| (v * share / count).sqrt());
    let mut found = tiles::empty(part, [truth, mean, standard_error]);
    let is_free = terms.is_free || places.len() == 1;
    if places.is_empty() {
        return found;
    }
    if places.iter().all(|&i| pixels.is_certain(i)) {
        (found.tolerance, found.ln_p) = (Some(0.0), [f64::INFINITY; 2]);
        return found;
    }
    let floor = mean_of(&|i| pixels.floor(i)) / unit;
    let is_exact = pixels.truth_share == 0.0;
    let of_pass = |pass: usize| -> Vec<f64> {
        places.iter().map(|&i| (stack.pass(pass)[i] - pixels.truth[i]) / unit).collect()
    };
    let of_averages = || -> Vec<f64> {
        places.iter().zip(&averages).map(|(&i, x)| (x - pixels.truth[i]) / unit).collect()
    };
    // All y by blocks: a pass each, or the averages alone.
    let blocks = if is_exact { stack.passes } else { 1 };
    let block = |k: usize| if is_exact { of_pass(k) } else { of_averages() };
    let variance = variance.filter(|_| terms.has_variance && is_free);
    let mut ln_e = Vec::new();
    if let Some(variance) = variance {
        let scale = if is_exact { 1.0 } else { share } / (unit * unit);
        let estimate = match &pixels.estimate {
            Some(found) => estimate::of_tile(variance * scale, q, found.passes, count),
            None => Estimate { variance: variance * scale, error: 0.0 },
        };
        if variance > 0.0 {
            if estimate.error.is_finite() {
                let mut gathered = Gathered::new(estimate, blocks as f64 * count);
                (0..blocks).for_each(|k| gathered.absorb(&block(k)));
                ln_e.push(gathered.ln_e(floor));
            }
            by_normal(&mut found, estimate, (share / count) / (unit * unit) / scale, unit, terms);
        } else {
            let y: Vec<f64> = (0..blocks).flat_map(block).collect();
            ln_e.push(without_spread(&mut found, &y, floor, is_exact));
        }
    }
    let range = pixels.range.filter(|_| is_free);
    let y = range.map(|_| (0..blocks).flat_map(block).collect::<Vec<f64>>());
    let bets = y.and_then(|y| by_range(pixels, &places, &y, is_exact, terms, floor, unit));
    if let Some(bets) = bets {
        ln_e.push(bets.evidence.ln_e);
        let sides = bets.evidence.ln_pass;
        if let (None, Some(design)) = (found.tolerance, bets.design) {
            (found.tolerance, found.ln_p) = (Some(design.tolerance), sides);
        }
    }
    found.ln_e = if ln_e.is_empty() { 0.0 } else { ln_mean_exp(&ln_e) };
    found
}

/// P± and ε by the normal law; `scale` takes the variance of y to that of its mean.
fn by_normal(found: &mut Tile, estimate: Estimate, scale: f64, unit: f64, terms: Terms) {
    let Some(variance) = estimate.upper(MISS) else { return };
    let error = (variance * scale).sqrt();
    let z = upper_quantile(MISS) + upper_quantile(0.025 / terms.count.max(1) as f64);
    let cap = if terms.is_capped { MEAN_CAP } else { f64::INFINITY };
    let tolerance = terms.tolerance.unwrap_or((z * error).min(cap));
    let off = (found.mean - found.truth) / unit;
    found.tolerance = Some(tolerance);
    found.ln_p = [tolerance - off, tolerance + off].map(|room| -upper_tail(room / error).ln());
}

/// ln E where the estimated variance is 0: no value varied. Rare bright values that were not drawn make a tile too
/// dark, but not too bright.
fn without_spread(found: &mut Tile, y: &[f64], floor: f64, is_exact: bool) -> f64 {
    let slack = 4.0 * floor + 1e-15;
    if y.iter().all(|y| y.abs() <= slack) {
        (found.tolerance, found.ln_p) = (Some(slack), [f64::INFINITY; 2]);
        return 0.0;
    }
    let is_flat = y.iter().all(|x| *x > slack && (x - y[0]).abs() <= slack);
    if is_flat && is_exact { f64::INFINITY } else { 0.0 }
}

/// Bets on y in a range.
fn by_range(
    pixels: &Pixels,
    places: &[usize],
    y: &[f64],
    is_exact: bool,
    terms: Terms,
    floor: f64,
    unit: f64,
) -> Option<Scalar> {
    let [low, high] = pixels.widened()?;
    let range = if is_exact {
        let of = |x: f64, pick: fn(f64, f64) -> f64| {
            places.iter().map(|&i| pixels.truth[i]).fold(x, pick)
        };
        [low - of(f64::NEG_INFINITY, f64::max), high - of(f64::INFINITY, f64::min)]
    } else {
        [low - high, high - low]
    };
    if !range.iter().any(|end| end.is_finite()) {
        return None;
    }
    let range = Some(range.map(|end| end / unit));
    let mean = Quantity { range, ..terms.mean(None, floor) };
    let of_block = |first: usize, last: usize, to: &mut Vec<f64>| to.extend(&y[first..last]);
    Some(judged(mean, Some(terms.planned(y.len() as f64)), AT_THE_END, y.len(), of_block))
}
