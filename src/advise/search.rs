//! Search of the σ̂ at which V·cost is smallest, and of the margins around it.
//!
//! All searches are on `ln x`, x a constant σ̂ or a factor on a field σ̂. A refused place has an infinite V·cost.

use numeric::roots;

/// Share of its limit by which V·cost may exceed it, where it only falls as σ̂ grows.
pub const ABOVE_LIMIT: f64 = 0.05;
/// Steps of the first, coarse search on each side of the natural scale, √2 each.
const STEPS: i32 = 9;
/// Tolerance of the best `ln x`: V·cost differs by its square.
const TOLERANCE: f64 = 5e-3;
/// Relative gain by a factor of ten that is near a limit.
const SETTLED: f64 = 1e-3;
/// Maximum number of factors of ten by which x follows a V·cost that still falls.
const DECADES: u32 = 7;
/// Largest factor of a margin: it stands for any larger one.
pub const MAX_FACTOR: f64 = 1024.0;
/// Significant digits of an advised σ̂.
const DIGITS: f64 = 4.0;

/// Kind of an advised σ̂.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// σ̂ is not free.
    Fixed,
    /// V·cost is smallest there.
    Optimum,
    /// V·cost falls towards a limit as σ̂ grows, and is 5 % above it there.
    NearLimit,
    /// V·cost still improves at the end of the search.
    EndOfSearch,
}

impl Kind {
    /// The words in tables and files.
    pub fn words(self) -> &'static str {
        match self {
            Self::Fixed => "",
            Self::Optimum => "optimum",
            Self::NearLimit => "within 5 % of the limit",
            Self::EndOfSearch => "end of the search",
        }
    }
}

/// The best x around `scale`, with its V·cost; `None` where every x is refused.
pub fn best(scale: f64, f: &dyn Fn(f64) -> f64) -> Option<(f64, f64, Kind)> {
    let step = 0.5 * 2f64.ln();
    let log = |i: i32| scale.ln() + f64::from(i) * step;
    let g = |log: f64| f(log.exp());
    let coarse: Vec<f64> = (-STEPS..=STEPS).map(|i| g(log(i))).collect();
    let least = (-STEPS..=STEPS).zip(&coarse).min_by(|a, b| a.1.total_cmp(b.1));
    let (place, &value) = least.filter(|least| least.1.is_finite())?;
    if value == 0.0 {
        return Some((log(place).exp(), value, Kind::Optimum));
    }
    if place == STEPS {
        return Some(towards_limit([log(place - 1), log(place)], value, &g));
    }
    let (mut around, mut middle) = ([place - 1, place, place + 1].map(log), value);
    let mut decades = 0;
    while place == -STEPS && decades < DECADES && g(around[0]) < middle {
        middle = g(around[0]);
        around = [around[0] - 10f64.ln(), around[0], around[1]];
        decades += 1;
    }
    let (found, least) = roots::least(around, middle, TOLERANCE, g);
    // A place of the coarse search may be the least σ̂ that is allowed, to all digits.
    let (found, least) = if least < middle { (found, least) } else { (around[1], middle) };
    let kind = if decades == DECADES { Kind::EndOfSearch } else { Kind::Optimum };
    let (x, value) = tidy(found.exp(), least, f);
    Some((x, value, kind))
}

/// Follows a V·cost that falls with `ln x`, from its last two places, to an optimum or towards a limit.
fn towards_limit(logs: [f64; 2], value: f64, g: &dyn Fn(f64) -> f64) -> (f64, f64, Kind) {
    let f = |x: f64| g(x.ln());
    let [mut last, mut now] = [(logs[0], f64::INFINITY), (logs[1], value)];
    for _ in 0..DECADES {
        let log = now.0 + 10f64.ln();
        let next = (log, g(log));
        if next.1 > now.1 {
            let (found, least) = roots::least([last.0, now.0, next.0], now.1, TOLERANCE, g);
            // V·cost falls towards a limit until a single draw has more lookups than the goal needs.
            let flat = least * (1.0 + ABOVE_LIMIT);
            if now.1 <= flat {
                return near([logs[0], found], flat, g);
            }
            let (x, value) = tidy(found.exp(), least, &f);
            return (x, value, Kind::Optimum);
        }
        (last, now) = (now, next);
        if now.1 >= last.1 * (1.0 - SETTLED) {
            return near([logs[0] - 10f64.ln(), now.0], now.1 * (1.0 + ABOVE_LIMIT), g);
        }
    }
    let (x, value) = tidy(now.0.exp(), now.1, &f);
    (x, value, Kind::EndOfSearch)
}

/// The least x with a V·cost of at most `level`.
fn near([low, high]: [f64; 2], level: f64, g: &dyn Fn(f64) -> f64) -> (f64, f64, Kind) {
    let log = bisect(low, high, |log| g(log) > level);
    let (x, value) = tidy(log.exp(), g(log), &|x| g(x.ln()));
    (x, value, Kind::NearLimit)
}

/// The place up to which `is_below` is true, as a value at which it is false, to the tolerance of the search.
fn bisect(mut low: f64, mut high: f64, is_below: impl Fn(f64) -> bool) -> f64 {
    while (high - low).abs() > TOLERANCE {
        let middle = 0.5 * (low + high);
        if is_below(middle) { low = middle } else { high = middle }
    }
    high
}

/// Rounds x up to few digits: an estimator that exists for a σ̂ exists for a larger one.
pub fn up(x: f64) -> f64 {
    let unit = 10f64.powf(x.log10().floor() + 1.0 - DIGITS);
    // A majorant is a little smaller than its rounding error allows.
    let rounded = (x / unit * (1.0 - 1e-12)).ceil() * unit;
    // A product of a whole number and a power of ten has rounding in its last digits.
    format!("{rounded:.11e}").parse().unwrap_or(x)
}

/// Rounds x up, unless that is refused.
fn tidy(x: f64, value: f64, f: &dyn Fn(f64) -> f64) -> (f64, f64) {
    let rounded = f(up(x));
    if rounded.is_finite() { (up(x), rounded) } else { (x, value) }
}

/// The factors below and above 1 by which x may be wrong before V·cost doubles; 0 and infinite where it does not within
/// a factor of 1024.
pub fn margins(x: f64, value: f64, f: &dyn Fn(f64) -> f64) -> [f64; 2] {
    let doubles = |factor: f64| f(x * factor) > 2.0 * value;
    let [low, high] = [-1.0, 1.0].map(|sign: f64| {
        let step = sign * 0.5 * 2f64.ln();
        let mut log = step;
        while log.abs() < MAX_FACTOR.ln() && !doubles(log.exp()) {
            log *= 1.5;
        }
        if log.abs() >= MAX_FACTOR.ln() {
            return if sign < 0.0 { 0.0 } else { f64::INFINITY };
        }
        let inside = if log == step { 0.0 } else { log / 1.5 };
        bisect(inside, log, |log| !doubles(log.exp())).exp()
    });
    [low, high]
}

/// The least x, down to x/1024, for which `exists` is true; 0 where it is true for all.
pub fn least(x: f64, exists: &dyn Fn(f64) -> bool) -> f64 {
    let mut log = 0.0;
    while log > -MAX_FACTOR.ln() {
        let next = log - 2f64.ln();
        if !exists(x * next.exp()) {
            let edge = bisect(next, log, |log| !exists(x * log.exp()));
            return x * edge.exp();
        }
        log = next;
    }
    0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_optimum_a_cliff_and_a_limit_are_found() {
        // x + 4/x: smallest at 2, doubled at 2(2 ± √3).
        let f = |x: f64| x + 4.0 / x;
        let (x, value, kind) = best(1.0, &f).expect("an optimum");
        assert!((x - 2.0).abs() < 0.02 && (value - 4.0).abs() < 1e-3 && kind == Kind::Optimum);
        let [low, high] = margins(2.0, 4.0, &f);
        assert!((low - 0.268).abs() < 2e-3 && (high - 3.732).abs() < 0.03, "{low} {high}");
        // Refused below 1: the best place is the edge itself, with few digits.
        let edge = 0.956_789_12;
        let cliff = |x: f64| if x < edge { f64::INFINITY } else { x };
        assert_eq!(best(edge, &cliff).map(|(x, ..)| x), Some(0.9568));
        assert!((least(2.0, &|x| x >= edge) / edge - 1.0).abs() < 0.01);
        assert_eq!(least(2.0, &|_| true), 0.0);
        // e^{1/x} − 1 times x falls to 1; it is 1.05 at 1/x = 0.0968.
        let limit = |x: f64| x * (1.0 / x).exp_m1();
        let (x, value, kind) = best(0.3, &limit).expect("near the limit");
        assert!((x * 0.0968 - 1.0).abs() < 0.02 && value < 1.0501, "{x} {value}");
        assert_eq!(kind, Kind::NearLimit);
        assert_eq!(best(1.0, &|_| f64::INFINITY), None);
    }
}
