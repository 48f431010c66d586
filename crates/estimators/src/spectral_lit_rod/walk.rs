//! The walk of a hero from the camera to the emitter, with a shadow ray from every scattering.
//!
//! ```text
//! the hero h flies forward or backward through its σ̂;  at a tentative collision, r = σ_t/σ̂ of the hero:
//!   null, 1 − r       Π (1 − r_λ) of the segment goes on
//!   absorbed          the walk ends
//!   scattered, a r    weight_λ ← weight_λ p_λ(ω) Π (1 − r_λ) r_λ a_λ, relative to the hero's;
//!                     a shadow ray flies through the hero's σ̂ and scores what it finds
//! leaving forward     the path scores
//! ```
//!
//! The whole path has one hero, shadow rays too. A flight takes two random numbers, that of a shadow ray one, a
//! scattering one, the choice of the hero one. A lane flies as a walk or as a shadow ray. Where a walk is scattered
//! its place is kept, and its shadow ray flies on from there with the weights of the path. When the shadow ray has
//! ended, the walk continues.
//!
//! ```text
//! X_λ = f_λ/Σ_h w_h (p_uni,h + p_nee,h),   f_λ = p_uni,λ = q_λ ρ_λ,  p_nee,λ = q_λ,  ρ_λ = p_λ(ω) Π (1 − r_λ)
//! ```
//!
//! q is the common factor of both techniques: the path up to the last real scattering, the transmittances through
//! σ̂ and the rates of tentative collisions. ρ is the factor of hits alone: the density of the direction on the
//! last segment, and the probability of its null collisions. A hit scores the same as a shadow ray along the same
//! path. Where the path was never scattered, and where no shadow rays are cast, `p_nee = 0`. Densities are relative
//! to those of the hero, see [`Media::common`].

use super::Albedos;
use super::events::{PathTechnique, WalkEvents};
use crate::walks::hero::{
    HeroDistribution, LastPiece, Media, Weighing, number_of_hero, of_hero, or_of_hero,
};
use crate::walks::{self, GROUPS, Route, SOME_LEFT, Scores, TentativeCollision, Walk};
use crate::{Draw, Setup};
use media::Lookups;
use media::body::MAX_CHANNELS;
use media::sampling::BothWays;
use numeric::rng::{Random, Stream};
use numeric::{Lane, Mask, kept};
use theory::ParticleRule;
use theory::problems::ChannelValues as Values;
use theory::problems::SpectralLitRod;

/// Numbers of all channels.
type PerChannel = [f64; MAX_CHANNELS];

/// The walk of a hero to the emitter.
pub struct ToEmitter<'a, S> {
    /// End of the rod.
    end: f64,
    steps: &'a S,
    media: Media,
    distribution: HeroDistribution,
    mean_free_paths: PerChannel,
    albedos: Albedos<'a>,
    /// The probability to keep the direction by channel and hero.
    forward: [PerChannel; MAX_CHANNELS],
    /// Weightings of paths: see [`Technique`].
    weighings: [Weighing; 3],
    casts: bool,
}

impl<S> Clone for ToEmitter<'_, S> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S> Copy for ToEmitter<'_, S> {}

impl<'a, S: WalkEvents> ToEmitter<'a, S> {
    /// The walk on a setup.
    #[inline(always)]
    pub fn of(steps: &'a S, setup: &'a Setup<SpectralLitRod>) -> Self {
        Self::new(steps, setup, Albedos::of(setup))
    }

    /// The walk on a setup, prepared for many draws.
    pub fn prepared(steps: &'a S, setup: &'a Setup<SpectralLitRod>) -> Self {
        Self::new(steps, setup, Albedos::found(setup))
    }

    #[inline(always)]
    fn new(steps: &'a S, setup: &'a Setup<SpectralLitRod>, albedos: Albedos<'a>) -> Self {
        let (heroes, count) = (steps.heroes(), setup.fields.len());
        let [mut mean_free_paths, mut probabilities] = [[0.0; MAX_CHANNELS]; 2];
        let mut forward = [[0.0; MAX_CHANNELS]; MAX_CHANNELS];
        for (channel, own) in setup.fields.iter().enumerate() {
            mean_free_paths[channel] = 1.0 / own.majorant;
            probabilities[channel] = heroes.probability(count, channel);
            for (hero, forward) in forward[channel][..count].iter_mut().enumerate() {
                *forward = setup.problem.forward[steps.phase_of(channel, hero)];
            }
        }
        Self {
            end: setup.residual().mesh.support().to,
            steps,
            media: Media::new(setup, &probabilities),
            distribution: HeroDistribution::new(heroes, count),
            mean_free_paths,
            albedos,
            forward,
            weighings: PathTechnique::ALL.map(|light| steps.weighing(light)),
            casts: steps.has_shadow_rays(),
        }
    }
}

/// Makes one draw.
#[inline(always)]
pub fn draw(
    steps: &impl WalkEvents,
    setup: &Setup<SpectralLitRod>,
    medium: &Lookups,
    random: &mut Stream,
) -> Draw<Values> {
    walks::draw(&ToEmitter::of(steps, setup), setup.residual().sampling, medium, random)
}

kept! {
    /// Walks on their way, and shadow rays, kept in memory.
    pub struct Particle<L> {
        is_forward: L::Mask,
        /// Lanes that fly as shadow rays, and lanes among them with walks that kept their directions.
        casts: L::Mask,
        keeps: L::Mask,
        /// Lanes that score in this step, and shadow rays among them, which then return to their vertices.
        scores: L::Mask,
        connected: L::Mask,
        /// Number of the technique if the path arrives, see [`Technique`].
        light: L,
        /// The number of each hero, its mean free path, and by channel its probability to keep the direction.
        hero: L,
        mean_free_path: L,
        forward: [L; MAX_CHANNELS],
        /// The beginning of the flight, and its length, forward.
        before: L,
        last: L,
        /// Length of the path and number of its tentative collisions; both at the vertex of a shadow ray.
        length: L,
        collisions: L,
        at_vertex: [L; 2],
        /// Factor of q from the real scatterings, relative to the hero's.
        weights: [L; MAX_CHANNELS],
        /// `p_λ(ω)` on the last segment, and `Π (1 − r_λ)` over its null collisions.
        phases: [L; MAX_CHANNELS],
        nulls: [L; MAX_CHANNELS],
        /// Values of both at the vertex of a shadow ray, if [`WalkEvents::GOES_ON`].
        last_phases: [L; MAX_CHANNELS],
        last_nulls: [L; MAX_CHANNELS],
        /// Quotient of f and the densities, if [`WalkEvents::GAINS`].
        excess: [L; MAX_CHANNELS],
        /// Present `σ_t/σ̂` and a of each channel, and the weights after the current step.
        real: [L; MAX_CHANNELS],
        albedos: [L; MAX_CHANNELS],
        next: [L; MAX_CHANNELS],
    }
}

impl<S: WalkEvents> Walk for ToEmitter<'_, S> {
    type State<L: Lane> = Particle<L>;

    const IS_CHROMATIC: bool = true;
    const DECIDES: bool = false;
    const PAUSES: bool = true;
    const SCORES: Scores = Scores::Often;

    #[inline(always)]
    fn begin<L: Lane>(&self, one: L, which: L::Mask, random: &mut impl Random<L>) -> Particle<L> {
        let (zero, all, ones) = (one.each(0.0), one.at_most(one), [one; MAX_CHANNELS]);
        let mut path = Particle {
            is_forward: all,
            casts: !all,
            keeps: all,
            scores: !all,
            connected: !all,
            light: zero,
            hero: zero,
            mean_free_path: one,
            forward: ones,
            before: zero,
            length: zero,
            collisions: zero,
            at_vertex: [zero; 2],
            weights: ones,
            phases: ones,
            nulls: ones,
            last_phases: ones,
            last_nulls: ones,
            excess: ones,
            last: zero,
            real: ones,
            albedos: ones,
            next: ones,
        };
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
        let (zero, count) = (one.each(0.0), self.media.count);
        for channel in 0..count {
            path.weights[channel].keep_where(which, one);
            path.phases[channel].keep_where(which, one);
            path.nulls[channel].keep_where(which, one);
            if S::GAINS {
                path.excess[channel].keep_where(which, one);
            }
        }
        path.length.keep_where(which, zero);
        path.collisions.keep_where(which, zero);
        path.light.keep_where(which, zero);
        path.is_forward |= which;
        let hero = self.distribution.choose(random.uniform_where(which));
        path.hero.keep_where(which, hero);
        self.follow(path, which, hero);
        for channel in 0..count {
            let forward = number_of_hero(hero, &self.forward[channel][..count]);
            path.forward[channel].keep_where(which, forward);
        }
    }

    #[inline(always)]
    fn mean_free_path<L: Lane>(&self, path: &Particle<L>, _: &Route<impl BothWays<L>>) -> L {
        path.mean_free_path
    }

    #[inline(always)]
    fn fly<L: Lane>(
        &self,
        path: &mut Particle<L>,
        route: &mut Route<impl BothWays<L>>,
        depth: L,
    ) -> L::Mask {
        if self.casts && path.connected.any() {
            self.go_back(path, route);
        }
        path.before = route.here.reached();
        route.here.fly_either_way(depth, path.is_forward | path.casts)
    }

    #[inline(always)]
    fn collide<L: Lane>(
        &self,
        path: &mut Particle<L>,
        route: &mut Route<impl BothWays<L>>,
        collided: &TentativeCollision<L>,
        random: &mut impl Random<L>,
    ) -> L::Mask {
        let (TentativeCollision { inside, t, extinctions, .. }, count) =
            (*collided, self.media.count);
        let (one, casts) = (t.each(1.0), path.casts);
        let number = random.uniform_where(!casts);
        let end = one.each(self.end);
        path.last = L::select(inside, t, end) - path.before;
        path.length = path.length + path.last.size();
        path.collisions = path.collisions + L::select(inside, one, one.each(0.0));
        let (mut own, mut albedo) = (one, one);
        for (channel, &extinction) in extinctions.iter().enumerate() {
            let majorant = one.each(self.media.majorants[channel]);
            path.real[channel] = extinction / majorant;
            path.albedos[channel] = self.albedos.at(channel, t);
            own = or_of_hero(path.hero, channel, own, path.real[channel]);
            albedo = or_of_hero(path.hero, channel, albedo, path.albedos[channel]);
        }
        let (hero, first) = (path.hero, self.media.majorants[0]);
        let decides = self.steps.decides(
            own,
            #[inline(always)]
            || of_hero(hero, extinctions) / one.each(first),
        );
        let probabilities = ParticleRule::Analog.probabilities(decides, albedo);
        let (scattered, null) = probabilities.decide_each(inside & !casts, number);
        let passes = null | (casts & inside);
        for channel in 0..count {
            let passed = path.nulls[channel] * (one - path.real[channel]);
            path.nulls[channel].keep_where(passes, passed);
        }
        path.connected = casts & !inside;
        path.scores = (path.is_forward & !inside & !casts) | path.connected;
        if scattered.any() {
            self.scatter(path, route, scattered, random);
        }
        casts | scattered | null
    }

    #[inline(always)]
    fn media(&self) -> usize {
        self.media.count
    }

    #[inline(always)]
    fn channels(&self) -> usize {
        self.media.count
    }

    #[inline(always)]
    fn scores<L: Lane>(&self, path: &Particle<L>, _: L::Mask) -> L::Mask {
        path.scores
    }

    #[inline(always)]
    fn leaves<'a, L: Lane>(
        &self,
        path: &'a Particle<L>,
        some: &'a mut [L; SOME_LEFT],
    ) -> [&'a [L]; GROUPS] {
        let light =
            L::select(path.connected, PathTechnique::Connected.as_lane(path.hero), path.light);
        *some = [path.hero, path.length, path.collisions, path.last, light];
        let (all, gains) = (..self.media.count, if S::GAINS { self.media.count } else { 0 });
        [&some[..], &path.weights[all], &path.phases[all], &path.nulls[all], &path.excess[..gains]]
    }

    #[inline(always)]
    fn score<L: Lane>(&self, numbers: &[L], _: L::Mask, _: L, values: &mut [L]) -> L {
        let (count, zero, one) = (self.media.count, numbers[0].each(0.0), numbers[0].each(1.0));
        let [hero, length, collisions, last, light, lists @ ..] = numbers else { return zero };
        let without = self.of_found(*light, |by| f64::from(by.last_piece != LastPiece::Everywhere));
        let next_event = self.of_found(*light, |by| f64::from(by.has_next_event));
        let share = self.of_found(*light, |by| by.share);
        for (channel, value) in values.iter_mut().enumerate() {
            *value = lists[channel];
        }
        self.media.common(*hero, [*length - *last * without, *collisions], values);
        let mut density = zero;
        for (channel, value) in values.iter_mut().enumerate() {
            let (common, probability) = (*value, self.media.probabilities[channel]);
            let direction = common * lists[count + channel];
            let by_hit = direction * lists[2 * count + channel];
            *value = by_hit;
            if S::GAINS {
                *value = *value * lists[3 * count + channel];
            }
            if self.has(|by| by.last_piece == LastPiece::InContribution) {
                let in_contribution =
                    |by: &Weighing| f64::from(by.last_piece == LastPiece::InContribution);
                let is_added = zero.below(self.of_found(*light, in_contribution));
                let last = (-(*last * self.media.majorants[channel])).exp();
                *value = L::select(is_added, *value * last, *value);
            }
            if channel + self.weighings[0].missing < count {
                let has_nulls = self.of_found(*light, |by| f64::from(by.has_nulls));
                let by_hit = L::select(zero.below(has_nulls), by_hit, direction);
                density = density + by_hit * probability;
                density = density + common * probability * next_event;
            }
        }
        let scale = L::select(zero.below(density), one / (density * share), zero);
        for value in values {
            *value = *value * scale;
        }
        zero
    }
}

impl<S: WalkEvents> ToEmitter<'_, S> {
    /// Value of a weighting's property for the techniques that found the paths.
    #[inline(always)]
    fn of_found<L: Lane>(&self, light: L, says: impl Fn(&Weighing) -> f64) -> L {
        let [unscattered, hit, connected] = &self.weighings;
        let (unscattered, hit) = (light.each(says(unscattered)), light.each(says(hit)));
        let by_walk = L::select(light.equals(0.0), unscattered, hit);
        L::select(light.below(light.each(2.0)), by_walk, light.each(says(connected)))
    }

    /// Returns whether a property holds for one of the techniques.
    #[inline(always)]
    fn has(&self, says: impl Fn(&Weighing) -> bool) -> bool {
        let [unscattered, hit, connected] = &self.weighings;
        says(unscattered) || says(hit) || says(connected)
    }

    /// Begins segments in directions that were kept or not.
    #[inline(always)]
    fn turn<L: Lane>(&self, path: &mut Particle<L>, which: L::Mask, keeps: L::Mask) {
        let one = path.hero.each(1.0);
        for channel in 0..self.media.count {
            let forward = path.forward[channel];
            let mut phase = L::select(keeps, forward, one - forward);
            if S::GOES_ON {
                phase = phase * path.phases[channel];
            } else {
                path.nulls[channel].keep_where(which, one);
            }
            path.phases[channel].keep_where(which, phase);
        }
    }

    /// Scatters walks: the segment joins the path.
    #[inline(always)]
    fn scatter<L: Lane>(
        &self,
        path: &mut Particle<L>,
        route: &mut Route<impl BothWays<L>>,
        which: L::Mask,
        random: &mut impl Random<L>,
    ) {
        let (count, one) = (self.media.count, path.hero.each(1.0));
        let mut own = one;
        for channel in 0..count {
            let mut next = path.weights[channel] * (path.real[channel] * path.albedos[channel]);
            if !S::GOES_ON {
                next = next * (path.phases[channel] * path.nulls[channel]);
            }
            if S::GAINS {
                let excess = path.excess[channel] * path.albedos[channel];
                path.excess[channel].keep_where(which, excess);
            }
            path.next[channel] = next;
            own = or_of_hero(path.hero, channel, own, next);
        }
        // The hero's density is 0 only with a known bug.
        let own = L::select(one.each(0.0).below(own), own, one);
        for channel in 0..count {
            let next = path.next[channel] / own;
            path.weights[channel].keep_where(which, next);
        }
        // The hero's own phase function is always among those that count.
        let own = of_hero(path.hero, &path.forward[..count]);
        let keeps = random.uniform_where(which).below(own);
        if self.casts {
            self.cast(path, route, (which, keeps), random);
        } else {
            self.turn(path, which, keeps);
        }
        path.is_forward ^= which & !keeps;
        path.light.keep_where(which, PathTechnique::Hit.as_lane(one));
    }

    /// Casts shadow rays of walks that are scattered.
    #[inline(always)]
    fn cast<L: Lane>(
        &self,
        path: &mut Particle<L>,
        route: &mut Route<impl BothWays<L>>,
        (which, keeps): (L::Mask, L::Mask),
        random: &mut impl Random<L>,
    ) {
        if S::GOES_ON {
            for channel in 0..self.media.count {
                path.last_phases[channel].keep_where(which, path.phases[channel]);
                path.last_nulls[channel].keep_where(which, path.nulls[channel]);
            }
        }
        let is_forward = path.is_forward;
        self.turn(path, which, is_forward);
        route.mark_where(which);
        path.at_vertex[0].keep_where(which, path.length);
        path.at_vertex[1].keep_where(which, path.collisions);
        path.casts |= which;
        path.keeps.set_where(which, keeps);
        if S::CASTS_ANEW {
            self.follow(path, which, self.distribution.choose(random.uniform_where(which)));
        }
    }

    /// Sends walks on from where their shadow rays were cast.
    #[inline(always)]
    fn go_back<L: Lane>(&self, path: &mut Particle<L>, route: &mut Route<impl BothWays<L>>) {
        let (which, keeps, [length, collisions]) = (path.connected, path.keeps, path.at_vertex);
        route.return_where(which);
        path.length.keep_where(which, length);
        path.collisions.keep_where(which, collisions);
        if S::GOES_ON {
            for channel in 0..self.media.count {
                path.phases[channel].keep_where(which, path.last_phases[channel]);
                path.nulls[channel].keep_where(which, path.last_nulls[channel]);
            }
        }
        self.turn(path, which, keeps);
        path.casts &= !which;
        if S::CASTS_ANEW {
            self.follow(path, which, path.hero);
            route.here.change(path.mean_free_path);
        }
    }

    /// Sets the lanes in `which` to the σ̂ of a hero.
    #[inline(always)]
    fn follow<L: Lane>(&self, path: &mut Particle<L>, which: L::Mask, hero: L) {
        let mean_free_path = number_of_hero(hero, &self.mean_free_paths[..self.media.count]);
        path.mean_free_path.keep_where(which, mean_free_path);
    }
}
