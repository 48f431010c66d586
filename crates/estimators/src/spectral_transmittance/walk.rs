//! The walk of a hero channel through a chromatic medium, and its scores in all channels.
//!
//! ```text
//! tᵢ a Poisson process of rate μ̄_h;  ρ_λ = Π n_λ(tᵢ)/μ̄_λ,  n_λ = μ̄_λ − σ_λ
//! f_λ = q_λ ρ_λ,  p_h = q_h (ratio tracking) or q_h ρ_h (delta tracking),  q_λ = e^{−μ̄_λ ℓ} μ̄_λⁿ
//! ```
//!
//! `f_λ` is the contribution of the null-collision path to channel λ and `p_h` its density by the hero h. Delta
//! tracking ends at a real collision of the hero. A step takes one random number for the flight and, in delta
//! tracking, one for the collision. Spectral tracking has one σ̂ for all channels, weights `w_λ` in the place of
//! `ρ_λ`, and null collisions by a probability that depends on all channels.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A Null-Scattering Path Integral Formulation of Light
//! Transport*, ACM Transactions on Graphics 38 (2019), section 5.1.

use super::events::WalkEvents;
use crate::setup::heroes::Heroes;
use crate::walks::hero::{HeroDistribution, Media, number_of_hero, of_hero};
use crate::walks::{self, GROUPS, Route, SOME_LEFT, Scores, TentativeCollision, Walk};
use crate::{Draw, Setup};
use media::Lookups;
use media::body::MAX_CHANNELS;
use media::sampling::BothWays;
use numeric::rng::{Random, Stream};
use numeric::{Lane, Span, kept};
use theory::problems::SpectralTransmittance;
use theory::problems::transmittance::SpectralValues as Values;
use theory::ray::spectral::{Spectrum, Tracker};

/// The spectrum of a setup, for predictions.
pub fn spectrum(
    setup: &Setup<SpectralTransmittance>,
    heroes: &Heroes,
    tracker: Tracker,
) -> Spectrum {
    let meshes: Vec<_> = setup.fields.iter().map(|channel| &*channel.mesh).collect();
    let majorants = setup.fields.iter().map(|channel| channel.majorant).collect();
    Spectrum::new(&meshes, majorants, heroes.of(setup.fields.len()), tracker)
}

/// The walk that scores by a tracker.
#[derive(Clone, Copy)]
pub struct AlongRay<'a, S> {
    setup: &'a Setup<SpectralTransmittance>,
    support: Span,
    tracker: Tracker,
    /// True if one walk serves all channels through their common σ̂: no hero is chosen.
    is_common: bool,
    /// The distribution of heroes.
    pub distribution: HeroDistribution,
    media: Media,
    /// `1/σ̂` of each channel.
    mean_free_paths: [f64; MAX_CHANNELS],
    /// `∫σ̂` of each channel.
    collisions: [f64; MAX_CHANNELS],
    steps: S,
}

impl<'a, S: WalkEvents> AlongRay<'a, S> {
    /// The walk of heroes.
    #[inline(always)]
    pub fn new(
        setup: &'a Setup<SpectralTransmittance>,
        heroes: &Heroes,
        tracker: Tracker,
        steps: S,
    ) -> Self {
        let count = setup.fields.len();
        let [mut mean_free_paths, mut collisions] = [[0.0; MAX_CHANNELS]; 2];
        let mut probabilities = [0.0; MAX_CHANNELS];
        for (channel, own) in setup.fields.iter().enumerate() {
            mean_free_paths[channel] = 1.0 / own.majorant;
            collisions[channel] = own.collisions;
            probabilities[channel] = heroes.probability(count, channel);
        }
        Self {
            setup,
            support: setup.residual().mesh.support(),
            tracker,
            is_common: false,
            distribution: HeroDistribution::new(heroes, count),
            media: Media::new(setup, &probabilities),
            mean_free_paths,
            collisions,
            steps,
        }
    }

    /// The walk of all channels together, through one σ̂.
    #[inline(always)]
    pub fn common(
        setup: &'a Setup<SpectralTransmittance>,
        heroes: &Heroes,
        tracker: Tracker,
        steps: S,
    ) -> Self {
        Self { is_common: true, ..Self::new(setup, heroes, tracker, steps) }
    }

    /// Makes one draw.
    #[inline(always)]
    pub fn draw(&self, medium: &Lookups, random: &mut Stream) -> Draw<Values> {
        walks::draw(self, self.setup.residual().sampling, medium, random)
    }

    #[inline(always)]
    fn from<L: Lane>(&self, one: L) -> L {
        one.each(self.support.from)
    }

    /// Returns whether a walk scores its hero alone.
    #[inline(always)]
    fn is_alone(&self) -> bool {
        matches!(self.tracker, Tracker::Independent { .. } | Tracker::InTurn { .. })
    }

    /// The probability that a collision is null; `None` where all collisions are.
    #[inline(always)]
    fn survival<L: Lane>(&self, hero: L, weights: &[L], shares: &[L]) -> Option<L> {
        match self.tracker {
            Tracker::Tracking(choice) => Some(choice.of_null(shares)),
            // Probabilities that depend on the weights score as the balance heuristic does.
            Tracker::Mis { delta: true } if self.is_common => {
                let (mut nulls, mut all) = (hero.each(0.0), hero.each(0.0));
                for (channel, &share) in shares.iter().enumerate() {
                    nulls = nulls + weights[channel] * share;
                    all = all + weights[channel];
                }
                Some(nulls / all)
            }
            Tracker::Hero { delta: true } | Tracker::Mis { delta: true } => {
                Some(of_hero(hero, shares))
            }
            _ => None,
        }
    }
}

/// Walks that score their heroes alone.
impl<S: WalkEvents> AlongRay<'_, S> {
    /// Sets the heroes of the lanes in `which`.
    #[inline(always)]
    fn follow<L: Lane>(&self, path: &mut Particle<L>, which: L::Mask, hero: L) {
        let count = self.media.count;
        path.hero.keep_where(which, hero);
        let mean_free_path = number_of_hero(hero, &self.mean_free_paths[..count]);
        path.mean_free_path.keep_where(which, mean_free_path);
        if self.is_alone() {
            let majorant = number_of_hero(hero, &self.media.majorants[..count]);
            path.majorant.keep_where(which, majorant);
        }
    }

    /// Handles collisions in the media of the heroes; returns the lanes that go on.
    #[inline(always)]
    fn collide_alone<L: Lane>(
        path: &mut Particle<L>,
        delta: bool,
        collided: &TentativeCollision<L>,
        random: &mut impl Random<L>,
    ) -> L::Mask {
        let share = collided.t.each(1.0) - of_hero(path.hero, collided.extinctions) / path.majorant;
        if delta {
            return random.uniform().below(share) & collided.inside;
        }
        let ratio = path.weights[0] * share;
        path.weights[0].keep_where(collided.inside, ratio);
        collided.inside
    }

    /// Restarts walks that have ended with the next channel, if there is one; returns the lanes that do.
    #[inline(always)]
    fn turn<L: Lane>(
        &self,
        path: &mut Particle<L>,
        delta: bool,
        (ended, inside): (L::Mask, L::Mask),
        route: &mut Route<impl BothWays<L>>,
    ) -> L::Mask {
        let (hero, count) = (path.hero, self.media.count);
        let (zero, one) = (hero.each(0.0), hero.each(1.0));
        let value = L::select(inside, zero, if delta { one } else { path.weights[0] });
        for channel in 0..count {
            path.weights[channel + 1].keep_where(ended & hero.equals(channel as f64), value);
        }
        let next = ended & hero.below(one.each((count - 1) as f64));
        path.weights[0].keep_where(next, one);
        self.follow(path, next, hero + 1.0);
        route.here.restart(next);
        next
    }
}

/// Scores of walks that have ended.
impl<S: WalkEvents> AlongRay<'_, S> {
    /// Computes scores from the hero and the weights that a walk left.
    #[inline(always)]
    fn weigh<L: Lane>(&self, numbers: &[L], lookups: L, values: &mut [L]) {
        let [hero, weights @ ..] = numbers else { return };
        let count = self.media.count;
        let (hero, one) = (*hero, hero.each(1.0));
        let last = || one.each(self.support.to) - weights[count];
        match self.tracker {
            Tracker::Independent { delta } => {
                let value = if delta { one } else { weights[0] };
                for (channel, own) in values.iter_mut().enumerate() {
                    let is_hero = hero.equals(channel as f64);
                    *own = self.steps.alone(is_hero, value, self.media.probabilities[channel]);
                }
            }
            Tracker::Hero { delta } if !self.is_common => {
                let density = if delta { of_hero(hero, &weights[..count]) } else { one };
                for (channel, own) in values.iter_mut().enumerate() {
                    *own = self.relative(channel, hero, lookups, last) * weights[channel] / density;
                }
            }
            Tracker::Mis { delta } if !self.is_common => {
                let (mut mean, mut densities) = (one.each(0.0), [one; MAX_CHANNELS]);
                for (channel, own) in values.iter_mut().enumerate() {
                    let relative = self.relative(channel, hero, lookups, last);
                    *own = relative * weights[channel];
                    densities[channel] = self.steps.density(delta, *own, relative);
                    let probability = self.media.probabilities[channel];
                    mean = mean
                        + densities[channel] * self.steps.share(probability, channel + 1 == count);
                }
                for (channel, own) in values.iter_mut().enumerate() {
                    *own = *own / self.steps.divisor(mean, densities[channel]);
                }
            }
            _ => {
                for (channel, own) in values.iter_mut().enumerate() {
                    *own = weights[channel];
                }
            }
        }
    }

    /// `q_λ/q_h`.
    #[inline(always)]
    fn relative<L: Lane>(&self, channel: usize, hero: L, lookups: L, last: impl Fn() -> L) -> L {
        let (Media { count, logarithms, majorants, .. }, collisions) =
            (&self.media, &self.collisions);
        let logarithm = number_of_hero(hero, &logarithms[..*count]);
        let log = lookups * (hero.each(logarithms[channel]) - logarithm);
        let expected = number_of_hero(hero, &collisions[..*count]);
        let relative = Lane::exp(log - (hero.each(collisions[channel]) - expected));
        let heros = number_of_hero(hero, &majorants[..*count]);
        self.steps.relative(relative, [hero.each(majorants[channel]), heros], last)
    }
}

kept! {
    /// Walks along a ray.
    pub struct Particle<L> {
        /// The number of the hero.
        hero: L,
        /// σ̂ of the hero, and `1/σ̂`.
        majorant: L,
        mean_free_path: L,
        /// `ρ_λ`, or the weights of spectral tracking. Walks that score their heroes alone use the first one only.
        /// Walks in turn store the values of finished channels behind it.
        weights: [L; MAX_CHANNELS + 1],
        /// Present `1 − σ_t/σ̂` of each channel.
        shares: [L; MAX_CHANNELS],
        /// The last collision, if [`WalkEvents::KEEPS_LAST`].
        last: L,
    }
}

impl<S: WalkEvents> Walk for AlongRay<'_, S> {
    type State<L: Lane> = Particle<L>;

    const IS_CHROMATIC: bool = true;
    const DECIDES: bool = false;
    const PAUSES: bool = true;
    const SCORES: Scores = Scores::Later;

    #[inline(always)]
    fn begin<L: Lane>(&self, one: L, which: L::Mask, random: &mut impl Random<L>) -> Particle<L> {
        let (hero, majorant) = (one.each(0.0), one.each(self.media.majorants[0]));
        let (mean_free_path, last) = (one.each(self.mean_free_paths[0]), self.from(one));
        let (weights, shares) = ([one; MAX_CHANNELS + 1], [one; MAX_CHANNELS]);
        let mut path = Particle { hero, majorant, mean_free_path, weights, shares, last };
        self.restart(&mut path, which, one, random);
        path
    }

    #[inline(always)]
    fn restart<L: Lane>(
        &self,
        path: &mut Particle<L>,
        which: L::Mask,
        one: L,
        random: &mut impl Random<L>,
    ) {
        let count = if self.is_alone() { 1 } else { self.media.count };
        for weight in &mut path.weights[..count] {
            weight.keep_where(which, one);
        }
        if S::KEEPS_LAST {
            path.last.keep_where(which, self.from(one));
        }
        match self.tracker {
            _ if self.is_common => {}
            Tracker::InTurn { .. } => self.follow(path, which, one.each(0.0)),
            _ => self.follow(path, which, self.distribution.choose(random.uniform_where(which))),
        }
    }

    #[inline(always)]
    fn mean_free_path<L: Lane>(&self, path: &Particle<L>, _: &Route<impl BothWays<L>>) -> L {
        path.mean_free_path
    }

    #[inline(always)]
    fn collide<L: Lane>(
        &self,
        path: &mut Particle<L>,
        route: &mut Route<impl BothWays<L>>,
        collided: &TentativeCollision<L>,
        random: &mut impl Random<L>,
    ) -> L::Mask {
        if let Tracker::Independent { delta } | Tracker::InTurn { delta } = self.tracker {
            let goes_on = Self::collide_alone(path, delta, collided, random);
            if matches!(self.tracker, Tracker::InTurn { .. }) {
                return goes_on | self.turn(path, delta, (!goes_on, collided.inside), route);
            }
            return goes_on;
        }
        let (TentativeCollision { inside, t, extinctions, .. }, count) =
            (*collided, self.media.count);
        let number = if self.tracker.is_delta() { random.uniform() } else { t };
        let one = t.each(1.0);
        let (hero, majorants) = (path.hero, &self.media.majorants[..count]);
        let heros = || number_of_hero(hero, majorants);
        let shares = &mut path.shares;
        for (channel, &extinction) in extinctions.iter().enumerate() {
            let own = one.each(self.media.majorants[channel]);
            shares[channel] = one - extinction / self.steps.majorant(own, heros);
        }
        let hero = self.steps.decides(hero, inside, random);
        let (mut goes_on, mut divisor) = (inside, None);
        if let Some(right) = self.survival(hero, &path.weights, &shares[..count]) {
            let mut survival = right;
            if self.is_common {
                let [choice, by] = self.steps.tracked(right, &shares[..count]);
                (survival, divisor) = (choice, Some(by));
            }
            goes_on = number.below(survival) & inside;
        }
        for (channel, &share) in shares[..count].iter().enumerate() {
            let mut factor = share;
            if let Some(divisor) = divisor {
                factor = factor / divisor;
            }
            let weight = path.weights[channel] * factor;
            path.weights[channel].keep_where(inside, weight);
        }
        if S::KEEPS_LAST {
            path.last.keep_where(inside, t);
        }
        goes_on
    }

    #[inline(always)]
    fn media(&self) -> usize {
        self.media.count
    }

    #[inline(always)]
    fn channels(&self) -> usize {
        let luminance = &self.setup.problem.luminance;
        self.media.count + usize::from(!luminance.is_empty())
    }

    #[inline(always)]
    fn leaves<'a, L: Lane>(
        &self,
        path: &'a Particle<L>,
        some: &'a mut [L; SOME_LEFT],
    ) -> [&'a [L]; GROUPS] {
        (some[0], some[1]) = (path.hero, path.last);
        let weights = match self.tracker {
            Tracker::Independent { .. } => &path.weights[..1],
            Tracker::InTurn { .. } => &path.weights[1..=self.media.count],
            _ => &path.weights[..self.media.count],
        };
        let last = if S::KEEPS_LAST { &some[1..2] } else { &[] };
        [&some[..1], weights, last, &[], &[]]
    }

    #[inline(always)]
    fn score<L: Lane>(&self, numbers: &[L], lives: L::Mask, lookups: L, values: &mut [L]) -> L {
        let (zero, count) = (lookups.each(0.0), self.media.count);
        self.weigh(numbers, lookups, &mut values[..count]);
        if !matches!(self.tracker, Tracker::InTurn { .. }) {
            for value in &mut values[..count] {
                *value = L::select(lives, *value, zero).sealed();
            }
        }
        if let [first, rest @ ..] = &self.setup.problem.luminance[..] {
            let mut sum = values[0] * *first;
            for (channel, &weight) in rest.iter().enumerate() {
                sum = sum + values[channel + 1] * weight;
            }
            values[count] = sum;
        }
        zero
    }
}
