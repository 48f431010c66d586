//! Two-stream equations along a rod from 0 to 1, by power series in 32 digits.
//!
//! Rates are constant in stretches. Each step of a stretch has its power series in t, its own width; what leaves it
//! is joined from the end of the rod backwards.
//!
//! ```text
//! m± = Σ mₙ± tⁿ, step h:   (n + 1) m⁺ₙ₊₁ = h(A m⁺ₙ − B m⁻ₙ − s⁺ₙ),   (n + 1) m⁻ₙ₊₁ = h(B m⁺ₙ − A m⁻ₙ + s⁻ₙ)
//! ```

use super::series::{self, constant};
use numeric::Wide;

/// Terms of a series: where the rates of a step add up to a half, 2⁻²²/22! = 2e-28.
pub(super) const TERMS: usize = 22;

/// A power series over a step.
pub(super) type Series = series::Series<TERMS>;

/// Worth of a particle that goes forward, and of one that goes backward.
pub(super) type Both = [Series; 2];

/// Nothing.
pub(super) const NOTHING: Both = [[Wide { high: 0.0, low: 0.0 }; TERMS]; 2];

/// A step of a rod.
#[derive(Debug, Clone, Copy)]
pub(super) struct Step {
    /// Number of its stretch.
    pub stretch: usize,
    /// Its beginning.
    pub from: Wide,
    /// Its width.
    pub width: Wide,
}

/// A rod in steps.
pub(super) struct Line(pub Vec<Step>);

impl Line {
    /// Cuts equal stretches with the given sums of absolute rates into steps.
    pub fn new(rates: &[f64]) -> Self {
        let cut = |(stretch, &rate): (usize, &f64)| {
            let count = (2.0 * rate / rates.len() as f64).ceil().max(1.0);
            let width = Wide::ONE / (rates.len() as f64 * count);
            let begin = Wide::from(stretch as f64) / rates.len() as f64;
            let steps = (0..).map(f64::from).take_while(move |&i| i < count);
            steps.map(move |i| Step { stretch, from: begin + width * i, width })
        };
        Self(rates.iter().enumerate().flat_map(cut).collect())
    }

    /// The series of all steps, where leaving at the beginning and at the end is worth `ends`: A and B of a
    /// stretch, and the source of a step by its number.
    pub fn solve(
        &self,
        rates: &dyn Fn(usize) -> [Wide; 2],
        source: &dyn Fn(usize) -> Both,
        ends: [Wide; 2],
    ) -> Vec<Both> {
        // What follows from m₊ = 1, from m₋ = 1, and from the source alone.
        let mut basis: Vec<[Both; 3]> = Vec::with_capacity(self.0.len());
        for (i, step) in self.0.iter().enumerate() {
            let rates = rates(step.stretch).map(|rate| rate * step.width);
            let source = source(i).map(|series| series.map(|x| step.width * x));
            let own = continued(rates, [Wide::default(); 2], &source);
            let is_same = i > 0 && self.0[i - 1].stretch == step.stretch;
            let [plus, minus] = if is_same {
                [basis[i - 1][0], basis[i - 1][1]]
            } else {
                let (zero, one) = (Wide::default(), Wide::ONE);
                [[one, zero], [zero, one]].map(|begin| continued(rates, begin, &NOTHING))
            };
            basis.push([plus, minus, own]);
        }
        // m₊ = ρ m₋ + η at the beginning of each step.
        let mut beyond = vec![[Wide::default(), ends[1]]];
        for basis in basis.iter().rev() {
            let [rho, eta] = beyond[beyond.len() - 1];
            let [of_plus, of_minus, own] = basis.each_ref().map(|both| both.each_ref().map(at_end));
            let left = |[plus, minus]: [Wide; 2]| plus - rho * minus;
            let scale = left(of_plus);
            beyond.push([-left(of_minus) / scale, (eta - left(own)) / scale]);
        }
        let mut minus = ends[0];
        let joined = basis.iter().zip(beyond.iter().rev()).map(|(basis, &[rho, eta])| {
            let factors = [rho * minus + eta, minus, Wide::ONE];
            let both: Both = std::array::from_fn(|way| {
                std::array::from_fn(|n| (0..3).map(|i| factors[i] * basis[i][way][n]).sum())
            });
            minus = at_end(&both[1]);
            both
        });
        joined.collect()
    }
}

fn at_end(series: &Series) -> Wide {
    series.iter().rev().copied().sum()
}

/// The series of a step with rates and a source for its whole width.
fn continued([a, b]: [Wide; 2], begin: [Wide; 2], source: &Both) -> Both {
    let mut found = begin.map(constant);
    for n in 0..TERMS - 1 {
        let (plus, minus) = (found[0][n], found[1][n]);
        let share = Wide::ONE / (n + 1) as f64;
        found[0][n + 1] = (a * plus - b * minus - source[0][n]) * share;
        found[1][n + 1] = (b * plus - a * minus + source[1][n]) * share;
    }
    found
}

/// Worth after a collision that leads onward or turns, with these factors.
pub(super) fn after([onward, turned]: [Wide; 2], [plus, minus]: &Both) -> Both {
    let mixed = |a: &Series, b: &Series| -> Series {
        std::array::from_fn(|n| onward * a[n] + turned * b[n])
    };
    [mixed(plus, minus), mixed(minus, plus)]
}
