//! Search of a σ̂, or of a factor on it: the place at which a function is smallest, and the edges of a level around it.
//!
//! All searches are on `ln x`. Values are kept, so that a search and its edges share them.

use std::cell::RefCell;
use std::f64::consts::{LN_2, LN_10};

use numeric::{order, roots};

/// Share of the least value by which a place near a limit may exceed it.
pub const ABOVE_LIMIT: f64 = 0.05;
/// Values from here on cannot be taken: too expensive, unknown, refused.
pub const BEYOND: f64 = 1e300;
/// Value where theory knows no variance or cost. A place that an inequality refuses has an infinite value.
pub const UNKNOWN: f64 = f64::MAX;
/// Largest factor of an edge: it stands for any larger one.
pub const MAX_FACTOR: f64 = 1024.0;
/// Factor beyond which no edge is sought.
const FURTHEST: f64 = MAX_FACTOR * MAX_FACTOR * MAX_FACTOR;
/// Tolerance of the best `ln x`, of which V·cost differs by the square, and of an edge.
const TOLERANCE: f64 = 5e-3;
/// Factor by which values rise within a few tolerances of a steep minimum.
const STEEP: f64 = 1.05;
/// Relative gain of a step that ends a descent.
const SETTLED: f64 = 1e-3;
/// Maximum number of steps of a descent beyond the first places, the last ones by a factor of ten.
const DESCENT: usize = 9;
/// Distance in `ln x` within which an edge of the domain makes a place the best.
const CLIFF: f64 = 0.02;
/// Factor below the best place at which a value that is hardly larger makes it a limit.
const FLAT: f64 = 4.0;
/// Significant digits of an advised place.
const DIGITS: f64 = 4.0;

/// Kind of a place.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum PlaceKind {
    /// Nothing is free.
    #[default]
    Fixed,
    /// The value is smallest there.
    Optimum,
    /// The value falls towards a limit with x, and is a given share above it there.
    NearLimit,
    /// The variance is 0 there.
    NoVariance,
    /// The value still falls at the end of the search.
    EndOfSearch,
}

impl PlaceKind {
    /// Returns the words in tables and files.
    pub fn words(self) -> &'static str {
        match self {
            Self::Fixed => "",
            Self::Optimum => "optimum",
            Self::NearLimit => "within 5 % of the limit",
            Self::NoVariance => "no variance",
            Self::EndOfSearch => "end of the search",
        }
    }
}

/// Least value of a search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Least {
    /// Its place.
    pub x: f64,
    /// Value there.
    pub value: f64,
    /// True if values still fall at the end of the search.
    pub is_open: bool,
}

/// Function of x with the values that are known.
pub struct Goal<'a> {
    f: Box<dyn Fn(f64) -> f64 + Send + 'a>,
    /// `ln x` with the values.
    known: RefCell<Vec<[f64; 2]>>,
    /// Tolerance of `ln x`.
    tolerance: f64,
}

impl<'a> Goal<'a> {
    /// Returns a function of which nothing is known.
    pub fn new(f: impl Fn(f64) -> f64 + Send + 'a) -> Self {
        Self::knowing(Vec::new(), TOLERANCE, f)
    }

    /// Returns a function with known values at some `ln x`, and a tolerance.
    pub fn knowing(
        known: Vec<[f64; 2]>,
        tolerance: f64,
        f: impl Fn(f64) -> f64 + Send + 'a,
    ) -> Self {
        Self { f: Box::new(f), known: RefCell::new(known), tolerance }
    }

    /// Returns the value at x.
    pub fn of(&self, x: f64) -> f64 {
        self.at(x.ln())
    }

    /// Returns the value at `ln x`.
    pub fn at(&self, log: f64) -> f64 {
        let known = self.known.borrow().iter().find(|known| known[0] == log).copied();
        known.map_or_else(
            || {
                let value = (self.f)(log.exp());
                self.known.borrow_mut().push([log, value]);
                value
            },
            |[_, value]| value,
        )
    }

    /// Returns `ln x` of the least value between three, and the value.
    pub fn between(&self, around: [f64; 3]) -> (f64, f64) {
        roots::least(around, self.at(around[1]), self.tolerance, &mut |log| self.at(log))
    }

    /// Returns three `ln x` around the least value of places that are apart by a factor of two, `reach` on each side of
    /// `start`, and beyond them as far as values fall; and whether they still fall there.
    fn bracket(&self, start: f64, reach: i32) -> ([f64; 3], bool) {
        let at = |k: i32| start.ln() + f64::from(k) * LN_2;
        let value = |k: i32| self.at(at(k));
        // Of equal places the one next to the start.
        let order = |a: &i32, b: &i32| value(*a).total_cmp(&value(*b)).then(a.abs().cmp(&b.abs()));
        let k = (-reach..=reach).min_by(order).unwrap_or(0);
        let mut around = [at(k - 1), at(k), at(k + 1)];
        let mut step = LN_2;
        for _ in 0..DESCENT {
            let [low, middle, high] = around;
            let falls = |end| self.at(end) < self.at(middle) * (1.0 - SETTLED);
            step = (2.0 * step).min(LN_10);
            around = match (falls(low), falls(high)) {
                (false, false) => return (around, false),
                (true, false) => [low - step, low, middle],
                (_, true) => [middle, high, high + step],
            };
        }
        (around, true)
    }

    /// Returns the least value near `start`; `None` where no place can be taken. A place with a value above `enough` is
    /// not searched to the end.
    pub fn least(&self, start: f64, reach: i32, enough: f64) -> Option<Least> {
        let (around, is_open) = self.bracket(start, reach);
        let middle = self.at(around[1]);
        let is_cliff = || {
            self.at(around[0]).is_infinite()
                && self.at(around[1] - CLIFF).is_infinite()
                && self.at(around[1] + CLIFF) >= middle
        };
        let is_last = middle >= BEYOND || middle > enough || is_cliff();
        let (log, value) = if is_last { (around[1], middle) } else { self.between(around) };
        // Where the variance vanishes at one σ̂, the tolerance is too wide.
        let is_steep = |&[place, other]: &[f64; 2]| {
            (place - log).abs() < 4.0 * self.tolerance && (STEEP * value..BEYOND).contains(&other)
        };
        let is_steep = value < BEYOND && self.known.borrow().iter().any(is_steep);
        let (log, value) = if is_steep {
            let around = [log - 2.0 * self.tolerance, log, log + 2.0 * self.tolerance];
            roots::least(around, value, 0.02 * self.tolerance, &mut |log| self.at(log))
        } else {
            (log, value)
        };
        (value < BEYOND).then(|| Least { x: log.exp(), value, is_open })
    }

    /// Returns the place to advise, with few digits, its value and its kind, given the least value.
    pub fn settled(&self, Least { mut x, mut value, is_open }: Least) -> (f64, f64, PlaceKind) {
        let mut kind = if is_open { PlaceKind::EndOfSearch } else { PlaceKind::Optimum };
        if !is_open && self.of(x / FLAT) <= value * (1.0 + ABOVE_LIMIT) {
            // The search ends where little is gained: the limit itself lies far beyond.
            let level = value.min(self.of(x * MAX_FACTOR)) * (1.0 + ABOVE_LIMIT);
            let edge = self.edge(x, -1.0, level, FURTHEST);
            // Where no σ̂ is too small, one is as good as another.
            if edge > 0.0 {
                (x, kind) = (x * edge, PlaceKind::NearLimit);
                value = self.of(x);
            }
        }
        // A σ̂ that is rounded up exists as well.
        let rounded = self.of(up(x));
        if rounded < BEYOND { (up(x), rounded, kind) } else { (x, value, kind) }
    }

    /// Returns the place to advise near `start`; `None` where no place can be taken.
    pub fn best(&self, start: f64, reach: i32) -> Option<(f64, f64, PlaceKind)> {
        self.least(start, reach, f64::INFINITY).map(|minimum| self.settled(minimum))
    }

    /// Returns the factor on x, below 1 for the sign −1 and above for 1, up to which the value is at most `level`; 0 or
    /// infinite where that is further than `furthest`.
    pub fn edge(&self, x: f64, sign: f64, level: f64, furthest: f64) -> f64 {
        let (from, furthest) = (x.ln(), furthest.ln());
        let mut beyond: Vec<f64> = self.known.borrow().iter().map(|known| known[0]).collect();
        beyond.retain(|log| sign * (log - from) > 0.0);
        order::ascend(&mut beyond);
        if sign < 0.0 {
            beyond.reverse();
        }
        let inside = beyond.iter().take_while(|log| self.at(**log) <= level).count();
        let mut outside = beyond.get(inside).copied();
        let mut inside = if inside > 0 { beyond[inside - 1] } else { from };
        while outside.is_none() {
            let distance = (inside - from).abs();
            if distance >= furthest - self.tolerance {
                return if sign < 0.0 { 0.0 } else { f64::INFINITY };
            }
            let next = from + sign * (4.0 * distance).clamp(LN_2, furthest);
            if self.at(next) <= level { inside = next } else { outside = Some(next) }
        }
        let mut outside = outside.unwrap_or(inside);
        let above = |log: f64| (self.at(log) / level).ln();
        let mut is_secant = true;
        while (outside - inside).abs() > self.tolerance {
            let slope = (above(outside) - above(inside)) / (outside - inside);
            let share = -above(inside) / slope / (outside - inside);
            let share = if is_secant && (0.02..0.98).contains(&share) { share } else { 0.5 };
            let place = inside + share * (outside - inside);
            let distance = above(place) / slope * sign;
            if (-self.tolerance..0.2 * self.tolerance).contains(&distance) && slope.is_finite() {
                return (place - from).exp();
            }
            // A secant that does not halve what is left is followed by halves.
            let left = if above(place) > 0.0 { share } else { 1.0 - share };
            is_secant = left <= 0.5;
            if above(place) > 0.0 { outside = place } else { inside = place }
        }
        (inside - from).exp()
    }
}

/// Rounds x up to few digits: an estimator that exists for a σ̂ exists for a larger one.
pub fn up(x: f64) -> f64 {
    let unit = 10f64.powf(x.log10().floor() + 1.0 - DIGITS);
    // A majorant is a little smaller than its rounding error allows.
    let rounded = (x / unit * (1.0 - 1e-12)).ceil() * unit;
    // A product of a whole number and a power of ten has rounding in its last digits.
    format!("{rounded:.11e}").parse().unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_optimum_a_cliff_and_a_limit_are_found() {
        // x + 4/x: smallest at 2, doubled at 2(2 ± √3).
        let goal = Goal::new(|x| x + 4.0 / x);
        let (x, value, kind) = goal.best(1.0, 2).expect("an optimum");
        assert!((x - 2.0).abs() < 0.02 && (value - 4.0).abs() < 1e-3 && kind == PlaceKind::Optimum);
        let [low, high] = [-1.0, 1.0].map(|sign| goal.edge(2.0, sign, 8.0, MAX_FACTOR));
        assert!((low - 0.268).abs() < 2e-3 && (high - 3.732).abs() < 0.03, "{low} {high}");
        assert!(goal.known.borrow().len() < 30, "{} values", goal.known.borrow().len());
        // Refused below 1: the best place is the edge itself, with few digits.
        let edge = 0.956_789_12;
        let cliff = Goal::new(|x| if x < edge * (1.0 - 1e-12) { f64::INFINITY } else { x });
        assert_eq!(cliff.best(edge, 2).map(|(x, ..)| x), Some(0.9568));
        assert!((2.0 * cliff.edge(2.0, -1.0, UNKNOWN, MAX_FACTOR) / edge - 1.0).abs() < 0.01);
        assert_eq!(goal.edge(2.0, -1.0, UNKNOWN, MAX_FACTOR), 0.0);
        // (e^{1/x} − 1) x falls to 1; it is 1.05 at 1/x = 0.0968.
        let limit = Goal::new(|x: f64| x * (1.0 / x).exp_m1());
        let (x, value, kind) = limit.best(0.3, 2).expect("near the limit");
        assert!((x * 0.0968 - 1.0).abs() < 0.02 && value < 1.0501, "{x} {value}");
        assert_eq!(kind, PlaceKind::NearLimit);
        assert_eq!(Goal::new(|_| f64::INFINITY).best(1.0, 2), None);
    }
}
