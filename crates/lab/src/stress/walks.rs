//! Walks in slabs: moments and lookups against discrete ordinates, thinner layers and Peierls' equation.
//!
//! The k-th moments of a walk are the light that leaves another slab. Its albedo may exceed 1. For a constant r and
//! isotropic scattering, discrete ordinates in 32 digits compute this light, and whether it is finite (`ordinates`).
//! For a varying r it is Peierls' equation (`peierls`). With other phase functions, in layers of different r or with
//! a varying r, the library solves again with 1.5 times as many directions and a thinner first layer.
//!
//! ```text
//! E[X^k]:  ∫σ̂(1 − Q_k) thick, of the albedo S_k/(1 − Q_k)
//! E[M] = (1 − R₀ − T₀)/(1 − Q₀ − S₀),  R₀ and T₀ those of k = 0
//! E[zᴹ] = L + (1 − L) z(1 − Q₀ − S₀)/(1 − zQ₀ − zS₀),  L = R + T of the slab of zQ₀ and zS₀
//! ```
//!
//! Factorial moments of M are the derivatives of `E[zᴹ]` at z = 1: those of the polynomial through nine values in 32
//! digits.

use super::fields;
use super::ordinates::{Ordinates, solved_pivoted};
use super::peierls::Peierls;
use super::prelude::*;
use super::rods::{lookups, moments_of};
use super::slabs::{LIGHTS, henyey_greenstein, lights, phase};
use media::phase::{Phase, isotropic::Isotropic};
use theory::problems::slab::{Incidence, IncidentLight};
use theory::slab::{self, Energy, EnergyBounds, Existence, Piece, Pieces, Resolution, SlabWalk};
use theory::{CountDistribution, Kernel, ParticleRule};

/// Directions of the ordinates.
const ORDINATES: usize = 48;
/// Distance from 1 below which an albedo is replaced by 1 less this distance: at 1 two solutions coincide.
const WHITE: f64 = 1e-14;
/// Half as many directions again as moments take, and a first layer of a hundredth.
const FINER: Resolution =
    Resolution { faintest: 1e-9, directions: 24, first_layer: 1e-12, ..Resolution::FINE };
/// Resolution where r varies and many layers are solved.
const LAYERED: Resolution = Resolution { faintest: 1e-6, first_layer: 1e-9, ..FINER };
/// Step of marks in units of the inverse number of collisions over which their distribution decays.
const STEP: f64 = 1e-3;
/// Quantity of the rows.
const WALKS: &str = "walks in a slab";
/// Fainter light is not resolved to 1e-4, and refused.
const FAINT: f64 = 1e-9;

/// All rows.
pub fn rows(run: Run) -> Vec<TrialRow> {
    let moments = |range| TrialRow::moments(WALKS, range).to_vec();
    let with_lookups = |range| {
        let mut rows = moments(range);
        rows.push(TrialRow::stated("lookups of walks in a slab", range));
        rows
    };
    let range = "isotropic, 3 rules, r = 0.1 … 3, τ = 1e-3 … 30, μ₀ = 1e-4 … 1; discrete ordinates";
    let mut of_even = with_lookups(range);
    of_even.push(TrialRow::wrong("diverging variances in slabs, wrong", range));
    let mut rows = run.fill([4, 64], of_even, Even::any, even);
    let range = "isotropic, 1 − a = 1e-7 … 0.5, 3 rules, r = 0.1 … 1, τ = 1e-2 … 30, μ₀ = 1e-4 … 1; discrete ordinates";
    let of_lookups = TrialRow::moments("lookups of walks in a slab, next to criticality", range);
    rows.extend(run.fill([2, 32], of_lookups, White::any, white));
    let range = "1 … 3 layers, |g| to 0.935, 3 rules, r = 0.1 … 2, τ = 1e-3 … 30; half as many directions again";
    rows.extend(run.fill([2, 64], with_lookups(range), Layers::any, finer));
    let range =
        "r varies, isotropic, 2 rules, r = 0 … 1.4, τ = 1e-2 … 5, μ₀ = 1e-4 … 1; Peierls' equation";
    rows.extend(run.fill([2, 48], moments(range), Graded::any, graded));
    let range = "r varies, |g| to 0.6, 2 rules, r = 0 … 1.4, ∫σ̂ = 1e-3 … 5; same layers, half as many directions again";
    rows.extend(run.fill([2, 16], with_lookups(range), Ramp::any, ramps));
    rows
}

parameters! {
    /// One ratio, isotropic scattering.
    Even {
        depth: f64 = sized(-3.0, 1.48),
        albedo: f64 = albedo(),
        ratio: f64 = sized(-1.0, 0.5),
        kind: usize = 0..3_usize,
        lights: Vec<IncidentLight> = lights(),
    }
    /// A walk that ends rarely or never before it leaves: one ratio, isotropic scattering.
    White {
        depth: f64 = sized(-2.0, 1.48),
        absorbed: f64 = sized(-7.0, -0.3),
        ratio: f64 = sized(-1.0, 0.0),
        kind: usize = 0..3_usize,
        lights: Vec<IncidentLight> = lights(),
    }
    /// Layers of other ratios, any phase function.
    Layers {
        depth: f64 = sized(-3.0, 1.48),
        albedo: f64 = albedo(),
        ratios: Vec<f64> = vec(sized(-1.0, 0.3), 1..=3),
        kind: usize = 0..3_usize,
        phase: Phase = phase(),
        lights: Vec<IncidentLight> = lights(),
    }
    /// Straight pieces of r, isotropic scattering.
    Graded {
        albedo: f64 = albedo(),
        maximum: f64 = between(0.2, 1.4),
        is_weighted: bool = proptest::bool::ANY,
        collisions: f64 = sized(-2.0, 0.7),
        values: Vec<f64> = vec(between(0.0, 1.0), 2..=4),
        largest: usize = 0..4_usize,
        lights: Vec<IncidentLight> = alike(),
    }
    /// r that rises or falls, any phase function.
    Ramp {
        flown: f64 = sized(-3.0, 0.7),
        albedo: f64 = albedo(),
        ends: [f64; 2] = [between(0.0, 1.4); 2],
        kind: usize = 0..2_usize,
        phase: Phase = prop_oneof![
            1 => Just(Phase::Isotropic(Isotropic)),
            3 => between(-0.6, 0.6).prop_map(henyey_greenstein),
        ],
        lights: Vec<IncidentLight> = lights(),
    }
}

fn albedo() -> impl Strategy<Value = f64> {
    let white = sized(-12.0, -1.0).prop_map(|less| 1.0 - less);
    prop_oneof![1 => white, 1 => sized(-2.0, -0.5), 4 => between(0.05, 1.0)]
}

/// An albedo that is not 1.
fn below_one(albedo: DoubleDouble) -> DoubleDouble {
    let is_white = (1.0 - albedo).high.abs() < WHITE;
    if is_white { 1.0 - DoubleDouble::from(WHITE) } else { albedo }
}

/// A rule that exists for ratios up to one.
fn rule(kind: usize, maximum: f64) -> ParticleRule {
    use ParticleRule::{NonTerminating, Terminating, Weighted};
    let rules = [NonTerminating, Weighted, Terminating];
    rules[kind % if maximum <= 1.0 { 3 } else { 2 }]
}

/// R and T in all lights.
type Leaving = Vec<[DoubleDouble; 2]>;

/// R and T of the slabs of a walk's moments, up to the first infinite one,
/// and how often it collides.
struct Exact {
    leaving: Vec<Leaving>,
    collisions: Option<Vec<DoubleDouble>>,
}

/// Compares a walk in all lights.
fn compare(seen: &mut Seen, walk: &SlabWalk, lights: &[IncidentLight], exact: &Exact) {
    let known = |x: DoubleDouble| Known::new(x.value(), f64::EPSILON * x.value());
    let answer = |both: &[DoubleDouble; 2]| {
        let [reflected, transmitted] = both.map(known);
        EnergyBounds { reflected, transmitted, score: Known::exact(0.0) }
    };
    let first = exact.leaving.first();
    let truths: Vec<EnergyBounds> =
        first.map_or_else(Vec::new, |all| all.iter().map(answer).collect());
    let all = walk.predict_all(lights, &truths);
    for (i, (light, computed)) in lights.iter().zip(all).enumerate() {
        seen.at(format_args!("{light:?}"));
        let is_faint = truths[i].reflected.value.min(truths[i].transmitted.value) < FAINT;
        if is_faint {
            seen.skip(0);
            seen.skip(1);
        }
        if let Some(collisions) = &exact.collisions {
            match computed.lookups.zip(collisions.get(i)).filter(|_| !is_faint) {
                Some((distribution, &exact)) => seen.stated(2, lookups(&distribution), exact),
                None => seen.skip(2),
            }
        }
        for (channel, side) in computed.channels.iter().zip(0..).filter(|_| !is_faint) {
            let raw: Vec<DoubleDouble> = exact.leaving.iter().map(|all| all[i][side]).collect();
            seen.at(format_args!("{}, {light:?}", channel.name));
            // Next to where moments become infinite either may be right.
            seen.resolved([0, 1], channel.moments, &raw);
        }
    }
}

/// A walk in isotropic light or another.
fn walk(
    phase: Phase,
    (albedo, rule): (f64, ParticleRule),
    pieces: Pieces,
    maximum: f64,
    depth: f64,
) -> SlabWalk {
    let incidence = Incidence { light: IncidentLight::Diffuse, phase };
    SlabWalk {
        incidence,
        albedo,
        rule,
        pieces,
        largest_ratio: maximum,
        depth,
        with_distributions: false,
    }
}

/// The layers of a walk's k-th moments.
fn slices(cut: &[Piece], walk: &SlabWalk, k: u32) -> Vec<Kernel> {
    let slice = |piece: &Piece| {
        let [mut straight, mut scattered] = [0.0; 2];
        for &[share, ratio] in &piece.ratios {
            let odds = moments_of(walk.rule, DoubleDouble::from(ratio), walk.albedo, k);
            let [q, s] = odds.map(DoubleDouble::value);
            straight += share * q;
            scattered += share * s;
        }
        Kernel { rate: piece.flown, straight, scattered, score: 1.0 }
    };
    cut.iter().map(slice).collect()
}

/// One ratio, isotropic scattering: discrete ordinates.
fn even(parameters: &Even, seen: &mut Seen) {
    let &Even { depth, albedo, ratio, kind, ref lights } = parameters;
    let rule = rule(kind, ratio);
    let (phase, flown) = (Phase::Isotropic(Isotropic), depth / ratio);
    let pieces = Pieces::Exact(vec![Piece::of(flown, ratio)]);
    let walk = walk(phase, (albedo, rule), pieces, ratio, depth);
    let of_power = |k: u32, longer: f64| {
        let [q, s] = moments_of(rule, DoubleDouble::from(ratio), albedo, k);
        let lost = 1.0 - q;
        if lost.high <= 0.0 {
            return None;
        }
        let depth = DoubleDouble::from(flown * longer) * lost;
        Ordinates::new(depth, below_one(s / lost), ORDINATES).filter(Ordinates::is_positive)
    };
    let exact: Vec<Ordinates> = (1..=4).map_while(|k| of_power(k, 1.0)).collect();
    // Within two thousandths of the critical depth either answer is right.
    let [before, beyond] = match exact.get(1) {
        Some(slab) if !slab.swings() => [true; 2],
        _ => [0.998, 1.002].map(|longer| of_power(2, longer).is_some()),
    };
    if before == beyond {
        seen.wrong(3, (walk.second_moment() == Existence::Diverges) == before);
    }
    let energy = |slab: &Ordinates| lights.iter().map(|&light| slab.energy(light)).collect();
    let leaving = exact.iter().map(energy).collect();
    let [q, s] = moments_of(rule, DoubleDouble::from(ratio), albedo, 0);
    let ends = 1.0 - q - s;
    let ends = if ends.high.abs() < 1e-13 { (1.0 - q) * WHITE } else { ends };
    let collisions = of_power(0, 1.0).map_or_else(Vec::new, |slab| {
        let left = |&light: &IncidentLight| slab.energy(light).into_iter().sum::<DoubleDouble>();
        lights.iter().map(|light| (1.0 - left(light)) / ends).collect()
    });
    compare(seen, &walk, lights, &Exact { leaving, collisions: Some(collisions) });
}

/// Variance and fourth moment of lookups, one ratio and isotropic scattering: discrete ordinates at nine marks.
fn white(parameters: &White, seen: &mut Seen) -> Option<()> {
    let &White { depth, absorbed, ratio, kind, ref lights } = parameters;
    let (rule, flown) = (rule(kind, ratio), depth / ratio);
    let pieces = Pieces::Exact(vec![Piece::of(flown, ratio)]);
    let walk = walk(Phase::Isotropic(Isotropic), (1.0 - absorbed, rule), pieces, ratio, depth);
    let computed =
        seen.computed(0, SlabWalk { with_distributions: true, ..walk.clone() }.lookups(lights))?;
    let laws: Vec<CountDistribution> =
        computed.into_iter().map(CountDistribution::of_factorial).collect();
    let scale = laws
        .iter()
        .map(|distribution| 1.0 + distribution.variance / distribution.mean)
        .fold(0.0, f64::max);
    let step = DoubleDouble::from(STEP / scale);
    let [q, s] = moments_of(rule, DoubleDouble::from(ratio), walk.albedo, 0);
    let generating = |place: i32| -> Option<Vec<DoubleDouble>> {
        // There two solutions of white slabs are one; probabilities add up to 1.
        if place == 0 {
            return Some(vec![DoubleDouble::ONE; lights.len()]);
        }
        let z = 1.0 + step * f64::from(place);
        let (lost, scattered) = (1.0 - z * q, z * s);
        let slab = Ordinates::new(DoubleDouble::from(flown) * lost, scattered / lost, ORDINATES)?;
        let ended = z * (1.0 - q - s) / (lost - scattered);
        let of_light = |&light: &IncidentLight| {
            let left: DoubleDouble = slab.energy(light).into_iter().sum();
            left + (1.0 - left) * ended
        };
        Some(lights.iter().map(of_light).collect())
    };
    let places = -4..=4;
    let values: Vec<Vec<DoubleDouble>> = places.clone().map(generating).collect::<Option<_>>()?;
    for (i, (light, distribution)) in lights.iter().zip(laws).enumerate() {
        let row = |(place, values): (i32, &Vec<DoubleDouble>)| {
            let powers = (0..9).map(|k| DoubleDouble::from(f64::from(place).powi(k)));
            powers.chain([values[i]]).collect()
        };
        let terms = solved_pivoted(places.clone().zip(&values).map(row).collect())?;
        let mut scale = DoubleDouble::ONE;
        let [f1, f2, f3, f4] = [1, 2, 3, 4].map(|k: u8| {
            scale = scale * f64::from(k) / step;
            terms[usize::from(k)] * scale
        });
        let raw = [f1, f2 + f1, f3 + 3.0 * f2 + f1, f4 + 6.0 * f3 + 7.0 * f2 + f1];
        let fourth = distribution.kurtosis * distribution.variance * distribution.variance;
        seen.at(format_args!("{light:?}"));
        for (row, (computed, exact)) in [distribution.variance, fourth]
            .into_iter()
            .zip(central(raw, DoubleDouble::ONE))
            .enumerate()
        {
            seen.stated(
                row,
                Known::estimated(computed, computed * distribution.moments_error),
                exact,
            );
        }
    }
    Some(())
}

/// Layers of other ratios and other phase functions: the same slabs with more directions.
fn finer(parameters: &Layers, seen: &mut Seen) {
    let &Layers { depth, albedo, ref ratios, kind, phase, ref lights } = parameters;
    let maximum = ratios.iter().copied().fold(0.0, f64::max);
    let rule = rule(kind, maximum);
    let thin = depth / ratios.len() as f64;
    let cut: Vec<Piece> = ratios.iter().map(|&r| Piece::of(thin / r, r)).collect();
    let walk = walk(phase, (albedo, rule), Pieces::Exact(cut.clone()), maximum, depth);
    let of_power = |k: u32| slab::energies(&phase, lights, &slices(&cut, &walk, k), FINER);
    let leaving = |energy: &Energy| [energy.reflected, energy.transmitted].map(DoubleDouble::from);
    let score = |energy: &Energy| DoubleDouble::from(energy.score);
    let exact = Exact {
        leaving: (1..=4).map_while(of_power).map(|all| all.iter().map(leaving).collect()).collect(),
        collisions: Some(of_power(0).map_or_else(Vec::new, |all| all.iter().map(score).collect())),
    };
    compare(seen, &walk, lights, &exact);
}

/// r that varies, and other phase functions: the same layers with more directions.
fn ramps(parameters: &Ramp, seen: &mut Seen) {
    let &Ramp { flown, albedo, ends, kind, phase, ref lights } = parameters;
    let rule = rule(kind, f64::INFINITY);
    let cut = |count: u32| -> Vec<Piece> {
        let ratio = |place: f64| ends[0] + (ends[1] - ends[0]) * place / f64::from(count);
        let layer = |i: u32| {
            let middle = f64::from(i) + 0.5;
            let nodes = [middle - 0.75f64.sqrt() / 3.0, middle + 0.75f64.sqrt() / 3.0];
            let ratios = nodes.map(|place| [0.5, ratio(place)]).to_vec();
            Piece { flown: flown / f64::from(count), ratios }
        };
        (0..count).map(layer).collect()
    };
    let cuts = [cut(12), cut(24)];
    // Weighted walks would know σ_t alone, and one layer, where r is nowhere above 1.
    let depth = 0.5 * flown * (ends[0] + ends[1]);
    let walk = walk(phase, (albedo, rule), Pieces::Graded(cuts.clone()), 1.4, depth);
    let of_power = |k: u32| -> Option<Vec<[DoubleDouble; 3]>> {
        let [coarse, fine] = cuts
            .each_ref()
            .map(|cut| slab::energies(&phase, lights, &slices(cut, &walk, k), LAYERED));
        let both = |(coarse, fine): (Energy, Energy)| {
            let all = |energy: Energy| [energy.reflected, energy.transmitted, energy.score];
            let (coarse, fine) = (all(coarse), all(fine));
            [0, 1, 2]
                .map(|i| [coarse[i], fine[i]])
                .map(|[coarse, fine]| DoubleDouble::from(fine + (fine - coarse) / 3.0))
        };
        Some(coarse?.into_iter().zip(fine?).map(both).collect())
    };
    let leaving =
        (1..=4).map_while(&of_power).map(|all| all.into_iter().map(|[r, t, _]| [r, t]).collect());
    let collisions = of_power(0).map(|all| all.into_iter().map(|[.., score]| score).collect());
    let exact = Exact { leaving: leaving.collect(), collisions };
    compare(seen, &walk, lights, &exact);
}

/// Lights that graze, or none of them: layers are thinner for all where one does.
fn alike() -> impl Strategy<Value = Vec<IncidentLight>> {
    let all = |cosine| vec(cosine, LIGHTS);
    (proptest::bool::ANY, all(sized(-4.0, -1.0)), all(between(0.1, 1.0))).prop_map(
        |(all_graze, grazing, steep)| {
            let diffuse = (!all_graze).then_some(IncidentLight::Diffuse);
            let cosines = if all_graze { grazing } else { steep };
            diffuse
                .into_iter()
                .chain(cosines.into_iter().map(IncidentLight::Collimated))
                .take(LIGHTS)
                .collect()
        },
    )
}

/// r that varies: Peierls' equation.
fn graded(parameters: &Graded, seen: &mut Seen) {
    let &Graded { albedo, maximum, is_weighted, collisions, ref values, largest, ref lights } =
        parameters;
    // Other walks know σ_t alone where r is nowhere above 1, as on one layer.
    let rule = rule(usize::from(is_weighted && maximum > 1.0), f64::INFINITY);
    let cuts = values.len() - 1;
    let knots: Vec<f64> = (0..=cuts).map(|i| i as f64 / cuts as f64).collect();
    let sampling = collisions / maximum;
    let mut values: Vec<f64> = values.iter().map(|value| collisions * value).collect();
    values[largest % (cuts + 1)] = collisions;
    let mesh = Mesh::new(fields::pieces(&knots, &values));
    let (flown, extinction) =
        (Piecewise::constant(sampling, mesh.support()), Piecewise::lines(&knots, &values));
    // Where r passes 1 its moments have kinks.
    let mut breaks = knots.clone();
    for (knots, values) in knots.windows(2).zip(values.windows(2)) {
        let share = (sampling - values[0]) / (values[1] - values[0]);
        if share > 0.0 && share < 1.0 {
            breaks.push(knots[0] + share * (knots[1] - knots[0]));
        }
    }
    let of_power = |k: u32| {
        let rates = |x: f64| {
            let ratio = extinction.value(x) / sampling;
            let [q, s] =
                moments_of(rule, DoubleDouble::from(ratio), albedo, k).map(DoubleDouble::value);
            [sampling * (1.0 - q), sampling * s]
        };
        let grows = (0..=200).any(|i| rates(f64::from(i) / 200.0)[0] <= 0.0);
        if grows { None } else { Peierls::new(&rates, &breaks).leaving(lights) }
    };
    let wide = |both: &[f64; 2]| both.map(DoubleDouble::from);
    let depth = mesh.optical_depth().value;
    let truth =
        Ordinates::new(DoubleDouble::from(depth), below_one(DoubleDouble::from(albedo)), ORDINATES);
    let truth = truth.map(|slab| lights.iter().map(|&light| slab.energy(light)).collect());
    let higher = (2..=4).map_while(of_power).map(|all| all.iter().map(wide).collect());
    let leaving = truth.into_iter().chain(higher).collect();
    let pieces = Pieces::new(&mesh, &flown, &rule.kinks(albedo), lights);
    let walk = walk(Phase::Isotropic(Isotropic), (albedo, rule), pieces, maximum, depth);
    compare(seen, &walk, lights, &Exact { leaving, collisions: None });
}
