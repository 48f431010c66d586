//! Average of two rays of ratio tracking.
//!
//! ```text
//! X = (X₁ + X₂)/2,  Var X = Var X₁/2,  twice the lookups
//! ```

use trueflight::estimators::transmittance::product;
use trueflight::estimators::transmittance::ratio::Ratio;
use trueflight::estimators::{Draw, Estimator, Inputs, Kernel, Refusal, Request, Setup, walks};
use trueflight::problems::Transmittance;
use trueflight::theory::collisions::rules::Weight;
use trueflight::theory::{CountDistribution, Moments, Prediction};

/// Two rays; σ̂ is their only input.
#[derive(Debug, Clone)]
pub struct TwoRays;

impl Estimator<Transmittance> for TwoRays {
    const INPUTS: Inputs = Inputs::SAMPLING;
    const PLAIN: Option<Self> = Some(Self);

    fn domain(&self, setup: &Setup<Transmittance>) -> Result<(), Refusal> {
        Ratio.domain(setup)
    }

    fn predict(&self, setup: &Setup<Transmittance>) -> Prediction {
        let mut one = Ratio.predict(setup);
        let mut channel = one.channels.remove(0);
        channel.moments = channel.moments.map(|of_one| {
            // The fourth central moment of a sum contains products of two squares.
            let [m2, m3, m4] = of_one.relative;
            let relative = [m2 / 2.0, m3 / 4.0, (m4 + 3.0 * m2 * m2) / 8.0];
            Moments { relative, ..of_one }
        });
        channel.losses = None;
        let lookups = one.lookups.take().map(|law| CountDistribution::poisson(2.0 * law.mean));
        Prediction { channels: vec![channel], lookups, ..Prediction::default() }
    }

    fn fill(&self, _: Kernel, setup: &Setup<Transmittance>, request: Request) {
        walks::one_by_one(
            setup,
            request,
            #[inline(always)]
            |medium, random| {
                let [first, second] = [0, 1].map(|_| product::draw(setup, &Weight, medium, random));
                let value = 0.5 * (first.value[0] + second.value[0]);
                Draw::free([value], first.lookups + second.lookups)
            },
        );
    }
}
