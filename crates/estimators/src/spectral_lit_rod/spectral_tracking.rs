//! Spectral tracking: one σ̂ for all channels, and probabilities of the next event that depend on all of them.
//!
//! Unbiased for: one constant σ̂ ≥ σ_t for all channels, and `forward = 1`; refused elsewhere.
//!
//! ```text
//! an event e = null, scattered, absorbed of probability P_e;  w_λ ← w_λ μ_e,λ/(μ̄ P_e);  X_λ = w_λ at the emitter
//! average  P_e = mean μ_e/μ̄     maximum  P_e = max μ_e/Σ_e max μ_e     history  P_e = mean w μ_e/(μ̄ mean w)
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `probabilities` | `"average"`, `"maximum"` or `"history"` | `"average"` |
//! | `sampling` | one constant σ̂ ≥ σ_t for all channels | required here or in the case |
//!
//! For rods in which light goes on forward (`forward = 1`). For rods in which light turns see `spectral-tracking`
//! of a rod with `albedos`: from some length on its variance is infinite. Forward, variances are finite and known.
//! An absorbing channel makes them large all the same: its probability to absorb is that of all, and the weights of
//! the paths that survive grow.
//!
//! Source: P. Kutz, R. Habel, Y. K. Li, J. Novák, *Spectral and Decomposition Tracking for Rendering
//! Heterogeneous Volumes*, ACM Transactions on Graphics 36 (2017), section 5.1.
//!
//! ```toml
//! title = "An example of spectral-tracking"
//!
//! [problem.rod]
//! medium = [1.05, 1, 0.95]
//! span = [0, 1]
//! albedos = [0.9, 0.85, 0.8]
//! forward = 1
//! light = "emitter"
//! sampling = 1.6
//! estimators = [{ spectral-tracking.probabilities = "average" }]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::{Albedos, realisable, spectrum};
use crate::setup::channels;
use crate::setup::heroes::Heroes;
use crate::setup::walker::read_chances;
use crate::walks::{Route, TentativeCollision, Walk, drawn};
use crate::{Estimator, Inputs, Refusal, Setup, Traits};
use media::body::MAX_CHANNELS;
use media::catalogue::Settings;
use media::sampling::BothWays;
use numeric::rng::Random;
use numeric::{Lane, kept};
use theory::Prediction;
use theory::colours::Chances;
use theory::problems::SpectralLitRod;
use theory::rod::lit::spectral::LitTracker;

/// Spectral tracking.
#[derive(Debug, Clone)]
pub struct SpectralTracking {
    chances: Chances,
}

impl Estimator<SpectralLitRod> for SpectralTracking {
    const INPUTS: Inputs = Inputs::SAMPLING;

    fn read(settings: &Settings) -> Option<Self> {
        Some(Self { chances: read_chances(settings)? })
    }

    fn traits(&self) -> Traits {
        Traits { settings: self.chances.label().into(), ..Traits::of(Self::INPUTS) }
    }

    fn domain(&self, setup: &Setup<SpectralLitRod>) -> Result<(), Refusal> {
        realisable(setup, &Heroes::Uniform)?;
        channels::require_common(&setup.fields)?;
        let turns = |(_, forward): &(usize, &f64)| **forward < 1.0;
        let turns = (1..).zip(&setup.problem.forward).find(turns);
        turns.map_or(Ok(()), |(channel, forward)| {
            let actual = format!("forward = {forward} in channel {channel}");
            Err(Refusal::mismatch("light that goes on forward", actual))
        })
    }

    fn predict(&self, setup: &Setup<SpectralLitRod>) -> Prediction {
        let tracker = LitTracker::Tracking(self.chances);
        spectrum(setup, &Heroes::Uniform, tracker).predict(setup.distributions)
    }

    drawn!(self, setup: SpectralLitRod =>
        Together::new(self.chances, setup, Albedos::of(setup)),
        Together::new(self.chances, setup, Albedos::found(setup))
    );
}

kept! {
    /// Walks of all channels together, kept in memory.
    pub struct Path<L> {
        weights: [L; MAX_CHANNELS],
        /// `μ_n/μ̄`, `μ_s/μ̄` and `μ_a/μ̄` of each channel where they are.
        nulls: [L; MAX_CHANNELS],
        scattered: [L; MAX_CHANNELS],
        absorbed: [L; MAX_CHANNELS],
    }
}

/// The walk of all channels together.
#[derive(Clone, Copy)]
struct Together<'a> {
    chances: Chances,
    majorant: f64,
    albedos: Albedos<'a>,
    count: usize,
}

impl<'a> Together<'a> {
    #[inline(always)]
    fn new(chances: Chances, setup: &Setup<SpectralLitRod>, albedos: Albedos<'a>) -> Self {
        let (majorant, count) = (setup.fields[0].majorant, setup.fields.len());
        Self { chances, majorant, albedos, count }
    }
}

impl Walk for Together<'_> {
    type State<L: Lane> = Path<L>;

    const IS_CHROMATIC: bool = true;

    #[inline(always)]
    fn begin<L: Lane>(&self, one: L, _: L::Mask, _: &mut impl Random<L>) -> Path<L> {
        let ones = [one; MAX_CHANNELS];
        Path { weights: ones, nulls: ones, scattered: ones, absorbed: ones }
    }

    #[inline(always)]
    fn restart<L: Lane>(&self, path: &mut Path<L>, which: L::Mask, one: L, _: &mut impl Random<L>) {
        for weight in &mut path.weights[..self.count] {
            weight.keep_where(which, one);
        }
    }

    #[inline(always)]
    fn mean_free_path<L: Lane>(&self, path: &Path<L>, _: &Route<impl BothWays<L>>) -> L {
        path.weights[0].each(1.0 / self.majorant)
    }

    #[inline(always)]
    fn collide<L: Lane>(
        &self,
        path: &mut Path<L>,
        _: &mut Route<impl BothWays<L>>,
        collided: &TentativeCollision<L>,
        _: &mut impl Random<L>,
    ) -> L::Mask {
        let (TentativeCollision { inside, t, extinctions, number, .. }, one) =
            (*collided, collided.t.each(1.0));
        let majorant = one.each(self.majorant);
        for (channel, &extinction) in extinctions.iter().enumerate() {
            let real = extinction / majorant;
            let scattered = real * self.albedos.at(channel, t);
            path.nulls[channel] = one - real;
            path.scattered[channel] = scattered;
            path.absorbed[channel] = real - scattered;
        }
        let [null, scattered, _] = self.chances.of_events(
            self.count,
            #[inline(always)]
            |channel| [path.nulls[channel], path.scattered[channel], path.absorbed[channel]],
            &path.weights,
        );
        let is_real = null.at_most(number);
        let probability = L::select(is_real, scattered, null);
        for channel in 0..self.count {
            let share = L::select(is_real, path.scattered[channel], path.nulls[channel]);
            let weight = path.weights[channel] * (share / probability);
            path.weights[channel].keep_where(inside, weight);
        }
        inside & number.below(null + scattered)
    }

    #[inline(always)]
    fn media(&self) -> usize {
        self.count
    }

    #[inline(always)]
    fn channels(&self) -> usize {
        self.count
    }

    #[inline(always)]
    fn value<L: Lane>(&self, path: &Path<L>, left: L::Mask, channel: usize) -> L {
        // An absorbed walk scores nothing.
        let weight = path.weights[channel];
        L::select(left, weight, weight.each(0.0))
    }
}
