//! Wrong walks of particles through rods, slabs and space.
//!
//! ```text
//! everywhere       scattered with probability q_s and weight a r w/q_s, straight on with q_t and (1 − r) w/q_t
//! rod              a scattered particle goes on in its direction with probability p_f
//! slab             a flight of optical depth u goes u|μ| deep; a particle that is scattered by an angle θ at an azimuth φ
//!                  goes on with μ' = μ cos θ + √(1 − μ²) sin θ cos φ;  diffuse light has the density 2μ₀
//! furnace          Σ w r (1 − a) + w where it leaves = 1 on average, and in every draw where a rule never ends a walk
//! infinite medium  E[x²] at absorption = 2/(σ_t² (1 − a)(1 − a g)) depends on scattering angles, on collisions and on
//!                  how a walk ends
//! lambertian       light from all sides: every distribution of starts but Lambert's changes lengths and counts
//! ```

use super::altered::{Altered, Change, Renumbered};
use super::{Mutant, MutantRow, On, family, filled, on, one_by_one};
use estimators::Setup;
use estimators::rod::walk::{self as rod, InRod, RuleAndRoulette};
use estimators::slab::walk::{self as slab, InSlab};
use estimators::space::walk::{InSpace, State};
use estimators::space::{ParticleSettings, Splitting, Tally, Walked, draws};
use estimators::walks::{self, Route, TentativeCollision, Walk};
use gate::CheckId;
use media::sampling::BothWays;
use numeric::geometry::Point;
use numeric::rng::Random;
use numeric::{Kept, Lane, Mask};
use theory::ParticleRule;
use theory::ParticleRule::{Adaptive, Analog, NonTerminating, Terminating, Weighted};
use theory::collisions::particle::EventProbabilities;
use theory::problems::{Furnace, InfiniteMedium, Lambertian, Rod, Slab};

/// `σ̂ = 1.6`, `a` from 0.9 to 0.5 and `p_f` from 0.8 to 0.3 along the rod.
const ROD_TERMINATING: On<ParticleSettings> = on("rod/known-bugs", 0, of(Terminating));
const ROD_ANALOG: On<ParticleSettings> = on("rod/known-bugs", 1, of(Analog));
const ROD_WEIGHTED: On<ParticleSettings> = on("rod/known-bugs", 2, of(Weighted));
/// `σ̂ = 0.9`, below σ_t at both ends.
const ROD_NON_TERMINATING: On<ParticleSettings> = on("rod/known-bugs", 3, of(NonTerminating));
const ROD_ADAPTIVE: On<ParticleSettings> = on("rod/known-bugs", 4, of(Adaptive));
/// `σ̂ = 2.4`, `a = 0.6`, roulette below 1/2.
const ROD_ROULETTE: On<ParticleSettings> = on("rod/roulette", 0, playing(NonTerminating, 0.5));
/// Henyey–Greenstein, g = 0.6, light at μ₀ = 0.6, `σ̂ = 1.2`.
const SLAB_ANALOG: On<ParticleSettings> = on("slab/known-bugs", 0, of(Analog));
const SLAB_WEIGHTED: On<ParticleSettings> = on("slab/known-bugs", 1, of(Weighted));
/// `σ̂ = 0.9`, below σ_t at both ends.
const SLAB_NON_TERMINATING: On<ParticleSettings> = on("slab/known-bugs", 2, of(NonTerminating));
const SLAB_ADAPTIVE: On<ParticleSettings> = on("slab/known-bugs", 3, of(Adaptive));
/// Diffuse light, a σ̂ in steps.
const SLAB_DIFFUSE: On<ParticleSettings> = on("slab/known-bugs-diffuse", 0, of(NonTerminating));
/// A thin ball, a = 0.9, `r = 1.15`.
const FURNACE_BELOW: On<ParticleSettings> = on("furnace/known-bugs", 0, of(NonTerminating));
/// `σ̂ = 1.2`.
const FURNACE_NON_TERMINATING: On<ParticleSettings> =
    on("furnace/known-bugs", 1, of(NonTerminating));
/// Roulette below 0.8.
const FURNACE_ROULETTE: On<ParticleSettings> =
    on("furnace/known-bugs", 2, playing(NonTerminating, 0.8));
const FURNACE_ANALOG: On<ParticleSettings> = on("furnace/known-bugs", 3, of(Analog));
/// Henyey–Greenstein, g = 0.6, a = 0.7.
const INFINITE_ANALOG: On<ParticleSettings> = on("infinite-medium/known-bugs", 0, of(Analog));
/// Roulette below 0.5.
const INFINITE_WEIGHTED: On<ParticleSettings> =
    on("infinite-medium/known-bugs", 1, playing(Weighted, 0.5));
/// Eq. 21, a = 1, `σ̂ = 1`.
const LAMBERTIAN: On<ParticleSettings> = on("lambertian/known-bugs", 0, of(NonTerminating));
/// A dense half and a thin one, a cell each.
const LAMBERTIAN_CELLS: On<ParticleSettings> = on("lambertian/known-bugs-cells", 0, of(Analog));

const fn of(rule: ParticleRule) -> ParticleSettings {
    ParticleSettings { rule, roulette: None, splitting: Splitting::None }
}

/// A particle that plays roulette below a weight.
const fn playing(rule: ParticleRule, below: f64) -> ParticleSettings {
    ParticleSettings { roulette: Some(below), ..of(rule) }
}

#[derive(Clone, Copy, PartialEq)]
enum Bug {
    None,
    Rule(ParticleRule),
    AlbedoTwice,
    AnalogAndWeighted,
    AlbedoStraightOn,
    SignLost,
    Undivided,
    OneNumber,
    Backward,
    Uncompensated,
    Unslanted,
    SlantInverted,
    EvenLight,
    NumberTwice,
    AboutZ,
    StaleMajorant,
}

#[rustfmt::skip] // one mutant, one entry
const IN_ROD: &[MutantRow<ParticleSettings, Bug>] = &[
    ("rod-albedo-twice", "the albedo is a chance and a weight", ROD_TERMINATING, CheckId::Mean, Bug::AlbedoTwice),
    ("rod-albedo-in-transmission", "what goes straight on is multiplied by the albedo too", ROD_WEIGHTED, CheckId::Mean, Bug::AlbedoStraightOn),
    ("rod-terminating-beyond", "the terminating rule where r > 2/(a + 1)", ROD_ADAPTIVE, CheckId::Mean, Bug::Rule(Terminating)),
    ("rod-sign-lost", "the weight of what goes straight on keeps its sign where r > 1", ROD_NON_TERMINATING, CheckId::Mean, Bug::SignLost),
    ("rod-undivided", "what is scattered is not divided by its chance", ROD_NON_TERMINATING, CheckId::Mean, Bug::Undivided),
    ("rod-one-number", "the number that decided the collision decides the direction too", ROD_ANALOG, CheckId::Mean, Bug::OneNumber),
    ("rod-forward-for-backward", "forward and backward are mixed up", ROD_ANALOG, CheckId::Mean, Bug::Backward),
    ("rod-analog-for-weighted", "absorption by roulette and by weight at once", ROD_WEIGHTED, CheckId::Mean, Bug::AnalogAndWeighted),
    ("rod-roulette-uncompensated", "what survives roulette keeps its weight", ROD_ROULETTE, CheckId::Mean, Bug::Uncompensated),
];

#[rustfmt::skip] // one mutant, one entry
const IN_SLAB: &[MutantRow<ParticleSettings, Bug>] = &[
    ("slab-cosine-sign", "the cosine of Henyey and Greenstein has the wrong sign: forward is backward", SLAB_ANALOG, CheckId::Mean, Bug::Backward),
    ("slab-albedo-twice", "the albedo is a chance and a weight", SLAB_NON_TERMINATING, CheckId::Mean, Bug::AlbedoTwice),
    ("slab-albedo-by-roulette-and-weight", "absorption by roulette and by weight at once", SLAB_WEIGHTED, CheckId::Mean, Bug::AnalogAndWeighted),
    ("slab-slant-forgotten", "a slanted flight goes as deep as one straight down", SLAB_ANALOG, CheckId::Lookups, Bug::Unslanted),
    ("slab-slant-inverted", "a flight goes u/|μ| deep", SLAB_WEIGHTED, CheckId::Mean, Bug::SlantInverted),
    ("slab-even-light", "diffuse light has the law dμ₀, without the cosine", SLAB_DIFFUSE, CheckId::Mean, Bug::EvenLight),
    ("slab-terminating-beyond", "the terminating rule where r > 2/(a + 1)", SLAB_ADAPTIVE, CheckId::Mean, Bug::Rule(Terminating)),
];

#[rustfmt::skip] // one mutant, one entry
const IN_FURNACE: &[MutantRow<ParticleSettings, Bug>] = &[
    ("furnace-albedo-twice", "the albedo is a chance and a weight", FURNACE_NON_TERMINATING, CheckId::Mean, Bug::AlbedoTwice),
    ("furnace-roulette-uncompensated", "who survives roulette keeps the old weight", FURNACE_ROULETTE, CheckId::Mean, Bug::Uncompensated),
    ("furnace-terminating-beyond", "the terminating rule where r > 2/(a + 1)", FURNACE_BELOW, CheckId::Mean, Bug::Rule(Terminating)),
    ("furnace-number-twice", "one random number for the flight and for what follows it", FURNACE_ANALOG, CheckId::Mean, Bug::NumberTwice),
];

#[rustfmt::skip] // one mutant, one entry
const IN_INFINITE_MEDIUM: &[MutantRow<ParticleSettings, Bug>] = &[
    ("infinite-cosine-sign", "the cosine of Henyey and Greenstein has the wrong sign: forward is backward", INFINITE_ANALOG, CheckId::Mean, Bug::Backward),
    ("infinite-turned-about-z", "a particle turns about the z axis, not about its direction", INFINITE_ANALOG, CheckId::Mean, Bug::AboutZ),
    ("infinite-albedo-twice", "absorption by weight and by roulette at once", INFINITE_WEIGHTED, CheckId::Mean, Bug::AlbedoTwice),
    ("infinite-roulette-uncompensated", "who survives roulette keeps the old weight", INFINITE_WEIGHTED, CheckId::Mean, Bug::Uncompensated),
];

#[rustfmt::skip] // one mutant, one entry
const UNDER_LIGHT: &[MutantRow<ParticleSettings, Bug>] = &[
    ("lambertian-even-light", "the cosine with the normal is even, without the law of Lambert", LAMBERTIAN, CheckId::Mean, Bug::EvenLight),
    ("lambertian-stale-majorant", "a flight goes on with the majorant of the cell it began in", LAMBERTIAN_CELLS, CheckId::Mean, Bug::StaleMajorant),
];

/// Mutants in a rod.
pub fn in_rod() -> Vec<Mutant<Rod>> {
    family(IN_ROD, &Bug::None, |&right, &bug| {
        let ParticleSettings { rule, roulette, .. } = bug.particle(right);
        filled(move |setup: &Setup<Rod>, request| {
            let walk = InRod { rod: &setup.problem, steps: RuleAndRoulette { rule, roulette } };
            walks::in_turn(&Altered { walk, change: bug }, setup, request);
        })
    })
}

/// Mutants in a slab.
pub fn in_slab() -> Vec<Mutant<Slab>> {
    family(IN_SLAB, &Bug::None, |&right, &bug| {
        let rule = bug.particle(right).rule;
        filled(move |setup: &Setup<Slab>, request| {
            let walk = InSlab::of(&setup.problem, rule);
            walks::in_turn(&Altered { walk, change: bug }, setup, request);
        })
    })
}

/// Mutants in a furnace.
pub fn in_furnace() -> Vec<Mutant<Furnace>> {
    in_space(IN_FURNACE)
}

/// Mutants in the infinite medium.
pub fn in_infinite_medium() -> Vec<Mutant<InfiniteMedium>> {
    in_space(IN_INFINITE_MEDIUM)
}

/// Mutants under light from all sides.
pub fn under_light() -> Vec<Mutant<Lambertian>> {
    in_space(UNDER_LIGHT)
}

fn in_space<P: Walked>(lines: &[MutantRow<ParticleSettings, Bug>]) -> Vec<Mutant<P>> {
    family(lines, &Bug::None, |&right, &bug| {
        let particle = bug.particle(right);
        one_by_one(move |setup: &Setup<P>, _, random| {
            let world = (setup.problem.scene(), &*setup.fields);
            match P::tally(setup, &particle) {
                Ok(tally) => {
                    let walk = InSpace::new(&tally, particle, world, &[]);
                    draws::draw(&Altered { walk, change: bug }, random)
                }
                Err(draw) => draw,
            }
        })
    })
}

impl Bug {
    /// The particle that walks: the right one, or one with another rule.
    fn particle(self, right: ParticleSettings) -> ParticleSettings {
        match self {
            Self::Rule(rule) => of(rule),
            Self::AnalogAndWeighted => of(Analog),
            _ => right,
        }
    }

    /// The weight of a walk that goes on, given the right one, the one before the collision, the probabilities of events
    /// and lanes that were scattered.
    fn weight<L: Lane>(
        self,
        right: L,
        before: L,
        (events, scattered): (EventProbabilities<L>, L::Mask),
        albedo: L,
    ) -> L {
        let EventProbabilities { scatter, scatter_weight, transmit_weight, .. } = events;
        match self {
            Self::AlbedoTwice | Self::AnalogAndWeighted => {
                L::select(scattered, right * albedo, right)
            }
            Self::AlbedoStraightOn => L::select(scattered, right, right * albedo),
            Self::SignLost => L::select(scattered, right, right.size().with_sign_of(before)),
            Self::Undivided => L::select(scattered, right * scatter, right),
            Self::Uncompensated => before * L::select(scattered, scatter_weight, transmit_weight),
            _ => right,
        }
    }
}

impl Change<InRod<'_>> for Bug {
    fn collide<L: Lane>(
        &self,
        walk: &InRod,
        particle: &mut rod::Particle<L>,
        route: &mut Route<impl BothWays<L>>,
        extinctions: &TentativeCollision<L>,
        random: &mut impl Random<L>,
    ) -> L::Mask {
        let before = *particle;
        let goes_on = walk.collide(particle, route, extinctions, random);
        let scattered = before.order.below(particle.order);
        let (albedo, forward) =
            (walk.rod.albedo.value(extinctions.t), walk.rod.forward.value(extinctions.t));
        match self {
            Self::OneNumber => {
                particle.is_forward =
                    before.is_forward ^ (scattered & forward.at_most(extinctions.number));
            }
            Self::Backward => particle.is_forward ^= scattered,
            _ => {}
        }
        let events = (walk.steps.rule.probabilities(extinctions.ratio(), albedo), scattered);
        let weight = self.weight(particle.weight, before.weight, events, albedo);
        particle.weight.set_where(goes_on, weight);
        goes_on
    }
}

impl Change<InSlab<'_>> for Bug {
    fn begin<L: Lane>(
        &self,
        walk: &InSlab,
        one: L,
        which: L::Mask,
        random: &mut impl Random<L>,
    ) -> slab::Particle<L> {
        let mut particle = walk.begin(one, which, random);
        if *self == Self::EvenLight {
            // √(1 − u) becomes 1 − u.
            particle.cosine = particle.cosine * particle.cosine;
        }
        particle
    }

    fn fly<L: Lane>(
        &self,
        walk: &InSlab,
        particle: &mut slab::Particle<L>,
        route: &mut Route<impl BothWays<L>>,
        depth: L,
    ) -> L::Mask {
        let slant = particle.cosine.size();
        let depth = match self {
            Self::Unslanted => depth / slant,
            Self::SlantInverted => depth / (slant * slant),
            _ => depth,
        };
        walk.fly(particle, route, depth)
    }

    fn collide<L: Lane>(
        &self,
        walk: &InSlab,
        particle: &mut slab::Particle<L>,
        route: &mut Route<impl BothWays<L>>,
        extinctions: &TentativeCollision<L>,
        random: &mut impl Random<L>,
    ) -> L::Mask {
        let (before, is_backward) = (*particle, *self == Self::Backward);
        let turns_from = if is_backward { -before.cosine } else { before.cosine };
        particle.cosine = turns_from;
        let goes_on = walk.collide(particle, route, extinctions, random);
        let scattered = !(particle.cosine - turns_from).equals(0.0);
        particle.cosine.set_where(!scattered, before.cosine);
        let albedo = extinctions.t.each(walk.albedo);
        let events = (walk.rule.probabilities(extinctions.ratio(), albedo), scattered);
        let weight = self.weight(particle.weight, before.weight, events, albedo);
        particle.weight.set_where(goes_on, weight);
        goes_on
    }
}

impl<T: Tally> Change<InSpace<'_, T>> for Bug {
    fn numbers<L: Lane>(
        &self,
        walk: &InSpace<T>,
        state: &mut State<L, T::Found<L>>,
        random: &mut impl Random<L>,
    ) -> [L; 2] {
        let (direction, turns) = (&mut state.path.flights.direction, state.scattered);
        match self {
            Self::AboutZ => direction.set_where(turns, Point([0.0, 0.0, 1.0]).each(direction[0])),
            Self::Backward => direction.set_where(turns, direction.map(|along| -along)),
            // The third number of a walk makes its cosine √(1 − u), which is 1 − v for u = 1 − (1 − v)².
            Self::EvenLight if state.ended.any() => {
                let even = |n, v: L| if n == 2 { v * (-v + 2.0) } else { v };
                return walk.numbers(state, &mut Renumbered::new(random, even));
            }
            _ => {}
        }
        walk.numbers(state, random)
    }

    fn fly<L: Lane>(
        &self,
        walk: &InSpace<T>,
        state: &mut State<L, T::Found<L>>,
        route: &mut Route<impl BothWays<L>>,
        depth: L,
    ) -> L::Mask {
        match self {
            Self::StaleMajorant => walk.advance_through(state, depth, |_, begun| begun),
            _ => walk.fly(state, route, depth),
        }
    }

    fn collide<L: Lane>(
        &self,
        walk: &InSpace<T>,
        state: &mut State<L, T::Found<L>>,
        route: &mut Route<impl BothWays<L>>,
        extinctions: &TentativeCollision<L>,
        random: &mut impl Random<L>,
    ) -> L::Mask {
        let weight = state.path.weight;
        if *self == Self::NumberTwice {
            let of_flight = |_, _| Lane::exp(-extinctions.number);
            return walk.collide(
                state,
                route,
                extinctions,
                &mut Renumbered::new(random, of_flight),
            );
        }
        let goes_on = walk.collide(state, route, extinctions, random);
        let albedo = weight.each(walk.scene.albedo.even().unwrap_or(f64::NAN));
        let ratio = extinctions.in_space[0] / state.sampling;
        let events = (walk.particle.rule.probabilities(ratio, albedo), state.scattered);
        let weight = self.weight(state.path.weight, weight, events, albedo);
        state.path.weight.set_where(goes_on, weight);
        goes_on
    }
}
