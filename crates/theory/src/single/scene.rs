//! A point of the ray with all quantities of theory there, and adaptive integrals over the ray.

use super::camera::Camera;
use super::segment::{Segment, Tracking};
use super::shadows::{Among, MANY, Shadows, thinned};
use crate::prediction::raw::added;
use crate::problems::{Problem, SingleScattering};
use numeric::adaptive::{Halved, Limits, halve};
use numeric::quadrature::GaussLegendre;
use numeric::sum::Sum;
use numeric::{Known, Span, order};

/// Relative difference of two resolutions of L at which panels are fine enough.
const RADIANCE: f64 = 2e-14;
/// Relative rounding error of sums and exponentials.
const ROUNDING: f64 = 2e-13;
/// Minimum number of steps into which the support is cut.
pub const STEPS: usize = 24;
/// Maximum width of a panel in the stretched variable.
const WIDEST: f64 = 0.5;
/// Limits of the panels of one integral.
const LIMITS: Limits = Limits { halvings: 40, panels: 10_000 };
/// Relative difference at which panels that hold several pieces of the medium are fine enough.
const UNRESOLVED: f64 = 1e-6;

/// A point of the ray.
#[derive(Debug, Clone, Copy)]
pub struct RayNode {
    /// Distance from the ray's origin.
    pub s: f64,
    /// Distance from the light's foot, with digits that `s` has lost next to the light.
    pub along: f64,
    /// σ_t there.
    pub extinction: f64,
    /// S there, see [`SingleScattering::source`].
    pub source: f64,
    /// The exact transmittance from the ray's origin.
    pub transmittance: f64,
    /// A relative error bound of `extinction · source`, and of `transmittance`.
    pub error: [f64; 2],
    /// The estimated transmittance from the ray's origin.
    pub camera: Segment,
    /// The estimated transmittance of the shadow ray.
    pub shadow: Segment,
}

impl RayNode {
    /// Mean number of lookups of the shadow ray of a draw that scatters here.
    pub fn shadow_lookups(&self) -> f64 {
        if self.extinction > 0.0 { self.camera.through[0] * self.shadow.lookups[1] } else { 0.0 }
    }

    /// `E[(N − 1)^k]` of a draw that scatters here. Its first lookup is σ_t here. Unless σ_t is 0, the lookups of
    /// the walk from the origin follow and, if that came through, those of the shadow ray.
    pub fn lookups(&self) -> [f64; 5] {
        if self.extinction <= 0.0 {
            return [1.0, 0.0, 0.0, 0.0, 0.0];
        }
        let Segment { lookups, through, .. } = self.camera;
        let with_shadow = added(through, self.shadow.lookups);
        let ended: [f64; 5] = std::array::from_fn(|k| lookups[k] - through[k]);
        std::array::from_fn(|k| with_shadow[k] + ended[k])
    }
}

/// A point of the ray, given by the stretched variable.
#[derive(Debug, Clone, Copy)]
pub struct StretchedPlace {
    /// Distance from the ray's origin.
    pub s: f64,
    /// Distance from the light's foot.
    pub along: f64,
    /// `ds/dx`.
    pub stretch: f64,
}

/// The ray, the light and the tracking of transmittances.
pub struct RayScene<'a> {
    /// The problem.
    pub problem: &'a SingleScattering,
    /// The transmittance from the ray's origin.
    pub camera: Camera<'a>,
    /// Tracking of the transmittances of shadow rays.
    pub shadow: Tracking,
    rule: GaussLegendre,
    /// True if panels hold several pieces of the medium.
    is_thinned: bool,
    /// Shadow rays, where they are interpolated.
    pub(super) shadows: Option<Shadows>,
}

/// An integral of several functions, each with a bound on its error, and the panels that it took.
pub struct Integral<const N: usize> {
    /// The integrals.
    pub value: [f64; N],
    /// Bounds on their errors: differences of two resolutions, over all panels. Where panels hold several pieces of the
    /// medium, estimates: the sum of differences, and twice the root of the sum of their squares.
    pub error: [f64; N],
    /// The ends of the panels in the stretched variable, ascending.
    pub panels: Vec<Span>,
}

impl<'a> RayScene<'a> {
    /// Joins the parts.
    pub fn new(problem: &'a SingleScattering, camera: Camera<'a>, shadow: Tracking) -> Self {
        let rule = GaussLegendre::new(16);
        let (_, is_thinned) = thinned(problem.medium().breaks());
        let mut scene = Self { problem, camera, shadow, rule, is_thinned, shadows: None };
        scene.shadows = scene.interpolated(shadow);
        scene
    }

    /// Shadow rays that are interpolated, in a medium of many pieces.
    fn interpolated(&self, tracking: Tracking) -> Option<Shadows> {
        let medium = self.problem.medium();
        let (support, pieces) = (medium.support(), medium.breaks().len());
        if support.is_empty() || pieces <= MANY {
            return None;
        }
        let [from, to] = [support.from, support.to].map(|s| self.unstretched(s));
        let follow = |x: f64| self.followed(self.stretched(x), tracking);
        Shadows::new(Span::new(from, to), pieces, follow)
    }

    /// The shadow ray from a place.
    pub(super) fn followed(
        &self,
        StretchedPlace { s, along, .. }: StretchedPlace,
        tracking: Tracking,
    ) -> Segment {
        let cast = self.problem.shadow_medium(s);
        let mut shadow = Segment::of_shadow(tracking, cast.as_ref(), &self.rule);
        // The shadow ray begins at s, which is rounded.
        let place = f64::EPSILON * (s.abs() + self.problem.foot().abs());
        shadow.error += shadow.size * place / along.hypot(self.problem.distance());
        shadow
    }

    /// The Gauss rule of a panel.
    pub fn rule(&self) -> &GaussLegendre {
        &self.rule
    }

    /// Quantities at a place.
    pub fn node(&self, place: StretchedPlace) -> RayNode {
        self.node_among(place, Among::All)
    }

    /// Quantities at a place, by all or half of the interpolated shadow rays.
    pub fn node_among(&self, place: StretchedPlace, among: Among) -> RayNode {
        let StretchedPlace { s, along, .. } = place;
        let medium = self.problem.medium();
        let depth = medium.optical_depth(Span::new(medium.support().from, s));
        let shadow = match &self.shadows {
            Some(shadows) => shadows.at(self.unstretched_by(along), among),
            None => self.followed(place, self.shadow),
        };
        let [source, rounding] = self.problem.source_beyond(along);
        RayNode {
            s,
            along,
            extinction: medium.extinction(s),
            source,
            transmittance: (-depth.value).exp(),
            error: [rounding, depth.error + f64::EPSILON],
            camera: self.camera.segment(s),
            shadow,
        }
    }

    /// The place at the stretched variable: `s = foot + D sinh x`, in which `1/r²` is smooth however
    /// near the light is.
    pub fn stretched(&self, x: f64) -> StretchedPlace {
        let distance = self.problem.distance();
        let along = distance * x.sinh();
        StretchedPlace { s: self.problem.foot() + along, along, stretch: distance * x.cosh() }
    }

    pub(super) fn unstretched(&self, s: f64) -> f64 {
        self.unstretched_by(s - self.problem.foot())
    }

    fn unstretched_by(&self, along: f64) -> f64 {
        (along / self.problem.distance()).asinh()
    }

    /// L by quadrature of exact optical depths, computed once for all experiments on it.
    pub fn radiance(&self) -> Known {
        let problem = self.problem;
        let medium = problem.medium();
        let from = medium.support().from;
        problem.radiance(|| {
            let shadows = self.interpolated(Tracking::Exact);
            let gathered = |StretchedPlace { s, along, .. }: StretchedPlace, among: Among| {
                let before = medium.optical_depth(Span::new(from, s)).value;
                let beyond = if let Some(shadows) = &shadows {
                    -shadows.at(self.unstretched_by(along), among).powers[0].ln()
                } else {
                    let cast = problem.shadow_medium(s);
                    cast.map_or(0.0, |m| m.optical_depth(m.support()).value)
                };
                let source = problem.source_beyond(along)[0];
                [medium.extinction(s) * source * (-(before + beyond)).exp()]
            };
            let among = shadows.as_ref().map_or(Vec::new(), |shadows| self.places(shadows));
            let mut result = self.over([RADIANCE], among, &|place| gathered(place, Among::All));
            if shadows.is_some() {
                self.compare(&mut result, &|place| gathered(place, Among::Half));
            }
            let [value] = result.value;
            // The optical depths add their own rounding, and so do positions next to the light.
            let depths = 2.0 * medium.optical_depth(medium.support()).error;
            let places = 0.25 * f64::EPSILON * problem.foot().abs() / problem.distance();
            Known::estimated(value, result.error[0] + (ROUNDING + depths + places) * value.abs())
        })
    }

    /// Initial ends of panels, in the stretched variable.
    fn ends(&self, cuts: Vec<f64>) -> Vec<f64> {
        let medium = self.problem.medium();
        let support = medium.support();
        let (mut s, _) = thinned(medium.breaks());
        s.extend(cuts);
        s.extend((1..STEPS).map(|i| support.from + support.length() * i as f64 / STEPS as f64));
        s.retain(|&s| support.contains_inside(s));
        s.extend([support.from, support.to]);
        let mut x: Vec<f64> = s.into_iter().map(|s| self.unstretched(s)).collect();
        order::ascend(&mut x);
        let cuts = |span: Span| span.even_cuts((span.length() / WIDEST).ceil());
        let further: Vec<f64> = Span::between(&x).flat_map(cuts).collect();
        x.extend(further);
        order::ascend(&mut x);
        x.dedup();
        x
    }

    fn panel<const N: usize>(&self, x: Span, f: &dyn Fn(StretchedPlace) -> [f64; N]) -> [f64; N] {
        let mut sum = [0.0; N];
        for (x, weight) in self.rule.on(x) {
            let place = self.stretched(x);
            let weight = weight * place.stretch;
            sum.iter_mut().zip(f(place)).for_each(|(sum, value)| *sum += weight * value);
        }
        sum
    }

    /// `∫ f ds` over the support, with panels that end at cuts, too: panels are halved until the two resolutions agree to
    /// the given parts of the whole.
    pub fn integrate<const N: usize>(
        &self,
        parts: [f64; N],
        mut cuts: Vec<f64>,
        f: &dyn Fn(&RayNode) -> [f64; N],
    ) -> Integral<N> {
        cuts.extend(self.camera.cuts());
        cuts.extend(self.shadows.iter().flat_map(|shadows| self.places(shadows)));
        let mut result = self.over(parts, cuts, &|place| f(&self.node(place)));
        if self.shadows.is_some() {
            self.compare(&mut result, &|place| f(&self.node_among(place, Among::Half)));
        }
        result
    }

    /// The places of shadow rays that are interpolated.
    fn places(&self, shadows: &Shadows) -> Vec<f64> {
        shadows.places().map(|x| self.stretched(x).s).collect()
    }

    /// Adds the difference to the integral by half of the shadow rays to the errors.
    fn compare<const N: usize>(
        &self,
        result: &mut Integral<N>,
        f: &dyn Fn(StretchedPlace) -> [f64; N],
    ) {
        let mut sums = [Sum::default(); N];
        for &x in &result.panels {
            sums.iter_mut().zip(self.panel(x, f)).for_each(|(sum, value)| sum.add(value));
        }
        for ((error, value), sum) in result.error.iter_mut().zip(result.value).zip(sums) {
            *error += (value - sum.value()).abs();
        }
    }

    /// `∫ f ds` over the support for a function of places, with panels that end at cuts, too.
    pub fn over<const N: usize>(
        &self,
        parts: [f64; N],
        cuts: Vec<f64>,
        f: &dyn Fn(StretchedPlace) -> [f64; N],
    ) -> Integral<N> {
        if self.problem.medium().support().is_empty() {
            return Integral { value: [0.0; N], error: [0.0; N], panels: Vec::new() };
        }
        let ends = self.ends(cuts);
        let minimum = if self.is_thinned { UNRESOLVED } else { 0.0 };
        let is_fine = |here: &Halved<N>, scale: &[f64; N]| {
            let change = here.change();
            !(0..N).any(|i| change[i].abs() > parts[i].max(minimum) * scale[i])
        };
        let result = halve(&mut Span::between(&ends), LIMITS, &|x| self.panel(x, f), &is_fine);
        let [mut sums, mut signed] = [[Sum::default(); N]; 2];
        let [mut error, mut squares] = [[0.0; N]; 2];
        for here in &result {
            let change = here.change();
            for i in 0..N {
                here.halves.iter().for_each(|half| sums[i].add(half[i]));
                error[i] += change[i].abs();
                signed[i].add(change[i]);
                squares[i] += change[i] * change[i];
            }
        }
        if self.is_thinned {
            // Differences have random signs.
            let of = |i: usize| signed[i].value().abs() + 2.0 * f64::sqrt(squares[i]);
            error = std::array::from_fn(of);
        }
        let panels = result.iter().flat_map(|here| here.span.halves()).collect();
        Integral { value: sums.map(|sum| sum.value()), error, panels }
    }
}
