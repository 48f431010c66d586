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
//! Where only `r = σ_t/σ̂` matters at a tentative collision, the k-th moments of a walk are reflectance
//! and transmittance of another slab: `∫σ̂(1 − Q_k)` thick, of albedo `S_k/(1 − Q_k)`, which may exceed
//! 1, see [`crate::particle`]. It may also be too thick for that albedo: then the moment is
//! infinite.
//!
//! Source: H. C. van de Hulst, *Multiple Light Scattering* (Academic Press, 1980), chapters 4 and 9.

pub mod cache;
pub mod directions;
pub mod layer;
pub mod orders;
pub mod pieces;
pub mod walk;

use crate::problems::slab::Light;
use media::phase::Phase;
use numeric::Known;

use directions::Directions;
use layer::{Layer, Slice};

pub use cache::cached;
pub use pieces::{Piece, Pieces};
pub use walk::{Existence, Walk};

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
pub type Answer = Shares<Known>;

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

impl Answer {
    /// No answer.
    pub const UNKNOWN: Self = {
        let nothing = Known { value: f64::NAN, error: f64::INFINITY };
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
}

impl Resolution {
    /// Resolution of exact answers: 1e-10, 1e-8 for Henyey–Greenstein of g = 0.9, and mostly far better.
    pub const FINE: Self =
        Self { faintest: 1e-11, directions: 32, first_layer: 3e-14, gains: [12.0, 400.0] };
    /// Resolution of moments: 1e-4 and mostly far better. With few directions, errors for grazing light in thin
    /// slabs may fall only as `1/n`: the answer with five eighths of them then differs by 8/5 − 1 times the error.
    /// Elsewhere errors oscillate, and those of sixteen, twelve and ten directions may agree by accident. Half of
    /// the directions have errors that are ten to a hundred times larger, and show it.
    pub const COARSE: Self =
        Self { faintest: 1e-5, directions: 16, first_layer: 1e-10, gains: [0.6, 4.0] };
    /// Resolution of moments where r varies, which need a hundred layers and more, and for differences.
    pub const LAYERED: Self =
        Self { faintest: 1e-4, directions: 12, first_layer: 1e-7, gains: [0.6, 4.0] };

    fn coarser(self) -> Self {
        Self {
            faintest: self.faintest.powf(0.75),
            directions: self.directions * 3 / 4,
            first_layer: 4.0 * self.first_layer,
            ..self
        }
    }

    fn coarsest(self) -> Self {
        // A sharp phase function needs more directions by its Legendre moments: five eighths of those, too.
        let faintest = self.faintest.powf(0.625);
        Self { faintest, directions: self.directions * 5 / 8, ..self.coarser() }
    }

    fn half(self) -> Self {
        let faintest = self.faintest.sqrt();
        Self { faintest, directions: self.directions / 2, ..self.coarser() }
    }
}

/// Returns true if two answers of different resolution give the error of an exact one: not where both would have
/// the maximum number of directions, as for Henyey–Greenstein of |g| > 0.935.
pub fn resolves(phase: &Phase) -> bool {
    directions::are_enough(phase, Resolution::FINE.coarser().faintest)
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
/// Depth of a thin slab: in thinner ones light grazes between the directions of all answers. Differences get the
/// further factor of this over the depth: of 4600 answers some exceeded them, by three times, from 5e-3 down.
const THIN: f64 = 1e-2;
/// Depth of a thick slab: in thicker ones rounding adds up: of 1500 answers one deviated by twice the sum at a depth
/// of 77.
const THICK: f64 = 5.0;
/// Maximum number of doublings: beyond, a share of the slab is lost in rounding.
const MOST_DOUBLINGS: f64 = 100.0;

/// Shares of lights on a stack of layers, from above; `None` where a share is infinite.
pub fn solve(
    phase: &Phase,
    lights: &[Light],
    slices: &[Slice],
    resolution: Resolution,
) -> Option<Vec<Answer>> {
    let at = |resolution| energies(phase, lights, slices, resolution);
    let fine = at(resolution)?;
    let coarse = at(resolution.coarser())?;
    let coarsest = at(resolution.coarsest())?;
    // With few directions the series may diverge by mistake.
    let half = at(resolution.half());
    let depth: f64 = slices.iter().map(|slice| slice.flown * slice.lost()).sum();
    let thick = (depth / THICK).max(1.0);
    let thin = if depth > 0.0 { (THIN / depth).max(1.0) } else { 1.0 };
    let answer = |i: usize| {
        // Known errors of the first layer and of rounding are added.
        Answer::each(|of: fn(&Energy) -> &f64| {
            let [fine, coarse, coarsest] = [&fine[i], &coarse[i], &coarsest[i]].map(|all| *of(all));
            let half = half.as_ref().map_or(fine, |half| *of(&half[i]));
            let [of_coarsest, of_half] = resolution.gains;
            let differences = (SAFETY * (fine - coarse).abs())
                .max((fine - coarsest).abs() / of_coarsest)
                .max((fine - half).abs() / of_half);
            Known::new(
                fine,
                thin * differences + thick * (resolution.first_layer + ROUNDING) * fine.abs(),
            )
        })
    };
    Some((0..lights.len()).map(answer).collect())
}

/// Shares at one resolution, without error bounds.
pub fn energies(
    phase: &Phase,
    lights: &[Light],
    slices: &[Slice],
    resolution: Resolution,
) -> Option<Vec<Energy>> {
    let count = directions::needed(phase, resolution.faintest).max(resolution.directions);
    let further: Vec<f64> = lights.iter().filter_map(|light| light.cosine()).collect();
    let directions = Directions::new(phase, count, &further);
    let layer = stack(&directions, slices, resolution.first_layer)?;
    let mut row = count;
    let mut found = Vec::with_capacity(lights.len());
    for light in lights {
        let share = |f: &dyn Fn(usize) -> f64| match light {
            Light::Collimated(_) => f(row),
            Light::Diffuse => {
                let nodes = directions.weights.iter().zip(&directions.cosines);
                nodes.enumerate().map(|(i, (weight, cosine))| 2.0 * weight * cosine * f(i)).sum()
            }
        };
        let energy = Energy {
            reflected: share(&|i| layer.reflected.row(i).iter().sum()),
            transmitted: share(&|i| layer.scattered.row(i).iter().sum::<f64>() + layer.direct[i]),
            score: share(&|i| layer.score[i]),
        };
        row += usize::from(light.cosine().is_some());
        found.push(energy);
    }
    let is_finite = |energy: &Energy| {
        [energy.reflected, energy.transmitted, energy.score].iter().all(|x| x.is_finite())
    };
    found.iter().all(is_finite).then_some(found)
}

/// The layers laid upon each other, the first on top.
fn stack(directions: &Directions, slices: &[Slice], error: f64) -> Option<Layer> {
    let homogeneous = |slice: &Slice| {
        let depth = slice.flown * slice.lost().abs().max(slice.scattered.abs());
        let doublings = (FIRST_LAYER * depth * depth.max(1.0) / error).log2().ceil();
        #[allow(clippy::cast_possible_truncation)] // a small number
        let doublings = doublings.clamp(0.0, MOST_DOUBLINGS) as i32;
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
pub fn answers(phase: &Phase, lights: &[Light], depth: Known, albedo: f64) -> Option<Vec<Answer>> {
    let slice = Slice { flown: depth.value, straight: 0.0, scattered: albedo, score: 1.0 };
    let answers = solve(phase, lights, &[slice], Resolution::FINE)?;
    let blurred = |(answer, light): (Answer, &Light)| {
        // A layer of optical depth δ more has light from all directions, and changes no share by more than the
        // light that collides in it.
        let steepest = light.cosine().map_or(6.0, |cosine| 4.0 + 1.0 / cosine);
        Answer::each(|of: fn(&Answer) -> &Known| {
            let known = of(&answer);
            Known::new(known.value, known.error + steepest * depth.error)
        })
    };
    Some(answers.into_iter().zip(lights).map(blurred).collect())
}
