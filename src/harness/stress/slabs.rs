//! Slabs: adding and doubling against itself with more directions, and against discrete ordinates.
//!
//! Where light is scattered evenly, the equations of N directions have solutions that fall and grow
//! like `e^{±kt}`, one to each root k of a secular equation: depth enters exactly, and nothing is added
//! or doubled.
//!
//! ```text
//! a Σ wᵢ/(1 − k²μᵢ²) = 1,   J(t) = Σⱼ αⱼ e^{−kⱼt} + βⱼ e^{−kⱼ(τ−t)},   I = 1 above, I = 0 below
//! R(μ₀) = ∫ J(t) e^{−t/μ₀} dt/μ₀,   T(μ₀) = e^{−τ/μ₀} + ∫ J(t) e^{−(τ−t)/μ₀} dt/μ₀
//! ```
//!
//! Light from all sides (I = 1) answers for a ray from μ₀, because paths can be turned round. The roots
//! lie between `1/μ` of neighbours and are bisected in 32 digits, in which the linear equations are
//! solved, too.
//!
//! Source: S. Chandrasekhar, *Radiative Transfer* (Oxford University Press, 1950), chapters 2, 3 and 7.

use super::rods::{of_stated, share};
use super::{Dice, Effort, Measure, Row, in_parts};
use crate::numeric::quadrature::GaussLegendre;
use crate::numeric::{Known, Wide};
use crate::phase::{
    Phase, henyey_greenstein::HenyeyGreenstein, isotropic::Isotropic, rayleigh::Rayleigh,
};
use crate::problems::slab::Light;
use crate::theory::slab;
use crate::theory::slab::{Resolution, layer::Slice};

const PARTS: u64 = 16;
/// Directions of the ordinates.
const ORDINATES: usize = 72;

/// Lights on one slab.
const LIGHTS: usize = 8;

/// All rows.
#[must_use]
pub fn rows(effort: Effort, seed: u64) -> Vec<Row> {
    in_parts(PARTS, |part| {
        let dice = &mut Dice::new(seed, "slabs", part);
        let some = effort.of(u32::from(part % 8 == 0), 3);
        vec![finer(dice, some), even(dice, effort.of(u32::from(part % 4 == 0), 4))]
    })
}

/// From all sides, and from near and far of the normal.
fn lights(dice: &mut Dice) -> Vec<Light> {
    let mut lights = vec![Light::Diffuse];
    while lights.len() < LIGHTS {
        let grazes = dice.below(3) == 0;
        let cosine = if grazes { dice.sized(-4.0, -1.0) } else { dice.between(0.05, 1.0) };
        lights.push(Light::Collimated(cosine));
    }
    lights
}

fn phase(dice: &mut Dice) -> Phase {
    let asymmetry = dice.between(-0.7, 0.7);
    match dice.below(4) {
        0 => Phase::Isotropic(Isotropic),
        1 => Phase::Rayleigh(Rayleigh),
        _ => {
            let phase = HenyeyGreenstein::new(asymmetry).map(Phase::HenyeyGreenstein);
            phase.unwrap_or(Phase::Isotropic(Isotropic))
        }
    }
}

fn see(row: &mut Row, found: &slab::Answer, exact: [Wide; 3], place: &dyn Fn() -> String) {
    let found = [found.reflected, found.transmitted, found.score];
    for (found, exact) in found.into_iter().zip(exact) {
        row.see(of_stated(found, exact), place);
    }
}

/// Adding and doubling with more directions and a thinner first layer.
fn finer(dice: &mut Dice, trials: u32) -> Row {
    let range = "τ = 1e-6 … 100, μ₀ = 1e-4 … 1, |g| to 0.7; twice the resolution";
    let mut row = Row::new("slab, adding and doubling", range, Measure::OfStated, 1.0);
    let finer = Resolution { faintest: 1e-14, directions: 72, first_layer: 1e-14 };
    for _ in 0..trials {
        let (depth, albedo) = (dice.sized(-6.0, 2.0), share(dice));
        let (phase, lights) = (phase(dice), lights(dice));
        let slice = Slice { flown: depth, straight: 0.0, scattered: albedo, score: 1.0 };
        let found = slab::answers(&phase, &lights, Known::exact(depth), albedo);
        let fine = slab::energies(&phase, &lights, &[slice], finer);
        let place = |light: &Light| {
            let light = *light;
            move || format!("τ = {depth:e}, a = {albedo:e}, {light:?}, {phase:?}")
        };
        let Some((found, fine)) = found.zip(fine) else {
            row.see(f64::NAN, place(&lights[0]));
            continue;
        };
        for ((found, fine), light) in found.iter().zip(fine).zip(&lights) {
            let exact = [fine.reflected, fine.transmitted, fine.score].map(Wide::from);
            see(&mut row, found, exact, &place(light));
        }
    }
    row
}

/// Isotropic scattering by discrete ordinates.
fn even(dice: &mut Dice, trials: u32) -> Row {
    let range = "isotropic, τ = 1e-2 … 100, μ₀ = 1e-4 … 1; discrete ordinates, 32 digits";
    let mut row = Row::new("slab, another method", range, Measure::OfStated, 1.0);
    for _ in 0..trials {
        let (depth, albedo) = (dice.sized(-2.0, 2.0), share(dice));
        let (phase, lights) = (Phase::Isotropic(Isotropic), lights(dice));
        let place = |light: &Light| {
            let light = *light;
            move || format!("τ = {depth:e}, a = {albedo:e}, {light:?}")
        };
        let found = slab::answers(&phase, &lights, Known::exact(depth), albedo);
        // At a = 0 and a = 1 two solutions are one: a grain beside it, 1e-20, nobody sees.
        let grain = Wide::from(1e-20);
        let near = match albedo {
            0.0 => grain,
            1.0 => Wide::ONE - grain,
            inside => Wide::from(inside),
        };
        let exact = Ordinates::new(depth, near, ORDINATES);
        let Some((found, exact)) = found.zip(exact) else {
            row.see(f64::NAN, place(&lights[0]));
            continue;
        };
        for (found, light) in found.iter().zip(&lights) {
            let [r, t] = exact.energy(*light);
            let lost = Wide::ONE - near;
            // Collisions are what is absorbed over 1 − a, of which a white slab leaves no digits.
            let score = (Wide::ONE - r - t) / lost;
            let score = if lost.high > 1e-9 { score } else { Wide::from(found.score.value) };
            see(&mut row, found, [r, t, score], &place(light));
        }
    }
    row
}

/// Directions and the solutions in them.
struct Ordinates {
    depth: Wide,
    cosines: Vec<Wide>,
    weights: Vec<Wide>,
    /// k, α and β.
    parts: Vec<[Wide; 3]>,
}

impl Ordinates {
    /// `None` where the linear equations have no solution.
    fn new(depth: f64, albedo: Wide, count: usize) -> Option<Self> {
        let (cosines, weights) = directions(count);
        let roots = roots(albedo, &cosines, &weights);
        let depth = Wide::from(depth);
        // Light from both sides alike, and of opposite signs: their halves add up to that from above.
        let solutions = [Wide::ONE, -Wide::ONE].map(|sign| {
            let entry = |mu: Wide, k: Wide| {
                let far = (-(k * depth)).exp() / (Wide::ONE + k * mu);
                Wide::ONE / (Wide::ONE - k * mu) + sign * far
            };
            let row = |&mu: &Wide| {
                let entries = roots.iter().map(|&k| entry(mu, k));
                entries.chain([Wide::ONE]).collect()
            };
            solved(cosines.iter().map(row).collect())
        });
        let [same, opposite] = solutions;
        let parts = roots.iter().zip(same?).zip(opposite?);
        let parts = parts.map(|((&k, a), b)| [k, (a + b).scaled(-1), (a - b).scaled(-1)]);
        Some(Self { depth, parts: parts.collect(), cosines, weights })
    }

    /// R and T of a ray.
    fn leaving(&self, cosine: Wide) -> [Wide; 2] {
        let straight = (-(self.depth / cosine)).exp();
        let mut leaving = [Wide::default(), straight];
        for &[k, alpha, beta] in &self.parts {
            let faint = (-(k * self.depth)).exp();
            let near = (Wide::ONE - faint * straight) / (Wide::ONE + k * cosine);
            let away = Wide::ONE - k * cosine;
            let x = away * self.depth / cosine;
            // (e^{−kτ} − e^{−τ/μ})/(1 − kμ), also where both are nearly one.
            let far = if x.high.abs() < 0.1 && x.high != 0.0 {
                straight * (self.depth / cosine) * (x.exp_m1() / x)
            } else {
                (faint - straight) / away
            };
            leaving[0] += alpha * near + beta * far;
            leaving[1] += beta * near + alpha * far;
        }
        leaving
    }

    fn energy(&self, light: Light) -> [Wide; 2] {
        if let Light::Collimated(cosine) = light {
            return self.leaving(Wide::from(cosine));
        }
        let mut sums = [Wide::default(); 3];
        for (&mu, &weight) in self.cosines.iter().zip(&self.weights) {
            let [r, t] = self.leaving(mu);
            for (sum, x) in sums.iter_mut().zip([r, t, Wide::ONE]) {
                *sum += mu * weight * x;
            }
        }
        [sums[0] / sums[2], sums[1] / sums[2]]
    }
}

/// `μ = x³` of Gauss' nodes, dense where light grazes, from the steepest to the most grazing, and weights.
pub(super) fn directions(count: usize) -> (Vec<Wide>, Vec<Wide>) {
    let rule = GaussLegendre::new(count);
    let nodes = rule.nodes.iter().zip(&rule.weights).rev();
    let (cosines, weights): (Vec<Wide>, Vec<Wide>) = nodes
        .map(|(&x, &w)| (Wide::from(x).powi(3), Wide::from(3.0 * w) * Wide::from(x).powi(2)))
        .unzip();
    let whole: Wide = weights.iter().copied().sum();
    (cosines, weights.into_iter().map(|w| w / whole).collect())
}

/// One k between 0 and the first `1/μ`, and one between each two.
pub(super) fn roots(albedo: Wide, cosines: &[Wide], weights: &[Wide]) -> Vec<Wide> {
    let left = |k: Wide| {
        let term = |(&mu, &w): (&Wide, &Wide)| w / (Wide::ONE - (k * mu).powi(2));
        Wide::ONE - albedo * cosines.iter().zip(weights).map(term).sum::<Wide>()
    };
    let mut from = Wide::default();
    let between = cosines.iter().map(|&mu| {
        let (mut low, mut high) = (from, Wide::ONE / mu);
        from = high;
        for _ in 0..110 {
            let middle = (low + high).scaled(-1);
            if left(middle).high > 0.0 { low = middle } else { high = middle }
        }
        (low + high).scaled(-1)
    });
    between.collect()
}

/// The solution of equations whose rows end with their right sides, by elimination with the largest pivot
/// of a column.
pub(super) fn solved(mut rows: Vec<Vec<Wide>>) -> Option<Vec<Wide>> {
    let n = rows.len();
    for column in 0..n {
        let size = |i: &usize| rows[*i][column].high.abs();
        let pivot = (column..n).max_by(|i, j| size(i).total_cmp(&size(j)))?;
        rows.swap(column, pivot);
        let (done, below) = rows.split_at_mut(column + 1);
        let first = &done[column];
        if first[column].high == 0.0 {
            return None;
        }
        for row in below {
            let factor = row[column] / first[column];
            for (x, &y) in row.iter_mut().zip(first).skip(column) {
                *x = *x - factor * y;
            }
        }
    }
    let mut solution = vec![Wide::default(); n];
    for i in (0..n).rev() {
        let known: Wide = (i + 1..n).map(|j| rows[i][j] * solution[j]).sum();
        solution[i] = (rows[i][n] - known) / rows[i][i];
    }
    Some(solution)
}
