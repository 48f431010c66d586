//! Fields along one ray, with and without a control.

use std::sync::Arc;

use super::{ChannelPart, FAINTEST, Fields, Parts, Residual, Setup};
use crate::{Estimated, Refusal};
use media::{Control, Piecewise};
use numeric::digits::rounded;
use numeric::{Lane, Span};
use theory::Mesh;
use theory::collisions::Rule;
use theory::problems::Problem;
use theory::ray::product::Product;

/// Logarithm of the largest weight that a draw may reach: a little below the largest double.
const LARGEST_WEIGHT: f64 = 700.0;
/// Negative logarithm of the smallest probability of a walk that may be drawn: 1e-21.
const NEVER: f64 = 48.4;

/// Fields with a σ̂ along a ray.
pub trait OnRay {
    /// Returns σ_t, σ̂ and σ_c; of several channels, those of the first.
    fn residual(&self) -> Residual<'_>;
}

impl<P: Estimated<Fields: OnRay>> Setup<P> {
    /// Returns σ_t, σ̂ and σ_c along the ray; of several channels, those of the first.
    pub fn residual(&self) -> Residual<'_> {
        self.fields.residual()
    }
}

/// Medium and σ̂ along a ray.
pub struct Line {
    /// Medium, cut into panels.
    pub mesh: Arc<Mesh>,
    /// σ̂ on the support; zero for estimators that take none.
    pub sampling: Piecewise,
}

impl Line {
    /// Joins medium and σ̂, which is restricted to the support.
    pub fn new((mesh, sampling): ChannelPart) -> Self {
        let support = mesh.support();
        let sampling = sampling.unwrap_or_else(|| Piecewise::constant(0.0, support)).on(support);
        Self { mesh, sampling }
    }
}

impl OnRay for Line {
    #[inline(always)]
    fn residual(&self) -> Residual<'_> {
        Residual { mesh: &self.mesh, sampling: &self.sampling, control: &Control::None }
    }
}

impl<P: Problem> Fields<P> for Line {
    fn new(_: &P, mut parts: Parts) -> Result<Self, Refusal> {
        Ok(Self::new(parts.channels.swap_remove(0)))
    }
}

/// Medium, σ̂ and control along a ray.
pub struct ControlledLine {
    /// Medium, cut into panels.
    pub mesh: Arc<Mesh>,
    /// σ̂ on the support; zero for estimators that take none.
    pub sampling: Piecewise,
    /// σ_c.
    pub control: Control,
    /// Draws are in units of `exp(−log_unit)`, see [`Problem::log_unit`].
    pub log_unit: f64,
    /// `exp(−∫σ_c)` from the beginning of the support to each of the problem's distances, in units of `exp(−log_unit)`.
    pub control_curve: Vec<f64>,
    /// Share of the support on which σ̂ is 0 because the residual is.
    skipped: f64,
}

impl ControlledLine {
    /// Joins medium and σ̂, which is restricted to the support, with a control.
    pub fn new(problem: &impl Problem, part: ChannelPart, control: Control) -> Self {
        let Line { mesh, sampling } = Line::new(part);
        let support = mesh.support();
        let log_unit = problem.log_unit(mesh.optical_depth().value);
        // Draws contain it: the exponential of lanes is the same on every machine.
        let upto = |&distance: &f64| {
            let span = Span::new(support.from, distance).intersect(support);
            Lane::exp(log_unit - control.optical_depth(span).value)
        };
        let control_curve = problem.distances().iter().map(upto).collect();
        Self { mesh, sampling, control, log_unit, control_curve, skipped: 0.0 }
    }

    /// `T_c = exp(−∫σ_c)` over the support, in units of `exp(−log_unit)`.
    #[inline(always)]
    pub fn control_transmittance(&self) -> f64 {
        self.control_curve[self.control_curve.len() - 1]
    }

    /// Requires draws in units of 1, not of `exp(−log_unit)`, see [`Problem::log_unit`].
    ///
    /// # Errors
    ///
    /// The optical depth.
    pub fn require_plain_unit(&self, needs: &'static str) -> Result<(), Refusal> {
        if self.log_unit == 0.0 {
            return Ok(());
        }
        Err(Refusal::mismatch(needs, format!("τ = {}", rounded(self.log_unit))))
    }

    /// Requires weights that stay finite in every walk that may be drawn.
    ///
    /// ```text
    /// ln T_c + n ln max|W| ≤ 700,   P(N ≥ n) ≤ exp(−n ln(n/Λ) + n − Λ) = 1e-21,  Λ = ∫σ̂
    /// ```
    ///
    /// # Errors
    ///
    /// The largest factor and n.
    pub fn require_finite_weights(&self, rule: &dyn Rule) -> Result<(), Refusal> {
        let mut cuts = self.sampling.knots().to_vec();
        cuts.extend(self.control.breaks());
        let factor = |t: f64, sigma: f64| {
            let (residual, sampling) = (self.residual().at(t, sigma), self.sampling.value(t));
            if sampling > 0.0 { rule.outcome(residual / sampling).weight.abs() } else { 0.0 }
        };
        let cut = self.mesh.refined(&cuts, &|_, _| Vec::new());
        let Some((_, largest)) = cut.largest(&factor).filter(|&(_, largest)| largest > 1.0) else {
            return Ok(());
        };
        let collisions = self.sampling.whole_depth();
        let rarity = |n: f64| n * (n / collisions).ln() - n + collisions;
        let (mut few, mut many) = (collisions, 2.0 * collisions + 1.0);
        while rarity(many) < NEVER {
            (few, many) = (many, 2.0 * many);
        }
        // A relative accuracy of 1e-3 is enough, and beyond 2⁵³ doubles do not differ by one.
        while many - few > (1e-3 * many).max(1.0) {
            let middle = 0.5 * (few + many);
            if rarity(middle) < NEVER { few = middle } else { many = middle }
        }
        let maximum = many.ceil();
        if self.control_transmittance().ln() + maximum * largest.ln() <= LARGEST_WEIGHT {
            return Ok(());
        }
        let needs = "weights that stay below 1e304";
        let actual = format!("{maximum} collisions may multiply them by {largest:.3e} each");
        Err(Refusal::mismatch(needs, actual))
    }
}

impl OnRay for ControlledLine {
    #[inline(always)]
    fn residual(&self) -> Residual<'_> {
        Residual { mesh: &self.mesh, sampling: &self.sampling, control: &self.control }
    }
}

impl<P: Problem> Fields<P> for ControlledLine {
    fn new(problem: &P, mut parts: Parts) -> Result<Self, Refusal> {
        Ok(Self::new(problem, parts.channels.swap_remove(0), parts.control))
    }

    /// Collisions where the residual is 0 would multiply weights by 1. σ̂ stays where a gap is too short to be worth a piece
    /// of σ̂.
    fn skipping(mut self) -> Self {
        let support = self.mesh.support();
        let stretches = self.residual().gaps();
        if !stretches.is_empty() {
            self.sampling = self.sampling.zero_on(&stretches);
            self.skipped = stretches.iter().map(|s| s.length()).sum::<f64>() / support.length();
        }
        self
    }

    fn skipped(&self) -> f64 {
        self.skipped
    }

    /// Requires `T_c`, in units of `exp(−log_unit)`, in the range of doubles.
    fn require_weights(&self) -> Result<(), Refusal> {
        let weight = self.control_transmittance();
        if (FAINTEST..=1.0 / FAINTEST).contains(&weight) {
            return Ok(());
        }
        if self.log_unit == 0.0 {
            let needs = "a control with T_c between 1e-300 and 1e300";
            return Err(Refusal::mismatch(needs, format!("T_c = {weight:e}")));
        }
        let needs = "draws between 1e-300 and 1e300 times T";
        let control = self.control.optical_depth(self.mesh.support()).value;
        let [whole, control] = [self.log_unit, control].map(rounded);
        let actual = format!("τ = {whole}, of which the control takes {control}");
        Err(Refusal::mismatch(needs, actual))
    }
}

impl<P: Estimated<Fields = ControlledLine>> Setup<P> {
    /// The product estimator with the given rule, for theory.
    pub fn product<'a>(&'a self, rule: &'a dyn Rule) -> Product<'a> {
        let ControlledLine { mesh, sampling, control, log_unit, .. } = &self.fields;
        let product = Product::new(mesh, sampling, control, rule);
        Product { with_distributions: self.distributions, log_unit: *log_unit, ..product }
    }
}
