//! Unidirectional path tracing: delta tracking until a path hits the emitter.
//!
//! Unbiased for: σ̂ ≥ σ_t; refused elsewhere.
//!
//! ```text
//! X = 1 if the path reaches the emitter, else 0;   Var[X] = L(1 − L) whatever σ̂
//! ```
//!
//! It takes σ̂ and no settings. Its distribution is exact. It is the walk of `analog` in `rod`.
//!
//! Source: E. R. Woodcock, T. Murphy, P. J. Hemmings, T. C. Longworth, *Techniques used in the GEM code for Monte
//! Carlo neutronics calculations in reactors and other systems of complex geometry*, ANL-7050 (1965); B. Miller, I.
//! Georgiev, W. Jarosz, *A null-scattering path integral formulation of light transport*, ACM Transactions on Graphics
//! 38 (2019), section 5.2.
//!
//! ```toml
//! title = "An example of unidirectional"
//!
//! [problem.rod]
//! medium = 1
//! span = [0, 2]
//! albedo = 0.9
//! forward = 0.75
//! light = "emitter"
//! sampling = 1.6
//! estimators = ["unidirectional"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::{Lit, lit};
use crate::Estimator;
use media::catalogue::Settings;
use theory::light::{Combination, Techniques};

/// Hits alone; σ̂ is its only input.
#[derive(Debug, Clone)]
pub struct Unidirectional;

const TECHNIQUES: Techniques =
    Techniques { shadow: None, combination: Combination::Unidirectional };

impl<P: Lit> Estimator<P> for Unidirectional {
    fn read(_: &Settings) -> Option<Self> {
        Some(Self)
    }

    lit!(self => TECHNIQUES);
}
