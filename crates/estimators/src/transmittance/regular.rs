//! Regular tracking: step from boundary to boundary of a piecewise-constant medium.
//!
//! Unbiased for: media that are constant between breaks, exactly; refused elsewhere.
//!
//! ```text
//! X = ∏ᵢ exp(−σ_t(mᵢ) Δᵢ),  mᵢ the middle of segment i
//! ```
//!
//! Exact for media that are constant between their breaks (constant, piecewise constant, nearest
//! voxels), one lookup per segment, no variance. Refused for every other medium: there it would be
//! ray marching, which is biased.
//!
//! Source: J. Amanatides, A. Woo, *A Fast Voxel Traversal Algorithm for Ray Tracing*, Eurographics
//! 1987; the name after Novák et al. 2018, section 4.2.
//!
//! ```toml
//! title = "An example of regular"
//!
//! [problem.transmittance]
//! medium.piecewise-constant = { breaks = [0, 1, 2], values = [0.4, 0.8] }
//! span = [0, 2]
//! estimators = ["regular"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use crate::{Draw, Estimator, Inputs, Kernel, Refusal, Request, Setup, walks};
use media::{Extinction, Lookups};
use numeric::Lane;
use theory::Prediction;
use theory::problems::Transmittance;
use theory::ray::atoms;

/// Regular tracking; it has no settings.
#[derive(Debug, Clone)]
pub struct Regular;

impl Estimator<Transmittance> for Regular {
    const INPUTS: Inputs = Inputs::NONE;
    const PLAIN: Option<Self> = Some(Self);

    fn domain(&self, setup: &Setup<Transmittance>) -> Result<(), Refusal> {
        let varying = setup.fields.mesh.panels().find(|panel| {
            let first = panel.extinction[0];
            panel.extinction.iter().any(|x| (x - first).abs() > 1e-12 * first.abs())
        });
        match varying {
            None => Ok(()),
            Some(panel) => Err(Refusal::Inequality {
                needs: "a medium that is constant between its breaks".into(),
                actual: "σ_t varies".into(),
                at: panel.span.middle(),
            }),
        }
    }

    fn predict(&self, setup: &Setup<Transmittance>) -> Prediction {
        let mesh = &setup.fields.mesh;
        atoms::exact(mesh, setup.fields.log_unit, mesh.panels().len())
    }

    #[inline(always)]
    fn fill(&self, _: Kernel, setup: &Setup<Transmittance>, request: Request) {
        walks::one_by_one(
            setup,
            request,
            #[inline(always)]
            |medium, _| tracked(setup, medium),
        );
    }
}

/// `∏ exp(−σ_t h)` over the pieces.
#[inline(always)]
fn tracked(setup: &Setup<Transmittance>, medium: &Lookups) -> Draw {
    let mut weight = 1.0;
    let mut left = setup.fields.log_unit;
    let mut lookups = 0;
    for panel in setup.fields.mesh.panels() {
        let extinction = medium.extinction(panel.span.middle());
        lookups += 1;
        if setup.fields.log_unit == 0.0 {
            weight *= Lane::exp(-extinction * panel.span.length());
        } else {
            // The product would underflow: its logarithm is taken from that of the unit.
            left -= extinction * panel.span.length();
        }
    }
    Draw::free([weight * Lane::exp(left)], lookups)
}
