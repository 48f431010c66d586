//! Media of a program's own: from closures, or from types that implement [`Field`].
//!
//! ```text
//! τ(a, b) = ∫ₐᵇ σ_t(t) dt   by Gauss–Legendre quadrature with 16 nodes a panel; panels are halved until
//!                           two halves agree with the whole to 1e-12 of the sum, and the polynomial through the
//!                           nodes meets σ_t at the panel's ends; 40 times at most
//! ```
//!
//! The error is the change by the last halving of each panel, an estimate and no proof. Jumps and kinks of σ_t are
//! declared by [`Formula::with_breaks`] and [`Medium::from_fn_with_breaks`]: panels then end there. Features
//! narrower than a 64th of the distance between two breaks may be missed. Where σ_t is negative or not finite, τ is
//! NaN, and a case with that field is an error. Free flights are bracketed roots of τ.

use std::sync::{Arc, LazyLock};

use super::{Extinction, Field, Medium, OpticalDepth, Profile, Reader, Stratified};
use crate::catalogue::{OwnPage, Page, Settings};
use numeric::adaptive::{Halved, Limits, halve};
use numeric::geometry::{Aabb, Bounds, Ray};
use numeric::quadrature::GaussLegendre;
use numeric::{Known, Lane, Span, sum::Sum};

/// A field along a ray that a closure gives: `σ_t(t)`, 1/length, finite and ≥ 0.
pub struct Formula<F> {
    at: F,
    breaks: Vec<f64>,
}

impl<F: Fn(f64) -> f64 + Send + Sync + 'static> Formula<F> {
    /// The field of a closure.
    pub fn new(at: F) -> Self {
        Self { at, breaks: Vec::new() }
    }

    /// The field with the distances where it jumps or has a kink.
    #[must_use]
    pub fn with_breaks(self, breaks: Vec<f64>) -> Self {
        Self { breaks, ..self }
    }
}

impl<F: Fn(f64) -> f64 + Send + Sync + 'static> Extinction for Formula<F> {
    #[inline(always)]
    fn extinction<L: Lane>(&self, t: L) -> L {
        t.map(&self.at)
    }
}

impl<F: Fn(f64) -> f64 + Send + Sync + 'static> OpticalDepth for Formula<F> {
    fn optical_depth(&self, span: Span) -> Known {
        let mut total = [Sum::default(), Sum::default()];
        let ends = span.cut(self.breaks.clone());
        for part in Span::between(&ends) {
            let depth = integral(&self.at, part);
            total[0].add(depth.value);
            total[1].add(depth.error);
        }
        Known::estimated(total[0].value(), total[1].value())
    }

    fn breaks(&self, _: Span) -> Vec<f64> {
        self.breaks.clone()
    }
}

/// Number of panels before any of them is halved.
const PANELS: f64 = 64.0;
/// Limits of halving: they end it where a closure's own rounding prevents agreement.
const LIMITS: Limits = Limits { halvings: 40, panels: 1 << 14 };
/// Relative agreement of two halves with the whole.
const AGREEMENT: f64 = 1e-12;
/// Relative distance from a panel's ends at which f is evaluated.
const NEAR: f64 = 1e-9;

static RULE: LazyLock<GaussLegendre> = LazyLock::new(|| GaussLegendre::new(16));

/// The weights of the polynomial through the nodes near each end of a panel.
static ENDS: LazyLock<[Vec<f64>; 2]> =
    LazyLock::new(|| [NEAR, 1.0 - NEAR].map(|x| RULE.weights_at(x)));

/// ∫ f over a panel by the rule, and the error that a jump between its ends and its outermost nodes would hide; NaN
/// where f is no extinction.
fn panel(f: &impl Fn(f64) -> f64, part: Span) -> [f64; 2] {
    let values: Vec<f64> = RULE.on(part).map(|(t, _)| f(t)).collect();
    if !values.iter().all(|value| *value >= 0.0) {
        return [f64::NAN; 2];
    }
    let sum: f64 = values.iter().zip(&RULE.weights).map(|(value, weight)| value * weight).sum();
    let gap = RULE.nodes[0] * part.length();
    let hidden = [NEAR, 1.0 - NEAR].into_iter().zip(ENDS.iter()).map(|(x, weights)| {
        let expected: f64 = values.iter().zip(weights).map(|(value, weight)| value * weight).sum();
        (f(part.from + x * part.length()) - expected).abs() * gap
    });
    [sum * part.length(), hidden.sum()]
}

/// ∫ f with an estimate of its error; NaN where f is negative or not finite.
fn integral(f: impl Fn(f64) -> f64, span: Span) -> Known {
    let cuts = span.cut(span.even_cuts(PANELS));
    let change = |here: &Halved<2>| here.change()[0].abs() + here.whole[1];
    // Where f is no extinction, nothing is compared.
    let is_rough = |here: &Halved<2>, &[size, _]: &[f64; 2]| {
        let share = size * AGREEMENT * (here.span.length() / span.length());
        change(here) > share.max(16.0 * f64::EPSILON * here.whole[0])
    };
    let on = |part: Span| panel(&f, part);
    let actual =
        halve(&mut Span::between(&cuts), LIMITS, &on, &|here, scale| !is_rough(here, scale));
    let (mut value, mut error) = (Sum::default(), Sum::default());
    for here in &actual {
        value.add(here.value()[0]);
        error.add(change(here));
    }
    let value = value.value();
    if !value.is_finite() {
        return Known::estimated(f64::NAN, f64::INFINITY);
    }
    Known::estimated(value, error.value() + 64.0 * f64::EPSILON * value)
}

/// A field in space that a closure gives: `σ_t(x, y, z)`, 1/length, finite and ≥ 0, within bounds.
///
/// ```
/// use trueflight_media::catalogue::{OwnPage, Page, Settings};
/// use trueflight_media::own::SpaceFormula;
/// use numeric::geometry::{Aabb, Bounds, Point};
///
/// let page = Page { module: "corner", source: "A cube that is densest in one corner." };
/// let cube = Bounds::Box(Aabb { low: Point([0.0; 3]), high: Point([1.0; 3]) });
/// let read = move |_: &Settings| Some(SpaceFormula::new(cube, 3.0, |[x, y, z]| x + y + z));
/// let corner = OwnPage::volume(page, &[], read); // volume.corner = {}
/// assert_eq!(corner.part, "media");
/// ```
pub struct SpaceFormula<F> {
    at: Arc<F>,
    bounds: Bounds,
    majorant: f64,
}

impl<F: Fn([f64; 3]) -> f64 + Send + Sync + 'static> SpaceFormula<F> {
    /// The field of a closure, and an upper bound of it within the bounds.
    pub fn new(bounds: Bounds, majorant: f64, at: F) -> Self {
        Self { at: Arc::new(at), bounds, majorant }
    }
}

impl<F: Fn([f64; 3]) -> f64 + Send + Sync + 'static> Field for SpaceFormula<F> {
    fn bounds(&self) -> Bounds {
        self.bounds
    }

    #[inline(always)]
    fn value<L: Lane>(&self, p: [L; 3]) -> L {
        let [x, y, z] = p;
        // Elements of all three lanes are read side by side; y and z are not changed.
        x.replaced(|x| {
            let _ = y.replaced(|y| {
                let _ = z.replaced(|z| {
                    for ((x, y), z) in x.iter_mut().zip(y.iter()).zip(z.iter()) {
                        *x = (self.at)([*x, *y, *z]);
                    }
                });
            });
        })
    }

    fn majorant(&self, _: &Aabb) -> f64 {
        self.majorant
    }

    fn along(&self, ray: &Ray, _: Span) -> Arc<Profile> {
        let (at, ray) = (self.at.clone(), *ray);
        Arc::new(Formula::new(move |t| at(ray.at(t).0)))
    }
}

impl Medium {
    /// The field of a closure on a ray, smooth except at the breaks of [`Medium::from_fn_with_breaks`]: for the
    /// expected value of an own estimator.
    ///
    /// ```
    /// use trueflight_media::Medium;
    /// use numeric::Span;
    ///
    /// let medium = Medium::from_fn(Span::new(0.0, 4.0), |t| 1.0 / (1.0 + t * t));
    /// let depth = medium.optical_depth(medium.span());
    /// assert!((depth.value - 4.0_f64.atan()).abs() <= depth.error);
    /// ```
    pub fn from_fn(span: Span, at: impl Fn(f64) -> f64 + Send + Sync + 'static) -> Self {
        Self::from_fn_with_breaks(span, Vec::new(), at)
    }

    /// The field of a closure on a ray, with the distances where σ_t jumps or has a kink.
    pub fn from_fn_with_breaks(
        span: Span,
        breaks: Vec<f64>,
        at: impl Fn(f64) -> f64 + Send + Sync + 'static,
    ) -> Self {
        Self::new(Arc::new(Formula::new(at).with_breaks(breaks)), span, span)
    }
}

const PART: &str = "media";

impl OwnPage {
    /// A field of one coordinate: `medium.NAME = { … }` along a line, `volume.NAME = { … }` as layers in space.
    pub fn layered<P: Stratified>(page: Page) -> Self {
        Self::new(PART, page, Reader::layered::<P>())
    }

    /// A field along a line, read from its settings: `medium.NAME = { … }`.
    ///
    /// `extinctions` are the settings to which σ_t is proportional, all together. Sweeps of the density and of the
    /// contrast change these, and refuse a field that has none.
    pub fn line<F: OpticalDepth + 'static>(
        page: Page,
        extinctions: &'static [&'static str],
        read: impl Fn(&Settings) -> Option<F> + Send + Sync + 'static,
    ) -> Self {
        Self::new(PART, page, Reader::new(extinctions).line(read))
    }

    /// A field in space, read from its settings: `volume.NAME = { … }`; see [`OwnPage::line`] for `extinctions`.
    pub fn volume<F: Field>(
        page: Page,
        extinctions: &'static [&'static str],
        read: impl Fn(&Settings) -> Option<F> + Send + Sync + 'static,
    ) -> Self {
        Self::new(PART, page, Reader::new(extinctions).volume(read))
    }
}
