//! A ball with an extinction that depends on the distance from its centre.
//!
//! ```text
//! σ_t(p) = Σₖ coefficients[k] xᵏ,   x = |p − centre|²/radius²,   within the ball x ≤ 1
//! ```
//!
//! | setting | meaning | unit | default |
//! |---|---|---|---|
//! | `centre` | of the ball, `[x, y, z]` | length | required |
//! | `radius` | of the ball, > 0 | length | required |
//! | `coefficients` | one to four numbers; their sum is σ_t at the surface, nowhere is σ_t negative | 1/length | required |
//!
//! It exists in 3-D only. `coefficients = [2, -2]` is `2(1 − r²/R²)`, densest at the centre and nothing
//! at the surface; `[0.5, 1]` is `0.5 + r²/R²`.
//!
//! Along a ray that passes the centre at the distance D, with its foot at `s_c`, x is
//! `(D² + (s − s_c)²)/radius²`: σ_t is a polynomial of degree six at most, which four Gauss nodes
//! integrate exactly. D comes from the residual vector, never from a difference of squares. Rounding
//! carries x past 1 at the surface; a σ_t below 0 by that is 0. The free flight is a bracketed root.
//!
//! ```toml
//! title = "An example of radial"
//!
//! [problem.transmittance]
//! volume.radial = { centre = [0, 0, 1], radius = 1, coefficients = [2, -1.5] }
//! ray = { origin = [0.2, 0, -1], direction = [0, 0, 1], length = 4 }
//! sampling = 2
//! estimators = ["ratio"]
//! ```
#![cfg_attr(not(doctest), doc = crate::draw_in_rust!())]

use std::sync::Arc;

use fearless_simd::Level;

use super::lookup::{self, DepthFormula, Depths};
use super::{Extinction, Facts, Field, OpticalDepth, Profile, Reader};
use crate::catalogue::{Domain, Settings};
use numeric::geometry::{Aabb, Bounds, Point, Ray};
use numeric::{Known, Lane, Span};

/// Maximum number of coefficients: those of a cubic, which has its extremes at the roots of a quadratic.
const MAX_COEFFICIENTS: usize = 4;

/// A ball.
pub struct Radial {
    centre: Point,
    radius: f64,
    coefficients: [f64; MAX_COEFFICIENTS],
}

/// A ball along a ray, or along rays side by side.
pub struct RadialChord<L = f64> {
    foot: L,
    /// 1/radius.
    scale: f64,
    /// D²/radius².
    offset: L,
    coefficients: [f64; MAX_COEFFICIENTS],
}

impl<L: Lane> RadialChord<L> {
    /// σ_t at distances.
    #[inline(always)]
    fn value(&self, t: L) -> L {
        let v = (t - self.foot) * self.scale;
        polynomial(self.coefficients, v.times_plus(v, self.offset))
    }

    /// `∫ σ_t` about the middle of an interval.
    #[inline(always)]
    fn integral(&self, middle: L, half: L) -> L {
        let mut sum = half.each(0.0);
        for (node, weight) in GAUSS {
            sum = sum + self.value(middle + half * node) * weight;
        }
        half * sum
    }
}

#[inline(always)]
fn polynomial<L: Lane>([a, b, c, d]: [f64; MAX_COEFFICIENTS], x: L) -> L {
    let inner = x.times_plus(x.each(d), x.each(c));
    x.times_plus(x.times_plus(inner, x.each(b)), x.each(a)).or_more(x.each(0.0))
}

/// Gauss–Legendre nodes and weights on `[−1, 1]` for degree seven: `√(3/7 ∓ (2/7)√(6/5))`,
/// `(18 ± √30)/36`.
const GAUSS: [(f64, f64); 4] = [
    (-0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
    (-0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
    (0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
    (0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
];

impl Extinction for RadialChord {
    #[inline(always)]
    fn extinction<L: Lane>(&self, t: L) -> L {
        let &Self { foot, scale, offset, coefficients } = self;
        RadialChord { foot: t.each(foot), scale, offset: t.each(offset), coefficients }.value(t)
    }

    fn facts(&self) -> Facts<'_> {
        // The square has the degree twelve.
        Facts { panel_nodes: Some(7), ..Facts::default() }
    }
}

impl OpticalDepth for RadialChord {
    fn optical_depth(&self, span: Span) -> Known {
        let depth = self.integral(span.middle(), 0.5 * span.length());
        // The error of an argument changes σ_t by its slope, |dσ/dx| |dx| with x ≤ 1.
        let [a, b, c, d] = self.coefficients.map(f64::abs);
        let moved = (span.from.abs() + span.to.abs() + 2.0 * self.foot.abs()) * self.scale;
        let off = 8.0 * (a + b + c + d) + (4.0 + 2.0 * moved) * (b + 2.0 * c + 3.0 * d);
        Known::new(depth, f64::EPSILON * span.length() * off)
    }
}

impl Radial {
    /// `Σ cₖ (r/radius)^{2k}`, which is nowhere negative in the ball.
    pub fn new(centre: Point, radius: f64, coefficients: [f64; MAX_COEFFICIENTS]) -> Self {
        Self { centre, radius, coefficients }
    }

    /// The ball along rays with these origins and directions.
    #[inline(always)]
    fn chord<L: Lane>(&self, [[a, b, c], [x, y, z]]: [[L; 3]; 2]) -> RadialChord<L> {
        let Point([u, v, w]) = self.centre;
        let (a, b, c) = (a.each(u) - a, b.each(v) - b, c.each(w) - c);
        let foot = a * x + b * y + c * z;
        let scale = 1.0 / self.radius;
        let (a, b, c) = ((a - x * foot) * scale, (b - y * foot) * scale, (c - z * foot) * scale);
        let offset = a * a + b * b + c * c;
        RadialChord { foot, scale, offset, coefficients: self.coefficients }
    }

    /// Candidates for the extremes of σ_t in x: the ends of a range and the roots of the slope inside.
    fn extremes(&self, from: f64, to: f64) -> impl Iterator<Item = f64> + use<> {
        let [_, b, c, d] = self.coefficients;
        // b + 2cx + 3dx² = 0, in the form that does not cancel, also for d = 0.
        let q = -(c + (c * c - 3.0 * b * d).max(0.0).sqrt().copysign(c));
        let inside = [q / (3.0 * d), b / q].into_iter().filter(move |&x| from < x && x < to);
        [from, to].into_iter().chain(inside)
    }
}

/// Reads the page.
pub fn reader() -> Reader {
    Reader::new(&["coefficients"]).volume(read_volume)
}

fn read_volume(settings: &Settings) -> Option<Radial> {
    let centre = settings.triple("centre").map(Point);
    let radius = settings.number("radius", Domain::Positive);
    let listed = settings.numbers("coefficients", Domain::Finite, 1)?;
    if listed.len() > MAX_COEFFICIENTS {
        let actual = format!("{} coefficients", listed.len());
        settings.fault("coefficients", actual, "there are four at most");
        return None;
    }
    let mut coefficients = [0.0; MAX_COEFFICIENTS];
    coefficients[..listed.len()].copy_from_slice(&listed);
    let field = Radial { centre: centre?, radius: radius?, coefficients };
    let [a, b, c, d] = coefficients;
    let value = |x: f64| a + x * (b + x * (c + x * d));
    let lowest = field.extremes(0.0, 1.0).min_by(|&x, &y| value(x).total_cmp(&value(y)))?;
    let size: f64 = coefficients.iter().map(|x| x.abs()).sum();
    // The rounding error at a double root is no negative extinction.
    if value(lowest) < -1e-14 * size {
        let actual =
            format!("σ_t is {:.4} at r = {:.4}", value(lowest), field.radius * lowest.sqrt());
        settings.fault("coefficients", actual, "an extinction is nowhere negative");
        return None;
    }
    Some(field)
}

impl DepthFormula for Radial {
    #[inline(always)]
    fn depth<L: Lane>(&self, ray: [[L; 3]; 2], [from, to]: [L; 2]) -> L {
        let length = (to - from).or_more(to.each(0.0));
        self.chord(ray).integral((from + to) * 0.5, length * 0.5)
    }
}

impl Field for Radial {
    fn bounds(&self) -> Bounds {
        Bounds::Sphere { centre: self.centre, radius: self.radius }
    }

    #[inline(always)]
    fn value<L: Lane>(&self, p: [L; 3]) -> L {
        polynomial(self.coefficients, self.centre.square_to(p, 1.0 / self.radius))
    }

    fn majorant(&self, within: &Aabb) -> f64 {
        let x = |p: Point| {
            let u = (p - self.centre) * (1.0 / self.radius);
            u.dot(u).min(1.0)
        };
        let away = |i: usize| {
            let (low, high) = (within.low.0[i], within.high.0[i]);
            if self.centre.0[i] - low > high - self.centre.0[i] { low } else { high }
        };
        let (near, far) = (x(within.nearest(self.centre)), x(Point(std::array::from_fn(away))));
        let highest =
            self.extremes(near, far).map(|x| polynomial(self.coefficients, x)).fold(0.0, f64::max);
        // The argument of a lookup is rounded, too.
        highest + 1e-13 * self.coefficients.iter().map(|x| x.abs()).sum::<f64>()
    }

    fn along(&self, ray: &Ray, _: Span) -> Arc<Profile> {
        Arc::new(self.chord([ray.origin.0, ray.direction.0]))
    }

    fn depths(&self, level: Level) -> Option<Box<dyn Depths + '_>> {
        lookup::depths(self, level)
    }

    fn facts(&self) -> Facts<'_> {
        Facts { is_radial: true, ..Facts::default() }
    }
}
