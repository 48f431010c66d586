//! Rods of coloured scatterers, by the [closed form](super::closed) of each albedo.
//!
//! `T_r`, the probability to leave after r scatterings that never absorb, are the coefficients of T(a), found on the
//! circle |a| = 1.

use std::f64::consts::TAU;

use num_complex::Complex64;

use super::closed::{self, continued, critical, leaving};
use super::moments;
use super::walk::RodWalk;
use crate::colours::scatterers::{BodyEnergies, Divergence, Orders};
use crate::problems::rod::channels;
use crate::problems::{Problem, Rod, SpectralRod};
use crate::{CountDistribution, Mesh, ParticleRule, colours};
use media::Piecewise;
use numeric::Known;

/// Relative rounding error of a sum over orders of scattering.
const ROUNDING: f64 = 1e-13;
/// Maximum probability of orders of scattering that are left out.
const RARE: f64 = 1e-17;
/// Relative error of an albedo that is a product of powers, in units of ε.
const OF_ALBEDO: f64 = 16.0;
/// Maximum number of orders of scattering.
const MAX_ORDERS: usize = 8192;
/// Rounding of the values on the circle |a| = 1, and of sums over it, in units of ε times the largest.
const OF_ORDERS: f64 = 16.0;
/// Maximum albedo.
const LARGEST: f64 = 1e6;

/// A rod with its mesh and σ̂.
pub struct Rods<'a> {
    rod: &'a SpectralRod,
    mesh: &'a Mesh,
    sampling: &'a Piecewise,
    depth: Known,
}

impl<'a> Rods<'a> {
    /// Joins the parts.
    pub fn new(rod: &'a SpectralRod, mesh: &'a Mesh, sampling: &'a Piecewise) -> Self {
        let depth = rod.medium().optical_depth(rod.medium().support());
        Self { rod, mesh, sampling, depth }
    }
}

impl BodyEnergies for Rods<'_> {
    fn leaving(&self, albedo: f64) -> Option<[Known; 2]> {
        closed::known(self.depth, albedo, self.rod.forward, OF_ALBEDO)
    }

    fn divergence(&self, albedo: f64) -> Option<Divergence> {
        let critical = critical(albedo, self.rod.forward);
        if self.depth.value >= critical {
            return Some(Divergence::BeyondLength { critical });
        }
        self.leaving(albedo).is_none().then_some(Divergence::Overflow)
    }

    fn orders(&self) -> Option<Orders> {
        let (result, each) = orders(self.depth.value, self.rod.forward)?;
        Some(Orders { result, error: ROUNDING, each, blur: self.depth.error })
    }

    fn lookups(&self, heroes: &[(f64, f64)]) -> Option<CountDistribution> {
        let of = |albedo: f64| {
            let [albedo, forward] =
                [albedo, self.rod.forward].map(|x| Piecewise::constant(x, self.mesh.support()));
            let medium = self.rod.medium().clone();
            let rod = Rod::new(medium, &albedo, &forward, channels(0, false, None));
            let walk = RodWalk::new(self.mesh, &rod, Some(self.sampling), ParticleRule::Analog);
            walk.known(0, &|line| Some(moments::lookups(line)?.to_vec()))?.try_into().ok()
        };
        let each = heroes.iter().map(|&(weight, albedo)| Some((weight, of(albedo)?)));
        colours::mixed(each.collect::<Option<Vec<_>>>()?).map(CountDistribution::of_factorial)
    }
}

/// Number of orders of scattering above which each is rarer than `rare` in a rod of an albedo.
///
/// ```text
/// T_r + R_r ≤ (T(b) + R(b)) b^{−r}  for every b up to the albedo that makes this length critical
/// ```
pub fn orders_above(depth: f64, albedo: f64, forward: f64, rare: f64) -> usize {
    let (mut low, mut high) = (1.0, 2.0);
    while critical(high, forward) > depth && high < LARGEST {
        high *= 2.0;
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if critical(middle, forward) > depth { low = middle } else { high = middle }
    }
    let bounds = (1..64).filter_map(|i| {
        let larger = f64::powf(low, f64::from(i) / 64.0);
        let size: f64 = leaving(depth, larger, forward)?.iter().sum();
        size.is_finite().then(|| (size.max(1.0) / rare).ln() / (larger / albedo).ln())
    });
    let minimum = bounds.filter(|orders| *orders >= 0.0).fold(f64::INFINITY, f64::min);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    // Beyond the largest integer it saturates.
    let minimum = minimum.ceil() as usize;
    minimum.saturating_add(8)
}

/// The probabilities to leave a rod without absorption after r scatterings, and a bound on the absolute error of
/// each, from the rounding of sums over the circle; `None` where there are too many orders.
fn orders(depth: f64, forward: f64) -> Option<(Vec<[f64; 2]>, f64)> {
    let count = orders_above(depth, 1.0, forward, RARE);
    if count > MAX_ORDERS {
        return None;
    }
    let angle = |j: usize| TAU * j as f64 / count as f64;
    // T(ā) is the conjugate of T(a): half the circle is enough.
    let half: Vec<[Complex64; 2]> = (0..=count / 2)
        .map(|j| continued(depth, Complex64::from_polar(1.0, angle(j)), forward))
        .collect();
    let turn: Vec<Complex64> = (0..count).map(|j| Complex64::from_polar(1.0, -angle(j))).collect();
    let order = |r: usize| {
        let mut sum = [0.0; 2];
        for (j, values) in half.iter().enumerate() {
            let weight = if j == 0 || 2 * j == count { 1.0 } else { 2.0 };
            for (sum, value) in sum.iter_mut().zip(values) {
                *sum += weight * (value * turn[j * r % count]).re;
            }
        }
        sum.map(|sum| (sum / count as f64).max(0.0))
    };
    let largest = half.iter().flatten().fold(0.0, |maximum: f64, value| maximum.max(value.norm()));
    Some(((0..count).map(order).collect(), OF_ORDERS * f64::EPSILON * largest + RARE))
}
