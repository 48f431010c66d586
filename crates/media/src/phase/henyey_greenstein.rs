//! Henyey–Greenstein scattering, with the mean cosine as its parameter.
//!
//! ```text
//! p(cos θ) = (1 − g²) / (4π (1 + g² − 2g cos θ)^{3/2}),   χ_l = g^l
//! ```
//!
//! | setting | meaning | unit | default |
//! |---|---|---|---|
//! | `g` | mean cosine, `−1 < g < 1`; above 0 light is scattered forward | – | required |
//!
//! A uniform number u gives
//!
//! ```text
//! cos θ = (u (1 + g)² (1 − g(1 − u)) − (1 − u)(1 − g)² (1 + g u)) / (1 − g + 2g u)²
//! ```
//!
//! which is the usual formula `(1 + g² − ((1 − g²)/(1 − g + 2g u))²)/(2g)` with g divided out: it is valid for
//! every g, 0 too. The two terms are `(1 + cos θ)/2` and `(1 − cos θ)/2`, so that no digits are lost where g is
//! near 1. The sign of `cos θ` is that of directions of travel; where papers write `+2g cos θ`, their angle is
//! measured to the direction from which the light came.
//!
//! Source: L. G. Henyey, J. L. Greenstein, *Diffuse radiation in the Galaxy*, Astrophysical Journal
//! 93, 70–83 (1941), equation 2.
//!
//! ```toml
//! title = "An example of henyey-greenstein"
//!
//! [problem.slab]
//! medium = 1
//! span = [0, 2]
//! albedo = 0.8
//! phase.henyey-greenstein.g = 0.6
//! incidence.collimated.cosine = 0.6
//! sampling = 1.2
//! estimators = ["weighted"]
//! ```
#![cfg_attr(not(doctest), doc = crate::draw_in_rust!())]

use std::f64::consts::PI;

use super::{PhaseFunction, unit};
use crate::catalogue::{Domain, Settings};
use numeric::Lane;
use numeric::digits::number;

/// The Henyey–Greenstein phase function.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HenyeyGreenstein {
    g: f64,
}

impl HenyeyGreenstein {
    /// The phase function of mean cosine `g`; `None` unless `−1 < g < 1`.
    pub fn new(g: f64) -> Option<Self> {
        (g.abs() < 1.0).then_some(Self { g })
    }

    /// The mean cosine.
    pub fn g(&self) -> f64 {
        self.g
    }
}

impl PhaseFunction for HenyeyGreenstein {
    fn read(settings: &Settings) -> Option<Self> {
        let g = settings.number("g", Domain::Finite)?;
        let phase = Self::new(g);
        if phase.is_none() {
            let help = "the mean cosine lies between -1 and 1, both excluded";
            settings.fault("g", format!("`g` is {}", number(g)), help);
        }
        phase
    }

    fn settings(&self) -> String {
        format!("g={}", self.g)
    }

    #[inline(always)]
    fn value<L: Lane>(&self, cosine: L) -> L {
        // 1 + g² − 2g cos θ as a sum of two numbers ≥ 0, so that the peak keeps its digits.
        let size = self.g.abs();
        let along = if self.g < 0.0 { -cosine } else { cosine };
        let square = (along.each(1.0) - along) * (2.0 * size) + (1.0 - size) * (1.0 - size);
        let scale = (1.0 - size) * (1.0 + size) / (4.0 * PI);
        square.each(scale) / (square * square.root())
    }

    fn moment(&self, order: usize) -> f64 {
        std::iter::repeat_n(self.g, order).product()
    }

    #[inline(always)]
    fn cosine<L: Lane>(&self, u: L) -> L {
        let g = self.g;
        let rest = u.each(1.0) - u;
        let size = g.abs();
        let near = if g < 0.0 { rest } else { u };
        let root = near * (2.0 * size) + (1.0 - size);
        let on = u * ((1.0 + g) * (1.0 + g)) * (rest * -g + 1.0);
        let back = rest * ((1.0 - g) * (1.0 - g)) * (u * g + 1.0);
        unit((on - back) / (root * root))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::Value;
    use crate::catalogue::fixture::read;

    #[test]
    fn hand_worked_values() {
        // g = ½ straight on: (1 − ¼)/(4π (½)³) = 6/(4π); straight back (3/2)³ = 27/8: (2/9)/(4π).
        let phase = HenyeyGreenstein::new(0.5).expect("in range");
        assert!((phase.value(1.0) * 4.0 * PI - 6.0).abs() < 1e-14);
        assert!((phase.value(-1.0) * 4.0 * PI - 2.0 / 9.0).abs() < 1e-15);
        // u = ½: s = 0, cos θ = 3g/2 − g³/2 = 11/16.
        assert_eq!(phase.cosine(0.5), 11.0 / 16.0);
    }

    #[test]
    fn a_mean_cosine_of_one_is_refused() {
        for g in [1.0, -1.0, 1.5] {
            let actual = read([("g", Value::Number(g))], HenyeyGreenstein::read);
            assert_eq!(actual, (None, vec![format!("`g` is {g}")]));
        }
    }
}
