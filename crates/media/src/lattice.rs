//! Gradient noise on an integer lattice, at a point and as the polynomial of one cell.
//!
//! ```text
//! noise(p) = Σ over the 8 corners c of p's cell:  Πⱼ w(1 − |pⱼ − cⱼ|) · g(c)·(p − c)
//! quintic fade: w(t) = 6t⁵ − 15t⁴ + 10t³      cubic fade: w(t) = 3t² − 2t³
//! ```
//!
//! `g(c)` is one of the 12 vectors to the edges of a cube (four of them occur twice). It is chosen by the low four
//! bits of an integer hash of `c`, the finaliser of `MurmurHash3`, in place of a table of permutations. Lattice
//! coordinates wrap at 2³².
//!
//! All of it is arithmetic, so that packs need no table either. The hashes of the two ends of an edge share the
//! halves of a 64-bit element, and a product with a gradient is a choice of two of the three distances and of their
//! signs. Products and sums are rounded separately on every machine.
//!
//! Sources: K. Perlin, *Improving Noise*, SIGGRAPH 2002 (quintic fade, edge gradients and their
//! order); K. Perlin, *An Image Synthesizer*, SIGGRAPH 1985 (cubic fade).

use numeric::words::{self, Words32};
use numeric::{Lane, Span};

/// The multipliers of the three lattice coordinates in the hash.
const STRIDES: [u32; 3] = [0x8da6_b343, 0xd816_3841, 0xcb1a_b31f];

/// Variation of the weights of a cell's corners across it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fade {
    /// `6t⁵ − 15t⁴ + 10t³`: two continuous derivatives.
    Quintic,
    /// `3t² − 2t³`: one continuous derivative.
    Cubic,
}

impl Fade {
    /// `w(t)`.
    #[inline(always)]
    pub fn weight<L: Lane>(self, t: L) -> L {
        match self {
            Self::Quintic => t * t * t * (t * (t * 6.0 - 15.0) + 10.0),
            Self::Cubic => t * t * (t.each(3.0) - t * 2.0),
        }
    }

    /// The largest `|noise|` that any choice of gradients allows, to rounding.
    pub fn bound(self) -> f64 {
        match self {
            Self::Quintic => 1.036_353_811_211_802_7,
            Self::Cubic => 1.044_905_189_609_877,
        }
    }
}

/// The finaliser of `MurmurHash3`.
#[inline(always)]
fn mix<W: Words32>(h: W) -> W {
    h.folded(16).times(0x85eb_ca6b).folded(13).times(0xc2b2_ae35).folded(16)
}

/// The hash of a lattice point.
#[inline(always)]
pub fn hash3(x: u32, y: u32, z: u32, seed: u32) -> u32 {
    let [a, b, c] = STRIDES;
    let hash = x.wrapping_mul(a) ^ y.wrapping_mul(b) ^ z.wrapping_mul(c) ^ seed;
    words::apart(mix(u64::from(hash)))[0]
}

/// The integer below `x`, and the distance of `x` from it, in `[0, 1]`.
#[inline(always)]
fn floor<L: Lane>(x: L) -> (L, L) {
    let below = Lane::floor(x);
    (below, x - below)
}

/// The hashes at the corners of the cell with the lowest corner `index`. The four edges along z from (0, 0),
/// (1, 0), (0, 1) and (1, 1) have a hash for the lower and one for the upper end.
#[inline(always)]
fn corner_hashes<L: Lane>(index: [L; 3], seed: u32) -> [L::Words; 4] {
    let [a, b, c] = STRIDES;
    let (x, y) = (index[0].words().times(a), index[1].words().times(b));
    let z = index[2].words().times(c);
    let z = z.plus(z.each([0, c])) ^ z.each([seed, seed]);
    let (near, far) = (y ^ z, y.plus(y.each([b, b])) ^ z);
    let beyond = x.plus(x.each([a, a]));
    [mix(x ^ near), mix(beyond ^ near), mix(x ^ far), mix(beyond ^ far)]
}

/// `g·d` at the lower (0) or upper (1) end of an edge: the last four bits of the hash choose one of the twelve sums
/// `±x ± y`, `±x ± z` and `±y ± z`.
#[inline(always)]
fn slope<L: Lane>(hashes: L::Words, end: u32, [x, y, z]: [L; 3]) -> L {
    let at = 32 * end;
    let first = L::where_bits(hashes, 8 << at, 0, x, y);
    let second = L::where_bits(hashes, 13 << at, 12 << at, x, z);
    let second = L::where_bits(hashes, 12 << at, 0, y, second);
    first.negated_where(hashes, at) + second.negated_where(hashes, at + 1)
}

/// The weighted sum of the slopes at the corners; bit 0 of a corner's number is its x, bit 2 its z.
#[inline(always)]
fn blend<L: Lane>(slopes: [L; 8], [x, y, z]: [L; 3], fade: Fade) -> L {
    let (u, v, w) = (fade.weight(x), fade.weight(y), fade.weight(z));
    let [a, b, c, d, e, f, g, h] = slopes;
    let near = between(v, between(u, a, b), between(u, c, d));
    let far = between(v, between(u, e, f), between(u, g, h));
    between(w, near, far)
}

#[inline(always)]
fn between<L: Lane>(w: L, a: L, b: L) -> L {
    a + w * (b - a)
}

/// Gradient noise at a point, in lattice coordinates below `2^51`.
#[inline(always)]
pub fn noise<L: Lane>(p: [L; 3], seed: u32, fade: Fade) -> L {
    let ((i, x), (j, y), (k, z)) = (floor(p[0]), floor(p[1]), floor(p[2]));
    let (x1, y1, z1) = (x - 1.0, y - 1.0, z - 1.0);
    let [a, b, c, d] = corner_hashes([i, j, k], seed);
    let slopes = [
        slope(a, 0, [x, y, z]),
        slope(b, 0, [x1, y, z]),
        slope(c, 0, [x, y1, z]),
        slope(d, 0, [x1, y1, z]),
        slope(a, 1, [x, y, z1]),
        slope(b, 1, [x1, y, z1]),
        slope(c, 1, [x, y1, z1]),
        slope(d, 1, [x1, y1, z1]),
    ];
    blend(slopes, [x, y, z], fade)
}

/// A cell of the lattice; its polynomial may be evaluated up to its faces.
pub struct Cell {
    corner: [f64; 3],
    gradients: [[f64; 3]; 8],
}

impl Cell {
    /// The cell that holds a point.
    pub fn around(p: [f64; 3], seed: u32) -> Self {
        let corner = p.map(|x| floor(x).0);
        let hashes = corner_hashes(corner, seed);
        let mut gradients = [[0.0; 3]; 8];
        // A loop that counts: `from_fn` is not always inlined.
        for (n, of_corner) in gradients.iter_mut().enumerate() {
            *of_corner = gradient(hashes[n % 4], u32::from(n >= 4));
        }
        Self { corner, gradients }
    }

    /// The cell's polynomial.
    pub fn value(&self, p: [f64; 3], fade: Fade) -> f64 {
        let (c, g) = (self.corner, &self.gradients);
        let [x, y, z] = [p[0] - c[0], p[1] - c[1], p[2] - c[2]];
        let [x1, y1, z1] = [x - 1.0, y - 1.0, z - 1.0];
        let slope = |n: usize, [x, y, z]: [f64; 3]| g[n][0] * x + g[n][1] * y + g[n][2] * z;
        let slopes = [
            slope(0, [x, y, z]),
            slope(1, [x1, y, z]),
            slope(2, [x, y1, z]),
            slope(3, [x1, y1, z]),
            slope(4, [x, y, z1]),
            slope(5, [x1, y, z1]),
            slope(6, [x, y1, z1]),
            slope(7, [x1, y1, z1]),
        ];
        blend(slopes, [x, y, z], fade)
    }
}

/// The vector `g`: [`slope`] is its product with a distance.
fn gradient(hashes: u64, end: u32) -> [f64; 3] {
    let along = |axis: [f64; 3]| slope(hashes, end, axis);
    [along([1.0, 0.0, 0.0]), along([0.0, 1.0, 0.0]), along([0.0, 0.0, 1.0])]
}

/// A ray in the coordinates of a lattice, `start + slope·t`.
#[derive(Debug, Clone, Copy)]
pub struct Track {
    /// Start of the ray.
    pub start: [f64; 3],
    /// Change per unit of length.
    pub slope: [f64; 3],
}

impl Track {
    /// The position at a distance.
    #[inline(always)]
    pub fn at<L: Lane>(&self, t: L) -> [L; 3] {
        let (a, b) = (self.start, self.slope);
        [t * b[0] + a[0], t * b[1] + a[1], t * b[2] + a[2]]
    }

    /// The track on a lattice twice as fine.
    #[must_use]
    pub fn doubled(self) -> Self {
        Self { start: self.start.map(|x| 2.0 * x), slope: self.slope.map(|x| 2.0 * x) }
    }

    /// The largest `|start| + |slope·t|` of any axis on an interval; NaN if one is NaN.
    pub fn max_coordinate(&self, inside: Span) -> f64 {
        let t = inside.from.abs().max(inside.to.abs());
        let reach = self.start.iter().zip(self.slope).map(|(a, b)| a.abs() + b.abs() * t);
        reach.fold(0.0, |maximum, x| if x.is_nan() || x > maximum { x } else { maximum })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hashes_are_the_published_ones() {
        assert_eq!(hash3(1, 2, 3, 0), 0xaf79_9881);
        assert_eq!(hash3(u32::MAX, 0, 5, 7), 0x42f7_1464);
    }

    /// Perlin's gradients in his order: 12 to 15 repeat 0, 9, 2 and 11 with x before y.
    #[test]
    fn gradients_are_perlins() {
        let gradients = [
            [1, 1, 0],
            [-1, 1, 0],
            [1, -1, 0],
            [-1, -1, 0],
            [1, 0, 1],
            [-1, 0, 1],
            [1, 0, -1],
            [-1, 0, -1],
            [0, 1, 1],
            [0, -1, 1],
            [0, 1, -1],
            [0, -1, -1],
            [1, 1, 0],
            [0, -1, 1],
            [-1, 1, 0],
            [0, -1, -1],
        ];
        for (hash, exact) in (0..).zip(gradients) {
            let others = 0xabcd_1230;
            let ends = [[others | hash, others], [others, others | hash]];
            for (end, hashes) in (0..).zip(ends) {
                assert_eq!(gradient(words::joined(hashes), end), exact.map(f64::from), "{hash}");
            }
        }
    }

    #[test]
    fn noise_agrees_with_thirty_digit_arithmetic() {
        let values = [
            ([0.3, 0.7, -0.45], 0.370_220_432_525_461_2),
            ([1.5, 2.25, -3.125], 0.408_336_497_843_265_5),
        ];
        for (p, exact) in values {
            assert!((noise(p, 0, Fade::Quintic) - exact).abs() < 1e-15);
        }
    }

    /// The bound is the largest value if every corner has its best gradient: the two longest of the three
    /// distances.
    #[test]
    fn bounds_hold_over_a_cell() {
        for fade in [Fade::Quintic, Fade::Cubic] {
            let mut highest = 0.0f64;
            let steps = 40u32;
            for n in 0..steps.pow(3) {
                let at = [n % steps, n / steps % steps, n / steps / steps];
                let p = at.map(|i| 0.5 * f64::from(i + 1) / f64::from(steps));
                let sum: f64 = (0..8u32)
                    .map(|corner| {
                        let far: [bool; 3] = std::array::from_fn(|j| corner >> j & 1 == 1);
                        let d: [f64; 3] =
                            std::array::from_fn(|j| if far[j] { 1.0 - p[j] } else { p[j] });
                        let w = d.map(|d: f64| fade.weight(1.0 - d)).iter().product::<f64>();
                        w * (d[0] + d[1] + d[2] - d[0].min(d[1]).min(d[2]))
                    })
                    .sum();
                highest = highest.max(sum);
            }
            assert!(highest <= fade.bound() && highest > fade.bound() - 1e-3, "{highest}");
        }
    }
}
