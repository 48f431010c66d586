//! Rules of collisions, from the papers.

/// Rule of a collision, from the papers.
#[derive(Clone, Copy, PartialEq)]
pub enum Rule {
    Double,
    Terminating,
    Clamped,
    NonTerminating(f64),
    Adaptive(f64),
    Null,
}

impl Rule {
    /// Returns `q_tran`.
    pub fn survival(self, r: f64) -> f64 {
        let kept = (1.0 - r).abs();
        let non_terminating = |a: f64| if kept == 0.0 { 0.0 } else { kept / (a * r.abs() + kept) };
        match self {
            Self::Double => 1.0,
            Self::Terminating | Self::Null => kept,
            Self::Clamped => kept.min(1.0),
            Self::Adaptive(a) if r >= 1.0 && a * r + kept <= 1.0 => kept,
            Self::NonTerminating(a) | Self::Adaptive(a) => non_terminating(a),
        }
    }

    /// Returns `E[W^k] = (1 − r)^k q^{1−k}`, and 0 at r = 1.
    pub fn power(self, r: f64, k: i32) -> f64 {
        match self.survival(r) {
            0.0 => 0.0,
            q => (1.0 - r).powi(k) * q.powi(1 - k),
        }
    }

    /// Returns the variance introduction density in units of σ̂: Eq. 17, 19, 20, or 18 where the paper has no formula
    /// of its own.
    pub fn introduced(self, r: f64) -> f64 {
        match self {
            Self::Double => r * r,
            Self::Terminating if r <= 1.0 => r,
            Self::Terminating => r * (3.0 - 2.0 / r),
            Self::NonTerminating(a) => r.abs() * (r.abs() + a * (1.0 - r).abs()),
            Self::Null => r,
            Self::Clamped | Self::Adaptive(_) => 2.0 * r - 1.0 + self.power(r, 2),
        }
    }
}
