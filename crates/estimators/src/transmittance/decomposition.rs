//! Decomposition tracking: the control's flight in closed form, then Woodcock through the residual.
//!
//! Unbiased for: a constant 0 ≤ σ_c ≤ σ_t and σ̂ ≥ σ_t − σ_c; refused elsewhere.
//!
//! ```text
//! t_c = −ln(u)/σ_c;  Woodcock through σ_t − σ_c up to min(t_c, ℓ);  X = 1 if both pass, else 0
//! ```
//!
//! The control is the minimum of σ_t if none is given. Draws are 0 or 1.
//!
//! ```text
//! J_k = τ for every k,  Var X = T(1 − T),  E[lookups] = ∫ σ̂ T dt
//! ```
//!
//! The same variance as `woodcock`, but σ̂ need only majorise the residual: fewer lookups.
//!
//! Source: P. Kutz, R. Habel, Y. K. Li, J. Novák, *Spectral and Decomposition Tracking for
//! Rendering Heterogeneous Volumes*, ACM Transactions on Graphics 36 (2017), section 4.
//!
//! ```toml
//! title = "An example of decomposition"
//!
//! [problem.transmittance]
//! medium.exponential = { extinction = 1.6, rate = 0.8 }
//! span = [0, 5]
//! sampling = 1.6
//! estimators = ["decomposition"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::woodcock::ZERO_OR_ONE;
use crate::recipes::controls;
use crate::walks::{self, Route, TentativeCollision, Walk};
use crate::{Estimator, Inputs, Kernel, Refusal, Request, Setup, Traits};
use media::Control;
use media::sampling::BothWays;
use numeric::rng::Random;
use numeric::{Lane, kept};
use theory::Prediction;
use theory::collisions::rules::Null;
use theory::problems::Transmittance;
use theory::ray::atoms::zero_or_one;

/// Decomposition tracking; σ̂ and a constant control are its inputs.
#[derive(Debug, Clone)]
pub struct Decomposition;

fn constant_control(setup: &Setup<Transmittance>) -> Option<f64> {
    match &setup.fields.control {
        Control::None => Some(0.0),
        Control::Pieces(pieces) => pieces.single_value(),
        Control::Field(_) => None,
    }
}

impl Estimator<Transmittance> for Decomposition {
    const INPUTS: Inputs = Inputs::BOTH;
    const PLAIN: Option<Self> = Some(Self);

    fn traits(&self) -> Traits {
        let default_control: Box<dyn controls::Recipe> = Box::new(controls::minimum::Minimum);
        Traits { default_control: Some(default_control), ..Traits::of(Self::INPUTS) }
    }

    fn domain(&self, setup: &Setup<Transmittance>) -> Result<(), Refusal> {
        setup.fields.require_plain_unit(ZERO_OR_ONE)?;
        let needs = "a constant control";
        match constant_control(setup) {
            None => return Err(Refusal::mismatch(needs, "the control varies")),
            Some(control) if control < 0.0 => {
                return Err(Refusal::mismatch("σ_c ≥ 0", format!("σ_c = {control}")));
            }
            Some(_) => {}
        }
        setup.residual().require_not_negative("σ_c ≤ σ_t everywhere")?;
        setup.residual().require_ratio_at_most(1.0, "σ̂ ≥ σ_t − σ_c everywhere")
    }

    fn predict(&self, setup: &Setup<Transmittance>) -> Prediction {
        let killing = constant_control(setup).unwrap_or(0.0);
        let product = theory::ray::product::Product { killing, ..setup.product(&Null) };
        zero_or_one(product.predict())
    }

    fn fill(&self, kernel: Kernel, setup: &Setup<Transmittance>, request: Request) {
        walks::fill(&Residual::new(setup), kernel, setup, request);
    }
}

kept! {
    /// A walk through the residual.
    pub struct ResidualFlight<L> {
        /// Lanes with the control's flight as their next step, which makes no lookup.
        begins: L::Mask,
        /// The end of the control's flight.
        stop: L,
    }
}

/// Woodcock tracking of `σ_t − σ_c` up to where the control's flight ended.
#[derive(Clone, Copy)]
pub struct Residual {
    /// σ_c of the first flight.
    pub control: f64,
    /// σ_c that collisions subtract.
    pub subtracted: f64,
    /// The beginning of the support.
    pub begin: f64,
    /// The end of the support: a control's flight that ends before it stops the walk.
    pub end: f64,
    /// The value of walks that pass.
    pub unit: f64,
}

impl Residual {
    /// The walk on a setup.
    #[inline(always)]
    pub fn new(setup: &Setup<Transmittance>) -> Self {
        let support = setup.fields.mesh.support();
        let control = setup.fields.control.extinction(support.from);
        Self {
            control,
            subtracted: control,
            begin: support.from,
            end: support.to,
            unit: Lane::exp(setup.fields.log_unit),
        }
    }
}

impl Walk for Residual {
    type State<L: Lane> = ResidualFlight<L>;

    const IS_FIXED: bool = true;
    const PAUSES: bool = true;

    #[inline(always)]
    fn begin<L: Lane>(&self, one: L, _: L::Mask, _: &mut impl Random<L>) -> ResidualFlight<L> {
        ResidualFlight { begins: one.at_most(one), stop: one.each(self.begin) }
    }

    #[inline(always)]
    fn fly<L: Lane>(
        &self,
        flight: &mut ResidualFlight<L>,
        route: &mut Route<impl BothWays<L>>,
        depth: L,
    ) -> L::Mask {
        let begins = flight.begins;
        // A control of 0 stops no flight: its stop is infinite, or NaN for a depth of 0.
        let stop = depth.times_plus(depth.each(1.0 / self.control), depth.each(self.begin));
        flight.stop.set_where(begins, stop);
        let inside = route.here.fly(depth);
        route.here.restart(begins);
        inside & !begins & !flight.stop.at_most(route.here.reached())
    }

    #[inline(always)]
    fn collide<L: Lane>(
        &self,
        flight: &mut ResidualFlight<L>,
        _: &mut Route<impl BothWays<L>>,
        extinctions: &TentativeCollision<L>,
        _: &mut impl Random<L>,
    ) -> L::Mask {
        let TentativeCollision { inside, mean_free_path, extinction, number, .. } = *extinctions;
        let is_real = number.below((extinction - self.subtracted) * mean_free_path);
        let goes_on = flight.begins | (inside & !is_real);
        flight.begins = flight.begins & !flight.begins;
        goes_on
    }

    #[inline(always)]
    fn value<L: Lane>(&self, flight: &ResidualFlight<L>, left: L::Mask, _: usize) -> L {
        let is_stopped = flight.stop.below(flight.stop.each(self.end));
        L::select(left & !is_stopped, flight.stop.each(self.unit), flight.stop.each(0.0))
    }
}
