//! Ray marching: a Riemann sum in the exponent. Biased, so that the gate must fail it.
//!
//! Unbiased for: never: it is here to be caught.
//!
//! ```text
//! X = exp(−h Σⱼ σ_t((j + u) h)),  h = ℓ/steps,  u = ½, or uniform in [0, 1) with jitter
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `steps` | number of steps along the support | required |
//! | `jitter` | one random offset for the whole ray | false |
//!
//! With jitter the sum is unbiased but its exponential is not (Jensen's inequality): the mean of X exceeds T. The
//! bias is predicted exactly, as a quadrature over u:
//!
//! ```text
//! E[X^k] = ∫₀¹ exp(−k h Σⱼ σ_t((j + u) h)) du
//! ```
//!
//! Source: M. Raab, D. Seibert, A. Keller, *Unbiased Global Illumination with Participating Media*,
//! Monte Carlo and Quasi-Monte Carlo Methods 2006, Springer (2008).
//!
//! ```toml
//! title = "An example of ray-marching"
//! expect = "biased"
//!
//! [problem.transmittance]
//! medium.exponential = { extinction = 1.6, rate = 0.8 }
//! span = [0, 5]
//! estimators = [{ ray-marching.steps = 5 }]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use crate::walks::slots;
use crate::{Draw, Estimator, Inputs, Kernel, Refusal, Request, Setup, Traits, walks};
use media::catalogue::Settings;
use media::{Extinction, Lookups};
use numeric::Lane;
use numeric::pack::{self, Hardware, Task, WIDTH};
use numeric::rng::{LANES, Stream};
use theory::Prediction;
use theory::problems::{Problem, Transmittance};
use theory::ray::marching;

/// Ray marching.
#[derive(Debug, Clone)]
pub struct RayMarching {
    steps: u32,
    jitter: bool,
}

impl RayMarching {
    /// `h Σⱼ σ_t((j + u) h)`.
    #[inline(always)]
    fn depth<M: Extinction, L: Lane>(&self, setup: &Setup<Transmittance>, medium: &M, u: L) -> L {
        marching::depth(medium, setup.fields.mesh.support(), self.steps, u)
    }

    /// The values of draws with the given offsets.
    #[inline(always)]
    fn value<M: Extinction, L: Lane>(&self, setup: &Setup<Transmittance>, medium: &M, u: L) -> L {
        (u.each(setup.fields.log_unit) - self.depth(setup, medium, u)).exp()
    }

    /// The value of one march.
    #[inline(always)]
    fn march(&self, setup: &Setup<Transmittance>, medium: &Lookups, random: &mut Stream) -> f64 {
        let u = if self.jitter { random.uniform() } else { 0.5 };
        self.value(setup, medium, u)
    }
}

impl Estimator<Transmittance> for RayMarching {
    const INPUTS: Inputs = Inputs::NONE;

    fn read(settings: &Settings) -> Option<Self> {
        let steps = settings.count("steps", 1..=1_000_000);
        let jitter = settings.flag_or("jitter", false);
        Some(Self { steps: u32::try_from(steps?).ok()?, jitter: jitter? })
    }

    fn traits(&self) -> Traits {
        let jitter = if self.jitter { ", jittered" } else { "" };
        let settings = format!("{} steps{jitter}", self.steps);
        Traits { settings, ..Traits::of(Self::INPUTS) }
    }

    fn domain(&self, _: &Setup<Transmittance>) -> Result<(), Refusal> {
        Ok(())
    }

    fn predict(&self, setup: &Setup<Transmittance>) -> Prediction {
        marching::predict(&setup.fields.mesh, setup.fields.log_unit, self.steps, self.jitter)
    }

    #[inline(always)]
    fn fill(&self, kernel: Kernel, setup: &Setup<Transmittance>, request: Request) {
        let left = match kernel {
            Kernel::Single => Some(request),
            Kernel::Packets(level) => {
                let medium = &setup.problem.lookups(level);
                let task = Marches { estimator: self, setup, medium, request };
                pack::on(level, task).err().map(|task| task.request)
            }
        };
        let Some(request) = left else { return };
        walks::one_by_one(
            setup,
            request,
            #[inline(always)]
            |medium, random| Draw::free([self.march(setup, medium, random)], self.steps),
        );
    }
}

/// Eight marches side by side: each lane makes the draws of its stream.
struct Marches<'a, 'r> {
    estimator: &'a RayMarching,
    setup: &'a Setup<Transmittance>,
    medium: &'a Lookups<'a>,
    request: Request<'r>,
}

impl Task for Marches<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Hardware>(self, simd: S) {
        let Self { estimator, setup, medium, request } = self;
        let Request { streams, count, buffer } = request;
        let Some((values, lookups, defects)) = buffer.one_channel(count) else { return };
        lookups.fill(estimator.steps);
        defects.fill(0.0);
        let [first, second] = streams.packs();
        let mut packs = [first.awake(simd), second.awake(simd)];
        let (rows, rest) = values.as_chunks_mut::<LANES>();
        for row in rows {
            for (numbers, row) in packs.iter_mut().zip(row.as_chunks_mut::<WIDTH>().0) {
                let half = simd.splat(0.5);
                let u = if estimator.jitter { numbers.uniform() } else { half };
                estimator.value(setup, medium, u).store(row);
            }
            // The first draw is that of the lane `turn`.
            row.rotate_left(streams.turn);
        }
        for (pack, numbers) in packs.into_iter().enumerate() {
            slots::leave(streams, pack, u64::MAX, numbers);
        }
        for value in rest {
            *value = estimator.march(setup, medium, streams.of_next_draw());
        }
    }
}
