//! Closed-form tracking: the optical depth is known, so the answer is too.
//!
//! Unbiased for: every medium, exactly.
//!
//! ```text
//! X = exp(−τ),  Var X = 0,  no lookups
//! ```
//!
//! Exact wherever the medium's optical depth is; every field of the catalogue has one. It is the end of the scale
//! of estimators: zero variance at no cost.
//!
//! Source: J. Novák, I. Georgiev, J. Hanika, W. Jarosz, *Monte Carlo Methods for Volumetric Light
//! Transport Simulation*, Computer Graphics Forum 37 (2018), section 4.1.
//!
//! ```toml
//! title = "An example of closed-form"
//!
//! [problem.transmittance]
//! medium.exponential = { extinction = 1.6, rate = 0.8 }
//! span = [0, 5]
//! estimators = ["closed-form"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use crate::{Draw, Estimator, Inputs, Kernel, Knowledge, Refusal, Request, Setup, Traits, walks};
use numeric::Lane;
use theory::Prediction;
use theory::problems::Transmittance;
use theory::ray::atoms;

/// Closed-form tracking; it has no settings.
#[derive(Debug, Clone)]
pub struct ClosedForm;

impl Estimator<Transmittance> for ClosedForm {
    const INPUTS: Inputs = Inputs::NONE;
    const PLAIN: Option<Self> = Some(Self);

    fn traits(&self) -> Traits {
        Traits { needs: Some(Knowledge::OpticalDepth), ..Traits::of(Self::INPUTS) }
    }

    fn domain(&self, _: &Setup<Transmittance>) -> Result<(), Refusal> {
        Ok(())
    }

    fn predict(&self, setup: &Setup<Transmittance>) -> Prediction {
        atoms::exact(&setup.fields.mesh, setup.fields.log_unit, 0)
    }

    fn fill(&self, _: Kernel, setup: &Setup<Transmittance>, request: Request) {
        let depth = setup.fields.mesh.optical_depth().value;
        // It enters draws: this crate's exponential, the same on every machine.
        let transmittance = Lane::exp(setup.fields.log_unit - depth);
        walks::one_by_one(
            setup,
            request,
            #[inline(always)]
            |_, _| Draw::free([transmittance], 0),
        );
    }
}
