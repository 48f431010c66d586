//! Double and single precision, as walks use them.

use numeric::{Lane, Narrow as F32};

/// Numbers of 2⁻²⁴.
pub const LATTICE: f64 = 16_777_216.0;

/// A precision.
pub trait Precision: Lane<Mask = bool> {
    /// A uniform number of a word, as renderers make it.
    fn uniform(word: u64) -> Self;
    /// The chance that such a number is below.
    fn chance(self) -> f64;
    /// As a double.
    fn double(self) -> f64;
    /// A constant.
    fn of(value: f64) -> Self;
    /// The chance that a flight of mean 1 ends within `reach`; exactly as the precision decides, where
    /// `inside` says so of a number: of 0, or none, and of all up to some number.
    fn chance_to_stay(reach: f64, inside: impl Fn(Self) -> bool) -> f64;
    /// The number at a share of those that have a chance.
    fn share(share: f64, chance: f64) -> Self;
}

impl Precision for f64 {
    #[inline(always)]
    fn uniform(word: u64) -> Self {
        (word >> 11) as f64 * (0.5 * f64::EPSILON)
    }

    #[inline(always)]
    fn chance(self) -> f64 {
        self.clamp(0.0, 1.0)
    }

    #[inline(always)]
    fn double(self) -> f64 {
        self
    }

    #[inline(always)]
    fn of(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn chance_to_stay(reach: f64, _: impl Fn(Self) -> bool) -> f64 {
        let x = reach.max(0.0);
        if x < 0.01 {
            // What 1 − e^{−x} would lose.
            let rest = (2..8).rev().fold(0.0, |rest, n| -x / f64::from(n) * (1.0 + rest));
            return x + x * rest;
        }
        if x < 50.0 { 1.0 - Lane::exp(-x) } else { 1.0 }
    }

    #[inline(always)]
    fn share(share: f64, chance: f64) -> Self {
        share * chance
    }
}

impl Precision for F32 {
    #[inline(always)]
    fn uniform(word: u64) -> Self {
        Self::of((word >> 40) as f64 / LATTICE)
    }

    #[inline(always)]
    fn chance(self) -> f64 {
        ((f64::from(self.0) * LATTICE).ceil() / LATTICE).clamp(0.0, 1.0)
    }

    #[inline(always)]
    fn double(self) -> f64 {
        f64::from(self.0)
    }

    #[inline(always)]
    fn of(value: f64) -> Self {
        F32::of(value)
    }

    #[inline(always)]
    fn chance_to_stay(reach: f64, inside: impl Fn(Self) -> bool) -> f64 {
        // Numbers below `within` are inside, `beyond` and all above are not.
        let is_inside = |number: f64| inside(F32::of(number / LATTICE));
        if is_inside(LATTICE - 1.0) {
            return 1.0;
        }
        let guess = (LATTICE * f64::chance_to_stay(reach, |_| true)).floor();
        let guess = guess.clamp(0.0, LATTICE - 1.0);
        let (mut within, mut beyond, mut width) = (guess + 1.0, LATTICE - 1.0, 1.0);
        if is_inside(guess) {
            while within < beyond && is_inside((within + width).min(beyond)) {
                within = (within + width).min(beyond) + 1.0;
                width *= 4.0;
            }
            beyond = (within + width).min(beyond);
        } else {
            beyond = guess;
            while beyond > 0.0 && !is_inside((beyond - width).max(0.0)) {
                beyond = (beyond - width).max(0.0);
                width *= 4.0;
            }
            within = (beyond - width).max(0.0).min(beyond);
        }
        while within < beyond {
            let middle = (0.5 * (within + beyond)).floor();
            if is_inside(middle) { within = middle + 1.0 } else { beyond = middle }
        }
        within / LATTICE
    }

    #[inline(always)]
    fn share(share: f64, chance: f64) -> Self {
        F32::of((share * (chance * LATTICE)).floor() / LATTICE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_chance_to_stay_counts_all_numbers_that_do() {
        // From places near the boundary and far from it, where rounding swallows short flights.
        for (from, path) in
            [(0.0, 0.3), (0.0, 1e-6), (0.999_999_9, 0.02), (0.97, 0.01), (1e5, 0.02)]
        {
            let (t, end) = (F32::of(from), F32::of(f64::floor(from) + 1.0));
            let inside = |u: F32| (t - (u.each(1.0) - u).ln() * path).below(end);
            let reach = (end - t).double() / path;
            let found = F32::chance_to_stay(reach, inside) * LATTICE;
            let at = |number: f64| inside(F32::of(number / LATTICE));
            assert!(found.fract() == 0.0 && (0.0..=LATTICE).contains(&found));
            assert!(found == 0.0 || at(found - 1.0), "{from} {path}: {found}");
            assert!(found == LATTICE || !at(found), "{from} {path}: {found}");
            let exact = f64::chance_to_stay(reach, |_| true);
            assert!(from > 1.0 || (found / LATTICE - exact).abs() < 2e-5, "{from} {path}: {found}");
        }
    }

    #[test]
    fn a_thin_stretch_keeps_the_digits_of_its_chance() {
        for reach in [1e-12, 1e-4, 0.009_999, 0.010_001, 3.0] {
            let exact = -f64::exp_m1(-reach);
            let found = f64::chance_to_stay(reach, |_| true);
            assert!((found / exact - 1.0).abs() < 1e-13, "{reach}: {found}");
        }
    }
}
