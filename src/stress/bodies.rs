//! Balls and boxes, and integrals over them in 32 digits.

use super::trial::Dice;
use numeric::Wide;
use numeric::geometry::Point;

/// A ball or a box.
pub(super) enum Body {
    Ball([f64; 3], f64),
    Box([f64; 3], [f64; 3]),
}

impl Body {
    pub(super) fn ball(dice: &mut Dice) -> Self {
        let radius = dice.sized(-3.0, 3.0);
        let away = dice.sized(-1.0, 1.0);
        Self::Ball([0; 3].map(|_| away * radius * dice.between(-1.0, 1.0)), radius)
    }

    fn cuboid(dice: &mut Dice) -> Self {
        let size = dice.sized(-3.0, 3.0);
        let low = [0; 3].map(|_| size * dice.between(-3.0, 3.0));
        Self::Box(low, low.map(|low| low + size * dice.between(0.1, 1.0)))
    }

    pub(super) fn of(dice: &mut Dice) -> Self {
        if dice.below(2) == 0 { Self::ball(dice) } else { Self::cuboid(dice) }
    }

    pub(super) fn text(&self) -> String {
        match self {
            Self::Ball(centre, radius) => {
                format!("bounds.sphere = {{ centre = {centre:?}, radius = {radius:e} }}")
            }
            Self::Box(low, high) => format!("bounds.box = {{ low = {low:?}, high = {high:?} }}"),
        }
    }

    pub(super) fn centre(&self) -> [Wide; 3] {
        match self {
            Self::Ball(centre, _) => centre.map(Wide::from),
            Self::Box(low, high) => [0, 1, 2].map(|i| (Wide::from(low[i]) + high[i]).scaled(-1)),
        }
    }

    pub(super) fn size(&self) -> f64 {
        match self {
            Self::Ball(_, radius) => *radius,
            Self::Box(low, high) => high[0] - low[0],
        }
    }

    /// How far its boundary is from its centre.
    pub(super) fn reach(&self) -> f64 {
        match self {
            Self::Ball(_, radius) => *radius,
            Self::Box(low, high) => 0.5 * (Point(*high) - Point(*low)).norm(),
        }
    }

    /// A place in it or next to it.
    pub(super) fn near(&self, dice: &mut Dice) -> [f64; 3] {
        let size = self.size();
        self.centre().map(|x| x.value() + size * dice.between(-1.5, 1.5))
    }

    /// `∫ dV` and `∫ h dV` over what lies below a height along an axis.
    pub(super) fn under(&self, axis: [f64; 3], height: Wide) -> [Wide; 2] {
        match self {
            Self::Ball(_, radius) => {
                let (reach, middle) = (Wide::from(*radius), dot(axis, self.centre()));
                let h = height - middle;
                let h = match h.high / radius {
                    x if x > 1.0 => reach,
                    x if x < -1.0 => -reach,
                    _ => h,
                };
                // π ∫ (R² − h²)(1, h)
                let square = reach * reach;
                let part = |h: Wide| square * h - h.powi(3) / 3.0;
                let first = part(h) - part(-reach);
                let second = (square * h * h).scaled(-1) - h.powi(4).scaled(-2)
                    + square * square.scaled(-2)
                    - (square * square).scaled(-1);
                [Wide::PI * first, Wide::PI * (second + middle * first)]
            }
            Self::Box(low, high) if axis[1] == 0.0 => {
                let [a, b, c] = [0, 1, 2].map(|i| [Wide::from(low[i]), Wide::from(high[i])]);
                let face = (b[1] - b[0]) * (c[1] - c[0]);
                let h = if (height - a[0]).high < 0.0 { a[0] } else { height };
                let h = if (h - a[1]).high > 0.0 { a[1] } else { h };
                [face * (h - a[0]), (face * (h * h - a[0] * a[0])).scaled(-1)]
            }
            Self::Box(low, high) => {
                // A corner of the height v adds ± (h − v)₊³/(6 Π aᵢ).
                let slopes = axis.map(|a| Wide::from(a.abs()));
                let scale = slopes[0] * slopes[1] * slopes[2];
                let mut sums = [Wide::default(); 2];
                for corner in 0..8 {
                    let is_far = |i: usize| corner >> i & 1 == 1;
                    let at = |i: usize| {
                        let is_high = is_far(i) == (axis[i] > 0.0);
                        Wide::product(axis[i], if is_high { high[i] } else { low[i] })
                    };
                    let v = at(0) + at(1) + at(2);
                    let u = height - v;
                    if u.high <= 0.0 {
                        continue;
                    }
                    let odd = (0..3).filter(|&i| is_far(i)).count() % 2 == 1;
                    let cube = u.powi(3) / 6.0;
                    let terms = [cube, v * cube + u.powi(4) / 8.0];
                    for (sum, term) in sums.iter_mut().zip(terms) {
                        *sum += if odd { -term } else { term };
                    }
                }
                sums.map(|sum| sum / scale)
            }
        }
    }

    /// `∫ wave(k·(p − centre))` for a wave with an even part of which `mean` is the mean over an edge, half
    /// of which is x, and `over` that of the ball.
    pub(super) fn wave(&self, k: [f64; 3], mean: fn(Wide) -> Wide, over: fn(Wide) -> Wide) -> Wide {
        match self {
            Self::Ball(_, radius) => {
                let square: Wide = k.iter().map(|&k| Wide::product(k, k)).sum();
                let cube = Wide::from(*radius).powi(3) * Wide::PI.scaled(2);
                cube * over(square.sqrt() * *radius)
            }
            Self::Box(low, high) => {
                let edge = |i: usize| {
                    let length = Wide::from(high[i]) - low[i];
                    length * mean((length * k[i]).scaled(-1))
                };
                edge(0) * edge(1) * edge(2)
            }
        }
    }
}

pub(super) fn dot(k: [f64; 3], p: [Wide; 3]) -> Wide {
    k.iter().zip(p).map(|(&k, p)| k * p).sum()
}

/// A series in x² by its first term and the divisors of those that follow.
fn series(first: Wide, x: Wide, ratio: impl Fn(f64) -> f64) -> Wide {
    let square = x * x;
    let (mut term, mut sum) = (first, first);
    for n in 1..24_i32 {
        term = term * square / ratio(f64::from(n));
        sum += term;
    }
    sum
}

/// `sinh x/x`.
pub(super) fn sinhc(x: Wide) -> Wide {
    if x.high.abs() < 1.0 {
        return series(Wide::ONE, x, |n| 2.0 * n * (2.0 * n + 1.0));
    }
    (x.exp() - (-x).exp()).scaled(-1) / x
}

/// `(q cosh q − sinh q)/q³`.
pub(super) fn sinh_over(q: Wide) -> Wide {
    if q.high < 1.0 {
        return series(Wide::ONE / 3.0, q, |n| 2.0 * n * (2.0 * n + 3.0));
    }
    let (up, down) = (q.exp(), (-q).exp());
    (q * (up + down) - (up - down)).scaled(-1) / q.powi(3)
}

pub(super) fn sinc(x: Wide) -> Wide {
    if x.high.abs() < 1.0 {
        return series(Wide::ONE, x, |n| -2.0 * n * (2.0 * n + 1.0));
    }
    let [sine, _] = x.sin_cos();
    sine / x
}

/// `(sin q − q cos q)/q³`.
pub(super) fn sine_over(q: Wide) -> Wide {
    if q.high < 1.0 {
        return series(Wide::ONE / 3.0, q, |n| -2.0 * n * (2.0 * n + 3.0));
    }
    let [sine, cosine] = q.sin_cos();
    (sine - q * cosine) / q.powi(3)
}
