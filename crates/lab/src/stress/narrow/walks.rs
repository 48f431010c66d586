//! Estimators that are compared: the case of each, and the walk that it makes from a setup.
//!
//! Where `σ̂ ≥ σ_t`, as here, `terminating` is `analog` and `adaptive` is `non-terminating`, to the bit. A furnace with the
//! non-terminating rule is left out: each draw is 1, without noise.

use std::any::Any;
use std::marker::PhantomData;

use super::Along;
use super::Along::{Depth, Origin, Steps};
use super::scene::{BALL, LIT, RAY, StressScene};
use super::trail::{Precision, Traced, Trail};
use estimators::free_flight::woodcock::Flights;
use estimators::rod::walk::{InRod, RuleAndRoulette};
use estimators::setup::OnRay;
use estimators::single_scattering::plan::{Absorption, Plan, Run, Technique, Vertices};
use estimators::slab::walk::InSlab;
use estimators::space::walk::InSpace;
use estimators::space::{ParticleSettings, Splitting, Tally, Walked, draws};
use estimators::sphere::Correct;
use estimators::sphere::combined::Combined;
use estimators::sphere::sharing::SharedTechniques;
use estimators::transmittance::decomposition::Residual;
use estimators::transmittance::local_majorant::Segments;
use estimators::transmittance::next_flight::NextFlight;
use estimators::transmittance::product::{Product, Survival};
use estimators::transmittance::scoring::{Scoring, Share};
use estimators::transmittance::unidirectional_mis::UnidirectionalMis;
use estimators::transmittance_curve::double::Curve;
use estimators::walks::{Walk, plain};
use estimators::{Draw, Estimated, Setup};
use fearless_simd::Level;
use media::Majorants;
use numeric::fused::compiled_once;
use numeric::rng::{Address, name_hash};
use numeric::{F32, ScalarLane as _};
use theory::ParticleRule;
use theory::ParticleRule::{Analog, NonTerminating, Weighted};
use theory::collisions::rules::{Collision, Null, Single, Weight};
use theory::problems::{
    self, Channels, FreeFlight, Furnace, InfiniteMedium, Lambertian, Problem, Rod,
    SingleScattering, Slab, Sphere, Transmittance, TransmittanceCurve,
};
use theory::single::{CameraTracking, Tracking};
use theory::space::sphere::Techniques;

/// A scene with the setup of an estimator.
#[derive(Clone, Copy)]
pub struct StressSubject<'a> {
    /// The scene.
    pub scene: &'a StressScene,
    /// A `Setup<P>`.
    pub setup: &'a dyn Any,
    /// The channel that is compared.
    pub channel: usize,
    /// True if walks are kept from their end, see [`Trail`].
    pub is_kept: bool,
}

/// An estimator in any precision.
trait PreciseDraws: Sync {
    /// Draw of a trail, without its likelihood; `None` if the setup is that of another problem.
    fn draw<N: Precision>(&self, of: StressSubject, trail: &Trail) -> Option<f64>;
}

/// An estimator in both precisions.
pub trait InBoth: Sync {
    /// Draws of a walk from a seed, in doubles and in single precision, and the number of random words of the first.
    /// Returns `None` if the setup is that of another problem.
    fn pair(&self, of: StressSubject, seed: u64, walk: u64) -> Option<([f64; 2], f64)>;
}

impl<D: PreciseDraws> InBoth for D {
    fn pair(&self, of: StressSubject, seed: u64, walk: u64) -> Option<([f64; 2], f64)> {
        let experiment = name_hash("stress|narrow");
        let stream = Address { seed, experiment, block: walk, lane: 0 }.stream();
        let trail = Trail::new(stream, of.is_kept);
        let double = weighted::<_, f64>(self, of, &trail)?;
        let words = trail.words();
        let single = weighted::<_, F32>(self, of, &trail.again(stream))?;
        Some(([double, single], words))
    }
}

/// A draw with its likelihood: compiled once for each precision.
#[inline(never)]
fn weighted<D: PreciseDraws, N: Precision>(
    draws: &D,
    of: StressSubject,
    trail: &Trail,
) -> Option<f64> {
    let draw = compiled_once(
        #[inline(always)]
        || draws.draw::<N>(of, trail),
    );
    draw.map(|draw| draw * trail.likelihood())
}

/// Makes a draw by a walk along the ray.
#[inline(always)]
fn along<'t, N: Precision, P: Estimated<Value: Channels, Fields: OnRay>>(
    walk: &impl Walk,
    setup: &Setup<P>,
    StressSubject { scene, channel, .. }: StressSubject,
    mut trail: &'t Trail,
) -> Option<f64> {
    let look_up = |_, t: Traced<'t, N>| scene.on_ray(t);
    let draw: Draw<P::Value> = plain::through(walk, setup.residual().sampling, look_up, &mut trail);
    draw.value.as_ref().get(channel).copied()
}

/// Makes a draw by a particle in space.
#[inline(always)]
fn in_space<'t, N: Precision, V: Channels + AsRef<[f64]>, const SPLITS: bool>(
    (tally, particle): (&impl Tally, ParticleSettings),
    world: (&problems::Scene, &Majorants),
    StressSubject { scene, channel, .. }: StressSubject,
    mut trail: &'t Trail,
) -> Option<f64> {
    // σ_t alone is looked up.
    let _ = world.0.albedo.even()?;
    let everywhere = world.0.volume.facts().single_value;
    let look_up =
        |_, place: [Traced<'t, N>; 3]| everywhere.map_or_else(|| scene.in_ball(place), Traced::of);
    let walk = InSpace::new(tally, particle, world, &[]);
    let draw = draws::follow::<_, V, _, SPLITS>(&walk, particle.splitting, look_up, &mut trail);
    draw.value.as_ref().get(channel).copied()
}

/// Estimators along the ray, and the walks that they make from a setup.
macro_rules! on_ray {
    ($([$($generic:tt)*] $Type:ty, $Problem:ty: |$this:pat_param, $setup:ident| $walk:expr;)*) => {
        $(impl<$($generic)*> PreciseDraws for $Type {
            #[inline(always)]
            fn draw<N: Precision>(&self, of: StressSubject, trail: &Trail) -> Option<f64> {
                let ($this, $setup) = (self, of.setup.downcast_ref::<Setup<$Problem>>()?);
                along::<N, _>(&$walk, $setup, of, trail)
            }
        })*
    };
}

struct Weighs<R>(R);
struct Woodcock;
struct Decomposed;
struct Local;
struct Scored<H>(H);
struct OnCurve;
struct Distance;
struct InLayers(ParticleRule);

on_ray! {
    [R: Collision + Sync] Weighs<R>, Transmittance: |Self(rule), setup| Product::new(rule, setup);
    [] Woodcock, Transmittance: |_, setup| Survival(Product::new(&Null, setup));
    [] Decomposed, Transmittance: |_, setup| Residual::new(setup);
    [] Local, Transmittance: |_, setup| Segments::of(setup)?;
    [H: Share + Sync] Scored<H>, Transmittance: |Self(share), setup| Scoring::new(*share, setup);
    [] OnCurve, TransmittanceCurve: |_, setup| Curve::new(setup);
    [] Distance, FreeFlight: |_, setup| Flights::new(setup);
    [] RuleAndRoulette, Rod: |steps, setup| InRod { rod: &setup.problem, steps: *steps };
    [] InLayers, Slab: |Self(rule), setup| InSlab::of(&setup.problem, *rule);
}

/// Single scattering by the plan for a scene.
struct PlannedScattering(fn(&StressScene) -> Plan);

struct ScatteringDraw<'a, N>(
    &'a Setup<SingleScattering>,
    StressSubject<'a>,
    &'a Trail,
    PhantomData<N>,
);

impl<N: Precision> Run for ScatteringDraw<'_, N> {
    type Output = Option<f64>;

    /// A function of its own for each walk: the time of a compiler grows faster than a function.
    #[inline(never)]
    fn run(self, walk: &impl Walk) -> Option<f64> {
        compiled_once(
            #[inline(always)]
            || along::<N, _>(walk, self.0, self.1, self.2),
        )
    }
}

impl PreciseDraws for PlannedScattering {
    #[inline(always)]
    fn draw<N: Precision>(&self, of: StressSubject, trail: &Trail) -> Option<f64> {
        let setup = of.setup.downcast_ref::<Setup<SingleScattering>>()?;
        let medium = setup.problem.lookups(Level::new());
        self.0(of.scene).run_on(setup, &medium, ScatteringDraw::<N>(setup, of, trail, PhantomData))
    }
}

/// A particle that walks through the scene of a problem.
struct SceneWalks<P, const SPLITS: bool = false>(ParticleSettings, PhantomData<fn(P)>);

impl<P: Walked, const SPLITS: bool> PreciseDraws for SceneWalks<P, SPLITS> {
    #[inline(always)]
    fn draw<N: Precision>(&self, of: StressSubject, trail: &Trail) -> Option<f64> {
        let setup = of.setup.downcast_ref::<Setup<P>>()?;
        let (tally, majorants) = (P::tally(setup, &self.0).ok()?, &*setup.fields);
        let world = (setup.problem.scene(), majorants);
        in_space::<N, P::Value, SPLITS>((&tally, self.0), world, of, trail)
    }
}

/// Next-event estimation in a ball, with the tracking of shadow rays through a scene.
struct Connects(ParticleRule, fn(&StressScene) -> Tracking);

impl PreciseDraws for Connects {
    #[inline(always)]
    fn draw<N: Precision>(&self, of: StressSubject, trail: &Trail) -> Option<f64> {
        let setup = of.setup.downcast_ref::<Setup<Sphere>>()?;
        let (sphere, majorants) = (&*setup.problem, &*setup.fields);
        let shadow = Some(self.1(of.scene));
        let sharing =
            SharedTechniques { techniques: Techniques::NextEvent, shadow, subpaths: None };
        let tally = Combined::<_, false>::new((sphere, majorants), self.0, (sharing, Correct));
        let world = (&sphere.scene, majorants);
        in_space::<N, [f64; 1], false>((&tally, particle(self.0)), world, of, trail)
    }
}

const fn particle(rule: ParticleRule) -> ParticleSettings {
    ParticleSettings { rule, roulette: None, splitting: Splitting::None }
}

const fn walks<P>(rule: ParticleRule) -> SceneWalks<P> {
    SceneWalks(particle(rule), PhantomData)
}

const fn rod(rule: ParticleRule) -> RuleAndRoulette {
    RuleAndRoulette { rule, roulette: None }
}

const fn plan(technique: Technique) -> Plan {
    Plan { technique, shadow: Tracking::Exact }
}

const fn points(camera: CameraTracking, shadow: Tracking) -> Plan {
    Plan { technique: Technique::Vertices(Vertices { camera, ..Vertices::FROM_LIGHT }), shadow }
}

const fn collides(light: bool) -> Plan {
    let collision = Some(Absorption::Weight);
    plan(Technique::Vertices(Vertices { light, collision, ..Vertices::FROM_LIGHT }))
}

const fn from_main(light: bool) -> Plan {
    plan(Technique::Vertices(Vertices { light, main: true, ..Vertices::FROM_LIGHT }))
}

const fn ratio(scene: &StressScene) -> Tracking {
    Tracking::Ratio { sampling: scene.collisions, control: 0.0 }
}

const fn delta(scene: &StressScene) -> Tracking {
    Tracking::Delta { sampling: scene.collisions }
}

/// Problem, medium, further settings and channel of a case; an empty channel is the first.
type CaseParts = [&'static str; 4];

/// An estimator in the list of its family.
pub struct FamilyEntry {
    /// Its name.
    pub name: &'static str,
    /// Quantities that are varied.
    pub varied: &'static [Along],
    /// The problem.
    pub requested: CaseParts,
    /// The estimator as a case has it.
    pub written: &'static str,
    /// True if the only decisions of a walk, if any, end it with the score 0; it is then kept from its end, see
    /// [`Trail`].
    pub is_kept: bool,
    /// Its draws.
    pub draws: &'static dyn InBoth,
}

const fn entry(
    (name, varied, requested): (&'static str, &'static [Along], CaseParts),
    written: &'static str,
    is_kept: bool,
    draws: &'static dyn InBoth,
) -> FamilyEntry {
    FamilyEntry { name, varied, requested, written, is_kept, draws }
}

const EVERY: &[Along] = &Along::ALL;
const NO_STEPS: &[Along] = &[Depth, Origin];

const TRANSMITTANCE: CaseParts = ["transmittance", RAY, "", ""];
const CURVE: CaseParts = ["transmittance", RAY, "distances = 2", ""];
const FLIGHT: CaseParts = ["free-flight", RAY, "", ""];
const ROD: CaseParts = ["rod", RAY, "albedo = 0.8\nforward = 0.7", "reflectance"];
const SLAB: CaseParts = ["slab", RAY, SLANTED, "reflectance"];
const SLANTED: &str =
    "albedo = 0.8\nphase.henyey-greenstein.g = 0.5\nincidence.collimated.cosine = 0.6";
const SINGLE: CaseParts = ["single-scattering", LIT, "", ""];
const FURNACE: CaseParts = ["furnace", BALL, "albedo = 0.8\nphase.henyey-greenstein.g = 0.5", ""];
const WHITE: CaseParts =
    ["lambertian", BALL, "albedo = 1\nphase.henyey-greenstein.g = 0.5", "path length"];
const SKY: CaseParts =
    ["ball", BALL, "albedo = 0.8\nphase.isotropic = {}\nlight.environment = {}", ""];
const INFINITE: CaseParts = [
    "infinite-medium",
    "ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 1 }\n\
     volume.constant.extinction = DEPTH",
    "albedo = 0.8\nphase.henyey-greenstein.g = 0.5",
    "squared distance",
];

const fn at_end(requested: CaseParts) -> CaseParts {
    let [problem, medium, settings, _] = requested;
    [problem, medium, settings, "transmittance"]
}

/// Transmittance by weights and decisions at collisions.
#[rustfmt::skip] // one estimator, one line
pub const PRODUCTS: &[FamilyEntry] = &[
    entry(("ratio", EVERY, TRANSMITTANCE), "ratio = { SAMPLING }", true, &Weighs(Weight)),
    entry(("residual-ratio", EVERY, TRANSMITTANCE), "residual-ratio = { control.constant = { value = DEPTH }, SAMPLING }", true, &Weighs(Weight)),
    entry(("woodcock", EVERY, TRANSMITTANCE), "woodcock = { SAMPLING }", true, &Woodcock),
    entry(("decomposition", EVERY, TRANSMITTANCE), "decomposition = { control.constant = { value = LEAST }, SAMPLING }", true, &Decomposed),
    entry(("single (terminating)", EVERY, TRANSMITTANCE), "single = { rule = \"terminating\", SAMPLING }", true, &Weighs(Single::Terminating)),
    entry(("single (non-terminating, a = 0.7)", EVERY, TRANSMITTANCE), "single = { rule = \"non-terminating\", albedo = 0.7, SAMPLING }", true, &Weighs(Single::NonTerminating { albedo: 0.7 })),
    entry(("single (adaptive, a = 0.7)", EVERY, TRANSMITTANCE), "single = { rule = \"adaptive\", albedo = 0.7, SAMPLING }", true, &Weighs(Single::Adaptive { albedo: 0.7 })),
    entry(("single (clamped)", EVERY, TRANSMITTANCE), "single = { rule = \"clamped\", SAMPLING }", true, &Weighs(Single::Clamped)),
    entry(("weighted-delta", EVERY, TRANSMITTANCE), "weighted-delta = { SAMPLING }", true, &Weighs(Single::NonTerminating { albedo: 1.0 })),
];

/// Transmittance by other ways, half way along a curve, and distances of free flights.
#[rustfmt::skip]
pub const OTHERS: &[FamilyEntry] = &[
    entry(("ratio, local majorants", NO_STEPS, TRANSMITTANCE), "ratio = { CELLS }", true, &Weighs(Weight)),
    entry(("woodcock, local majorants", NO_STEPS, TRANSMITTANCE), "local-majorant = { CELLS }", true, &Local),
    entry(("curve, half way", EVERY, CURVE), "double = { SAMPLING }", true, &OnCurve),
    entry(("woodcock, distance", EVERY, FLIGHT), "woodcock = { SAMPLING }", false, &Distance),
    entry(("next-flight", EVERY, TRANSMITTANCE), "next-flight = { SAMPLING }", true, &Scored(NextFlight)),
    entry(("unidirectional-mis", EVERY, TRANSMITTANCE), "unidirectional-mis = { SAMPLING }", true, &Scored(UnidirectionalMis)),
];

/// Rods.
#[rustfmt::skip]
pub const RODS: &[FamilyEntry] = &[
    entry(("rod, analog", EVERY, ROD), "analog = { SAMPLING }", false, &rod(Analog)),
    entry(("rod, weighted", EVERY, ROD), "weighted = { SAMPLING }", false, &rod(Weighted)),
    entry(("rod, non-terminating", EVERY, ROD), "non-terminating = { SAMPLING }", false, &rod(NonTerminating)),
    entry(("rod, roulette", EVERY, ROD), "roulette = { below = 0.1, SAMPLING }", false, &RuleAndRoulette { rule: NonTerminating, roulette: Some(0.1) }),
    entry(("rod, analog, transmitted", EVERY, at_end(ROD)), "analog = { SAMPLING }", false, &rod(Analog)),
];

/// Slabs that scatter forward, under light from the side.
#[rustfmt::skip]
pub const SLABS: &[FamilyEntry] = &[
    entry(("slab, analog", EVERY, SLAB), "analog = { SAMPLING }", false, &InLayers(Analog)),
    entry(("slab, weighted", EVERY, SLAB), "weighted = { SAMPLING }", false, &InLayers(Weighted)),
    entry(("slab, non-terminating", EVERY, SLAB), "non-terminating = { SAMPLING }", false, &InLayers(NonTerminating)),
    entry(("slab, analog, transmitted", EVERY, at_end(SLAB)), "analog = { SAMPLING }", false, &InLayers(Analog)),
];

/// Single scattering.
#[rustfmt::skip]
pub const POINTS: &[FamilyEntry] = &[
    entry(("source-driven", NO_STEPS, SINGLE), "source-driven = {}", false, &PlannedScattering(|_| points(CameraTracking::Exact, Tracking::Exact))),
    entry(("source-driven, ratio", EVERY, SINGLE), "source-driven = { camera = \"ratio\", shadow.ratio = { sampling = COLLISIONS }, SAMPLING }", false, &PlannedScattering(|scene| points(CameraTracking::Ratio, ratio(scene)))),
    entry(("source-driven, delta", EVERY, SINGLE), "source-driven = { camera = \"delta\", shadow.delta = { sampling = COLLISIONS }, SAMPLING }", true, &PlannedScattering(|scene| points(CameraTracking::Delta, delta(scene)))),
    entry(("scattering-driven", NO_STEPS, SINGLE), "scattering-driven = { control.constant = { value = DEPTH } }", false, &PlannedScattering(|_| from_main(false))),
    entry(("delta-tracking", EVERY, SINGLE), "delta-tracking = { SAMPLING }", false, &PlannedScattering(|_| collides(false))),
    entry(("attenuation-driven", EVERY, SINGLE), "attenuation-driven = { SAMPLING }", false, &PlannedScattering(|_| plan(Technique::Interactions))),
    entry(("attenuation-resampled", EVERY, SINGLE), "attenuation-resampled = { SAMPLING }", false, &PlannedScattering(|_| plan(Technique::Resampled))),
    entry(("shared-walk", EVERY, SINGLE), "shared-walk = { points = 4, SAMPLING }", false, &PlannedScattering(|_| plan(Technique::Shared(4)))),
    entry(("source-scattering-mis", NO_STEPS, SINGLE), "source-scattering-mis = { control.constant = { value = DEPTH } }", false, &PlannedScattering(|_| from_main(true))),
    entry(("source-delta-mis", EVERY, SINGLE), "source-delta-mis = { SAMPLING }", false, &PlannedScattering(|_| collides(true))),
];

/// Balls, and an infinite medium with a source at the origin.
#[rustfmt::skip]
pub const SPACE: &[FamilyEntry] = &[
    entry(("furnace, analog", EVERY, FURNACE), "particle = { rule = \"analog\", SAMPLING }", false, &walks::<Furnace>(Analog)),
    entry(("furnace, weighted", EVERY, FURNACE), "particle = { rule = \"weighted\", SAMPLING }", false, &walks::<Furnace>(Weighted)),
    entry(("furnace, splitting", EVERY, FURNACE), "splitting = { depth = 3, rule = \"analog\", SAMPLING }", false, &SceneWalks::<Furnace, true>(ParticleSettings { splitting: Splitting::Depth(3), ..particle(Analog) }, PhantomData)),
    entry(("lambertian, analog", EVERY, WHITE), "particle = { rule = \"analog\", SAMPLING }", false, &walks::<Lambertian>(Analog)),
    entry(("infinite medium, analog", &[Steps], INFINITE), "particle = { rule = \"analog\", SAMPLING }", false, &walks::<InfiniteMedium>(Analog)),
    entry(("sphere, particle", EVERY, SKY), "particle = { rule = \"analog\", SAMPLING }", false, &walks::<Sphere>(Analog)),
    entry(("sphere, next-event, ratio", EVERY, SKY), "next-event = { rule = \"weighted\", shadow.ratio = { sampling = COLLISIONS }, SAMPLING }", false, &Connects(Weighted, ratio)),
    entry(("sphere, next-event, delta", EVERY, SKY), "next-event = { rule = \"analog\", shadow.delta = { sampling = COLLISIONS }, SAMPLING }", false, &Connects(Analog, delta)),
];
