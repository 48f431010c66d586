//! The plane-parallel slab: reflectance and transmittance by adding and doubling, and the moments of
//! walks in it.
//!
//! ```text
//! μ dI/dτ = −I + (a/2) ∫₋₁¹ p(μ, μ') I(μ') dμ',   light from above at μ₀, or spread like 2μ₀ dμ₀
//! ```
//!
//! A layer so thin that light scatters in it at most once is doubled until it is the slab; layers that differ are
//! laid upon each other. Any answer is computed four times, with fewer and fewer directions and thicker first
//! layers, and the differences give its error. Thin slabs need grazing directions, and answers with too few of them
//! may agree by accident.
//!
//! If the maximum number of directions does not resolve a phase function, its forward peak is cut off (δ-M). With n
//! directions the share `f = χ_{2n}` goes straight on, and the rest has the moments `(χ_l − f)/(1 − f)`. Each of
//! the four answers has its own f.
//!
//! Where only `r = σ_t/σ̂` matters at a tentative collision, the k-th moments of a walk are reflectance
//! and transmittance of another slab: `∫σ̂(1 − Q_k)` thick, of albedo `S_k/(1 − Q_k)`, which may exceed
//! 1, see [`crate::collisions::particle`]. It may also be too thick for that albedo: then the moment is
//! infinite.
//!
//! Source: H. C. van de Hulst, *Multiple Light Scattering* (Academic Press, 1980), chapters 4 and 9; δ-M: W. J.
//! Wiscombe, *The Delta-M Method*, Journal of the Atmospheric Sciences 34, 1408–1422 (1977).

pub mod cache;
pub mod chromatic;
pub mod directions;
pub mod layer;
pub mod lit;
pub mod orders;
pub mod pieces;
#[cfg(test)]
mod tests;
mod thin;
pub mod walk;

use self::thin::Grazing;
use crate::Kernel;
use crate::problems::slab::IncidentLight;
use media::phase::Phase;
use numeric::{Known, Scalar};

use directions::Directions;
use layer::Layer;

pub use cache::cached;
pub use pieces::{Piece, Pieces};
pub use walk::{Existence, SlabWalk};

/// Shares of light by where it goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shares<T> {
    /// The share that comes back.
    pub reflected: T,
    /// The share that passes, unscattered light included.
    pub transmitted: T,
    /// The score of its collisions.
    pub score: T,
}

/// Energy without error bounds.
pub type Energy = Shares<f64>;

/// Energy with error bounds.
pub type EnergyBounds = Shares<Known>;

impl<T> Shares<T> {
    /// Makes all shares, given a function of the accessor of each.
    fn each<U>(of: impl Fn(fn(&Shares<U>) -> &U) -> T) -> Self {
        Self {
            reflected: of(|shares| &shares.reflected),
            transmitted: of(|shares| &shares.transmitted),
            score: of(|shares| &shares.score),
        }
    }
}

impl EnergyBounds {
    /// No answer.
    pub const UNKNOWN: Self = {
        let nothing = Known::estimated(f64::NAN, f64::INFINITY);
        Self { reflected: nothing, transmitted: nothing, score: nothing }
    };
}

/// Resolution of a slab.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resolution {
    /// Legendre moments of this size are resolved.
    pub faintest: f64,
    /// Minimum number of directions.
    pub directions: usize,
    /// Maximum error from the first layer.
    pub first_layer: f64,
    /// Ratios of differences to the error: of the answer with five eighths of the directions, and of that with half
    /// of them.
    pub gains: [f64; 2],
    /// Number of directions for phase functions that this number does not resolve: their forward peak is cut off. 0 if no
    /// peak is.
    pub peaked: usize,
}

impl Resolution {
    /// Resolution of exact answers: 1e-10, 1e-8 for Henyey–Greenstein of g = 0.9, and mostly far better.
    pub const FINE: Self = Self {
        faintest: 1e-11,
        directions: 32,
        first_layer: 3e-14,
        gains: [12.0, 400.0],
        peaked: 144,
    };
    /// Resolution of moments: 1e-4 and mostly far better. With few directions, errors for grazing light in thin
    /// slabs may fall only as `1/n`: the answer with five eighths of them then differs by 8/5 − 1 times the error.
    /// Elsewhere errors oscillate, and those of sixteen, twelve and ten directions may agree by accident. Half of
    /// the directions have errors that are ten to a hundred times larger, and show it.
    pub const COARSE: Self =
        Self { faintest: 1e-5, directions: 16, first_layer: 1e-10, gains: SLOW, peaked: 96 };
    /// Resolution of moments where r varies, which need a hundred layers and more, and for differences.
    pub const LAYERED: Self =
        Self { faintest: 1e-4, directions: 12, first_layer: 1e-7, gains: SLOW, peaked: 72 };

    /// A share of the directions, in eighths, and a thicker first layer. A sharp phase function needs more directions
    /// by its Legendre moments: the same share of those, too.
    fn coarser(self, eighths: u8) -> Self {
        let [directions, peaked] =
            [self.directions, self.peaked].map(|count| count * usize::from(eighths) / 8);
        let faintest = self.faintest.powf(f64::from(eighths) / 8.0);
        Self { faintest, directions, peaked, first_layer: 4.0 * self.first_layer, ..self }
    }

    /// Resolution for a phase function: `peaked` is 0 unless its forward peak is cut off.
    fn of(self, phase: &Phase) -> Self {
        let is_whole = self.peaked == 0;
        if is_whole || directions::are_enough(phase, self.coarser(6).faintest, self.peaked) {
            Self { peaked: 0, ..self }
        } else {
            Self { gains: PEAKED, ..self }
        }
    }

    /// Returns whether the peak of a phase function is cut off.
    pub fn cuts(self, phase: &Phase) -> bool {
        self.of(phase).peaked > 0
    }

    /// Returns the number of directions for a phase function.
    pub fn count(self, phase: &Phase) -> usize {
        self.of(phase).directions(phase).0
    }

    /// Returns the number of directions, and the share of the phase function that goes straight on.
    fn directions(&self, phase: &Phase) -> (usize, f64) {
        if self.peaked > 0 {
            return (self.peaked, phase.moment(2 * self.peaked));
        }
        (directions::needed(phase, self.faintest).max(self.directions), 0.0)
    }
}

/// Maximum relative error of an exact answer that draws are compared with.
const BLURRED: f64 = 1e-4;
/// The smallest exact answer: below, the fourth power of a draw's mean is no double of full length.
pub const FAINT: f64 = 1e-70;

/// Returns whether an answer is known well enough for a comparison with draws.
pub fn is_sharp(known: Known) -> bool {
    known.value >= FAINT && known.error <= BLURRED * known.value
}

/// Returns whether answers of different resolutions give the error of an exact one: by more and more directions, or
/// with a forward peak cut off. A backward peak is resolved for Henyey–Greenstein of g ≥ −0.935.
pub fn resolves(phase: &Phase) -> bool {
    let Resolution { peaked, .. } = Resolution::FINE;
    let is_forward = phase.moment(2 * peaked + 1) > 0.0;
    is_forward || directions::are_enough(phase, Resolution::FINE.coarser(6).faintest, peaked)
}

/// The error of a first layer of optical depth u, doubled to τ, is about `13 τ u`.
const FIRST_LAYER: f64 = 13.0;
/// Relative rounding error of fifty doublings of a hundred directions: twice the measured loss of energy without
/// absorption.
const ROUNDING: f64 = 2e-13;
/// Factor of the difference to an answer with three quarters of the directions; [`Resolution::gains`] has those of
/// five eighths and of half of them. Of 160 random slabs, 1e-4 to 10 thick, two exceeded the first difference
/// alone, with a factor of 1, as did one of 128 others, by five times. With five eighths of thirty-two, divided by
/// twelve, no more than 0.72 was reached.
const SAFETY: f64 = 2.0;
/// Depth of a thick slab: in thicker ones rounding adds up: of 1500 answers one deviated by twice the sum at a depth
/// of 77.
const THICK: f64 = 5.0;
/// Values of [`Resolution::gains`] for errors that fall only as `1/n`.
const SLOW: [f64; 2] = [0.6, 4.0];
/// Values of [`Resolution::gains`] where a forward peak is cut off. In slabs of g = 0.9 at 48 directions the
/// differences to 30 and to 24 directions are at least 20 and 160 times the error.
const PEAKED: [f64; 2] = [6.0, 40.0];
/// Bisections of the depth at which fewer directions give the answer of all of them.
const BISECTIONS: u32 = 24;
/// Maximum error of an optical depth, relative to a share, for which a bound that holds for all slabs is good enough.
const OF_DEPTH: f64 = 1e-9;
/// Maximum number of doublings: beyond, a share of the slab is lost in rounding.
const MAX_DOUBLINGS: f64 = 100.0;

/// Shares of lights on a stack of layers, from above; `None` where a share is infinite.
pub fn solve(
    phase: &Phase,
    lights: &[IncidentLight],
    slices: &[Kernel],
    resolution: Resolution,
) -> Option<Vec<EnergyBounds>> {
    cache::STACKS.get(cache::of_stack(phase, lights, slices, resolution), || {
        let known = resolved(phase, lights, slices, resolution)?;
        let answer = |(i, &light): (usize, &IncidentLight)| {
            let grazing = thin::grazing(phase, light, slices);
            EnergyBounds::each(|of: fn(&Energy) -> &f64| {
                known(i, 1.0, grazing, &|energy| *of(energy))
            })
        };
        Some(lights.iter().enumerate().map(answer).collect())
    })
}

/// Factorial moments `E[M(M − 1)…(M − k + 1)]`, k = 1 … 4, of the number of collisions of each light, given layers in
/// which every collision has a mark and scores 1. Doubles have the first only, the others are infinite. `None` where
/// a moment is infinite.
pub fn factorial_moments<S: Scalar>(
    phase: &Phase,
    lights: &[IncidentLight],
    slices: &[Kernel<S>],
    resolution: Resolution,
) -> Option<Vec<[Known; 4]>> {
    cache::COUNTS.get(cache::of_stack(phase, lights, slices, resolution), || {
        let known = resolved(phase, lights, slices, resolution)?;
        let of_light = |i: usize| {
            factorial::<S>(|k| {
                // Next to criticality a relative error x of the mean is one of (2k + 1)x.
                let amplified = (2 * k + 1) as f64;
                known(i, amplified, Grazing::UNKNOWN, &|shares| shares.score.term(k))
            })
        };
        Some((0..lights.len()).map(of_light).collect())
    })
}

/// Factorial moments from the coefficients of a score.
fn factorial<S: Scalar>(coefficient: impl Fn(usize) -> Known) -> [Known; 4] {
    let mut factorial = 1.0;
    std::array::from_fn(|k| {
        factorial *= (k + 1) as f64;
        if k < S::TERMS { coefficient(k) * factorial } else { Known::INFINITE }
    })
}

/// A number that is made of the shares of a light.
type Functional<'f, S> = dyn Fn(&Shares<S>) -> f64 + 'f;

/// Solves a stack of layers at four resolutions and returns a function. From the shares of a light it makes a number
/// and its error, in which that of the first layer is multiplied by a factor. In a thin slab the error of the
/// directions exceeds their difference by no more than a bound on what grazes.
fn resolved<S: Scalar>(
    phase: &Phase,
    lights: &[IncidentLight],
    slices: &[Kernel<S>],
    resolution: Resolution,
) -> Option<impl Fn(usize, f64, Grazing, &Functional<'_, S>) -> Known> {
    let resolution = resolution.of(phase);
    let at = |resolution| energies_at(phase, lights, slices, resolution);
    let fine = at(resolution)?;
    let [of_coarsest, of_half] = resolution.gains;
    // Each coarser answer, and the factor of its difference. With fewer directions the series may diverge by mistake.
    let others =
        [(6, SAFETY), (5, 1.0 / of_coarsest), (4, 1.0 / of_half)].map(|(eighths, factor)| {
            let other = resolution.coarser(eighths);
            match at(other) {
                Some(result) => Some((result, factor)),
                None => thicker(phase, lights, slices, [resolution, other], factor, &fine)
                    .map(|result| (result, 1.0)),
            }
        });
    let depth: f64 = slices.iter().map(|slice| slice.rate * slice.lost().leading()).sum();
    let thick = (depth / THICK).max(1.0);
    let thin = thin::factor(depth);
    Some(move |i: usize, amplified: f64, grazing: Grazing, of: &Functional<'_, S>| {
        // Known errors are added: of the first layer, of rounding, and of doubles that have fewer digits.
        let fine = of(&fine[i]);
        let difference = |other: &Option<(Vec<Shares<S>>, f64)>| match other {
            Some((result, factor)) => factor * (fine - of(&result[i])).abs(),
            None => f64::INFINITY,
        };
        let differences = others.iter().map(difference).fold(0.0, f64::max);
        let known = amplified * thick * (resolution.first_layer + ROUNDING) * fine.abs();
        let of_directions = (thin * differences).min(differences + grazing.bound(fine));
        Known::estimated(fine, of_directions + known + f64::MIN_POSITIVE)
    })
}

/// Shares of a slab that is thicker by the error of its critical depth; `None` where they are infinite.
///
/// For slabs in which the series diverges with fewer directions only, at the second of two resolutions. Next to a
/// critical depth the error of an answer is that of the depth:
///
/// ```text
/// 1 − δ        depth, relative to the slab's, at which fewer directions give the reflectance `fine`
/// 1 + factor δ  depth of the slab that is solved, relative to the slab's
/// ```
fn thicker<S: Scalar>(
    phase: &Phase,
    lights: &[IncidentLight],
    slices: &[Kernel<S>],
    [resolution, other]: [Resolution; 2],
    factor: f64,
    fine: &[Shares<S>],
) -> Option<Vec<Shares<S>>> {
    let at = |resolution, depth: f64| {
        let slices: Vec<Kernel<S>> =
            slices.iter().map(|slice| Kernel { rate: depth * slice.rate, ..*slice }).collect();
        energies_at(phase, lights, &slices, resolution)
    };
    let is_below = |depth: f64| {
        let result = at(other, depth);
        let reflected = |shares: &Shares<S>| shares.reflected.leading();
        result.is_some_and(|result| {
            result.iter().zip(fine).all(|(x, y)| reflected(x) <= reflected(y))
        })
    };
    let (mut low, mut high) = (0.5, 1.0);
    if !is_below(low) {
        return None;
    }
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if is_below(middle) { low = middle } else { high = middle }
    }
    at(resolution, 1.0 + factor * (1.0 - low))
}

/// Factorial moments at one resolution, see [`factorial_moments`]; their errors are those of rounding.
fn counts<S: Scalar>(
    phase: &Phase,
    lights: &[IncidentLight],
    slices: &[Kernel<S>],
    resolution: Resolution,
) -> Option<Vec<[Known; 4]>> {
    let result = energies_at(phase, lights, slices, resolution.of(phase))?;
    let of = |shares: &Shares<S>| factorial::<S>(|k| Known::exact(shares.score.term(k)));
    Some(result.iter().map(of).collect())
}

/// Shares at one resolution, without error bounds.
pub fn energies(
    phase: &Phase,
    lights: &[IncidentLight],
    slices: &[Kernel],
    resolution: Resolution,
) -> Option<Vec<Energy>> {
    energies_at(phase, lights, slices, resolution.of(phase))
}

/// Shares at a resolution that was made for the phase function.
fn energies_at<S: Scalar>(
    phase: &Phase,
    lights: &[IncidentLight],
    slices: &[Kernel<S>],
    resolution: Resolution,
) -> Option<Vec<Shares<S>>> {
    let result = layers(phase, lights, slices, resolution)?;
    Some(result.into_iter().map(|(energy, _)| energy).collect())
}

/// Shares for each light, and the light that would collide in a thin layer below, per optical depth of that layer.
fn layers<S: Scalar>(
    phase: &Phase,
    lights: &[IncidentLight],
    slices: &[Kernel<S>],
    resolution: Resolution,
) -> Option<Vec<(Shares<S>, f64)>> {
    let (count, peak) = resolution.directions(phase);
    let further: Vec<f64> = lights.iter().filter_map(|light| light.cosine()).collect();
    let directions = Directions::new(phase, count, &further, peak);
    // The peak goes straight on.
    let cut = |slice: &Kernel<S>| Kernel {
        straight: slice.straight + slice.scattered * peak,
        scattered: slice.scattered * (1.0 - peak),
        ..*slice
    };
    let slices: Vec<Kernel<S>> = slices.iter().map(cut).collect();
    let layer = stack(&directions, &slices, resolution.first_layer)?;
    let sum = |row: &mut dyn Iterator<Item = S>| row.fold(S::from(0.0), |sum, x| sum + x);
    let leaving = |i: usize| {
        let row = layer.scattered.row(i).zip(&directions.cosines);
        let scattered = sum(&mut row.map(|(scattered, &cosine)| scattered / cosine));
        scattered + layer.direct[i] / directions.cosines[i]
    };
    let mut row = count;
    let mut result = Vec::with_capacity(lights.len());
    for light in lights {
        let share = |f: &dyn Fn(usize) -> S| match light {
            IncidentLight::Collimated(_) => f(row),
            IncidentLight::Diffuse => {
                let nodes = directions.weights.iter().zip(&directions.cosines).enumerate();
                sum(&mut nodes.map(|(i, (weight, cosine))| f(i) * (2.0 * weight * cosine)))
            }
        };
        let shares = Shares {
            reflected: share(&|i| sum(&mut layer.reflected.row(i))),
            transmitted: share(&|i| sum(&mut layer.scattered.row(i)) + layer.direct[i]),
            score: share(&|i| layer.score[i]),
        };
        let colliding = share(&leaving).leading();
        row += usize::from(light.cosine().is_some());
        result.push((shares, colliding));
    }
    let is_finite = |(shares, _): &(Shares<S>, f64)| {
        let Shares { reflected, transmitted, score } = *shares;
        [reflected, transmitted, score]
            .iter()
            .all(|x| (0..S::TERMS).all(|index| x.term(index).is_finite()))
    };
    result.iter().all(is_finite).then_some(result)
}

/// The layers laid upon each other, the first on top.
fn stack<S: Scalar>(directions: &Directions, slices: &[Kernel<S>], error: f64) -> Option<Layer<S>> {
    let homogeneous = |slice: &Kernel<S>| {
        let [lost, scattered] = [slice.lost(), slice.scattered].map(|x| x.leading().abs());
        let depth = slice.rate * lost.max(scattered);
        let doublings = (FIRST_LAYER * depth * depth.max(1.0) / error).log2().ceil();
        #[allow(clippy::cast_possible_truncation)] // a small number
        let doublings = doublings.clamp(0.0, MAX_DOUBLINGS) as i32;
        Layer::homogeneous(directions, slice, doublings)
    };
    let (last, above) = slices.split_last()?;
    let mut stack = homogeneous(last)?;
    for slice in above.iter().rev() {
        stack = homogeneous(slice)?.over(&stack)?;
    }
    Some(stack)
}

/// Reflectance and transmittance of a slab of optical depth τ and albedo a; the score is the expected
/// number of collisions. `None` where they are infinite, which takes an albedo above 1.
pub fn answers(
    phase: &Phase,
    lights: &[IncidentLight],
    depth: Known,
    albedo: f64,
) -> Option<Vec<EnergyBounds>> {
    if albedo == 0.0 {
        return Some(lights.iter().map(|&light| thin::black(light, depth)).collect());
    }
    let slice = Kernel { rate: depth.value, straight: 0.0, scattered: albedo, score: 1.0 };
    let answers = solve(phase, lights, &[slice], Resolution::FINE)?;
    let resolution = Resolution { first_layer: 1e-6, ..Resolution::FINE };
    let is_faint = |answer: &EnergyBounds| {
        [answer.reflected, answer.transmitted].iter().any(|x| depth.error > OF_DEPTH * x.value)
    };
    let colliding = (albedo <= 1.0 && answers.iter().any(is_faint))
        .then(|| layers(phase, lights, &[slice], resolution.coarser(4).of(phase)))
        .flatten();
    let blurred = |(i, (answer, light)): (usize, (EnergyBounds, &IncidentLight))| {
        // A layer of optical depth δ more has light from all directions, and changes no share by more than the
        // light that collides in it.
        let steepest = light.cosine().map_or(6.0, |cosine| 4.0 + 1.0 / cosine);
        // Below the slab that is the light that leaves there; half of the directions give it within a factor of 2.
        let below = colliding.as_ref().map_or(steepest, |result| 2.0 * result[i].1);
        let with = |known: Known, slope| known.blurred(slope * depth.error);
        let shares = thin::by_orders(phase, *light, depth.value, albedo)
            .unwrap_or([answer.reflected, answer.transmitted]);
        let [reflected, transmitted] = shares.map(|known| with(known, steepest.min(below)));
        EnergyBounds { reflected, transmitted, score: with(answer.score, steepest) }
    };
    Some(answers.into_iter().zip(lights).enumerate().map(blurred).collect())
}
