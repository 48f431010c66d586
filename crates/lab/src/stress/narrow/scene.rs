//! The medium of three waves, and what theory says of estimators in it.

use super::Stated;
use crate::stress::fields::{Field, Line};
use media::Extinction;
use numeric::Lane;
use numeric::quadrature::GaussLegendre;
use theory::volterra::{self, Source};
use theory::{Mesh, Rule};

/// A ray of length 1 through the waves.
#[derive(Debug, Clone, Copy)]
pub struct Scene {
    /// τ, which is also the mean of σ_t.
    pub depth: f64,
    /// ∫σ̂.
    pub collisions: f64,
    /// t₀.
    pub from: f64,
    /// σ̂ of each cell: as many collisions, shared like the largest σ_t.
    pub majorants: [f64; CELLS],
    /// Theory of cases.
    pub stated: Stated,
}

/// One over the period of the waves, times 2π.
pub const FREQUENCY: f64 = 6.0 * std::f64::consts::PI;
/// Their amplitude.
const WAVE: f64 = 0.8;
/// The cells of local majorants.
pub const CELLS: usize = 12;

impl Extinction for Scene {
    #[inline(always)]
    fn extinction<L: Lane>(&self, t: L) -> L {
        let wave = ((t - self.from) * FREQUENCY).sin();
        (wave * WAVE + 1.0) * self.depth
    }
}

impl Scene {
    /// Of an optical depth, a number of collisions and a distance from the origin; without theory of cases.
    pub fn new(depth: f64, collisions: f64, from: f64) -> Self {
        let scene = Self { depth, collisions, from, majorants: [0.0; CELLS], stated: |_, _| None };
        let width = 1.0 / CELLS as f64;
        let most: [f64; CELLS] = std::array::from_fn(|cell| {
            let place = |i: i32| (cell as f64 + f64::from(i) / 64.0) * width;
            (0..=64).map(|i| scene.at(place(i))).fold(0.0, f64::max)
        });
        let mean = most.iter().sum::<f64>() * width;
        Self { majorants: most.map(|most| collisions * most / mean), ..scene }
    }

    /// σ_t at a share of the ray.
    fn at(&self, share: f64) -> f64 {
        self.extinction(self.from + share)
    }

    /// T.
    pub fn transmittance(&self) -> f64 {
        (-self.depth).exp()
    }

    /// The least σ_t.
    pub fn least(&self) -> f64 {
        (1.0 - WAVE) * self.depth
    }

    /// `∫₀^s σ_t`, in closed form.
    #[inline(always)]
    pub fn depth_to<L: Lane>(&self, s: L) -> L {
        let wave = s.each(1.0) - (s * FREQUENCY).cos();
        (s + wave * (WAVE / FREQUENCY)) * self.depth
    }

    /// The mean of σ_t between two places.
    #[inline(always)]
    pub fn mean<L: Lane>(&self, one: L, other: L) -> L {
        let half = (other - one) * (0.5 * FREQUENCY);
        let middle = (one + other) * 0.5 - self.from;
        let is_near = half.size().at_most(half.each(1e-4));
        let sinc = L::select(is_near, half.each(1.0), half.sin() / half);
        ((middle * FREQUENCY).sin() * sinc * WAVE + 1.0) * self.depth
    }

    /// σ_t along z as a case writes it, `= { … }` to follow a medium's name.
    pub fn sines(&self, frequencies: &str) -> String {
        format!(
            "{{ base = {:e}, amplitudes = [{:e}], {frequencies}, phases = [0] }}",
            self.depth,
            WAVE * self.depth
        )
    }

    /// `V/T²` of a product estimator, `expm1 ∫σ̂ E[(1 − W)²]`.
    pub fn of_product(&self, control: f64, rule: &dyn Rule) -> f64 {
        let loss = |s: f64| {
            let ratio = (self.at(s) - control) / self.collisions;
            rule.outcome(ratio).mean_loss(2)
        };
        (self.collisions * integral(loss)).exp_m1()
    }

    /// The same of ratio tracking with local majorants: `expm1 ∫σ_t²/σ̂`.
    pub fn of_cells(&self) -> f64 {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a share of the cells
        let cell = |s: f64| ((s * CELLS as f64) as usize).min(CELLS - 1);
        integral(|s| self.at(s).powi(2) / self.majorants[cell(s)]).exp_m1()
    }

    /// The same of next-flight and unidirectional MIS; `None` where theory has lost it.
    pub fn of_source(&self, source: &dyn Source) -> Option<f64> {
        let waves = vec![[WAVE * self.depth, FREQUENCY, 0.0]];
        let field = Field::Sines { base: self.depth, waves };
        let mesh = Mesh::new(Line { field, from: 0.0, to: 1.0 }.medium());
        let found = volterra::predict(&mesh, self.collisions, source);
        found.channels[0].moments.map(|moments| moments.relative[0])
    }

    /// Mean and `V/m²` of the distance flown, at most 1: `E[s^k] = ∫ k s^{k−1} T ds`.
    pub fn of_distance(&self) -> [f64; 2] {
        let alive = |s: f64| (-self.depth_to(s)).exp();
        let (mean, square) = (integral(alive), integral(|s| 2.0 * s * alive(s)));
        [mean, square / (mean * mean) - 1.0]
    }
}

/// `∫₀¹`, in panels that are shorter where much is lost at the beginning.
fn integral(f: impl Fn(f64) -> f64) -> f64 {
    let rule = GaussLegendre::new(20);
    let cuts = || (0..=96).map(|i| f64::from(i) / 96.0);
    let ends: Vec<f64> = [0.0, 1e-3, 3e-3].into_iter().chain(cuts().skip(1)).collect();
    ends.windows(2).map(|pair| rule.integrate(pair[0], pair[1], &f)).sum()
}
