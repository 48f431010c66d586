//! Single scattering of a point light along a ray through layers of three waves.
//!
//! ```text
//! ray from (0, 0, t₀) along z, of length 1; light at (D, 0, t₀ + foot)
//! ```
//!
//! Distances along the ray are from its origin; places, where σ_t is looked up, are in space.

use std::f64::consts::PI;

use super::compare::{Estimator, Spread, Theory, fly, tracked};
use super::precision::Precision;
use super::scene::{FREQUENCY, Scene};
use super::trail::Trail;
use super::{EVERY, Entry, NO_STEPS, stated};
use media::Extinction;
use media::phase::PhaseFunction;
use media::phase::henyey_greenstein::HenyeyGreenstein;

/// D.
const DISTANCE: f64 = 0.3;
/// Where the ray is nearest to the light.
const FOOT: f64 = 0.7;
/// The albedo.
const ALBEDO: f64 = 0.8;
/// The mean cosine of scattering.
const FORWARD: f64 = 0.5;
/// What a point costs where nothing is tracked, in collisions.
const UNTRACKED: f64 = 20.0;
/// The points that share a walk.
const POINTS: usize = 4;

/// How a transmittance is found.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Tracking {
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

    /// Along `z₀ + slope t`, t = 0 … length: the weight, and the chance that delta tracking comes through.
    #[inline(always)]
    fn through<P: Precision>(
        self,
        scene: &Scene,
        trail: &mut Trail,
        [from, slope, length]: [P; 3],
    ) -> (P, f64) {
        if self == Self::Exact {
            return (exact(scene, [from, slope, length]), 1.0);
        }
        let path = P::of(1.0 / scene.collisions);
        let ratio = |t: P| scene.extinction(from + slope * t) * path;
        tracked(trail, [P::of(0.0), length, path], self == Self::Ratio, ratio)
    }
}

/// A transmittance along `z₀ + slope t`, t = 0 … length.
#[inline(always)]
fn exact<P: Precision>(scene: &Scene, [from, slope, length]: [P; 3]) -> P {
    (-(scene.mean(from, from + slope * length) * length)).exp()
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

    /// The transmittances of a point as they are tracked: from the eye, and from the light.
    fn camera(&self, tracking: Tracking, trail: &mut Trail, s: P) -> (P, f64) {
        tracking.through(self.scene, trail, [self.origin, P::of(1.0), s])
    }

    fn shadow(&self, tracking: Tracking, trail: &mut Trail, s: P) -> (P, f64) {
        let length = self.square(s).root();
        let slope = (self.foot - s) / length;
        tracking.through(self.scene, trail, [self.origin + s, slope, length])
    }

    /// Both transmittances of a point in closed form.
    fn through(&self, s: P) -> P {
        exact(self.scene, [self.origin, P::of(1.0), s])
    }

    fn shaded(&self, s: P) -> P {
        let length = self.square(s).root();
        exact(self.scene, [self.origin + s, (self.foot - s) / length, length])
    }

    /// What a unit of σ_t sends towards the eye.
    fn lit(&self, s: P) -> P {
        self.source(s) * self.shaded(s)
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

    /// All tentative collisions of a walk along the ray, with `σ_t/σ̂`.
    #[inline(always)]
    fn fly(&self, trail: &mut Trail, mut collide: impl FnMut(P, P)) {
        let path = P::of(1.0 / self.scene.collisions);
        fly(trail, [P::of(0.0), P::of(1.0), path], |s| collide(s, self.extinction(s) * path));
    }

    /// What is found at the first real collision, on average over all decisions.
    #[inline(always)]
    fn collide(&self, trail: &mut Trail, found: impl Fn(P) -> P) -> f64 {
        let (mut alive, mut sum) = (1.0, 0.0);
        self.fly(trail, |s, ratio| {
            let real = ratio.chance();
            sum += alive * real * found(s).double();
            alive *= 1.0 - real;
        });
        sum
    }
}

/// How scattering points are found.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Single {
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

impl Estimator for Single {
    fn theory(&self, scene: &Scene) -> Theory {
        let field = scene.sines(&format!("vectors = [[0, 0, {FREQUENCY:e}]]"));
        let text = format!(
            "title = \"t\"\n[problem.single-scattering]\nvolume.sines = {field}\n\
             ray = {{ origin = [0, 0, 0], direction = [0, 0, 1], length = 1 }}\n\
             light = {{ position = [{DISTANCE}, 0, {FOOT}] }}\nalbedo = {ALBEDO}\n\
             phase.henyey-greenstein = {{ g = {FORWARD} }}\nestimators = [{{ {} }}]",
            self.written(scene)
        );
        let known = stated(scene, &text, "");
        // Averaged decisions of delta tracking weigh like ratio tracking.
        let drawn = if *self == Self::Source(Tracking::Delta) {
            Self::Source(Tracking::Ratio).theory(scene).variance
        } else {
            known.variance
        };
        match drawn.filter(|_| known.variance.is_some()) {
            Some(drawn) => Theory { spread: Spread::Rare(drawn), ..known },
            None => Theory::UNKNOWN,
        }
    }

    fn cost(&self, scene: &Scene) -> Option<f64> {
        Some(match self {
            Self::Source(Tracking::Exact) | Self::Scattering | Self::SourceScattering => UNTRACKED,
            _ => scene.collisions,
        })
    }

    #[inline(always)]
    fn draw<P: Precision>(&self, scene: &Scene, trail: &mut Trail) -> f64 {
        let view = View::<P>::new(scene);
        match *self {
            Self::Source(tracking) => {
                let s = view.equiangular(trail.uniform());
                let (camera, arrives) = view.camera(tracking, trail, s);
                let (shadow, comes) = view.shadow(tracking, trail, s);
                let found = camera * (view.extinction(s) * view.source(s)) * shadow;
                (found / view.equiangular_density(s)).double() * arrives * comes
            }
            Self::Scattering => {
                let s = view.scattering(trail.uniform());
                (sent(&view, s) / view.scattering_density(s)).double()
            }
            Self::Delta => view.collide(trail, |s| view.lit(s)),
            Self::Attenuation => {
                let (mut sum, mut weight) = (P::of(0.0), P::of(1.0));
                view.fly(trail, |s, ratio| {
                    sum = sum + weight * ratio * view.lit(s);
                    weight = weight * (P::of(1.0) - ratio);
                });
                sum.double()
            }
            Self::Resampled => resampled(&view, trail),
            Self::SharedWalk => shared_walk(&view, trail),
            Self::SourceScattering => {
                let points = [view.equiangular(trail.uniform()), view.scattering(trail.uniform())];
                let [one, other] = points.map(|s| {
                    let density = view.equiangular_density(s) + view.scattering_density(s);
                    sent(&view, s) / density
                });
                (one + other).double()
            }
            Self::SourceDelta => {
                let at = |s: P| {
                    let collision = view.extinction(s) * view.through(s);
                    collision * view.lit(s) / (view.equiangular_density(s) + collision)
                };
                at(view.equiangular(trail.uniform())).double() + view.collide(trail, at)
            }
        }
    }
}

/// What a point sends to the eye, with nothing tracked.
#[inline(always)]
fn sent<P: Precision>(view: &View<P>, s: P) -> P {
    view.through(s) * (view.extinction(s) * view.lit(s))
}

/// On average over which collision is chosen: the later of two with its share of the sum.
#[inline(always)]
fn resampled<P: Precision>(view: &View<P>, trail: &mut Trail) -> f64 {
    let (mut sum, mut weight, mut shadow) = (P::of(0.0), P::of(1.0), 0.0);
    view.fly(trail, |s, ratio| {
        let part = weight * ratio * view.source(s);
        sum = sum + part;
        let chosen = (part / sum).chance();
        shadow += chosen * (view.shaded(s).double() - shadow);
        weight = weight * (P::of(1.0) - ratio);
    });
    sum.double() * shadow
}

#[inline(always)]
fn shared_walk<P: Precision>(view: &View<P>, trail: &mut Trail) -> f64 {
    let mut at: [P; POINTS] = std::array::from_fn(|_| view.equiangular(trail.uniform()));
    at.sort_unstable_by(|a, b| a.double().total_cmp(&b.double()));
    let (mut sum, mut weight, mut next) = (P::of(0.0), P::of(1.0), 0);
    let mut pass = |reached: P, weight: P| {
        while next < POINTS && at[next].at_most(reached) {
            let source = view.extinction(at[next]) * view.lit(at[next]);
            let share = P::of(1.0 / POINTS as f64);
            sum = sum + share * weight * source / view.equiangular_density(at[next]);
            next += 1;
        }
    };
    view.fly(trail, |s, ratio| {
        pass(s, weight);
        weight = weight * (P::of(1.0) - ratio);
    });
    pass(P::of(f64::INFINITY), weight);
    sum.double()
}

/// All of them.
pub const ALL: &[Entry] = &[
    ("source-driven", &Single::Source(Tracking::Exact), NO_STEPS),
    ("source-driven, ratio", &Single::Source(Tracking::Ratio), EVERY),
    ("source-driven, delta", &Single::Source(Tracking::Delta), EVERY),
    ("scattering-driven", &Single::Scattering, NO_STEPS),
    ("delta-tracking", &Single::Delta, EVERY),
    ("attenuation-driven", &Single::Attenuation, EVERY),
    ("attenuation-resampled", &Single::Resampled, EVERY),
    ("shared-walk", &Single::SharedWalk, EVERY),
    ("source-scattering-mis", &Single::SourceScattering, NO_STEPS),
    ("source-delta-mis", &Single::SourceDelta, EVERY),
];
