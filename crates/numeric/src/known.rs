//! A value with a bound on its own error, the ground of that bound, and a stretch of a line.

/// Ground of a stated error.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum Grade {
    /// A difference of resolutions, or a safety factor: true in every test, but not proven.
    Estimated,
    /// A closed form with its rounding, or a proven inequality.
    Proven,
}

impl Grade {
    /// Word in reports.
    pub fn word(self) -> &'static str {
        match self {
            Self::Estimated => "estimated",
            Self::Proven => "proven",
        }
    }
}

/// A number that is known up to a stated absolute error.
///
/// `error` bounds `|value − exact|`. No measurement is compared with `value` more strictly than
/// `error` allows. Arithmetic carries errors through, without the rounding of the operation itself. The result has
/// the lower grade of its parts.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Known {
    /// The best available value.
    pub value: f64,
    /// Upper bound of the absolute error of `value`.
    pub error: f64,
    /// Ground of `error`.
    pub grade: Grade,
}

impl Known {
    /// A value of which nothing is known.
    pub const UNKNOWN: Self = Self::new(f64::NAN, f64::NAN);
    /// An infinite value, as of a moment that diverges.
    pub const INFINITE: Self = Self::new(f64::INFINITY, f64::INFINITY);

    /// A value with no error but its own rounding to a double.
    pub fn exact(value: f64) -> Self {
        Self::new(value, f64::EPSILON * value.abs())
    }

    /// A value with a proven bound on its absolute error.
    pub const fn new(value: f64, error: f64) -> Self {
        Self { value, error, grade: Grade::Proven }
    }

    /// A value with an estimate of its absolute error.
    pub const fn estimated(value: f64, error: f64) -> Self {
        Self { value, error, grade: Grade::Estimated }
    }

    /// The value of the finer of two resolutions, with their difference as an estimate of its error.
    pub fn of_resolutions(fine: f64, coarse: f64) -> Self {
        Self::estimated(fine, (fine - coarse).abs())
    }

    /// Adds an error of another origin.
    #[must_use]
    pub fn blurred(self, error: f64) -> Self {
        Self { error: self.error + error, ..self }
    }

    /// Lowers the grade to that of another number that the error depends on.
    #[must_use]
    pub fn graded(self, grade: Grade) -> Self {
        Self { grade: self.grade.min(grade), ..self }
    }

    /// `error/|value|`; the error itself where the value is 0.
    pub fn relative_error(self) -> f64 {
        if self.value == 0.0 { self.error } else { self.error / self.value.abs() }
    }

    /// `exp(−self)`, with the error carried through: `|d e^{−τ}| = e^{−τ} |dτ|`.
    #[must_use]
    pub fn exp_neg(self) -> Self {
        let value = (-self.value).exp();
        Self { value, error: value * self.error.exp_m1() + f64::EPSILON * value, ..self }
    }

    /// Power `self^k`, k ≥ 1, with the error carried through: `(|x| + δ)^k − |x|^k ≤ k (|x| + δ)^{k−1} δ`.
    #[must_use]
    pub fn powi(self, k: i32) -> Self {
        let slope = f64::from(k) * (self.value.abs() + self.error).powi(k - 1);
        Self { value: self.value.powi(k), error: slope * self.error, ..self }
    }
}

impl std::ops::Add for Known {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            error: self.error + other.error,
            grade: self.grade.min(other.grade),
        }
    }
}

impl std::ops::Sub for Known {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + other * -1.0
    }
}

impl std::ops::Mul<f64> for Known {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self { value: factor * self.value, error: factor.abs() * self.error, ..self }
    }
}

impl std::ops::Mul for Known {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let [a, b] = [self.value.abs(), other.value.abs()];
        Self {
            value: self.value * other.value,
            error: a * other.error + b * self.error + self.error * other.error,
            grade: self.grade.min(other.grade),
        }
    }
}

impl std::iter::Sum for Known {
    fn sum<I: Iterator<Item = Self>>(numbers: I) -> Self {
        numbers.fold(Self::new(0.0, 0.0), |sum, number| sum + number)
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

    /// Returns whether the stretch has no length.
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
        crate::order::ascend(&mut places);
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

    /// Returns whether `t` lies strictly inside.
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

    #[test]
    fn arithmetic_bounds_the_error_and_keeps_the_lower_grade() {
        let (a, b) = (Known::new(3.0, 0.5), Known::estimated(-2.0, 0.25));
        assert_eq!(a + b, Known::estimated(1.0, 0.75));
        assert_eq!(a - b, Known::estimated(5.0, 0.75));
        assert_eq!(a * 2.0, Known::new(6.0, 1.0));
        // Between 2.5 · −1.75 and 3.5 · −2.25.
        assert_eq!(a * b, Known::estimated(-6.0, 1.875));
        assert_eq!(a.powi(2), Known::new(9.0, 3.5));
        assert_eq!([a, a].into_iter().sum::<Known>(), Known::new(6.0, 1.0));
    }
}
