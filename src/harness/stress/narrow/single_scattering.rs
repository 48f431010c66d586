//! Single scattering of a point light along a ray through layers of three waves.
//!
//! ```text
//! ray from (0, 0, t₀) along z, of length 1; light at (D, 0, t₀ + foot)
//! ```
//!
//! Distances along the ray are from its origin; places, where σ_t is looked up, are in space.

use std::f64::consts::PI;

use super::compare::{Stated, Walk, compare_walks};
use super::precision::Precision;
use super::scene::{FREQUENCY, Scene};
use super::trail::Trail;
use super::{Entry, NO_STEPS, entry, stated};
use crate::media::Extinction;
use crate::phase::PhaseFunction;
use crate::phase::henyey_greenstein::HenyeyGreenstein;

/// D.
const DISTANCE: f64 = 0.3;
/// Where the ray is nearest to the light.
const FOOT: f64 = 0.7;
/// The albedo.
const ALBEDO: f64 = 0.8;
/// The mean cosine of scattering.
const FORWARD: f64 = 0.5;
/// The points that share a walk.
const POINTS: usize = 4;

/// How a transmittance is found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tracking {
    /// In closed form.
    Exact,
    /// By ratio tracking.
    Ratio,
    /// By delta tracking.
    Delta,
}

impl Tracking {
    fn shadow(self, scene: &Scene) -> String {
        match self {
            Self::Exact => String::new(),
            Self::Ratio => format!("shadow.ratio = {{ sampling = {:e} }}, ", scene.collisions),
            Self::Delta => format!("shadow.delta = {{ sampling = {:e} }}, ", scene.collisions),
        }
    }

    /// Along `z₀ + slope t`, t = 0 … length.
    #[inline(always)]
    fn through<P: Precision>(
        self,
        scene: &Scene,
        trail: &mut Trail,
        [from, slope, length]: [P; 3],
    ) -> P {
        if self == Self::Exact {
            return (-(scene.mean(from, from + slope * length) * length)).exp();
        }
        let (path, sampling) = (P::of(1.0 / scene.collisions), P::of(scene.collisions));
        let (mut t, mut weight) = (P::of(0.0), P::of(1.0));
        loop {
            let reach = (length - t) * sampling;
            let flown = trail.fly(reach, |depth| t + depth * path, |t| t.below(length));
            let Some(place) = flown else { return weight };
            t = place;
            let ratio = scene.extinction(from + slope * t) * path;
            if self == Self::Ratio {
                weight = weight * (P::of(1.0) - ratio);
            } else if trail.happens(ratio) {
                return P::of(0.0);
            }
        }
    }
}

/// The ray and the light as a precision sees them.
struct View<'a, P> {
    scene: &'a Scene,
    origin: P,
    foot: P,
    angles: [f64; 2],
}

impl<'a, P: Precision> View<'a, P> {
    fn new(scene: &'a Scene) -> Self {
        let origin = P::of(scene.from);
        let foot = P::of(scene.from + FOOT) - origin;
        let angle = |s: f64| ((s - FOOT) / DISTANCE).atan();
        Self { scene, origin, foot, angles: [angle(0.0), angle(1.0)] }
    }

    fn square(&self, s: P) -> P {
        let along = s - self.foot;
        along * along + P::of(DISTANCE * DISTANCE)
    }

    fn extinction(&self, s: P) -> P {
        self.scene.extinction(self.origin + s)
    }

    /// What a unit of σ_t scatters towards the eye, but for both transmittances.
    fn source(&self, s: P) -> P {
        let square = self.square(s);
        let Some(phase) = HenyeyGreenstein::new(FORWARD) else { return P::of(f64::NAN) };
        let one = P::of(1.0);
        let cosine = ((self.foot - s) / square.root()).or_more(-one).or_less(one);
        phase.value(cosine) * (ALBEDO / (4.0 * PI)) / square
    }

    fn camera(&self, tracking: Tracking, trail: &mut Trail, s: P) -> P {
        tracking.through(self.scene, trail, [self.origin, P::of(1.0), s])
    }

    fn shadow(&self, tracking: Tracking, trail: &mut Trail, s: P) -> P {
        let length = self.square(s).root();
        let slope = (self.foot - s) / length;
        tracking.through(self.scene, trail, [self.origin + s, slope, length])
    }

    /// A point at equal angles, and the density of such points.
    fn equiangular(&self, u: P) -> P {
        let [from, to] = self.angles;
        let angle = u * (to - from) + from;
        self.foot + angle.sin() / angle.cos() * DISTANCE
    }

    fn equiangular_density(&self, s: P) -> P {
        let [from, to] = self.angles;
        P::of(DISTANCE / (to - from)) / self.square(s)
    }

    /// A point of the mean σ_t's own scattering, and the density of such points.
    fn scattering(&self, u: P) -> P {
        let absorbed = -(-self.scene.depth).exp_m1();
        -(P::of(1.0) - u * absorbed).ln() / P::of(self.scene.depth)
    }

    fn scattering_density(&self, s: P) -> P {
        let absorbed = -(-self.scene.depth).exp_m1();
        (-(s * self.scene.depth)).exp() * (self.scene.depth / absorbed)
    }

    /// The next tentative collision of a flight along the ray.
    fn fly(&self, trail: &mut Trail, s: P) -> Option<P> {
        let (path, end) = (P::of(1.0 / self.scene.collisions), P::of(1.0));
        let reach = (end - s) * self.scene.collisions;
        trail.fly(reach, |depth| s + depth * path, |s| s.below(end))
    }

    /// The first real collision.
    fn collide(&self, trail: &mut Trail) -> Option<P> {
        let mut s = P::of(0.0);
        loop {
            s = self.fly(trail, s)?;
            if trail.happens(self.extinction(s) / P::of(self.scene.collisions)) {
                return Some(s);
            }
        }
    }
}

/// How scattering points are found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Single {
    /// At equal angles, with both transmittances tracked so.
    Source(Tracking),
    /// Where the mean σ_t scatters.
    Scattering,
    /// At the first real collision.
    Delta,
    /// At every collision of a ratio tracking walk.
    Attenuation,
    /// At one of those.
    Resampled,
    /// At equal angles, with one walk for all.
    SharedWalk,
    /// At equal angles and where the mean σ_t scatters.
    SourceScattering,
    /// At equal angles and at the first real collision.
    SourceDelta,
}

impl Single {
    fn written(self, scene: &Scene) -> String {
        let sampling = format!("sampling.constant = {{ value = {:e} }}", scene.collisions);
        let control = format!("control.constant = {{ value = {:e} }}", scene.depth);
        match self {
            Self::Source(Tracking::Exact) => "source-driven = {}".to_owned(),
            Self::Source(tracking) => {
                let word = if tracking == Tracking::Ratio { "ratio" } else { "delta" };
                let shadow = tracking.shadow(scene);
                format!("source-driven = {{ camera = \"{word}\", {shadow}{sampling} }}")
            }
            Self::Scattering => format!("scattering-driven = {{ {control} }}"),
            Self::Delta => format!("delta-tracking = {{ {sampling} }}"),
            Self::Attenuation => format!("attenuation-driven = {{ {sampling} }}"),
            Self::Resampled => format!("attenuation-resampled = {{ {sampling} }}"),
            Self::SharedWalk => format!("shared-walk = {{ points = {POINTS}, {sampling} }}"),
            Self::SourceScattering => format!("source-scattering-mis = {{ {control} }}"),
            Self::SourceDelta => format!("source-delta-mis = {{ {sampling} }}"),
        }
    }
}

impl Walk for Single {
    fn stated(&self, scene: &Scene) -> Stated {
        let field = scene.sines(&format!("vectors = [[0, 0, {FREQUENCY:e}]]"));
        let text = format!(
            "title = \"t\"\n[problem.single-scattering]\nvolume.sines = {field}\n\
             ray = {{ origin = [0, 0, 0], direction = [0, 0, 1], length = 1 }}\n\
             light = {{ position = [{DISTANCE}, 0, {FOOT}] }}\nalbedo = {ALBEDO}\n\
             phase.henyey-greenstein = {{ g = {FORWARD} }}\nestimators = [{{ {} }}]",
            self.written(scene)
        );
        stated(&text, "")
    }

    #[inline(always)]
    fn draw<P: Precision>(&self, scene: &Scene, trail: &mut Trail) -> f64 {
        let view = View::<P>::new(scene);
        let found = match *self {
            Self::Source(tracking) => {
                let s = view.equiangular(trail.uniform());
                lit(&view, tracking, trail, s) / view.equiangular_density(s)
            }
            Self::Scattering => {
                let s = view.scattering(trail.uniform());
                lit(&view, Tracking::Exact, trail, s) / view.scattering_density(s)
            }
            Self::Delta => match view.collide(trail) {
                Some(s) => view.source(s) * view.shadow(Tracking::Exact, trail, s),
                None => P::of(0.0),
            },
            Self::Attenuation => attenuation(&view, trail),
            Self::Resampled => resampled(&view, trail),
            Self::SharedWalk => shared_walk(&view, trail),
            Self::SourceScattering => {
                let points = [view.equiangular(trail.uniform()), view.scattering(trail.uniform())];
                let [one, other] = points.map(|s| {
                    let density = view.equiangular_density(s) + view.scattering_density(s);
                    lit(&view, Tracking::Exact, trail, s) / density
                });
                one + other
            }
            Self::SourceDelta => {
                let first = view.equiangular(trail.uniform());
                let second = view.collide(trail);
                let at = |s: P| {
                    let through = view.camera(Tracking::Exact, trail, s);
                    let collision = view.extinction(s) * through;
                    let lit = view.source(s) * view.shadow(Tracking::Exact, trail, s);
                    collision * lit / (view.equiangular_density(s) + collision)
                };
                let found = [Some(first), second].into_iter().flatten().map(at);
                found.fold(P::of(0.0), |sum, x| sum + x)
            }
        };
        found.double()
    }
}

/// What a point sends to the eye, both transmittances tracked alike.
#[inline(always)]
fn lit<P: Precision>(view: &View<P>, tracking: Tracking, trail: &mut Trail, s: P) -> P {
    let through = view.camera(tracking, trail, s);
    let source = view.extinction(s) * view.source(s);
    through * source * view.shadow(tracking, trail, s)
}

/// Every collision of a walk: its place, and what it sends but for the shadow ray.
#[inline(always)]
fn interactions<P: Precision>(
    view: &View<P>,
    trail: &mut Trail,
    mut tell: impl FnMut(P, P, &mut Trail),
) {
    let sampling = P::of(view.scene.collisions);
    let (mut s, mut weight) = (P::of(0.0), P::of(1.0));
    while let Some(place) = view.fly(trail, s) {
        s = place;
        let ratio = view.extinction(s) / sampling;
        tell(s, weight * ratio * view.source(s), trail);
        weight = weight * (P::of(1.0) - ratio);
    }
}

#[inline(always)]
fn attenuation<P: Precision>(view: &View<P>, trail: &mut Trail) -> P {
    let mut sum = P::of(0.0);
    interactions(view, trail, |s, weight, trail| {
        sum = sum + weight * view.shadow(Tracking::Exact, trail, s);
    });
    sum
}

#[inline(always)]
fn resampled<P: Precision>(view: &View<P>, trail: &mut Trail) -> P {
    let (mut sum, mut chosen) = (P::of(0.0), None);
    interactions(view, trail, |s, weight, trail| {
        sum = sum + weight.size();
        if trail.happens(weight.size() / sum) {
            chosen = Some(s);
        }
    });
    match chosen {
        Some(s) => sum * view.shadow(Tracking::Exact, trail, s),
        None => P::of(0.0),
    }
}

#[inline(always)]
fn shared_walk<P: Precision>(view: &View<P>, trail: &mut Trail) -> P {
    let mut at: [P; POINTS] = std::array::from_fn(|_| view.equiangular(trail.uniform()));
    at.sort_unstable_by(|a, b| a.double().total_cmp(&b.double()));
    let (mut sum, mut weight, mut s, mut next) = (P::of(0.0), P::of(1.0), P::of(0.0), 0);
    loop {
        let collision = view.fly(trail, s);
        while next < POINTS && collision.is_none_or(|reached| at[next].at_most(reached)) {
            let here = at[next];
            let source = view.extinction(here) * view.source(here);
            let lit = source * view.shadow(Tracking::Exact, trail, here);
            sum = sum + weight * lit / view.equiangular_density(here) * (1.0 / POINTS as f64);
            next += 1;
        }
        let Some(reached) = collision else { return sum };
        s = reached;
        weight = weight * (P::of(1.0) - view.extinction(s) / P::of(view.scene.collisions));
    }
}

/// All of them.
pub const ALL: &[Entry] = &[
    entry!("source-driven", |x| compare_walks(&Single::Source(Tracking::Exact), x), NO_STEPS),
    entry!("source-driven, ratio", |x| compare_walks(&Single::Source(Tracking::Ratio), x)),
    entry!("source-driven, delta", |x| compare_walks(&Single::Source(Tracking::Delta), x)),
    entry!("scattering-driven", |x| compare_walks(&Single::Scattering, x), NO_STEPS),
    entry!("delta-tracking", |x| compare_walks(&Single::Delta, x)),
    entry!("attenuation-driven", |x| compare_walks(&Single::Attenuation, x)),
    entry!("attenuation-resampled", |x| compare_walks(&Single::Resampled, x)),
    entry!("shared-walk", |x| compare_walks(&Single::SharedWalk, x)),
    entry!("source-scattering-mis", |x| compare_walks(&Single::SourceScattering, x), NO_STEPS),
    entry!("source-delta-mis", |x| compare_walks(&Single::SourceDelta, x)),
];
