//! Prediction from mixed moments: each channel, the luminance, and covariances of adjacent channels.

use std::cell::RefCell;
use std::collections::HashMap;

use super::Spectrum;
use crate::prediction::raw::RawMoments;
use crate::prediction::{Covariance, UNRESOLVED};
use crate::problems::channels::channel_name;
use crate::{Channel, Moments, Prediction, Tails};
use numeric::sum::Sum;
use numeric::{Jet, Known, Scalar};

/// Relative rounding error of a moment.
const ROUNDING: f64 = 1e-13;
/// Computed moments, by their powers.
type Cache = RefCell<HashMap<Vec<u8>, Option<f64>>>;

impl Spectrum {
    /// Prediction for draws that score every channel and, by these weights, the luminance.
    pub fn predict(&self, luminance: &[f64]) -> Prediction {
        let one = |channel: usize| {
            let mut form = vec![0.0; self.channels()];
            form[channel] = 1.0;
            form
        };
        let mut forms: Vec<Vec<f64>> = (0..self.channels()).map(one).collect();
        if !luminance.is_empty() {
            forms.push(luminance.to_vec());
        }
        let cache = RefCell::default();
        let expected = |factors: &[&Vec<f64>]| self.expected(factors, &cache);
        let channels: Vec<Channel> =
            forms.iter().enumerate().map(|(i, form)| self.channel(i, form, &expected)).collect();
        let covariance = |i: usize| {
            let (x, y) = (&forms[i], &forms[i + 1]);
            let [s, t] = [i, i + 1].map(|i| channels[i].truth.value);
            let xy = expected(&[x, y])?;
            let (xxy, xyy) = (expected(&[x, x, y])?, expected(&[x, y, y])?);
            let (xx, yy) = (expected(&[x, x])?, expected(&[y, y])?);
            let mixed = [xy, xxy, xyy, expected(&[x, x, y, y])?];
            let result = Covariance::of_raw([i, i + 1], [s, t], [xx, yy], mixed);
            Some(Covariance { variance: result.variance.max(0.0), ..result })
        };
        let covariances = (0..forms.len() - 1).filter_map(covariance).collect();
        let lookups = Some(self.lookups());
        Prediction { channels, lookups, covariances, ..Prediction::default() }
    }

    fn channel(
        &self,
        index: usize,
        form: &Vec<f64>,
        expected: &dyn Fn(&[&Vec<f64>]) -> Option<f64>,
    ) -> Channel {
        let truths: Vec<Known> = self.depths.iter().map(|depth| depth.exp_neg()).collect();
        let truth: Known = form.iter().zip(&truths).map(|(a, truth)| *truth * *a).sum();
        let value = truth.value;
        let relative_error = |k: f64| {
            let scored = (0..self.channels()).filter(|&channel| form[channel] != 0.0);
            let rounding = scored.map(|channel| self.rounding(channel, k)).fold(0.0, f64::max);
            let by_depth = self.mesh.relative_error() * self.most_collisions().max(1.0);
            ROUNDING + by_depth + rounding
        };
        let raw = |order: usize| {
            let moment = expected(&vec![form; order])?;
            let error = relative_error(if order == 2 { 2.0 } else { 4.0 });
            Some(Known::estimated(moment, error * moment.abs()))
        };
        // The truth by itself has another error than the moments in its units.
        let mean = Known::estimated(value, 0.0);
        let moments = raw(2).zip(raw(3)).zip(raw(4)).map(|((second, third), fourth)| {
            let raw = RawMoments([mean, second, third, fourth, Known::UNKNOWN]);
            if raw.is_certain(value) {
                Moments::certain(value)
            } else {
                raw.central(mean, UNRESOLVED).in_units_of(truth)
            }
        });
        let is_one = index < self.channels();
        let tails = match moments {
            Some(_) if is_one => self.tails(index),
            Some(_) => (0..self.channels()).map(|channel| self.tails(channel)).fold(
                Tails::LIGHT,
                |a, b| Tails {
                    rare_event_size: a.rare_event_size.max(b.rare_event_size),
                    eighth_moment_ratio: a.eighth_moment_ratio.max(b.eighth_moment_ratio),
                },
            ),
            None => Tails::LIGHT,
        };
        let name =
            if is_one { channel_name(index, self.channels()) } else { "luminance".to_owned() };
        if moments.is_none() {
            return Channel {
                name,
                ..Channel::bounded(truth, self.most_score(form) * (value + truth.error))
            };
        }
        Channel { name, ..Channel::unbiased(truth, moments, tails) }
    }

    /// Maximum of a linear form of a draw of MIS, `max a_λ/w_λ`: a survivor scores `Σ_λ a_λ p_λ/Σ_h w_h p_h`,
    /// others nothing, so that `E[Y²] ≤ E[Y] max a_λ/w_λ`.
    fn most_score(&self, form: &[f64]) -> f64 {
        form.iter().zip(&self.hero).map(|(a, w)| a / w).fold(0.0, f64::max)
    }

    fn most_collisions(&self) -> f64 {
        self.majorants.iter().fold(0.0f64, |maximum, &x| maximum.max(x)) * self.length()
    }

    /// `E[Π (a·X)]` over linear forms of the channels.
    fn expected(&self, factors: &[&Vec<f64>], cache: &Cache) -> Option<f64> {
        let mut sum = Sum::default();
        let mut powers = vec![0u8; self.channels()];
        self.expand(factors, 1.0, &mut powers, cache, &mut sum)?;
        Some(sum.value())
    }

    fn expand(
        &self,
        factors: &[&Vec<f64>],
        weight: f64,
        powers: &mut Vec<u8>,
        cache: &Cache,
        sum: &mut Sum,
    ) -> Option<()> {
        let Some((first, rest)) = factors.split_first() else {
            let known = cache.borrow().get(powers).copied();
            let moment = known.unwrap_or_else(|| {
                let k: Vec<f64> = powers.iter().map(|&k| f64::from(k)).collect();
                let moment = self.moment(&k);
                cache.borrow_mut().insert(powers.clone(), moment);
                moment
            });
            sum.add(weight * moment?);
            return Some(());
        };
        for (channel, &a) in first.iter().enumerate().filter(|(_, a)| **a != 0.0) {
            powers[channel] += 1;
            self.expand(rest, weight * a, powers, cache, sum)?;
            powers[channel] -= 1;
        }
        Some(())
    }

    /// With `φ(s) = ln E[|X|^s]`: `D = 2φ′(2) − φ(2)` is the relative entropy of the draws that carry `E[X²]`.
    fn tails(&self, channel: usize) -> Tails {
        // φ and its derivative, as a power series.
        let of = |s: f64, slope: f64| {
            let mut k = vec![Jet::from(0.0); self.channels()];
            k[channel] = Jet([s, slope]);
            self.moment(&k).map_or([f64::NAN; 2], |moment| moment.ln().0)
        };
        let [[eighth, _], [fourth, _], [second, slope]] =
            [of(8.0, 0.0), of(4.0, 0.0), of(2.0, 1.0)];
        Tails {
            rare_event_size: (2.0 * slope - second).max(0.0).exp(),
            eighth_moment_ratio: (eighth - 2.0 * fourth).exp(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Mesh;
    use crate::ray::spectral::Tracker;
    use media::Medium;
    use media::constant::Constant;
    use numeric::Span;
    use std::sync::Arc;

    /// A thin hero walks for a thick channel: the second moment is e^584, an exponent with few digits left after
    /// the point.
    #[test]
    fn large_exponents_are_part_of_the_error() {
        let span = Span::new(0.0, 1.0);
        let (depths, above, shares) = ([0.0003, 0.0734], [0.153, 2.2329], [0.3, 1.0]);
        let meshes = depths.map(|extinction| {
            Mesh::new(Medium::new(Arc::new(Constant { extinction }), span, span))
        });
        let majorants = (0..2).map(|i| depths[i] * (1.0 + above[i])).collect();
        let heroes = shares.map(|share| share / 1.3).to_vec();
        let meshes: Vec<&Mesh> = meshes.iter().collect();
        let spectrum = Spectrum::new(&meshes, majorants, heroes, Tracker::Hero { delta: true });
        let moments = spectrum.predict(&[]).channels[1].moments.expect("known");
        // In 60 digits, of the same doubles.
        let off = (moments.relative[0] / 2.388_350_829_586_169_4e253 - 1.0).abs();
        assert!(off <= moments.error && moments.error < 1e-11, "{off:e}, {:e}", moments.error);
    }
}
