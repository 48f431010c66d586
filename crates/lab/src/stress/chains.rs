//! Moments of what a ray's walk scatters along it, as linear equations with series in 32 digits.
//!
//! In `x` with `s = foot + D sinh x`, `r = D cosh x`, functionals of the rest of a walk obey equations with
//! coefficients `rⁿ e^{−br}`. Each is continued from the ray's end to its beginning, from power series to
//! power series, a fifth of their radius at a time.
//!
//! ```text
//! U' = r A U − Σ f K V,   K = rⁿ⁺¹ e^{−br},   K' = K((n + 1) tanh x − b D sinh x),   V = 1 or a U before
//! ```

use std::f64::consts::FRAC_PI_2;

use super::series::{coefficient, value};
use numeric::Wide;

/// Terms of a series: at a fifth of its radius, 5⁻²⁸ = 3e-20 of the largest.
const TERMS: usize = 28;
const SHARE: f64 = 0.2;
/// The largest exponent of a step. That of a circle around it which is six times as wide, `1.2 sinh(2)/0.31`,
/// is 14: e¹⁴ 6⁻²⁸ = 2e-16 at the very most.
const STEEPEST: f64 = 1.2;

type Series = [Wide; TERMS];

/// What is added on the way: a factor, a kernel, and the functional that it multiplies.
#[derive(Debug, Clone, Copy)]
pub struct Term {
    /// f.
    pub factor: Wide,
    /// K, see [`Chain::kernel`].
    pub kernel: usize,
    /// V, see [`Chain::add`]; 1 if absent.
    pub of: Option<usize>,
}

struct Functional {
    rate: Wide,
    terms: Vec<Term>,
}

impl Functional {
    /// Of what is neither lost on the way nor left of anything that is.
    fn is_free(&self) -> bool {
        self.rate.high == 0.0 && self.terms.iter().all(|term| term.of.is_none())
    }
}

/// What is lost this many times e on the way back to the light's foot or the beginning is left out, if nothing
/// grows: e⁻¹³⁰ = 3e-57.
const LOST: f64 = 130.0;

/// Functionals of a ray and a light.
pub struct Chain {
    distance: Wide,
    foot: f64,
    ends: [Wide; 2],
    kernels: Vec<(i32, Wide)>,
    functionals: Vec<Functional>,
}

/// arsinh, of the size of its argument.
pub fn arsinh(x: Wide) -> Wide {
    let size = x.abs();
    let near = (size + size * size / (1.0 + (1.0 + size * size).sqrt())).ln_1p();
    if x.high < 0.0 { -near } else { near }
}

impl Chain {
    /// On a ray from 0.
    pub fn new(distance: f64, foot: f64, length: f64) -> Self {
        let distance = Wide::from(distance);
        let ends = [0.0, length].map(|s| arsinh((Wide::from(s) - foot) / distance));
        Self { distance, foot, ends, kernels: Vec::new(), functionals: Vec::new() }
    }

    /// `rⁿ e^{−br} ds`.
    pub fn kernel(&mut self, power: i32, loss: Wide) -> usize {
        let wanted = (power, loss);
        let found = self.kernels.iter().position(|kernel| *kernel == wanted);
        found.unwrap_or_else(|| {
            self.kernels.push(wanted);
            self.kernels.len() - 1
        })
    }

    /// `U(s) = Σ f ∫ₛ K V e^{−A(t − s)} dt`.
    pub fn add(&mut self, rate: Wide, terms: Vec<Term>) -> usize {
        self.functionals.push(Functional { rate, terms });
        self.functionals.len() - 1
    }

    /// All functionals at the beginning of the ray.
    pub fn solve(&self) -> Vec<Wide> {
        let lost = self.functionals.iter().filter(|functional| !functional.is_free());
        let least = lost.map(|functional| functional.rate.high).fold(f64::INFINITY, f64::min);
        let far = if least > 0.0 { self.foot.max(0.0) + LOST / least } else { f64::INFINITY };
        let mut values = vec![Wide::default(); self.functionals.len()];
        let [begin, end] = self.ends;
        let far = arsinh(Wide::from((far - self.foot) / self.distance.high));
        let middle = if far.high < end.high { far } else { end };
        let middle = if middle.high > begin.high { middle } else { begin };
        self.over(&mut values, [middle, end], true);
        self.over(&mut values, [begin, middle], false);
        values
    }

    /// Continues from the end of a stretch to its beginning, all functionals or those that are free.
    fn over(&self, values: &mut [Wide], [begin, end]: [Wide; 2], only_free: bool) {
        let wanted: Vec<bool> =
            self.functionals.iter().map(|functional| !only_free || functional.is_free()).collect();
        let used = |kernel: usize| {
            let mut functionals =
                self.functionals.iter().zip(&wanted).filter(|(_, wanted)| **wanted);
            functionals.any(|(functional, _)| functional.terms.iter().any(|t| t.kernel == kernel))
        };
        let used: Vec<bool> = (0..self.kernels.len()).map(used).collect();
        let kernels = || self.kernels.iter().zip(&used).filter(|(_, used)| **used);
        let rates = self.functionals.iter().zip(&wanted).filter(|(_, wanted)| **wanted);
        let rates = rates.map(|(functional, _)| functional.rate.high.abs());
        let losses = kernels().map(|((_, loss), _)| loss.high.abs());
        let steepest = rates.fold(0.0, f64::max) + losses.fold(0.0, f64::max);
        let powers = kernels().map(|(&(power, _), _)| f64::from(power + 1).abs());
        let highest = powers.fold(0.0, f64::max);
        let mut at = end;
        while at.high > begin.high {
            let mut step = (SHARE * at.high.hypot(FRAC_PI_2)).min(1.0);
            let radius = self.distance.high * at.high.abs().cosh();
            step = step.min(STEEPEST / (highest + steepest * radius * step.exp()));
            let next = at - step;
            let next = if next.high > begin.high { next } else { begin };
            self.continued(values, [at, next - at], [&wanted, &used]);
            at = next;
        }
    }

    fn continued(&self, values: &mut [Wide], [at, step]: [Wide; 2], [wanted, used]: [&[bool]; 2]) {
        let (grown, mut radius, mut along) = (at.exp(), zero(), zero());
        let [cosh, sinh] =
            [Wide::ONE, -Wide::ONE].map(|sign| (grown + sign / grown).scaled(-1) * self.distance);
        let mut factor = Wide::ONE;
        for n in 0..TERMS {
            let pair = if n % 2 == 0 { [cosh, sinh] } else { [sinh, cosh] };
            [radius[n], along[n]] = pair.map(|x| x * factor);
            factor = factor / (n + 1) as f64;
        }
        let mut tanh = zero();
        tanh[0] = sinh / cosh;
        for n in 0..TERMS - 1 {
            let one = if n == 0 { 1.0 } else { 0.0 };
            tanh[n + 1] = (one - coefficient(&tanh, &tanh, n)) * share(n);
        }
        let kernel = |(&(power, loss), &used): (&(i32, Wide), &bool)| {
            if !used {
                return zero();
            }
            let power = power + 1;
            let raised = cosh.powi(power.unsigned_abs());
            let raised = if power < 0 { 1.0 / raised } else { raised };
            let rate: Series =
                std::array::from_fn(|n| f64::from(power) * tanh[n] - loss * along[n]);
            let mut series = zero();
            series[0] = raised * (-(loss * cosh)).exp();
            for n in 0..TERMS - 1 {
                series[n + 1] = coefficient(&series, &rate, n) * share(n);
            }
            series
        };
        let kernels: Vec<Series> = self.kernels.iter().zip(used).map(kernel).collect();
        let mut all: Vec<Series> = Vec::with_capacity(values.len());
        let functionals = self.functionals.iter().zip(wanted);
        for ((Functional { rate, terms }, &is_wanted), at_end) in functionals.zip(values) {
            let mut series = zero();
            if !is_wanted {
                all.push(series);
                continue;
            }
            series[0] = *at_end;
            for n in 0..TERMS - 1 {
                let mut sum = Wide::default();
                if rate.high != 0.0 {
                    sum = *rate * coefficient(&radius, &series, n);
                }
                for term in terms {
                    let kernel = &kernels[term.kernel];
                    let more = term.of.map_or(kernel[n], |of| coefficient(kernel, &all[of], n));
                    sum = sum - term.factor * more;
                }
                series[n + 1] = sum * share(n);
            }
            *at_end = value(&series, step);
            all.push(series);
        }
    }
}

fn zero() -> Series {
    [Wide::default(); TERMS]
}

/// 1/(n + 1).
fn share(n: usize) -> Wide {
    Wide::ONE / (n + 1) as f64
}
