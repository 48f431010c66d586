//! Prediction for slabs in which every channel has a medium of its own, with draws that score all of them.
//!
//! ```text
//! R_λ and T_λ    those of the slab of the channel λ, by adding and doubling
//! independent    E[X_λ^k] = w_λ^{1−k} R_λ, or T_λ;  E[X_λ X_μ] = 0: a walk leaves once, and is of one channel
//! balanced       0 ≤ X_λ ≤ 1/w_λ, so that E[X_λ²] ≤ R_λ/w_λ, or T_λ/w_λ
//! relative to the density of one walker    E[X_λ²] bounded as in [`bound`]
//! ```
//!
//! Lookups are those of the heroes' walks, mixed by their probabilities.
//!
//! Source: derived from B. Miller, I. Georgiev, W. Jarosz, *A Null-Scattering Path Integral Formulation of Light
//! Transport*, ACM Transactions on Graphics 38 (2019), section 5.1.

use super::{Pieces, Walk};
use crate::colours::bound::{self, Flight, SecondMomentRates};
use crate::colours::rates::{Proposal, Rates};
use crate::colours::{self};
use crate::prediction::raw::{POWERS, RESOLVED, RawMoments};
use crate::problems::ChromaticSlab;
use crate::problems::channels::End;
use crate::problems::slab::Light;
use crate::{Channel, CountDistribution, Mesh, ParticleRule, Prediction, slab};
use media::Piecewise;
use numeric::{Known, exponential_integrals};

/// A slab, with the mesh and σ̂ of each channel.
pub struct Spectrum<'a> {
    problem: &'a ChromaticSlab,
    media: Vec<(&'a Mesh, &'a Piecewise)>,
    laws: bool,
}

impl<'a> Spectrum<'a> {
    /// Joins the parts, mesh and σ̂ of each channel; without `laws` lookups have a mean only.
    pub fn new(
        problem: &'a ChromaticSlab,
        media: Vec<(&'a Mesh, &'a Piecewise)>,
        laws: bool,
    ) -> Self {
        Self { problem, media, laws }
    }

    /// First channel with an answer that is not known well enough for a comparison with draws.
    pub fn blurred(&self) -> Option<usize> {
        let is_sharp = |&(end, channel): &(End, usize)| {
            let is_resolved = slab::resolves(&self.problem.incidences[channel].phase);
            is_resolved && slab::is_sharp(self.truth(end, channel))
        };
        self.problem.colours.seen.iter().find(|seen| !is_sharp(seen)).map(|seen| seen.1)
    }

    /// Energy that leaves a channel's slab at an end; NaN where it is unknown.
    fn truth(&self, end: End, channel: usize) -> Known {
        let (incidence, depth) =
            (&self.problem.incidences[channel], self.media[channel].0.optical_depth());
        let answer = slab::cached(incidence, depth, self.problem.colours.albedos[channel]);
        answer.map_or(Known::estimated(f64::NAN, f64::INFINITY), |answer| match end {
            End::Reflected => answer.reflected,
            End::Transmitted => answer.transmitted,
        })
    }

    /// Prediction for one channel a draw, given the probability of each.
    pub fn independent(&self, heroes: &[f64]) -> Prediction {
        let mut moments = Vec::new();
        let channels = self.channels(|truth, channel| {
            let raw = colours::independent(&RawMoments(POWERS.map(|_| truth)), heroes[channel]);
            moments.push([truth.value, raw.second().value]);
            raw.channel(truth, RESOLVED)
        });
        let covariances = colours::exclusive(&moments);
        Prediction { channels, covariances, lookups: self.lookups(heroes), ..Prediction::default() }
    }

    /// Prediction for all channels by the balance heuristic, given the probability of each hero.
    pub fn balanced(&self, heroes: &[f64]) -> Prediction {
        if heroes.len() == 1 {
            return self.independent(heroes);
        }
        let channels = self.channels(|truth, channel| colours::bounded(truth, heroes[channel]));
        Prediction { channels, lookups: self.lookups(heroes), ..Prediction::default() }
    }

    /// Prediction for all channels relative to the density of one walker, given bounds on `E[X²]`; lookups are
    /// known for heroes.
    pub fn relative(&self, heroes: Option<&[f64]>, second_moment_bounds: &[f64]) -> Prediction {
        let channels =
            self.channels(|truth, channel| Channel::bounded(truth, second_moment_bounds[channel]));
        let lookups = heroes.and_then(|heroes| self.lookups(heroes));
        Prediction { channels, lookups, ..Prediction::default() }
    }

    /// Bound on `E[X²]` of a channel where draws are relative to the density of a walker, Φ given.
    ///
    /// # Errors
    ///
    /// The factor of the second moment between two scatterings, where it is too large.
    pub fn second_moment_bound(
        &self,
        walk: Proposal,
        channel: usize,
        phi: f64,
    ) -> Result<f64, f64> {
        let problem = self.problem;
        let majorants =
            self.media.iter().map(|(_, sampling)| sampling.single_value().unwrap_or_default());
        let rates =
            Rates { majorants: majorants.collect(), albedos: problem.colours.albedos.clone() };
        let at = |t: f64| {
            let here: Vec<f64> =
                self.media.iter().map(|(mesh, _)| mesh.medium().extinction(t)).collect();
            bound::square(&rates, walk, channel, &here, phi)
        };
        let ends =
            self.media.iter().flat_map(|(mesh, _)| mesh.panels().map(|panel| panel.span.from));
        let mesh = self.media[0].0.cut(&ends.collect::<Vec<f64>>());
        let nothing = bound::NOTHING * rates.majorants[0];
        // Where there are no collisions nothing is lost or gained.
        let is_empty = |s: &SecondMomentRates| s.scattered == 0.0 && s.lost.abs() <= nothing;
        let of = |f: &dyn Fn(SecondMomentRates) -> f64| {
            let peaks = mesh.peaks(|t| Some(at(t)).filter(|s| !is_empty(s)).map_or(0.0, f));
            peaks.into_iter().map(|(_, value)| value).fold(0.0, f64::max)
        };
        let gained = of(&|s| -s.lost);
        let [largest, share] = [of(&|s| s.lost), of(&|s| s.scattered / s.lost)];
        if gained > 0.0 || !share.is_finite() {
            return Err(f64::INFINITY);
        }
        let deep = largest * mesh.support().length();
        let flight = |leaves: f64| Flight { leaves, collides: 1.0 - leaves };
        let first = match problem.incidences[0].light {
            Light::Collimated(cosine) => flight((-deep / cosine).exp()),
            Light::Diffuse => flight(0.0),
        };
        // The mean of e^{−x/|μ|} over all directions is smallest in the middle.
        let is_isotropic = bound::are_isotropic(&problem.phases());
        let then = flight(if is_isotropic { exponential_integrals(0.5 * deep)[1] } else { 0.0 });
        bound::largest(first, then, [share, 0.0]).ok_or(share * then.collides)
    }

    /// All channels that are seen, each made from its expected value and its channel number.
    fn channels(&self, mut of: impl FnMut(Known, usize) -> Channel) -> Vec<Channel> {
        let seen = self.problem.colours.seen.iter();
        let channel = |&(end, channel): &(End, usize)| Channel {
            name: end.name(channel),
            ..of(self.truth(end, channel), channel)
        };
        seen.map(channel).collect()
    }

    fn lookups(&self, heroes: &[f64]) -> Option<CountDistribution> {
        let rule = ParticleRule::Analog;
        let walk = |(channel, &weight): (usize, &f64)| {
            let ((mesh, sampling), incidence) =
                (self.media[channel], self.problem.incidences[channel]);
            let albedo = self.problem.colours.albedos[channel];
            let pieces = Pieces::new(mesh, sampling, &rule.kinks(albedo), &[incidence.light]);
            let (depth, laws) = (mesh.optical_depth().value, self.laws);
            let walk = Walk { incidence, albedo, rule, pieces, largest_ratio: 1.0, depth, laws };
            Some((weight, walk.lookups(&[incidence.light])?[0]))
        };
        let lookups = heroes.iter().enumerate().map(walk).collect::<Option<Vec<_>>>()?;
        colours::mixed(lookups).map(CountDistribution::of_factorial)
    }
}
