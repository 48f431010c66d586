//! Gradient noise on an integer lattice, at a point and as the polynomial of one cell.
//!
//! ```text
//! noise(p) = Σ over the 8 corners c of p's cell:  Πⱼ w(1 − |pⱼ − cⱼ|) · g(c)·(p − c)
//! quintic fade: w(t) = 6t⁵ − 15t⁴ + 10t³      cubic fade: w(t) = 3t² − 2t³
//! ```
//!
//! `g(c)` is one of the 12 vectors to the edges of a cube (four of them stand twice), chosen by the
//! low four bits of an integer hash of `c`, the finaliser of `MurmurHash3`, in place of a table of
//! permutations. Lattice coordinates wrap at 2³².
//!
//! Sources: K. Perlin, *Improving Noise*, SIGGRAPH 2002 (quintic fade, edge gradients and their
//! order); K. Perlin, *An Image Synthesizer*, SIGGRAPH 1985 (cubic fade).

/// Adding `1.5·2^52` leaves the nearest integer in the low bits of a double below `2^51`.
const ROUNDER: f64 = 6_755_399_441_055_744.0;

/// The multipliers of the three lattice coordinates in the hash.
const STRIDES: [u32; 3] = [0x8da6_b343, 0xd816_3841, 0xcb1a_b31f];

/// Perlin's gradients in his order: rows 12 to 15 repeat rows 0, 9, 2 and 11 with x before y.
const GRADIENTS: [[f64; 3]; 16] = [
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
    [1.0, -1.0, 0.0],
    [-1.0, -1.0, 0.0],
    [1.0, 0.0, 1.0],
    [-1.0, 0.0, 1.0],
    [1.0, 0.0, -1.0],
    [-1.0, 0.0, -1.0],
    [0.0, 1.0, 1.0],
    [0.0, -1.0, 1.0],
    [0.0, 1.0, -1.0],
    [0.0, -1.0, -1.0],
    [1.0, 1.0, 0.0],
    [0.0, -1.0, 1.0],
    [-1.0, 1.0, 0.0],
    [0.0, -1.0, -1.0],
];

/// How the weights of a cell's corners change across it.
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
    #[must_use]
    pub fn weight(self, t: f64) -> f64 {
        match self {
            Self::Quintic => t * t * t * (t * (t * 6.0 - 15.0) + 10.0),
            Self::Cubic => t * t * (3.0 - 2.0 * t),
        }
    }

    /// The largest `|noise|` that any choice of gradients allows, to rounding.
    #[must_use]
    pub fn bound(self) -> f64 {
        match self {
            Self::Quintic => 1.036_353_811_211_802_7,
            Self::Cubic => 1.044_905_189_609_877,
        }
    }
}

#[inline(always)]
fn mix(mut h: u32) -> u32 {
    h ^= h >> 16;
    h = h.wrapping_mul(0x85eb_ca6b);
    h ^= h >> 13;
    h = h.wrapping_mul(0xc2b2_ae35);
    h ^ (h >> 16)
}

/// The hash of a lattice point.
#[inline(always)]
#[must_use]
pub fn hash3(x: u32, y: u32, z: u32, seed: u32) -> u32 {
    let [a, b, c] = STRIDES;
    mix(x.wrapping_mul(a) ^ y.wrapping_mul(b) ^ z.wrapping_mul(c) ^ seed)
}

/// The lattice index below `x`, and how far `x` is beyond it, in `[0, 1]`.
#[inline(always)]
#[allow(clippy::cast_possible_truncation)] // the low 32 bits are the index
fn floor(x: f64) -> (u32, f64) {
    let shifted = x + ROUNDER;
    let (index, rest) = (shifted.to_bits() as u32, x - (shifted - ROUNDER));
    let below = rest < 0.0;
    (index.wrapping_sub(u32::from(below)), if below { rest + 1.0 } else { rest })
}

/// The gradients at the corners of the cell with the lowest corner `index`; bit 0 of a corner's
/// number is its x, bit 2 its z.
#[inline(always)]
fn corner_gradients(index: [u32; 3], seed: u32) -> [&'static [f64; 3]; 8] {
    let ends = |axis: usize| {
        let low = index[axis].wrapping_mul(STRIDES[axis]);
        [low, low.wrapping_add(STRIDES[axis])]
    };
    let (x, y, z) = (ends(0), ends(1), ends(2));
    let z = [z[0] ^ seed, z[1] ^ seed];
    let yz = [y[0] ^ z[0], y[1] ^ z[0], y[0] ^ z[1], y[1] ^ z[1]];
    let hashes = [
        x[0] ^ yz[0],
        x[1] ^ yz[0],
        x[0] ^ yz[1],
        x[1] ^ yz[1],
        x[0] ^ yz[2],
        x[1] ^ yz[2],
        x[0] ^ yz[3],
        x[1] ^ yz[3],
    ];
    hashes.map(|hash| &GRADIENTS[(mix(hash) & 15) as usize])
}

/// The weighted sum over the corners, at the place `at` in `[0, 1]³` of the cell.
#[inline(always)]
fn blend(gradients: &[&'static [f64; 3]; 8], at: [f64; 3], fade: Fade) -> f64 {
    let [x, y, z] = at;
    let (x1, y1, z1) = (x - 1.0, y - 1.0, z - 1.0);
    let dot = |g: &[f64; 3], x: f64, y: f64, z: f64| g[0] * x + g[1] * y + g[2] * z;
    let lerp = |w: f64, a: f64, b: f64| a + w * (b - a);
    let (u, v, w) = (fade.weight(x), fade.weight(y), fade.weight(z));
    let [a, b, c, d, e, f, g, h] = *gradients;
    let near = lerp(
        v,
        lerp(u, dot(a, x, y, z), dot(b, x1, y, z)),
        lerp(u, dot(c, x, y1, z), dot(d, x1, y1, z)),
    );
    let far = lerp(
        v,
        lerp(u, dot(e, x, y, z1), dot(f, x1, y, z1)),
        lerp(u, dot(g, x, y1, z1), dot(h, x1, y1, z1)),
    );
    lerp(w, near, far)
}

/// Gradient noise at a point, in lattice coordinates below `2^51`.
#[inline(always)]
#[must_use]
pub fn noise(p: [f64; 3], seed: u32, fade: Fade) -> f64 {
    let ((i, x), (j, y), (k, z)) = (floor(p[0]), floor(p[1]), floor(p[2]));
    blend(&corner_gradients([i, j, k], seed), [x, y, z], fade)
}

/// One cell of the lattice, whose polynomial may be evaluated up to its very faces.
pub struct Cell {
    corner: [f64; 3],
    gradients: [&'static [f64; 3]; 8],
}

impl Cell {
    /// The cell that holds a point.
    #[must_use]
    pub fn around(p: [f64; 3], seed: u32) -> Self {
        let index = p.map(|x| floor(x).0);
        Self { corner: p.map(f64::floor), gradients: corner_gradients(index, seed) }
    }

    /// The cell's polynomial.
    #[must_use]
    pub fn value(&self, p: [f64; 3], fade: Fade) -> f64 {
        blend(&self.gradients, std::array::from_fn(|j| p[j] - self.corner[j]), fade)
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

    #[test]
    fn noise_vanishes_at_lattice_points() {
        for p in [[0.0, 0.0, 0.0], [-3.0, 5.0, 1e6], [7.0, -1.0, -2.0]] {
            assert_eq!(noise(p, 3, Fade::Quintic), 0.0);
            assert_eq!(noise(p, 3, Fade::Cubic), 0.0);
        }
    }

    #[test]
    fn a_cell_continues_its_noise() {
        for fade in [Fade::Quintic, Fade::Cubic] {
            let cell = Cell::around([-0.5, 3.5, 9.5], 5);
            for p in [[-0.1, 3.2, 9.9], [-1.0, 3.0, 9.0], [-0.999, 3.7, 9.0]] {
                assert!((cell.value(p, fade) - noise(p, 5, fade)).abs() < 1e-14);
            }
        }
    }

    /// The bound is the largest value when every corner has the gradient that suits it best: the
    /// two longest of the three distances.
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
                        let w = d.map(|d| fade.weight(1.0 - d)).iter().product::<f64>();
                        w * (d[0] + d[1] + d[2] - d[0].min(d[1]).min(d[2]))
                    })
                    .sum();
                highest = highest.max(sum);
            }
            assert!(highest <= fade.bound() && highest > fade.bound() - 1e-3, "{highest}");
        }
    }
}
