//! The analog walk through a rod or a slab, and its scores in all channels by its number of scatterings.
//!
//! ```text
//! fly forward or backward through σ̂; at a tentative collision the particle goes straight on with probability
//! 1 − r, r = σ_t/σ̂, is scattered with a r, and absorbed otherwise; scattered, it turns round with 1 − p_f
//! ```
//!
//! A flight and the event at its end take a random number each; a scattering takes a third. The choice of a hero
//! takes the first of all. A rod is a slab with two directions, of cosines 1 and −1; slabs decide as `slab` does.

use std::f64::consts::TAU;

use super::Coloured;
use crate::setup::heroes::Heroes;
use crate::walks::hero::{HeroDistribution, number_of_hero};
use crate::walks::steps::{diffuse, entering, turned};
use crate::walks::{self, GROUPS, Route, SOME_LEFT, Scores, TentativeCollision, Walk};
use crate::{Draw, Kernel, Refusal, Request, Setup};
use media::Lookups;
use media::body::MAX_CHANNELS;
use media::phase::Phase;
use media::phase::isotropic::Isotropic;
use media::sampling::BothWays;
use numeric::digits::rounded;
use numeric::pack::WIDTH;
use numeric::rng::{Random, Stream};
use numeric::{Lane, Mask, kept};
use theory::ParticleRule;
use theory::colours::scatterers::Divergence;
use theory::problems::channels::{ColourValues as Values, Colours, End};
use theory::problems::slab::{Incidence, IncidentLight};

/// Geometry of the walks.
#[derive(Clone, Copy)]
pub enum Place<'a> {
    /// A rod, with the probability that scattering keeps the direction.
    Rod(f64),
    /// A slab, with its incident light.
    Slab(&'a Incidence),
}

/// Hero of a walk, and its weights in every channel.
pub trait HeroWeights {
    /// The distribution of the hero; `None` where one walk, number 0, serves all channels.
    fn heroes(&self) -> Option<&Heroes>;

    /// Probability that a real collision scatters a hero.
    #[inline(always)]
    fn probability(&self, albedos: &[f64], hero: usize) -> f64 {
        albedos[hero]
    }

    /// Weights of a walk in every channel where it leaves after `order` scatterings.
    fn weights(&self, albedos: &[f64], hero: usize, order: u32) -> [f64; MAX_CHANNELS];
}

/// `(a_λ/P)^r`: the density of each channel's walk after r scatterings, relative to a walk that is scattered with a
/// probability P.
#[inline(always)]
pub fn relative_to(albedos: &[f64], probability: f64, order: u32) -> [f64; MAX_CHANNELS] {
    let mut weights = [1.0; MAX_CHANNELS];
    for _ in 0..order {
        for (weight, albedo) in weights.iter_mut().zip(albedos) {
            *weight *= albedo / probability;
        }
    }
    weights
}

kept! {
    /// Particles on their way.
    pub struct Particle<L> {
        /// The cosine of the direction with the normal of a slab; 1 or −1 in a rod.
        cosine: L,
        /// The number of the hero, and its probability to be scattered at a real collision.
        hero: L,
        scattering: L,
        /// The number of scatterings.
        order: L,
    }
}

/// The walk through a body.
#[derive(Clone, Copy)]
pub struct InBody<'a> {
    place: Place<'a>,
    colours: &'a Colours,
    page: &'a dyn HeroWeights,
    /// The distribution of the hero, if one is chosen.
    distribution: Option<HeroDistribution>,
    /// The number of heroes, and their probabilities to be scattered at a real collision.
    heroes: usize,
    probabilities: [f64; MAX_CHANNELS],
    /// Weights by channel, order and hero: of [`TABLE`] orders, or empty.
    table: &'a [f64],
}

/// Number of orders in the table.
const TABLE: usize = 16;

impl<'a> InBody<'a> {
    #[inline(always)]
    fn new<P: Coloured>(page: &'a dyn HeroWeights, setup: &'a Setup<P>) -> Self {
        let (place, colours) = (setup.problem.place(), setup.problem.colours());
        let albedos = &colours.albedos;
        let distribution = page.heroes().map(|heroes| HeroDistribution::new(heroes, albedos.len()));
        let heroes = if distribution.is_some() { albedos.len() } else { 1 };
        let mut probabilities = [0.0; MAX_CHANNELS];
        for (hero, scattering) in probabilities[..heroes].iter_mut().enumerate() {
            *scattering = page.probability(albedos, hero);
        }
        Self { place, colours, page, distribution, heroes, probabilities, table: &[] }
    }

    /// The weights of walks by their number, `order · heroes + hero`.
    fn weights_of(&self, number: usize) -> [f64; MAX_CHANNELS] {
        let order = u32::try_from(number / self.heroes).unwrap_or(u32::MAX);
        self.page.weights(&self.colours.albedos, number % self.heroes, order)
    }

    /// Weights by channel, order and hero.
    fn tabulated(&self) -> Vec<f64> {
        let of: Vec<_> = (0..TABLE * self.heroes).map(|number| self.weights_of(number)).collect();
        let of_channel = |channel: usize| of.iter().map(move |weights| weights[channel]);
        (0..self.colours.albedos.len()).flat_map(of_channel).collect()
    }

    /// Lanes at a collision that are scattered, and lanes that go straight on.
    #[inline(always)]
    fn decide<L: Lane>(
        &self,
        extinctions: &TentativeCollision<L>,
        scattering: L,
        sampling: L,
    ) -> [L::Mask; 2] {
        let TentativeCollision { inside, extinction, number, .. } = *extinctions;
        if let Place::Slab(_) = self.place {
            let (scattered, passes) = ParticleRule::Analog
                .probabilities(extinctions.ratio(), scattering)
                .decide_each(inside, number);
            return [scattered, passes];
        }
        let ratio = extinction / sampling;
        let null = ratio.one_minus();
        let passes = inside & number.below(null);
        [inside & !passes & number.below(null + scattering * ratio), passes]
    }

    /// The cosines of lanes that are scattered.
    #[inline(always)]
    fn turned<L: Lane>(&self, cosine: L, which: L::Mask, random: &mut impl Random<L>) -> L {
        let number = random.uniform_where(which);
        let phase = match self.place {
            Place::Rod(forward) => {
                return L::select(number.below(number.each(forward)), cosine, -cosine);
            }
            Place::Slab(incidence) => &incidence.phase,
        };
        let deflection = phase.cosine(number);
        if *phase == Phase::Isotropic(Isotropic) {
            return deflection;
        }
        turned(cosine, deflection, (random.uniform_where(which) * TAU).cos())
    }

    /// Values of walks in all channels.
    #[inline(always)]
    fn weights<L: Lane>(&self, hero: L, order: L) -> [L; MAX_CHANNELS] {
        let mut weights = [hero; MAX_CHANNELS];
        let mut number = order * self.heroes as f64 + hero;
        let size = TABLE * self.heroes;
        let is_known = order.below(order.each(TABLE as f64));
        if !self.table.is_empty() && !(!is_known).any() {
            for (channel, table) in self.table.chunks_exact(size).enumerate() {
                weights[channel] = number.entry(table);
            }
            return weights;
        }
        let mut lanes = [[0.0; MAX_CHANNELS]; WIDTH];
        let mut note = |numbers: &mut [f64]| {
            for (lane, number) in numbers.iter().enumerate() {
                lanes[lane] = self.weights_of(whole(*number));
            }
        };
        number = number.replaced(&mut note);
        for channel in 0..self.colours.albedos.len() {
            weights[channel] = number.replaced(
                #[inline(always)]
                |elements| {
                    for (lane, element) in elements.iter_mut().enumerate() {
                        *element = lanes[lane][channel];
                    }
                },
            );
        }
        weights
    }
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a count
fn whole(number: f64) -> usize {
    number as usize
}

impl Walk for InBody<'_> {
    type State<L: Lane> = Particle<L>;

    const SCORES: Scores = Scores::Later;

    #[inline(always)]
    fn begin<L: Lane>(&self, one: L, which: L::Mask, random: &mut impl Random<L>) -> Particle<L> {
        let zero = one.each(0.0);
        let hero = match &self.distribution {
            Some(distribution) => distribution.choose(random.uniform_where(which)),
            None => zero,
        };
        let light = match self.place {
            Place::Rod(_) => IncidentLight::Collimated(1.0),
            Place::Slab(incidence) => incidence.light,
        };
        let cosine = entering(light, diffuse, which, one, random);
        let scattering = number_of_hero(hero, &self.probabilities[..self.heroes]);
        Particle { cosine, hero, scattering, order: zero }
    }

    #[inline(always)]
    fn fly<L: Lane>(
        &self,
        particle: &mut Particle<L>,
        route: &mut Route<impl BothWays<L>>,
        depth: L,
    ) -> L::Mask {
        let cosine = particle.cosine;
        route.here.fly_either_way(depth * cosine.size(), cosine.each(0.0).below(cosine))
    }

    #[inline(always)]
    fn collide<L: Lane>(
        &self,
        particle: &mut Particle<L>,
        route: &mut Route<impl BothWays<L>>,
        extinctions: &TentativeCollision<L>,
        random: &mut impl Random<L>,
    ) -> L::Mask {
        let [scattered, passes] =
            self.decide(extinctions, particle.scattering, route.here.sampling());
        if scattered.maybe() {
            let cosine = self.turned(particle.cosine, scattered, random);
            particle.cosine.set_where(scattered, cosine);
            particle.order.count_where(scattered);
        }
        scattered | passes
    }

    #[inline(always)]
    fn channels(&self) -> usize {
        self.colours.seen.len()
    }

    #[inline(always)]
    fn leaves<'a, L: Lane>(
        &self,
        particle: &'a Particle<L>,
        some: &'a mut [L; SOME_LEFT],
    ) -> [&'a [L]; GROUPS] {
        (some[0], some[1], some[2]) = (particle.cosine, particle.hero, particle.order);
        [&some[..3], &[], &[], &[], &[]]
    }

    #[inline(always)]
    fn score<L: Lane>(&self, numbers: &[L], left: L::Mask, _: L, values: &mut [L]) -> L {
        let (cosine, zero) = (numbers[0], numbers[0].each(0.0));
        let (weights, is_down) = (self.weights(numbers[1], numbers[2]), zero.below(cosine));
        for (number, &(end, channel)) in self.colours.seen.iter().enumerate() {
            let there = if end == End::Transmitted { is_down } else { !is_down };
            values[number] = L::select(left & there, weights[channel], zero).sealed();
        }
        zero
    }
}

/// Makes one draw.
#[inline(always)]
pub fn draw<P: Coloured>(
    page: &impl HeroWeights,
    setup: &Setup<P>,
    medium: &Lookups,
    random: &mut Stream,
) -> Draw<Values> {
    walks::draw(&InBody::new(page, setup), &setup.fields.sampling, medium, random)
}

/// Makes the draws of a request.
pub fn fill<P: Coloured>(
    page: &dyn HeroWeights,
    kernel: Kernel,
    setup: &Setup<P>,
    request: Request,
) {
    let walk = InBody::new(page, setup);
    let table = walk.tabulated();
    walks::fill(&InBody { table: &table, ..walk }, kernel, setup, request);
}

/// Checks σ̂ ≥ σ_t, few collisions, one hero probability for each channel, and that theory covers the body.
///
/// # Errors
///
/// The violated requirement.
pub fn require<P: Coloured>(setup: &Setup<P>, heroes: &Heroes) -> Result<(), Refusal> {
    heroes.require(setup.problem.colours().albedos.len())?;
    setup.residual().require_ratio_at_most(1.0, "σ̂ ≥ σ_t everywhere")?;
    setup.residual().require_few_collisions("∫σ̂ ≤ 1e6")?;
    P::require_answer(setup)
}

/// Requires heroes that scatter, or none that does.
///
/// # Errors
///
/// A hero that is not scattered where another channel is.
pub fn require_scattering(albedos: &[f64], heroes: &Heroes) -> Result<(), Refusal> {
    let scatters = albedos.iter().any(|&albedo| albedo > 0.0);
    let lost = (0..albedos.len()).find(|&hero| {
        scatters && albedos[hero] == 0.0 && heroes.probability(albedos.len(), hero) > 0.0
    });
    lost.map_or(Ok(()), |hero| {
        let actual = format!("the albedo of channel {} is 0, which biases the others", hero + 1);
        Err(Refusal::mismatch("heroes that scatter where another channel does", actual))
    })
}

/// Requires a finite variance of each channel.
///
/// # Errors
///
/// The channel, and the body that it needs.
pub fn require_variance(divergence: Option<(usize, Divergence)>) -> Result<(), Refusal> {
    let Some((channel, reason)) = divergence else { return Ok(()) };
    let reason = match reason {
        Divergence::BeyondLength { critical } => {
            format!("is infinite from optical length {} on", rounded(critical))
        }
        Divergence::Overflow => "is infinite for a double: it is above 1.8e308".into(),
        Divergence::BeyondAlbedo { critical, albedo } => {
            let [critical, albedo] = [critical, albedo].map(rounded);
            format!("is infinite from the albedo {critical} on, and it asks for {albedo}")
        }
        Divergence::NearAlbedo { critical, albedo } => {
            let [critical, albedo] = [critical, albedo].map(rounded);
            format!(
                "asks for the albedo {albedo}, which is too near to {critical}, from about where on it is infinite, to tell \
                 on which side it is"
            )
        }
    };
    let actual = format!("E[X²] of channel {} {reason}", channel + 1);
    Err(Refusal::mismatch("a finite variance", actual))
}
