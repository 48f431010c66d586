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
use crate::Lane;

/// Two unit vectors that are perpendicular to a unit vector and to each other.
#[inline(always)]
pub fn across(direction: Point) -> [Point; 2] {
    across_lanes(direction.0).map(Point)
}

/// Two unit vectors across each direction of a lane, as in [`across`]. A z of −0 counts as 0.
#[inline(always)]
fn across_lanes<L: Lane>([x, y, z]: [L; 3]) -> [[L; 3]; 2] {
    let one = z.each(1.0);
    let sign = L::select(z.below(z.each(0.0)), -one, one);
    let a = -one / (sign + z);
    let b = x * y * a;
    [[sign * x * x * a + 1.0, sign * b, -sign * x], [b, sign + y * y * a, -y]]
}

/// The direction at an angle of the given cosine from another, at an azimuth in turns.
#[inline(always)]
pub fn turned(direction: Point, cosine: f64, turns: f64) -> Point {
    Point(turned_lanes(direction.0, cosine, turns))
}

/// The turned direction for each direction of a lane, as in [`turned`].
#[inline(always)]
pub fn turned_lanes<L: Lane>(direction: [L; 3], cosine: L, turns: L) -> [L; 3] {
    let (angle, one) = (turns * std::f64::consts::TAU, cosine.each(1.0));
    let sine = ((one - cosine) * (one + cosine)).or_more(one.each(0.0)).root();
    let (along, aside) = (sine * angle.cos(), sine * angle.sin());
    let [[a, b, c], [d, e, f]] = across_lanes(direction);
    let [x, y, z] = direction;
    let x = a * along + d * aside + x * cosine;
    let y = b * along + e * aside + y * cosine;
    let z = c * along + f * aside + z * cosine;
    // A thousand turns must not add up to another length: one step of Newton's for 1/|d|.
    let square = x * x + y * y + z * z;
    let factor = one.each(1.5) - square * 0.5;
    [x * factor, y * factor, z * factor]
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
