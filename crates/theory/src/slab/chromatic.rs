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
use numeric::{Known, Span, exponential_integrals};

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
        let [largest, share] = self.largest_rates(walk, channel, phi);
        if !share.is_finite() {
            return Err(f64::INFINITY);
        }
        let deep = largest * self.media[0].0.support().length();
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

    /// Upper bounds of α and of S Φ/α over the slab; the second is infinite where the second moment grows without
    /// limit.
    fn largest_rates(&self, walk: Proposal, channel: usize, phi: f64) -> [f64; 2] {
        let majorants =
            self.media.iter().map(|(_, sampling)| sampling.single_value().unwrap_or_default());
        let rates =
            Rates { majorants: majorants.collect(), albedos: self.problem.colours.albedos.clone() };
        let ends =
            self.media.iter().flat_map(|(mesh, _)| mesh.panels().map(|panel| panel.span.from));
        let mesh = self.media[0].0.cut(&ends.collect::<Vec<f64>>());
        let at = |t: f64| {
            let here: Vec<f64> =
                self.media.iter().map(|(mesh, _)| mesh.medium().extinction(t)).collect();
            let SecondMomentRates { lost, scattered, .. } =
                bound::square(&rates, walk, channel, &here, phi);
            [lost, lost, scattered]
        };
        let within = |part: Span| {
            let below = rates.majorants.iter().map(|&majorant| Span::new(0.0, majorant));
            let media = self.media.iter().zip(below);
            let here: Vec<Span> =
                media.map(|((mesh, _), below)| mesh.extremes(part).intersect(below)).collect();
            bound::square_within(&rates, walk, channel, &here, phi)
        };
        let nothing = bound::NOTHING * rates.majorants[0];
        let share = |[least, _, scattered]: [f64; 3]| match least {
            // Every scattering of a hero's own channel has the same factor.
            _ if walk == Proposal::Hero(channel) => rates.albedos[channel] * phi,
            // Where there are no collisions nothing is lost or gained.
            _ if scattered == 0.0 && least >= -nothing => 0.0,
            _ if least > 0.0 => scattered / least,
            _ => f64::INFINITY,
        };
        let of = |f: &dyn Fn([f64; 3]) -> f64| {
            mesh.supremum(|t| f(at(t)), |part| f(within(part))).max(0.0)
        };
        [of(&|[_, most, _]| most), of(&share)]
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
        let kinks = ParticleRule::Analog.kinks(1.0);
        let walk = |(channel, &weight): (usize, &f64)| {
            let ((mesh, sampling), incidence) =
                (self.media[channel], self.problem.incidences[channel]);
            let albedo = self.problem.colours.albedos[channel];
            let pieces = Pieces::new(mesh, sampling, &kinks, &[incidence.light]);
            let depth = mesh.optical_depth().value;
            (weight, Walk::analog(incidence, albedo, pieces, depth, self.laws))
        };
        Walk::mixed_lookups(heroes.iter().enumerate().map(walk))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colours::Chance;
    use crate::problems::slab::Incidence;
    use media::exponential::Exponential;
    use media::gaussian::Gaussian;
    use media::phase::Phase;
    use media::phase::isotropic::Isotropic;
    use media::sines::{Wave, Waves};
    use media::{Medium, OpticalDepth};
    use std::sync::Arc;

    const SPAN: Span = Span { from: 0.0, to: 1.0 };

    /// Polynomials between breaks, smooth fields, and pairs of fields that vanish at the same place.
    fn profiles() -> Vec<[Arc<dyn OpticalDepth>; 2]> {
        let line = |ends: [f64; 2]| Arc::new(Piecewise::lines(&[0.0, 1.0], &ends));
        let wave = |amplitude| Wave { amplitude, frequency: 9.0, phase: 0.4 };
        let steep = |extinction| Arc::new(Exponential::new(extinction, 30.0));
        let blob = |peak| Arc::new(Gaussian::new(peak, 0.3, 0.08));
        vec![
            [Arc::new(Piecewise::constant(1.0, SPAN)), line([0.95, 1.05])],
            [line([0.6, 0.9]), Arc::new(Piecewise::steps(&[0.0, 0.4, 1.0], &[1.1, 0.8]))],
            [
                Arc::new(Waves::new(0.9, vec![wave(0.2)])),
                Arc::new(Waves::new(1.0, vec![wave(-0.1)])),
            ],
            [steep(1.2), steep(1.0)],
            [blob(1.0), blob(1.3)],
            [line([0.0, 1.2]), line([0.0, 1.0])],
        ]
    }

    /// At thousands of distances no rate is above its bound. The bound is at most 2 % above the largest of them: 1 % by its
    /// own measure, and what lies between the distances.
    #[test]
    fn rates_are_nowhere_above_their_bounds() {
        let incidence = Incidence { light: Light::Diffuse, phase: Phase::Isotropic(Isotropic) };
        let walks = [
            Proposal::Hero(0),
            Proposal::Hero(1),
            Proposal::Together(Chance::Average),
            Proposal::Together(Chance::Maximum),
        ];
        for (number, profiles) in profiles().into_iter().enumerate() {
            let media = profiles.map(|profile| Medium::new(profile, SPAN, SPAN));
            let (albedos, majorants) = (vec![0.7, 0.8], vec![1.6; 2]);
            let problem = ChromaticSlab::new(media.to_vec(), albedos.clone(), vec![incidence; 2]);
            let meshes = media.clone().map(Mesh::new);
            let flown = Piecewise::constant(majorants[0], SPAN);
            let parts = meshes.iter().map(|mesh| (mesh, &flown)).collect();
            let spectrum = Spectrum::new(&problem, parts, false);
            let rates = Rates { majorants, albedos };
            for (walk, channel) in walks.into_iter().flat_map(|walk| [(walk, 0), (walk, 1)]) {
                let bounds = spectrum.largest_rates(walk, channel, 1.0);
                let mut largest = [0.0f64; 2];
                for i in 1..=4000 {
                    let t = (f64::from(i) * 0.618_033_988_749_894_9).fract();
                    let here = media.each_ref().map(|medium| medium.extinction(t));
                    let found = bound::square(&rates, walk, channel, &here, 1.0);
                    largest[0] = largest[0].max(found.lost);
                    let is_lost = found.lost > 0.0;
                    let share = if is_lost { found.scattered / found.lost } else { f64::INFINITY };
                    largest[1] = largest[1].max(share);
                }
                for (bound, largest) in bounds.into_iter().zip(largest) {
                    let context = format!("{number}, {walk:?}, {channel}: {bound}, {largest}");
                    assert!(largest <= bound * (1.0 + 1e-12), "{context}");
                    assert!(bound <= 1.02 * largest, "{context}");
                }
            }
        }
    }
}
