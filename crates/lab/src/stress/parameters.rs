//! Strategies for the parameters of trials.
//!
//! Numbers shrink to fewer digits, so that a failure can be repeated by hand.

use std::fmt::Debug;

use proptest::strategy::{NewTree, Strategy, ValueTree};
use proptest::test_runner::TestRunner;

/// Declares a struct of parameters, and `any()`, the strategy that draws it, given its arguments if there are any.
macro_rules! parameters {
    ($(
        $(#[$doc:meta])*
        $name:ident $(($($given:ident: $of:ty),*))? { $($field:ident: $type:ty = $strategy:expr,)* }
    )*) => {$(
        $(#[$doc])*
        #[derive(Debug, Clone)]
        struct $name {
            $($field: $type,)*
        }

        impl $name {
            fn any($($($given: $of),*)?) -> impl proptest::strategy::Strategy<Value = Self> {
                proptest::strategy::Strategy::prop_map(
                    ($($strategy,)*),
                    |($($field,)*)| Self { $($field,)* },
                )
            }
        }
    )*};
}
pub(super) use parameters;

/// Distribution of a number.
#[derive(Debug, Clone, Copy)]
enum NumberDistribution {
    Uniform,
    LogUniform,
    NearEnds,
}

/// Strategy for a number in an interval.
#[derive(Debug, Clone, Copy)]
pub struct NumberStrategy {
    low: f64,
    high: f64,
    kind: NumberDistribution,
}

/// Uniform number in `[low, high)`.
pub fn between(low: f64, high: f64) -> NumberStrategy {
    NumberStrategy { low, high, kind: NumberDistribution::Uniform }
}

/// Number between two powers of ten, uniform in its logarithm.
pub fn sized(low: f64, high: f64) -> NumberStrategy {
    NumberStrategy {
        low: 10f64.powf(low),
        high: 10f64.powf(high),
        kind: NumberDistribution::LogUniform,
    }
}

/// Number in [0, 1], often next to an end.
pub fn share() -> NumberStrategy {
    NumberStrategy { low: 0.0, high: 1.0, kind: NumberDistribution::NearEnds }
}

/// One item of a list.
pub fn any_of<T: Copy + Debug + 'static>(items: &'static [T]) -> impl Strategy<Value = T> {
    (0..items.len()).prop_map(|index| items[index])
}

/// 1 or −1.
pub fn sign() -> impl Strategy<Value = f64> {
    any_of(&[1.0, -1.0])
}

/// A number and its shorter forms.
#[derive(Debug, Clone, Copy)]
pub struct Digits {
    exact: f64,
    number: NumberStrategy,
    /// Significant digits shown; all of them at [`Digits::ALL`].
    shown: usize,
    is_shrunk: bool,
}

impl Digits {
    const ALL: usize = 17;
}

impl Strategy for NumberStrategy {
    type Tree = Digits;
    type Value = f64;

    fn new_tree(&self, runner: &mut TestRunner) -> NewTree<Self> {
        use proptest::prelude::Rng;
        let mut uniform = || (runner.rng().next_u64() >> 11) as f64 * (0.5 * f64::EPSILON);
        let Self { low, high, kind } = *self;
        let decades = |u: f64, low: f64, high: f64| 10f64.powf(low + (high - low) * u);
        let exact = match kind {
            NumberDistribution::Uniform => low + (high - low) * uniform(),
            NumberDistribution::LogUniform => decades(uniform(), low.log10(), high.log10()),
            NumberDistribution::NearEnds => {
                let [kind, u] = [5.0 * uniform(), uniform()];
                match kind {
                    0.0..1.0 => decades(u, -12.0, -1.0),
                    1.0..2.0 => 1.0 - decades(u, -15.0, -1.0),
                    2.0..3.0 => (2.999 * u).floor() * 0.5,
                    _ => u,
                }
            }
        };
        Ok(Digits { exact, number: *self, shown: Digits::ALL, is_shrunk: false })
    }
}

impl ValueTree for Digits {
    type Value = f64;

    fn current(&self) -> f64 {
        if self.shown == Self::ALL {
            return self.exact;
        }
        let short = format!("{:.*e}", self.shown - 1, self.exact).parse();
        short.unwrap_or(self.exact).clamp(self.number.low, self.number.high)
    }

    fn simplify(&mut self) -> bool {
        if std::mem::replace(&mut self.is_shrunk, true) {
            return false;
        }
        self.shown = 1;
        true
    }

    fn complicate(&mut self) -> bool {
        if self.shown >= Self::ALL {
            return false;
        }
        self.shown = (self.shown + 2).min(Self::ALL);
        true
    }
}
