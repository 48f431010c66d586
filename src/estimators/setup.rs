//! What an estimator works on, prepared once per experiment.

use std::sync::Arc;

use crate::media::{Body, Control, Piecewise};
use crate::numeric::Lane;
use crate::problems::Problem;
use crate::rng::Address;
use crate::theory::{Mesh, Rule, product::Product};

/// What a recipe sees when it prepares a sampling extinction or a control.
#[derive(Clone, Copy)]
pub struct Site<'a> {
    /// The field as the case gives it.
    pub body: &'a Body,
    /// The medium, cut into panels.
    pub mesh: &'a Mesh,
    /// Where pilot rays find their random numbers.
    pub address: Address,
}

/// A problem with everything that its estimators need.
pub struct Setup<P> {
    /// What is sought.
    pub problem: Arc<P>,
    /// The medium, cut into panels.
    pub mesh: Arc<Mesh>,
    /// σ̂ on the support; zero for estimators that take none.
    pub sampling: Piecewise,
    /// σ_c.
    pub control: Control,
    /// Draws are in units of `exp(−log_unit)`, see [`Problem::log_unit`].
    pub log_unit: f64,
    /// `T_c = exp(−∫σ_c)` over the support, in units of `exp(−log_unit)`.
    pub control_transmittance: f64,
    /// `T` over the support, in units of `exp(−log_unit)`.
    pub transmittance: f64,
    /// Whether whole laws are asked for; a search for optima leaves them out.
    pub laws: bool,
}

impl<P: Problem> Setup<P> {
    /// Joins the parts; σ̂ is restricted to the support.
    #[must_use]
    pub fn new(
        problem: Arc<P>,
        mesh: Arc<Mesh>,
        sampling: Option<Piecewise>,
        control: Control,
    ) -> Self {
        let support = mesh.support();
        let sampling = sampling.unwrap_or_else(|| Piecewise::constant(0.0, support)).on(support);
        // Both enter draws: this crate's exponential, the same on every machine.
        let depth = mesh.optical_depth().value;
        let log_unit = problem.log_unit(depth);
        let control_depth = control.optical_depth(support).value;
        let control_transmittance = Lane::exp(log_unit - control_depth);
        let transmittance = Lane::exp(log_unit - depth);
        Self {
            problem,
            mesh,
            sampling,
            control,
            log_unit,
            control_transmittance,
            transmittance,
            laws: true,
        }
    }

    /// `r`, where medium, control and σ̂ are each one constant on the support.
    #[must_use]
    pub fn constant_ratio(&self) -> Option<f64> {
        let control = match &self.control {
            Control::None => 0.0,
            Control::Pieces(pieces) => pieces.single_value()?,
            Control::Field(_) => return None,
        };
        let sampling = self.sampling.single_value().filter(|&value| value > 0.0)?;
        let mut extinctions = self.mesh.panels().flat_map(|panel| panel.extinction);
        let first = *extinctions.next()?;
        extinctions.all(|&x| x == first).then_some((first - control) / sampling)
    }

    /// The product estimator with the given rule, for theory.
    #[must_use]
    pub fn product<'a>(&'a self, rule: &'a dyn Rule) -> Product<'a> {
        let product = Product::new(&self.mesh, &self.sampling, &self.control, rule);
        Product { laws: self.laws, log_unit: self.log_unit, ..product }
    }
}
