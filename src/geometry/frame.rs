//! Directions about a direction.
//!
//! ```text
//! s = sign(z),  a = −1/(s + z),  b = x y a
//! b₁ = (1 + s x² a, s b, −s x),   b₂ = (b, s + y² a, −y),   an orthonormal frame with d = (x, y, z)
//! d' = sin θ cos φ b₁ + sin θ sin φ b₂ + cos θ d
//! ```
//!
//! Source: T. Duff, J. Burgess, P. Christensen, C. Hery, A. Kensler, M. Liani, R. Villemin, *Building an
//! Orthonormal Basis, Revisited*, Journal of Computer Graphics Techniques 6(1), 2017, listing 3.

use super::Point;
use crate::numeric::Lane;

/// Two unit vectors that are perpendicular to a unit vector and to each other.
#[inline(always)]
pub fn across(direction: Point) -> [Point; 2] {
    let [x, y, z] = direction.0;
    let sign = 1f64.copysign(z);
    let a = -1.0 / (sign + z);
    let b = x * y * a;
    [Point([1.0 + sign * x * x * a, sign * b, -sign * x]), Point([b, sign + y * y * a, -y])]
}

/// The direction at an angle of the given cosine from another, at an azimuth in turns.
#[inline(always)]
pub fn turned(direction: Point, cosine: f64, turns: f64) -> Point {
    let angle = std::f64::consts::TAU * turns;
    let sine = Lane::or_more((1.0 - cosine) * (1.0 + cosine), 0.0).sqrt();
    let [first, second] = across(direction);
    let turned =
        first * (sine * Lane::cos(angle)) + second * (sine * Lane::sin(angle)) + direction * cosine;
    // A thousand turns must not add up to another length: one step of Newton's for 1/|d|.
    turned * (1.5 - 0.5 * turned.dot(turned))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn directions() -> impl Iterator<Item = Point> {
        let some = [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.3, -0.8, -1e-9]];
        let more = [[-0.2, 0.7, 0.4], [1e-8, 1e-8, -1.0], [0.5, 0.5, -0.5]];
        some.into_iter().chain(more).filter_map(|d| Point(d).normalised())
    }

    #[test]
    fn the_frame_is_orthonormal() {
        for d in directions() {
            let [a, b] = across(d);
            for (u, v, product) in [(a, b, 0.0), (a, d, 0.0), (b, d, 0.0), (a, a, 1.0), (b, b, 1.0)]
            {
                assert!((u.dot(v) - product).abs() < 4e-15, "{d:?}");
            }
        }
    }

    #[test]
    fn a_turn_keeps_its_cosine_and_its_azimuth() {
        for d in directions() {
            for cosine in [-1.0, -0.4, 0.0, 0.7, 1.0] {
                let turned_by = |turns: f64| turned(d, cosine, turns);
                for turns in [0.0, 0.1, 0.37, 0.9] {
                    let there = turned_by(turns);
                    assert!((there.dot(d) - cosine).abs() < 4e-15, "{d:?} {cosine}");
                    assert!((there.norm() - 1.0).abs() < 4e-15, "{d:?} {cosine}");
                }
                // Half a turn on it is as far on the other side.
                let both = turned_by(0.2) + turned_by(0.7);
                assert!((both - d * (2.0 * cosine)).norm() < 1e-14, "{d:?} {cosine}");
            }
        }
    }

    #[test]
    fn a_long_walk_keeps_its_length() {
        let mut d = Point([1.0, 0.0, 0.0]);
        for step in 0..100_000 {
            d = turned(d, 0.3, f64::from(step) * 0.618);
        }
        assert!((d.norm() - 1.0).abs() < 1e-15);
    }
}
