//! Draws that score several channels: moments against closed forms in 32 digits.
//!
//! ```text
//! transmittance, `theory::ray::spectral`, homogeneous:  every moment is an exponential, of MIS a sum of them
//! coloured scatterers, `theory::colours::scatterers`:     E[X^k] = Σ_h w_h L(a_λ^k/a_h^{k−1}), L(a) what leaves the body of an
//!     albedo a, above 1, too; tracking at P_s:  L(a_λ^k/P_s^{k−1});  independent:  w^{1−k} L(a_λ)
//! ```

use super::equations::power;
use super::fields::homogeneous;
use super::ordinates::Ordinates;
use super::prelude::*;
use super::rods::{critical, leaving, light};
use media::phase::{Phase, isotropic::Isotropic};
use theory::colours::Chance;
use theory::colours::scatterers::{BodyEnergies, BodySpectrum, BodyTracker};
use theory::problems::channels::{Colours, End};
use theory::problems::slab::{Incidence, IncidentLight};
use theory::problems::{ChromaticSlab, SpectralRod};
use theory::ray::spectral;
use theory::rod::spectral::Rods;
use theory::slab::chromatic::{self, Slabs};
use theory::{Channel, Moments};

/// Directions of the ordinates.
const ORDINATES: usize = 40;

/// All rows.
pub fn rows(run: Run) -> Vec<TrialRow> {
    let range = "2 … 4 channels, 8 trackers, τ = 1e-4 … 10, σ̂/σ_t = 1 … 11";
    let row = TrialRow::moments("spectral transmittance", range);
    let mut rows = run.fill([64, 6400], row, Transmittance::any, transmittance);
    let range = "2 … 4 albedos, 3 trackers, τ = 1e-3 … 10";
    let row = TrialRow::moments("spectral rods", range);
    rows.extend(run.fill([64, 6400], row, Coloured::any, rod));
    let range =
        "isotropic, 2 … 4 albedos, 3 trackers, τ = 1e-2 … 5, μ₀ = 0.05 … 1; discrete ordinates";
    let row = TrialRow::moments("spectral slabs", range);
    rows.extend(run.fill([1, 32], row, Coloured::any, slab));
    let range =
        "isotropic, 2 … 4 media, independent, τ = 1e-2 … 10, μ₀ = 0.05 … 1; discrete ordinates";
    let row = TrialRow::moments("chromatic slabs", range);
    rows.extend(run.fill([2, 48], row, Media::any, chromatic));
    rows
}

/// Tracker of a transmittance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum TrackerKind {
    Independent,
    InTurn,
    Hero,
    Mis,
    Average,
    Maximum,
}

parameters! {
    /// Channels with a medium each: optical depth, `σ̂/σ_t` less 1, and a share of the heroes.
    Transmittance {
        channels: Vec<(f64, f64, f64)> =
            vec((sized(-4.0, 1.0), sized(-2.0, 1.0), between(0.1, 1.0)), 2..=4),
        kind: TrackerKind = any_of(&[
            TrackerKind::Independent,
            TrackerKind::InTurn,
            TrackerKind::Hero,
            TrackerKind::Mis,
            TrackerKind::Average,
            TrackerKind::Maximum,
        ]),
        is_delta: bool = proptest::bool::ANY,
    }
    /// Channels with an albedo each, and shares of the heroes.
    Coloured {
        depth: f64 = sized(-3.0, 1.0),
        forward: f64 = between(0.0, 1.0),
        cosine: f64 = between(0.05, 1.0),
        channels: Vec<(f64, f64)> = vec((between(0.02, 1.0), between(0.1, 1.0)), 2..=4),
        tracker: BodyTracker = prop_oneof![
            any_of(&[BodyTracker::Independent, BodyTracker::Hero]),
            between(0.3, 1.0).prop_map(|scatter| BodyTracker::Tracking { scatter }),
        ],
    }
    /// Channels with a medium each: depth, albedo and a share of the heroes.
    Media {
        cosine: f64 = between(0.05, 1.0),
        channels: Vec<(f64, f64, f64)> =
            vec((sized(-2.0, 1.0), between(0.02, 1.0), between(0.1, 1.0)), 2..=4),
    }
}

/// Probabilities in proportion to shares.
fn heroes(shares: impl Iterator<Item = f64> + Clone) -> Vec<f64> {
    let whole: f64 = shares.clone().sum();
    shares.map(|share| share / whole).collect()
}

/// Variance and fourth moment of a channel, from raw moments; none of them where one is infinite.
fn see(seen: &mut Seen, channel: &Channel, raw: [Option<DoubleDouble>; 4]) {
    let Some(Moments { scale, relative, error, .. }) = channel.moments else {
        seen.skip(0);
        return seen.skip(1);
    };
    let is_known = raw.map(|moment| moment.is_some_and(|m| m.high.is_finite()));
    let [second, fourth] =
        central(raw.map(|m| m.unwrap_or(DoubleDouble::from(f64::NAN))), DoubleDouble::from(scale));
    for (row, needed, computed, exact) in [(0, 2, relative[0], second), (1, 4, relative[2], fourth)]
    {
        match (is_known[..needed].iter().all(|&known| known), computed.is_finite()) {
            // Of draws that hardly vary there are no digits.
            (true, true) if exact.high > 1e-9 => seen.central(row, computed, error, exact),
            (false, false) => seen.see(row, 0.0),
            _ => seen.skip(row),
        }
    }
}

fn transmittance(case: &Transmittance, seen: &mut Seen) {
    let &Transmittance { ref channels, kind, is_delta } = case;
    let depths: Vec<f64> = channels.iter().map(|channel| channel.0).collect();
    let mut majorants: Vec<f64> =
        channels.iter().map(|(depth, above, _)| depth * (1.0 + above)).collect();
    let tracker = match kind {
        TrackerKind::Independent => spectral::Tracker::Independent { delta: is_delta },
        TrackerKind::InTurn => spectral::Tracker::InTurn { delta: is_delta },
        TrackerKind::Hero => spectral::Tracker::Hero { delta: is_delta },
        TrackerKind::Mis => spectral::Tracker::Mis { delta: is_delta },
        TrackerKind::Average => spectral::Tracker::Tracking(Chance::Average),
        TrackerKind::Maximum => spectral::Tracker::Tracking(Chance::Maximum),
    };
    if matches!(kind, TrackerKind::Average | TrackerKind::Maximum) {
        let largest = majorants.iter().copied().fold(0.0, f64::max);
        majorants.fill(largest);
    }
    let hero = heroes(channels.iter().map(|channel| channel.2));
    let meshes: Vec<Mesh> =
        depths.iter().map(|&depth| Mesh::new(homogeneous(depth, 1.0))).collect();
    let meshes: Vec<&Mesh> = meshes.iter().collect();
    let spectrum = spectral::Spectrum::new(&meshes, majorants.clone(), hero.clone(), tracker);
    for (index, channel) in spectrum.predict(&[]).channels.iter().enumerate() {
        seen.at(format_args!("channel {}", index + 1));
        let exact = Walked { depths: &depths, majorants: &majorants, hero: &hero, kind, is_delta };
        see(seen, channel, [1, 2, 3, 4].map(|k| exact.moment(index, k)));
    }
}

/// Channels of length 1, and how they are walked.
struct Walked<'a> {
    depths: &'a [f64],
    majorants: &'a [f64],
    hero: &'a [f64],
    kind: TrackerKind,
    is_delta: bool,
}

impl Walked<'_> {
    /// `E[X_λ^k]`; `None` where it is infinite.
    fn moment(&self, own: usize, k: usize) -> Option<DoubleDouble> {
        let wide = |x: f64| DoubleDouble::from(x);
        let (majorant, depth, w) = (self.majorants[own], self.depths[own], self.hero[own]);
        let null = |channel: usize| wide(self.majorants[channel]) - self.depths[channel];
        let nulls = power(null(own), k);
        // A walk of its own.
        let alone = if self.is_delta {
            -wide(depth)
        } else {
            nulls / power(wide(majorant), k - 1) - majorant
        };
        let alone = alone.exp();
        let by_hero = |hero: usize| {
            let left = if self.is_delta { null(hero) } else { wide(self.majorants[hero]) };
            let flights = (k - 1) as f64 * wide(self.majorants[hero]) - k as f64 * wide(majorant);
            (flights + nulls / power(left, k - 1)).exp() * self.hero[hero]
        };
        let channels = 0..self.hero.len();
        match self.kind {
            TrackerKind::Independent => Some(alone / power(wide(w), k - 1)),
            TrackerKind::InTurn => Some(alone),
            TrackerKind::Hero => Some(channels.map(by_hero).sum()),
            TrackerKind::Mis => {
                // By the number of null collisions; of delta tracking with the density of nulls.
                let mut terms: Vec<[DoubleDouble; 2]> = channels
                    .map(|hero| {
                        let rate =
                            if self.is_delta { null(hero) } else { wide(self.majorants[hero]) };
                        [(-wide(self.majorants[hero])).exp() * self.hero[hero], rate]
                    })
                    .collect();
                let mut term = (-(k as f64 * wide(majorant))).exp();
                let mut sum = DoubleDouble::default();
                for n in 1..4000_i32 {
                    let density: DoubleDouble = terms.iter().map(|[density, _]| *density).sum();
                    let more = term / power(density, k - 1);
                    sum += more;
                    if f64::from(n) > 2.0 * majorant && more.high < 1e-25 * sum.high {
                        break;
                    }
                    // Everything is scaled by n!, and both sides by one rate, so that nothing overflows.
                    term = term * nulls / f64::from(n) / power(wide(majorant), k - 1);
                    for [density, rate] in &mut terms {
                        *density = *density * *rate / majorant;
                    }
                }
                Some(sum)
            }
            TrackerKind::Average | TrackerKind::Maximum => {
                let shares = |channel| null(channel) / majorant;
                let all: Vec<DoubleDouble> = channels.map(shares).collect();
                let size = |x: &DoubleDouble| x.value();
                let probability = if self.kind == TrackerKind::Average {
                    all.iter().copied().sum::<DoubleDouble>() / all.len() as f64
                } else {
                    let largest = all.iter().copied().max_by(|a, b| size(a).total_cmp(&size(b)))?;
                    let minimum = all.iter().copied().min_by(|a, b| size(a).total_cmp(&size(b)))?;
                    largest / (largest + 1.0 - minimum)
                };
                let kept = power(all[own], k) / power(probability, k - 1);
                Some((majorant * (kept - 1.0)).exp())
            }
        }
    }
}

/// Compares a body of coloured scatterers with what leaves bodies of one albedo.
fn coloured(
    case: &Coloured,
    (body, colours): (Box<dyn BodyEnergies + '_>, &Colours),
    leaving: &dyn Fn(DoubleDouble) -> Option<[DoubleDouble; 2]>,
    seen: &mut Seen,
) {
    let hero = heroes(case.channels.iter().map(|channel| channel.1));
    let spectrum = BodySpectrum::new(body, colours, hero.clone(), case.tracker);
    let prediction = spectrum.predict();
    for (channel, &(end, own)) in prediction.channels.iter().zip(&colours.seen) {
        seen.at(&channel.name);
        let of =
            |albedo: DoubleDouble| Some(leaving(albedo)?[usize::from(end == End::Transmitted)]);
        let albedo = |channel: usize| DoubleDouble::from(colours.albedos[channel]);
        let moment = |k: usize| match case.tracker {
            BodyTracker::Tracking { scatter } => {
                of(power(albedo(own), k) / power(DoubleDouble::from(scatter), k - 1))
            }
            BodyTracker::Hero => (0..hero.len())
                .map(|h| Some(of(power(albedo(own), k) / power(albedo(h), k - 1))? * hero[h]))
                .sum(),
            _ => Some(of(albedo(own))? / power(DoubleDouble::from(hero[own]), k - 1)),
        };
        see(seen, channel, [1, 2, 3, 4].map(moment));
    }
}

fn rod(case: &Coloured, seen: &mut Seen) {
    let albedos: Vec<f64> = case.channels.iter().map(|channel| channel.0).collect();
    let medium = homogeneous(case.depth, 1.0);
    let rod = SpectralRod::new(medium.clone(), albedos, case.forward);
    let (mesh, flown) = (Mesh::new(medium.clone()), Piecewise::constant(case.depth, medium.span()));
    let exact = |albedo: DoubleDouble| {
        let rates = light(DoubleDouble::from(case.depth), albedo, case.forward);
        // Next to the critical length either answer is right.
        (critical(rates) > 1.002).then(|| self::leaving(rates))
    };
    coloured(case, (Box::new(Rods::new(&rod, &mesh, &flown)), &rod.colours), &exact, seen);
}

fn slab(case: &Coloured, seen: &mut Seen) {
    // Diffuse now and then.
    let light = if case.cosine < 0.2 {
        IncidentLight::Diffuse
    } else {
        IncidentLight::Collimated(case.cosine)
    };
    let albedos: Vec<f64> = case.channels.iter().map(|channel| channel.0).collect();
    let depth = case.depth.clamp(1e-2, 5.0);
    let medium = homogeneous(depth, 1.0);
    let incidence = Incidence { light, phase: Phase::Isotropic(Isotropic) };
    let colours = Colours::new(albedos, true);
    let (mesh, flown) = (Mesh::new(medium.clone()), Piecewise::constant(depth, medium.span()));
    let exact = |albedo: DoubleDouble| {
        let [here, beyond] = [1.0, 1.002].map(|longer| {
            Ordinates::new(DoubleDouble::from(depth) * longer, albedo, ORDINATES)
                .filter(|slab| !slab.swings() || slab.is_positive())
        });
        beyond.and(here).map(|slab| slab.energy(light))
    };
    let body = Slabs { incidence, mesh: &mesh, sampling: &flown, with_distributions: false };
    coloured(case, (Box::new(body), &colours), &exact, seen);
}

/// One channel a draw: `E[X^k] = w^{1−k} R`, or T.
fn chromatic(case: &Media, seen: &mut Seen) -> Option<()> {
    let light = if case.cosine < 0.2 {
        IncidentLight::Diffuse
    } else {
        IncidentLight::Collimated(case.cosine)
    };
    let albedos: Vec<f64> = case.channels.iter().map(|channel| channel.1).collect();
    let hero = heroes(case.channels.iter().map(|channel| channel.2));
    let media: Vec<_> = case.channels.iter().map(|channel| homogeneous(channel.0, 1.0)).collect();
    let incidence = Incidence { light, phase: Phase::Isotropic(Isotropic) };
    let problem = ChromaticSlab::new(media.clone(), albedos, vec![incidence; media.len()]);
    let flown = |channel: &(f64, f64, f64)| Piecewise::constant(channel.0, media[0].span());
    let flown: Vec<Piecewise> = case.channels.iter().map(flown).collect();
    let meshes: Vec<Mesh> = media.into_iter().map(Mesh::new).collect();
    let joined = meshes.iter().zip(&flown).collect();
    let computed = chromatic::SlabSpectrum::new(&problem, joined, false).independent(&hero);
    for (channel, &(end, own)) in computed.channels.iter().zip(&problem.colours.seen) {
        seen.at(&channel.name);
        let (depth, albedo, _) = case.channels[own];
        let slab =
            Ordinates::new(DoubleDouble::from(depth), DoubleDouble::from(albedo), ORDINATES)?;
        let mean = slab.energy(light)[usize::from(end == End::Transmitted)];
        let raw = |k: usize| Some(mean / power(DoubleDouble::from(hero[own]), k - 1));
        see(seen, channel, [1, 2, 3, 4].map(raw));
    }
    Some(())
}
