//! Roots and minima of functions of one variable.
//!
//! What draws do not wait for takes a function by reference, and is compiled once for all of them.

/// The root of a function that changes sign on `[low, high]`, by bisection with secant steps
/// (regula falsi in the Illinois form), to the last bits of the bracket.
///
/// Where both ends have one sign, the end with the smaller absolute value is returned.
pub fn root(mut low: f64, mut high: f64, f: &dyn Fn(f64) -> f64) -> f64 {
    let (mut f_low, mut f_high) = (f(low), f(high));
    if f_low == 0.0 || (f_low > 0.0) == (f_high > 0.0) && f_low.abs() < f_high.abs() {
        return low;
    }
    if (f_low > 0.0) == (f_high > 0.0) {
        return high;
    }
    for step in 0..200 {
        let width = high - low;
        let secant = high - f_high * width / (f_high - f_low);
        let inside = secant > low && secant < high && step % 3 != 2;
        let middle = if inside { secant } else { low + 0.5 * width };
        if middle <= low || middle >= high {
            break;
        }
        let f_middle = f(middle);
        if f_middle == 0.0 {
            return middle;
        }
        if (f_middle > 0.0) == (f_low > 0.0) {
            (low, f_low) = (middle, f_middle);
            f_high *= 0.5;
        } else {
            (high, f_high) = (middle, f_middle);
            f_low *= 0.5;
        }
        if high - low <= 4.0 * f64::EPSILON * high.abs().max(low.abs()) {
            break;
        }
    }
    0.5 * (low + high)
}

/// The root of a function that rises from below zero at `low` to above zero at `high`, by Newton's
/// steps kept within the bracket; `f` returns the value and the slope.
pub fn rising(low: f64, high: f64, f: impl FnMut(f64) -> (f64, f64)) -> f64 {
    rising_from(0.5 * (low + high), [low, high], |_, _| false, f)
}

/// The root of a rising function, as by [`rising`], from a first guess within the bracket. Stops after a step that is
/// lost in rounding, or if `is_last` is true of the step and the slope.
pub fn rising_from(
    mut x: f64,
    [mut low, mut high]: [f64; 2],
    is_last: impl Fn(f64, f64) -> bool,
    mut f: impl FnMut(f64) -> (f64, f64),
) -> f64 {
    for _ in 0..200 {
        let (value, slope) = f(x);
        let step = value / slope;
        if value == 0.0 || step.abs() <= f64::EPSILON * x.abs() || is_last(step, slope) {
            return if step.is_finite() { (x - step).max(low).min(high) } else { x };
        }
        if value < 0.0 {
            low = x;
        } else {
            high = x;
        }
        let next = x - step;
        // A flat stretch sends the step away: halve instead.
        x = if next > low && next < high { next } else { 0.5 * (low + high) };
        if x <= low || x >= high {
            break;
        }
    }
    x
}

/// The place of the only minimum of a function on `[low, high]`, by golden sections until the bracket is `tolerance`
/// wide.
///
/// Source: J. Kiefer, *Sequential minimax search for a maximum*, Proc. AMS 4 (1953), 502–506.
pub fn minimum(mut low: f64, mut high: f64, tolerance: f64, f: &dyn Fn(f64) -> f64) -> f64 {
    const SECTION: f64 = 0.618_033_988_749_894_9;
    let mut left = high - SECTION * (high - low);
    let mut right = low + SECTION * (high - low);
    let (mut f_left, mut f_right) = (f(left), f(right));
    while high - low > tolerance && left < right {
        if f_left <= f_right {
            (high, right, f_right) = (right, left, f_left);
            left = high - SECTION * (high - low);
            f_left = f(left);
        } else {
            (low, left, f_left) = (left, right, f_right);
            right = low + SECTION * (high - low);
            f_right = f(right);
        }
    }
    0.5 * (low + high)
}

/// The place of the minimum of a function between two places about a third, to `tolerance`, and the minimum: by
/// parabolas where they help, else by golden sections. `f` was evaluated at the returned place: next to a jump it is
/// on the side of the smaller values.
///
/// Source: R. P. Brent, *Algorithms for Minimization Without Derivatives* (Prentice-Hall, 1973), chapter 5.
pub fn least(
    [mut low, start, mut high]: [f64; 3],
    at_start: f64,
    tolerance: f64,
    f: &mut dyn FnMut(f64) -> f64,
) -> (f64, f64) {
    const SECTION: f64 = 0.381_966_011_250_105_1;
    // The best place with its value, the second, and the one before that.
    let [mut x, mut w, mut v] = [(start, at_start); 3];
    let (mut step, mut before) = (0.0f64, 0.0f64);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if (x.0 - middle).abs() <= 2.0 * tolerance - 0.5 * (high - low) {
            break;
        }
        let (r, q) = ((x.0 - w.0) * (x.1 - v.1), (x.0 - v.0) * (x.1 - w.1));
        let (p, q) = ((x.0 - v.0) * q - (x.0 - w.0) * r, 2.0 * (q - r));
        let parabola = -p / q;
        let lands = x.0 + parabola;
        let helps = before.abs() > tolerance
            && parabola.abs() < 0.5 * before.abs()
            && lands > low
            && lands < high;
        let towards = if x.0 < middle { high - x.0 } else { low - x.0 };
        if helps {
            (before, step) = (step, parabola);
            if lands - low < 2.0 * tolerance || high - lands < 2.0 * tolerance {
                step = tolerance.copysign(towards);
            }
        } else {
            (before, step) = (towards, SECTION * towards);
        }
        let place = x.0 + if step.abs() < tolerance { tolerance.copysign(step) } else { step };
        let u = (place, f(place));
        if u.1 <= x.1 {
            if u.0 < x.0 {
                high = x.0;
            } else {
                low = x.0;
            }
            (v, w, x) = (w, x, u);
        } else {
            if u.0 < x.0 {
                low = u.0;
            } else {
                high = u.0;
            }
            if u.1 <= w.1 || w.0 == x.0 {
                (v, w) = (w, u);
            } else if u.1 <= v.1 || v.0 == x.0 || v.0 == w.0 {
                v = u;
            }
        }
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_a_root_to_the_last_bits() {
        let x = root(0.0, 3.0, &|x| x * x - 2.0);
        assert!((x - 2.0f64.sqrt()).abs() < 1e-15);
        assert_eq!(root(0.0, 1.0, &|x| x), 0.0);
    }

    #[test]
    fn finds_a_rising_root_across_a_flat_stretch() {
        let cube = |x: f64| ((x - 1.0).powi(3) - 1e-3, 3.0 * (x - 1.0).powi(2));
        assert!((rising(0.0, 5.0, cube) - 1.1).abs() < 1e-14);
    }

    #[test]
    fn a_good_guess_takes_one_step() {
        let mut requested = 0;
        let root = rising_from(
            1.414,
            [1.0, 2.0],
            |step, _| step.abs() < 1e-3,
            |x| {
                requested += 1;
                (x * x - 2.0, 2.0 * x)
            },
        );
        assert!(requested == 1 && (root - 2f64.sqrt()).abs() < 1e-7);
        // What the last step would leave the bracket for is its end.
        assert_eq!(rising_from(1.0, [0.0, 1.0], |_, _| true, |_| (-1.0, 1.0)), 1.0);
    }

    #[test]
    fn finds_the_least_value_in_few_steps_and_stays_off_cliffs() {
        let mut requested = 0;
        let mut smooth = |x: f64| {
            requested += 1;
            x.exp() - 2.0 * x
        };
        let (x, value) = least([0.0, 0.5, 2.0], 0.5f64.exp() - 1.0, 1e-7, &mut smooth);
        let ln = 2f64.ln();
        assert!((x - ln).abs() < 1e-7 && (value - (2.0 - 2.0 * ln)).abs() < 1e-14, "{x} {value}");
        assert!(requested <= 15, "{requested}");
        let mut cliff = |x: f64| if x < 1.0 { 0.0 } else { -1.0 / x };
        let (x, value) = least([0.0, 1.5, 3.0], -1.0 / 1.5, 1e-7, &mut cliff);
        assert!((1.0..1.0 + 1e-6).contains(&x) && value == cliff(x), "{x} {value}");
    }

    #[test]
    fn finds_a_minimum() {
        let x = minimum(-3.0, 9.0, 1e-9, &|x| (x - 1.5).powi(2));
        assert!((x - 1.5).abs() < 1e-7);
    }
}
