//! A value with a bound on its own error, and a stretch of a line.

/// A number that is known up to a stated absolute error.
///
/// `error` bounds `|value − exact|`. No measurement is compared with `value` more strictly than
/// `error` allows.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Known {
    /// The best available value.
    pub value: f64,
    /// Upper bound of the absolute error of `value`.
    pub error: f64,
}

impl Known {
    /// A value with no error but its own rounding to a double.
    pub fn exact(value: f64) -> Self {
        Self { value, error: f64::EPSILON * value.abs() }
    }

    /// A value with the given bound on its absolute error.
    pub fn new(value: f64, error: f64) -> Self {
        Self { value, error }
    }

    /// `exp(−self)`, with the error carried through: `|d e^{−τ}| = e^{−τ} |dτ|`.
    #[must_use]
    pub fn exp_neg(self) -> Self {
        let value = (-self.value).exp();
        Self { value, error: value * self.error.exp_m1() + f64::EPSILON * value }
    }
}

impl std::ops::Add for Known {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, error: self.error + other.error }
    }
}

/// A closed stretch `[from, to]` of a ray or line, in units of length; empty where `from ≥ to`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Span {
    /// Beginning of the stretch.
    pub from: f64,
    /// End of the stretch.
    pub to: f64,
}

impl Span {
    /// The stretch `[from, to]`.
    pub fn new(from: f64, to: f64) -> Self {
        Self { from, to }
    }

    /// A stretch of length zero at `at`.
    pub fn empty(at: f64) -> Self {
        Self { from: at, to: at }
    }

    /// `to − from`, never negative.
    pub fn length(self) -> f64 {
        (self.to - self.from).max(0.0)
    }

    /// Returns true if the stretch has no length.
    pub fn is_empty(self) -> bool {
        self.length() <= 0.0
    }

    /// The stretches between consecutive numbers of an ascending list.
    pub fn between(ends: &[f64]) -> impl ExactSizeIterator<Item = Self> + DoubleEndedIterator + '_ {
        ends.windows(2).map(|pair| Self::new(pair[0], pair[1]))
    }

    /// Both ends and the places strictly inside, ascending, each once.
    pub fn cut(self, mut places: Vec<f64>) -> Vec<f64> {
        places.retain(|&t| self.contains_inside(t));
        places.extend([self.from, self.to]);
        places.sort_by(f64::total_cmp);
        places.dedup();
        places
    }

    /// The places that cut the stretch into `parts` equal parts, a whole number, without its ends.
    pub fn even_cuts(self, parts: f64) -> Vec<f64> {
        let numbers = std::iter::successors(Some(1.0), |n| Some(n + 1.0));
        let at = |n: f64| self.from + self.length() * (n / parts);
        numbers.take_while(|&n| n < parts).map(at).collect()
    }

    /// The two stretches on either side of the midpoint.
    pub fn halves(self) -> [Self; 2] {
        [Self::new(self.from, self.middle()), Self::new(self.middle(), self.to)]
    }

    /// The midpoint.
    pub fn middle(self) -> f64 {
        0.5 * (self.from + self.to)
    }

    /// The part that both stretches share; empty where they do not meet.
    #[must_use]
    pub fn intersect(self, other: Self) -> Self {
        let from = self.from.max(other.from);
        let to = self.to.min(other.to);
        if from < to { Self { from, to } } else { Self::empty(from.min(self.to).max(self.from)) }
    }

    /// Returns true if `t` lies strictly inside.
    pub fn contains_inside(self, t: f64) -> bool {
        self.from < t && t < self.to
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intersection_of_disjoint_spans_is_empty() {
        assert!(Span::new(0.0, 1.0).intersect(Span::new(2.0, 3.0)).is_empty());
        assert_eq!(Span::new(0.0, 2.0).intersect(Span::new(1.0, 3.0)), Span::new(1.0, 2.0));
    }

    #[test]
    fn a_span_is_cut_inside_only_and_once() {
        let span = Span::new(0.0, 4.0);
        assert_eq!(span.cut(vec![3.0, 4.0, 1.0, -1.0, 3.0]), [0.0, 1.0, 3.0, 4.0]);
        assert_eq!(span.even_cuts(4.0), [1.0, 2.0, 3.0]);
        assert!(span.even_cuts(1.0).is_empty());
        assert!(Span::between(&[0.0, 2.0, 4.0]).eq(span.halves()));
    }

    #[test]
    fn transmittance_carries_the_error_of_its_depth() {
        let t = Known::new(2.0, 1e-9).exp_neg();
        assert!((t.value - 0.135_335_283_236_612_7).abs() < 1e-16);
        assert!(t.error >= 1.35e-10 && t.error < 1.36e-10);
    }
}
