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

use fearless_simd::Level;

use super::woodcock::{ZERO_OR_ONE, zero_or_one};
use crate::kernels::packet::{self, Request};
use crate::recipes::controls;
use crate::{Draw, Estimator, Inputs, Refusal, Setup};
use media::{Control, Extinction, Lookups};
use numeric::Lane;
use numeric::rng::Stream;
use theory::Prediction;
use theory::problems::Transmittance;
use theory::rules::Null;

/// Decomposition tracking; σ̂ and a constant control are its inputs.
#[derive(Debug, Clone)]
pub struct Decomposition;

fn constant_control(setup: &Setup<Transmittance>) -> Option<f64> {
    match &setup.control {
        Control::None => Some(0.0),
        Control::Pieces(pieces) => pieces.single_value(),
        Control::Field(_) => None,
    }
}

impl Estimator<Transmittance> for Decomposition {
    const INPUTS: Inputs = Inputs::BOTH;
    const PLAIN: Option<Self> = Some(Self);
    const IN_PACKETS: bool = true;

    fn default_control() -> Option<Box<dyn controls::Recipe>> {
        Some(Box::new(controls::minimum::Minimum))
    }

    fn domain(&self, setup: &Setup<Transmittance>) -> Result<(), Refusal> {
        setup.require_plain_unit(ZERO_OR_ONE)?;
        let needs = "a constant control";
        match constant_control(setup) {
            None => return Err(Refusal::mismatch(needs, "the control varies")),
            Some(control) if control < 0.0 => {
                return Err(Refusal::mismatch("σ_c ≥ 0", format!("σ_c = {control}")));
            }
            Some(_) => {}
        }
        setup.require_not_negative("σ_c ≤ σ_t everywhere")?;
        setup.require_ratio_at_most(1.0, "σ̂ ≥ σ_t − σ_c everywhere")
    }

    fn predict(&self, setup: &Setup<Transmittance>) -> Prediction {
        let killing = constant_control(setup).unwrap_or(0.0);
        let product = theory::product::Product { killing, ..setup.product(&Null) };
        zero_or_one(product.predict())
    }

    #[inline(always)]
    fn draw(&self, setup: &Setup<Transmittance>, medium: &Lookups, rng: &mut Stream) -> Draw {
        let support = setup.mesh.support();
        let control = setup.control.extinction(support.from);
        // A control of 0 stops no flight: it is infinite, or no number for a depth of 0. It takes
        // two random numbers like every step of the walk.
        let (depth, _) = (-rng.ln_uniform(), rng.word());
        let flown = depth.times_plus(1.0 / control, support.from);
        let mut cursor = setup.sampling.begin();
        let mut lookups = 0;
        loop {
            let (depth, number) = (-rng.ln_uniform(), rng.uniform());
            let Some(sampling) = setup.sampling.fly(&mut cursor, depth) else { break };
            if flown <= cursor.t {
                break;
            }
            lookups += 1;
            if number < (medium.extinction(cursor.t) - control) * (1.0 / sampling) {
                return Draw::free([0.0], lookups);
            }
        }
        let stopped = flown < support.to;
        Draw::free([if stopped { 0.0 } else { Lane::exp(setup.log_unit) }], lookups)
    }

    fn draw_packets<'a>(
        &self,
        level: Level,
        setup: &Setup<Transmittance>,
        medium: &Lookups,
        request: Request<'a>,
    ) -> Option<Request<'a>> {
        let control = setup.control.extinction(setup.mesh.support().from);
        packet::decomposition(level, setup, control, medium, request)
    }
}
