//! Evidence of two stacks on a tile.
//!
//! ```text
//! rows      the averages of a tile in every pass, of both stacks
//! y         (x̄ − ȳ)/u of every pixel;  u the mean |ȳ| of the picture in that channel
//! V         the mean of s_x²/N + s_y²/M over the pixels;   r the larger of both stacks'
//! signs     d = x_k − y_k of pass k of both stacks, in every pixel
//! P±, ε     as in `noisy`; where pixels depend on each other, by Student's t distribution of the averages of passes,
//!           with the degrees of freedom of the smaller stack
//! ```

use statrs::distribution::{ContinuousCDF, StudentsT};

use super::super::judgement::Tile;
use super::super::noisy::slack;
use super::super::picture::Stack;
use super::super::tiles::{Part, mean_at};
use super::super::{ImageError, ImageOptions, variance};
use gate::stats::estimated_variance::Estimate;
use gate::stats::normal::{p_value_of_symmetric, upper_quantile, upper_tail};
use gate::stats::verdict::MISS;
use theory::parallel;

/// Sums over the passes of both stacks, for every value.
pub(super) struct PassSums<'a> {
    stacks: [&'a Stack; 2],
    required: &'a ImageOptions,
    is_free: bool,
    rounding: f64,
    units: Vec<f64>,
    means: [Vec<f64>; 2],
    variances: [Vec<f64>; 2],
    /// Mean and variance of all passes together: the order of the passes does not matter.
    together: [Vec<f64>; 2],
}

impl<'a> PassSums<'a> {
    /// Adds up the passes; the tolerance is relative to the reference.
    pub(super) fn new(
        stack: &'a Stack,
        reference: &'a Stack,
        rounding: f64,
        required: &'a ImageOptions,
        is_free: bool,
    ) -> Result<Self, ImageError> {
        let size = stack.size;
        let mut units = vec![0.0; size.channels];
        let of =
            |stack: &Stack| -> Vec<f64> { (0..size.values()).map(|i| stack.mean(i)).collect() };
        let means = [stack, reference].map(of);
        // A dark reference may have missed rare values: then the other stack gives the scale.
        for means in means.iter().rev() {
            if units.iter().all(|&unit| unit == 0.0) {
                for pixel in means.chunks_exact(size.channels) {
                    units
                        .iter_mut()
                        .zip(pixel)
                        .for_each(|(unit, x)| *unit += x.abs() / size.pixels() as f64);
                }
            }
        }
        if units.iter().all(|&unit| unit == 0.0) && required.tolerance.is_none() {
            return Err(ImageError::NoUnit);
        }
        units.iter_mut().filter(|unit| **unit == 0.0).for_each(|unit| *unit = 1.0);
        let rounding = rounding.max(stack.rounding).max(reference.rounding);
        let variances =
            [variance::variances(stack)?.values, variance::variances(reference)?.values];
        let [n, m] = [stack.passes as f64, reference.passes as f64];
        let all = |i: usize| (n * means[0][i] + m * means[1][i]) / (n + m);
        let square = |i: usize| {
            let apart = means[0][i] - means[1][i];
            let within = (n - 1.0) * variances[0][i] + (m - 1.0) * variances[1][i];
            (within + n * m / (n + m) * apart * apart) / (n + m - 1.0)
        };
        let values = 0..size.values();
        let together = [values.clone().map(all).collect(), values.map(square).collect()];
        let stacks = [stack, reference];
        Ok(Self { stacks, required, is_free, rounding, units, means, variances, together })
    }

    fn passes(&self) -> [f64; 2] {
        self.stacks.map(|stack| stack.passes as f64)
    }

    fn averages(&self, places: &[usize]) -> Vec<f64> {
        let of = |stack: &'a Stack| (0..stack.passes).map(move |pass| stack.pass(pass));
        let passes = of(self.stacks[0]).chain(of(self.stacks[1]));
        passes.map(|x| mean_at(places, |i| x[i])).collect()
    }

    /// Returns the averages of every part in every pass, pass after pass, and the prior variance of each part.
    pub(super) fn rows(&self, parts: &[Part]) -> (Vec<f64>, Vec<f64>) {
        let columns = parallel::map(parts, |part| {
            let places: Vec<usize> = part.places(self.stacks[0]).collect();
            let variance: f64 = places.iter().map(|&i| self.together[1][i]).sum();
            (self.averages(&places), variance / (places.len() as f64).powi(2))
        });
        let passes = self.stacks[0].passes + self.stacks[1].passes;
        let values = (0..passes).flat_map(|pass| columns.iter().map(move |(x, _)| x[pass]));
        (values.collect(), columns.iter().map(|(_, prior)| *prior).collect())
    }

    /// Returns the sum of squares of each pass about the mean of all passes, in units of the variance, and its prior
    /// variance.
    pub(super) fn spreads(&self) -> (Vec<f64>, f64) {
        let [mean, variance] = &self.together;
        let of = |x: &[f64]| {
            let terms = x.iter().zip(mean).zip(variance).filter(|(_, v)| **v > 0.0);
            terms.map(|((x, mean), v)| (x - mean).powi(2) / v).sum::<f64>()
        };
        let passes = |stack: &'a Stack| (0..stack.passes).map(move |pass| stack.pass(pass));
        let values: Vec<f64> = self.stacks.into_iter().flat_map(passes).map(of).collect();
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let prior = values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0);
        (values, prior)
    }

    /// Returns the variance of the first stack over that of the second, over all values.
    pub(super) fn spread(&self) -> Option<f64> {
        let [one, other] = self.variances.each_ref().map(|v| v.iter().sum::<f64>());
        Some(one / other).filter(|ratio| ratio.is_finite() && *ratio > 0.0)
    }

    /// Returns all tiles; the first `count` are tiles, the others the whole. `p` has their p-values for equal
    /// distributions; without it they come from signs.
    pub(super) fn tiles(&self, parts: &[Part], count: usize, p: Option<&[f64]>) -> Vec<Tile> {
        let q = self.stacks.map(|stack| variance::all_q(&[stack], parts, None));
        parallel::range(parts.len(), |i| {
            let is_whole = i >= count;
            let number = if is_whole { 1 } else { count };
            let mut tile = self.tile(parts[i], [q[0][i], q[1][i]], number, is_whole);
            tile.p = match p {
                Some(p) => Some(p[i]),
                None => self.by_signs(parts[i]),
            };
            tile
        })
    }

    /// Returns the p-value by the signs of differences; `None` if pixels depend on each other.
    fn by_signs(&self, part: Part) -> Option<f64> {
        if !self.is_free && part.height * part.width > 1 {
            return None;
        }
        let [one, other] = self.stacks;
        let (mut sum, mut squares) = (0.0, 0.0);
        for pass in 0..one.passes.min(other.passes) {
            let (x, y) = (one.pass(pass), other.pass(pass));
            for i in part.places(one) {
                let d = x[i] - y[i];
                sum += d;
                squares += d * d;
            }
        }
        Some(p_value_of_symmetric(sum, squares))
    }

    fn tile(&self, part: Part, q: [f64; 2], count: usize, is_whole: bool) -> Tile {
        let places: Vec<usize> = part.places(self.stacks[0]).collect();
        let pixels = places.len() as f64;
        let unit = self.units[part.channel];
        let mean_of = |x: &[f64]| mean_at(&places, |i| x[i]);
        let [mean, truth] = self.means.each_ref().map(|x| mean_of(x));
        let passes = self.passes();
        let [first, second] = [0, 1].map(|k| mean_of(&self.variances[k]) / passes[k]);
        let is_free = self.is_free || places.len() == 1;
        let variance = first + second;
        let error = if is_free { (variance / pixels).sqrt() } else { self.welch(&places) };
        let mut finding = Tile::new(part, [truth, mean, error]);
        let y: Vec<f64> =
            places.iter().map(|&i| (self.means[0][i] - self.means[1][i]) / unit).collect();
        let floor = self.rounding * truth.abs() / unit;
        if variance == 0.0 {
            let slack = slack(floor);
            let is_same = y.iter().all(|y| y.abs() <= slack);
            return if is_same { finding.without_doubt(slack) } else { finding };
        }
        // Error of either variance: a stack that missed rare values underestimates its own.
        let pairs = self.stacks.map(|stack| (stack.passes / 2) as f64 * pixels);
        let relative = (q[0] / pairs[0]).max(q[1] / pairs[1]);
        let estimate = Estimate { variance: variance / (unit * unit), error: relative };
        if is_free && relative.is_finite() {
            finding.ln_e = estimate.ln_e(&y, floor);
        }
        let tail = 0.025 / count.max(1) as f64;
        let degrees = passes[0].min(passes[1]) - 1.0;
        let student = StudentsT::new(0.0, 1.0, degrees).ok();
        let (bound, quantiles) = match (is_free, &student) {
            (true, _) => {
                let upper = estimate.upper(MISS).map(|v| (v / pixels).sqrt());
                (upper, upper_quantile(MISS) + upper_quantile(tail))
            }
            (false, Some(density)) => {
                let quantile = |tail: f64| -density.inverse_cdf(tail);
                (Some(error / unit), quantile(MISS) + quantile(tail))
            }
            (false, None) => (None, 0.0),
        };
        if let Some(error) = bound.filter(|error| *error > 0.0) {
            let tail = |z: f64| match (&student, is_free) {
                (Some(density), false) => density.cdf(-z),
                _ => upper_tail(z),
            };
            finding.promise(self.required.tolerance, is_whole, quantiles, [error, unit], tail);
            finding.plan_by_error(self.stacks[0].passes, [first, second], quantiles * error);
        }
        finding
    }

    /// Returns the standard error of x̄ − ȳ of averages of whole passes.
    fn welch(&self, places: &[usize]) -> f64 {
        let averages = self.averages(places);
        let (one, other) = averages.split_at(self.stacks[0].passes);
        let of = |x: &[f64]| {
            let n = x.len() as f64;
            let mean = x.iter().sum::<f64>() / n;
            x.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0) / n
        };
        (of(one) + of(other)).sqrt()
    }
}
