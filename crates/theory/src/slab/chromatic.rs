//! Slabs of several channels, with draws that score all of them: coloured scatterers in one medium, and channels with a
//! medium of their own.
//!
//! **One medium.** Moments are those of [`crate::colours::scatterers`]. An albedo above 1 may be too large for the depth of
//! the slab: the slab is critical, and the moment infinite. With anisotropic phase functions, albedos above 1 are solved
//! to 1e-4. Orders of scattering are known for isotropic scattering. With other phase functions multiple importance
//! sampling has a mean, and a bound on the variance, as its draws never exceed 1/w.
//!
//! **Several media.**
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

use super::{Pieces, Resolution, SlabWalk};
use crate::colours::bound::{self, FlightMoments, SecondMomentRates};
use crate::colours::rates::{Proposal, Rates};
use crate::colours::scatterers::{BodyEnergies, Divergence, Orders};
use crate::colours::{self};
use crate::prediction::raw::{POWERS, RESOLVED, RawMoments};
use crate::problems::ChromaticSlab;
use crate::problems::channels::End;
use crate::problems::slab::{Incidence, IncidentLight};
use crate::{Channel, CountDistribution, Kernel, Mesh, ParticleRule, Prediction, slab};
use media::Piecewise;
use media::phase::Phase;
use media::phase::isotropic::Isotropic;
use numeric::{Known, Span, exponential_integrals};

/// Relative error of orders of scattering beyond that which their sum shows.
const OF_ORDERS: f64 = 2e-12;
/// Relative distance to a critical depth within which theory does not resolve on which side of it a slab is.
const NEAR: f64 = 1e-3;
/// Relative error of critical albedos.
const SHARP: f64 = 1e-7;

/// A slab of one medium with its mesh and σ̂.
pub struct Slabs<'a> {
    /// Light and phase function.
    pub incidence: Incidence,
    /// The medium.
    pub mesh: &'a Mesh,
    /// σ̂.
    pub sampling: &'a Piecewise,
    /// True if the distribution of lookups is computed; otherwise they have a mean only.
    pub with_distributions: bool,
}

impl Slabs<'_> {
    fn depth(&self) -> Known {
        self.mesh.optical_depth()
    }

    /// Analog walks of several heroes, given their probabilities and albedos.
    fn walks(&self, heroes: &[(f64, f64)]) -> impl Iterator<Item = (f64, SlabWalk)> {
        let kinks = ParticleRule::Analog.kinks(1.0);
        let pieces = Pieces::new(self.mesh, self.sampling, &kinks, &[self.incidence.light]);
        let depth = self.depth().value;
        heroes.iter().map(move |&(weight, albedo)| {
            (
                weight,
                SlabWalk::analog(
                    self.incidence,
                    albedo,
                    pieces.clone(),
                    depth,
                    self.with_distributions,
                ),
            )
        })
    }
}

/// An answer of moderate precision, `None` where it is infinite: with sharp phase functions an exact one takes
/// seconds.
fn coarse(incidence: &Incidence, depth: f64, albedo: f64) -> Option<[Known; 2]> {
    let slice = Kernel { rate: depth, straight: 0.0, scattered: albedo, score: 0.0 };
    let result = slab::solve(&incidence.phase, &[incidence.light], &[slice], Resolution::COARSE)?;
    Some([result[0].reflected, result[0].transmitted])
}

fn is_isotropic(incidence: &Incidence) -> bool {
    incidence.phase == Phase::Isotropic(Isotropic)
}

/// Returns whether a slab of an optical depth has a finite answer.
fn is_finite(incidence: &Incidence, depth: f64, albedo: f64) -> bool {
    let light = Incidence { light: IncidentLight::Diffuse, ..*incidence };
    if is_isotropic(incidence) {
        slab::cached(&light, Known::exact(depth), albedo).is_some()
    } else {
        coarse(&light, depth, albedo).is_some()
    }
}

/// Albedo from which on a slab has no finite answer.
fn critical(incidence: &Incidence, depth: f64) -> f64 {
    let (mut low, mut high) = (1.0, 2.0);
    while is_finite(incidence, depth, high) && high < 1e6 {
        (low, high) = (high, 2.0 * high);
    }
    while high - low > SHARP * low {
        let middle = 0.5 * (low + high);
        if is_finite(incidence, depth, middle) { low = middle } else { high = middle }
    }
    high
}

impl BodyEnergies for Slabs<'_> {
    fn leaving(&self, albedo: f64) -> Option<[Known; 2]> {
        let answer = slab::cached(&self.incidence, self.depth(), albedo)?;
        Some([answer.reflected, answer.transmitted])
    }

    fn power(&self, albedo: f64) -> Option<[Known; 2]> {
        if is_isotropic(&self.incidence) || albedo <= 1.0 {
            return self.leaving(albedo);
        }
        coarse(&self.incidence, self.depth().value, albedo)
    }

    fn divergence(&self, albedo: f64) -> Option<Divergence> {
        let (incidence, depth) = (&self.incidence, self.depth().value);
        if albedo <= 1.0 {
            return None;
        }
        let near = depth * (1.0 + NEAR);
        if is_finite(incidence, near, albedo) && self.power(albedo).is_some() {
            return None;
        }
        let critical = critical(incidence, depth);
        // With its peak cut off, light along the slab may grow that the whole phase function turns away.
        let is_cut = Resolution::COARSE.cuts(&incidence.phase);
        let is_infinite = !is_cut && !is_finite(incidence, depth * (1.0 - NEAR), albedo);
        Some(if is_infinite {
            Divergence::BeyondAlbedo { critical, albedo }
        } else {
            Divergence::NearAlbedo { critical, albedo }
        })
    }

    fn orders(&self) -> Option<Orders> {
        if !is_isotropic(&self.incidence) {
            return None;
        }
        let depth = self.depth();
        let result = slab::orders::orders(self.incidence.light, depth.value)?;
        let steepest = self.incidence.light.cosine().map_or(6.0, |cosine| 4.0 + 1.0 / cosine);
        let all: f64 = result.iter().flatten().sum();
        let error = OF_ORDERS + (all - 1.0).abs();
        Some(Orders { result, error, each: 0.0, blur: steepest * depth.error })
    }

    fn lookups(&self, heroes: &[(f64, f64)]) -> Option<CountDistribution> {
        SlabWalk::mixed_lookups(self.walks(heroes))
    }
}

/// A slab with a medium for each channel.
pub struct SlabSpectrum<'a> {
    problem: &'a ChromaticSlab,
    slabs: Vec<Slabs<'a>>,
}

impl<'a> SlabSpectrum<'a> {
    /// Joins the parts, mesh and σ̂ of each channel; without `with_distributions` lookups have a mean only.
    pub fn new(
        problem: &'a ChromaticSlab,
        media: Vec<(&'a Mesh, &'a Piecewise)>,
        with_distributions: bool,
    ) -> Self {
        let slab = |((mesh, sampling), &incidence)| Slabs {
            incidence,
            mesh,
            sampling,
            with_distributions,
        };
        let slabs = media.into_iter().zip(&problem.incidences).map(slab).collect();
        Self { problem, slabs }
    }

    /// Energy that leaves a channel's slab at an end; NaN where it is unknown.
    fn truth(&self, end: End, channel: usize) -> Known {
        let result = self.slabs[channel].leaving(self.problem.colours.albedos[channel]);
        result.map_or(slab::EnergyBounds::UNKNOWN.reflected, |result| {
            result[usize::from(end == End::Transmitted)]
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
        let deep = largest * self.slabs[0].mesh.support().length();
        let flight = |leaves: f64| FlightMoments { leaves, collides: 1.0 - leaves };
        let first = match problem.incidences[0].light {
            IncidentLight::Collimated(cosine) => flight((-deep / cosine).exp()),
            IncidentLight::Diffuse => flight(0.0),
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
            self.slabs.iter().map(|slab| slab.sampling.single_value().unwrap_or_default());
        let rates =
            Rates { majorants: majorants.collect(), albedos: self.problem.colours.albedos.clone() };
        let ends =
            self.slabs.iter().flat_map(|slab| slab.mesh.panels().map(|panel| panel.span.from));
        let mesh = self.slabs[0].mesh.cut(&ends.collect::<Vec<f64>>());
        let at = |t: f64| {
            let here: Vec<f64> =
                self.slabs.iter().map(|slab| slab.mesh.medium().extinction(t)).collect();
            let SecondMomentRates { lost, scattered, .. } =
                bound::square(&rates, walk, channel, &here, phi);
            [lost, lost, scattered]
        };
        let within = |part: Span| {
            let below = rates.majorants.iter().map(|&majorant| Span::new(0.0, majorant));
            let slabs = self.slabs.iter().zip(below);
            let here: Vec<Span> =
                slabs.map(|(slab, below)| slab.mesh.extremes(part).intersect(below)).collect();
            bound::square_within(&rates, walk, channel, &here, phi)
        };
        let nothing = bound::NOTHING * rates.majorants[0];
        let share = |[minimum, _, scattered]: [f64; 3]| match minimum {
            // Every scattering of a hero's own channel has the same factor.
            _ if walk == Proposal::Hero(channel) => rates.albedos[channel] * phi,
            // Where there are no collisions nothing is lost or gained.
            _ if scattered == 0.0 && minimum >= -nothing => 0.0,
            _ if minimum > 0.0 => scattered / minimum,
            _ => f64::INFINITY,
        };
        let of = |f: &dyn Fn([f64; 3]) -> f64| {
            mesh.supremum(|t| f(at(t)), |part| f(within(part))).max(0.0)
        };
        [of(&|[_, maximum, _]| maximum), of(&share)]
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
        let parts = self.slabs.iter().zip(heroes).zip(&self.problem.colours.albedos);
        let walk = |((slab, &weight), &albedo): ((&'_ Slabs<'_>, _), _)| {
            slab.walks(&[(weight, albedo)]).collect::<Vec<_>>()
        };
        SlabWalk::mixed_lookups(parts.flat_map(walk))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colours::Chance;
    use media::constant::Constant;
    use media::exponential::Exponential;
    use media::gaussian::Gaussian;
    use media::phase::henyey_greenstein::HenyeyGreenstein;
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
        let incidence =
            Incidence { light: IncidentLight::Diffuse, phase: Phase::Isotropic(Isotropic) };
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
            let spectrum = SlabSpectrum::new(&problem, parts, false);
            let rates = Rates { majorants, albedos };
            for (walk, channel) in walks.into_iter().flat_map(|walk| [(walk, 0), (walk, 1)]) {
                let bounds = spectrum.largest_rates(walk, channel, 1.0);
                let mut largest = [0.0f64; 2];
                for i in 1..=4000 {
                    let t = (f64::from(i) * 0.618_033_988_749_894_9).fract();
                    let here = media.each_ref().map(|medium| medium.extinction(t));
                    let result = bound::square(&rates, walk, channel, &here, 1.0);
                    largest[0] = largest[0].max(result.lost);
                    let is_lost = result.lost > 0.0;
                    let share =
                        if is_lost { result.scattered / result.lost } else { f64::INFINITY };
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

    /// Next to the critical albedo theory does not tell on which side a slab is, on either side of it.
    #[test]
    fn next_to_the_critical_albedo_nothing_is_said_to_be_infinite() {
        let peaked = HenyeyGreenstein::new(0.5).map(Phase::HenyeyGreenstein).expect("in range");
        for phase in [Phase::Isotropic(Isotropic), peaked] {
            let incidence = Incidence { light: IncidentLight::Collimated(0.6), phase };
            let span = Span::new(0.0, 1.7);
            let medium = Medium::new(Arc::new(Constant { extinction: 1.0 }), span, span);
            let (mesh, sampling) = (Mesh::new(medium), Piecewise::constant(1.0, span));
            let slabs =
                Slabs { incidence, mesh: &mesh, sampling: &sampling, with_distributions: false };
            let at = critical(&incidence, 1.7);
            assert_eq!(slabs.divergence(0.99 * at), None);
            for share in [1.0 - 1e-4, 1.0 - 1e-6, 1.0 + 1e-6, 1.0 + 1e-4] {
                let albedo = share * at;
                let near = Divergence::NearAlbedo { critical: at, albedo };
                assert_eq!(slabs.divergence(albedo), Some(near), "{share}");
            }
            let albedo = 1.01 * at;
            let beyond = Divergence::BeyondAlbedo { critical: at, albedo };
            assert_eq!(slabs.divergence(albedo), Some(beyond));
        }
    }
}
